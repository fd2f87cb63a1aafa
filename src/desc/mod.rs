//! Scene files as plain data: what was asked for, with the place in the file where it was asked.
//!
//! [`load`] reads a scene file into a [`SceneDesc`]. Nothing here knows how to render: spectra are the numbers that were typed,
//! transforms are matrices, materials and lights are names with parameters already checked for type and range. The scene builder
//! turns a description into things that rays can meet.
//!
//! The formats: pbrt-v4 ([`pbrt`]) and Mitsuba 3 ([`mitsuba`]), with meshes in PLY ([`ply`]), OBJ ([`obj`]) and Mitsuba's own
//! format ([`serialized`]); meshes in PLY or OBJ by themselves ([`bare`]). Lucerna's extensions to pbrt-v4:
//!
//! - several `Camera` directives before `WorldBegin` are several views, named by `"string name"`; film, sampler and filter are
//!   shared by all of them;
//! - `"float nearclip"` of a perspective camera, see [`CameraKind::Perspective`];
//! - `"point3 P1"` of a `trianglemesh`, see [`MeshDesc::positions_end`];
//! - `"integer maxdepth" -1` of an integrator: paths of any length;
//! - `PixelFilter "blackmanharris"`;
//! - a file of responses as the `sensor` of a film, see [`SensorDesc::Curves`], and its `measure`, see [`MeasureDesc`];
//! - `"integer blades"` and `"float bladerotation"` of a camera, see [`ApertureDesc`];
//! - glasses by Sellmeier's equation and more metals among the spectra with names.

pub mod bare;
mod bytes;
mod camera;
mod degenerate;
mod film;
mod images;
mod integrator;
mod kinds;
mod light;
mod material;
mod measured_media;
mod medium;
pub mod mitsuba;
pub mod obj;
pub mod pbrt;
pub mod ply;
mod report;
pub mod rgl;
pub mod serialized;
mod shape;
mod suggest;
mod texture;
mod view;

use std::path::Path;

use glam::DAffine3;

use crate::error::{Diagnostic, Error, Result, SourceMap, Span};

pub use crate::sampling::SamplerKind;
pub use crate::spectrum::ColorSpace;
pub use camera::{ApertureDesc, CameraDesc, CameraKind, LensSurface, RealisticDesc, StopShape};
pub use film::{CropDesc, FilmDesc, FilmKind, GBufferSpace, MeasureDesc, PixelRect, SensorDesc, SpectralBins};
pub use integrator::{
    Distribution, Heuristic, IntegratorDesc, IntegratorKind, KajiyaDesc, LightSamplerKind, OcclusionDesc, PathDesc,
    PhotonDesc, PhotonFilter, SppmDesc, Strategy, Term, Termination, Terms,
};
pub use kinds::{
    Entry, FloatRange, INTEGRATORS, LIGHTS, MATERIALS, MEDIA, Parameter, ParameterDefault, ParameterKind, SAMPLERS,
    TEXTURES,
};
pub use light::{AreaLightDesc, AreaSpread, LightDesc, LightKind, SpotFalloff};
pub use material::{
    CoatDesc, ConductorDesc, DistributionDesc, HairColorDesc, HairDesc, MaterialDesc, MaterialKind, PlasticDesc,
    PrincipledDesc, ReliefDesc, RoughnessDesc, SpectrumDesc, SpectrumValue,
};
pub use medium::{CoefficientsDesc, MediumDesc, MediumInterfaceDesc};
pub use rgl::{MeasuredDesc, Tensor};
pub use shape::{
    AttributeDomain, CurveDesc, CurveKindDesc, DisplacementDesc, MeshAttributeDesc, MeshDesc, PatchMeshDesc,
    QuadricDesc, ShapeDesc, ShapeKind, TubeBasis, TubesDesc,
};
pub use texture::{
    ClassedTexture, ImageDesc, ImageFilterDesc, ImageId, ImageMapDesc, MappingDesc, OctavesDesc, TextureClass,
    TextureDesc, TextureId, TextureKind, Textured, WrapDesc, color_space_of,
};
pub use view::{FilterDesc, FilterKind, SamplerDesc, ViewDesc};

/// A whole scene, as its file describes it.
///
/// Every index in it ([`MaterialId`], [`MediumId`], [`TextureId`], [`ObjectId`], the vertex indices of meshes) is in range, every number finite, every transform
/// invertible.
#[derive(Clone, Debug)]
pub struct SceneDesc {
    /// The texts that the spans point into.
    pub sources: SourceMap,
    /// At least one; names are distinct.
    pub views: Vec<ViewDesc>,
    /// How light transport is to be estimated.
    pub integrator: IntegratorDesc,
    /// What [`MaterialId`] counts. The first is pbrt's default, a diffuse reflectance of 0.5.
    pub materials: Vec<MaterialDesc>,
    /// What [`MediumId`] counts.
    pub media: Vec<MediumDesc>,
    /// What [`TextureId`] counts.
    pub textures: Vec<TextureDesc>,
    /// What [`ImageId`] counts: every file once for each encoding.
    pub images: Vec<ImageDesc>,
    /// The shapes that stand in the world themselves, in file order.
    pub shapes: Vec<ShapeDesc>,
    /// Groups of shapes that are seen only through instances; what [`ObjectId`] counts.
    pub objects: Vec<ObjectDesc>,
    /// Copies of objects, in file order.
    pub instances: Vec<InstanceDesc>,
    /// Lights that are not shapes, in file order; for those see [`ShapeDesc::area_light`].
    pub lights: Vec<LightDesc>,
    /// The times of the start and the end of every [`MotionDesc`], in the time of the shutters: start < end. Scene time 0 is the
    /// former, 1 the latter; outside them everything stands still.
    pub transform_times: [f64; 2],
    /// What has no effect or is approximated, in file order.
    pub warnings: Vec<Diagnostic>,
    /// BLAKE3 over the bytes of all files read, meshes and spectra included, in hexadecimal.
    pub hash: String,
}

/// Index into [`SceneDesc::materials`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MaterialId(pub u32);

/// Index into [`SceneDesc::media`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct MediumId(pub u32);

/// Index into [`SceneDesc::objects`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ObjectId(pub u32);

/// A transform at the two [`SceneDesc::transform_times`]; how to go from one to the other (by decomposition and quaternions) is the
/// renderer's business.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionDesc {
    /// At scene time 0.
    pub start: DAffine3,
    /// At scene time 1.
    pub end: DAffine3,
}

impl MotionDesc {
    /// No transform at all.
    pub const IDENTITY: Self = Self {
        start: DAffine3::IDENTITY,
        end: DAffine3::IDENTITY,
    };

    /// The same transform at all times.
    pub fn fixed(transform: DAffine3) -> Self {
        Self {
            start: transform,
            end: transform,
        }
    }

    /// Whether both transforms are the same, number for number.
    pub fn is_static(&self) -> bool {
        self.start == self.end
    }

    /// The inverse at each time.
    pub fn inverse(&self) -> Self {
        Self {
            start: self.start.inverse(),
            end: self.end.inverse(),
        }
    }
}

/// A named group of shapes (pbrt: `ObjectBegin` to `ObjectEnd`).
#[derive(Clone, Debug)]
pub struct ObjectDesc {
    /// As in the file; distinct among the objects of a scene.
    pub name: String,
    /// Its shapes. Their `world_from_object` leads into the space of the group, and [`InstanceDesc::world_from_instance`] from
    /// there into the world. None of them is a light.
    pub shapes: Vec<ShapeDesc>,
    /// Its name in the file.
    pub span: Span,
}

/// One copy of an object.
#[derive(Clone, Debug)]
pub struct InstanceDesc {
    /// Which object.
    pub object: ObjectId,
    /// Applied after the `world_from_object` of the object's shapes.
    pub world_from_instance: MotionDesc,
    /// The object's name in the `ObjectInstance` directive.
    pub span: Span,
}

/// How strictly a file is read.
#[derive(Clone, Debug, Default)]
pub struct ParseOptions {
    /// Unknown and unsupported parameters, types and directives are warnings where something sensible can stand in for them.
    pub lenient: bool,
    /// Names and values of parameters (`$name`) of a Mitsuba scene, instead of its defaults.
    pub defines: Vec<(String, String)>,
}

/// The extensions of the files that [`load`] reads.
const EXTENSIONS: &str = ".pbrt (pbrt-v4), .xml (Mitsuba 3), .ply or .obj; .pbrt, .ply and .obj also with .gz";

/// Reads a scene file, or a mesh on a neutral stage (see [`bare`]); the format goes by the extension (`.pbrt`, `.xml`, `.ply`, `.obj`;
/// all but `.xml` may be followed by `.gz`).
///
/// # Errors
///
/// [`Error::Scene`] with every problem found (at most some 50), in file order, [`Error::Io`] if `path` itself cannot be read,
/// [`Error::Usage`] if its extension is not known, or it is told parameters and is none of Mitsuba's.
pub fn load(path: &Path, options: &ParseOptions) -> Result<SceneDesc> {
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    if let (Some((parameter, _)), false) = (options.defines.first(), name.ends_with(".xml")) {
        return Err(Error::Usage(format!(
            "{}: parameters like {parameter} are for scenes of Mitsuba (.xml); this one has none",
            path.display()
        )));
    }
    let mut scene = if name.ends_with(".pbrt") || name.ends_with(".pbrt.gz") {
        pbrt::load(path, options)
    } else if name.ends_with(".xml") {
        mitsuba::load(path, options)
    } else if bare::is_mesh(path) {
        bare::load(path, None, options)
    } else {
        Err(Error::Usage(format!(
            "{}: not a scene file that Lucerna reads (expected the extension {EXTENSIONS})",
            path.display()
        )))
    }?;
    degenerate::warn(&mut scene);
    Ok(scene)
}
