//! Scene files as plain data: what was asked for, with the place in the file where it was asked.
//!
//! [`load`] reads a scene file into a [`SceneDesc`]. Nothing here knows how to render: spectra are the numbers that were typed,
//! transforms are matrices, materials and lights are names with parameters already checked for type and range. The scene builder
//! turns a description into things that rays can meet.
//!
//! The formats: pbrt-v4 ([`pbrt`]), with meshes in PLY ([`ply`]). Lucerna's extensions to pbrt-v4:
//!
//! - several `Camera` directives before `WorldBegin` are several views, named by `"string name"`; film, sampler and filter are
//!   shared by all of them;
//! - `"float nearclip"` of a perspective camera, see [`CameraKind::Perspective`];
//! - `"point3 P1"` of a `trianglemesh`, see [`MeshDesc::positions_end`];
//! - `"integer maxdepth" -1` of an integrator: paths of any length;
//! - `PixelFilter "blackmanharris"`.

mod bytes;
mod light;
mod material;
mod parameter;
pub mod pbrt;
pub mod ply;
mod shape;
mod texture;
mod texture_kinds;
mod view;

use std::path::Path;

use glam::DAffine3;

use crate::error::{Diagnostic, Error, Result, SourceMap, Span};

pub use crate::sampling::SamplerKind;
pub use light::{AreaLightDesc, LightDesc, LightKind};
pub use material::{ConductorDesc, MaterialDesc, MaterialKind, RoughnessDesc, SpectrumDesc, SpectrumValue};
pub use parameter::{FloatRange, Parameter, ParameterKind};
pub use shape::{MeshDesc, ShapeDesc, ShapeKind};
pub use texture::{ClassedTexture, TextureClass, TextureDesc, TextureId, TextureKind, Textured};
pub use texture_kinds::{TEXTURES, TextureEntry};
pub use view::{CameraDesc, CameraKind, CropDesc, FilmDesc, FilterDesc, FilterKind, PixelRect, SamplerDesc, ViewDesc};

/// A whole scene, as its file describes it.
///
/// Every index in it ([`MaterialId`], [`TextureId`], [`ObjectId`], the vertex indices of meshes) is in range, every number finite, every transform
/// invertible.
#[derive(Clone, Debug)]
pub struct SceneDesc {
    /// The texts that the spans point into.
    pub sources: SourceMap,
    /// At least one; names are distinct.
    pub views: Vec<ViewDesc>,
    /// How light transport is to be estimated.
#[derive(Clone, Debug, PartialEq)]
pub struct IntegratorDesc {
    /// The greatest number of scattering events of a path (pbrt's count; default 5); `None`: as many as Russian roulette grants.
    pub max_depth: Option<u32>,
    /// How the light of next-event estimation is chosen; the expectation is the same for all.
    pub light_sampler: LightSamplerKind,
    /// The estimator.
    pub kind: IntegratorKind,
}

/// The estimators, with the parameters that are theirs alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum IntegratorKind {
    /// Unidirectional path tracing.
    Path(PathDesc),
    /// The rendering equation taken literally, the oracle.
    Kajiya(KajiyaDesc),
}

/// Parameters of [`IntegratorKind::Path`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PathDesc {
    /// Which of its two ways of finding light it uses.
    pub strategy: Strategy,
    /// How the two are weighed.
    pub heuristic: Heuristic,
    /// Into how many paths one is split where it first meets a surface that is not specular, at least 1.
    pub splitting: u32,
}

impl Default for PathDesc {
    fn default() -> Self {
        Self {
            strategy: Strategy::default(),
            heuristic: Heuristic::default(),
            splitting: 1,
        }
    }
}

/// How a path tracer finds light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Strategy {
    /// By directions drawn from BSDFs only: lights without extent are not found.
    Bsdf,
    /// By points of lights only, but where a path is specular.
    Light,
    /// Both, by multiple importance sampling.
    #[default]
    Mis,
}

/// Weights of multiple importance sampling (Veach 1997, section 9.2).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Heuristic {
    /// In proportion to the densities.
    Balance,
    /// In proportion to their squares.
    #[default]
    Power,
}

/// Parameters of [`IntegratorKind::Kajiya`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KajiyaDesc {
    /// The probability of ending a path at a surface.
    pub termination: Termination,
    /// Directions that a path goes on in, at least 1.
    pub branching: u32,
    /// What they are drawn from.
    pub distribution: Distribution,
}

impl Default for KajiyaDesc {
    fn default() -> Self {
        Self {
            termination: Termination::Constant(0.5),
            branching: 1,
            distribution: Distribution::Bsdf,
        }
    }
}

/// The probability alpha of ending a path at a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Termination {
    /// The same everywhere, in [0.05, 0.95].
    Constant(f32),
    /// One minus the surface's albedo, in [0.05, 0.95].
    Albedo,
}

/// What directions are drawn from where a surface is not specular.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Distribution {
    /// All alike.
    Uniform,
    /// In proportion to the cosine to the normal.
    Cosine,
    /// The BSDF's own.
    Bsdf,
}

/// How one of many lights is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum LightSamplerKind {
    /// By a bounding volume hierarchy over the lights (pbrt's default).
    #[default]
    Bvh,
    /// In proportion to emitted power.
    Power,
    /// All alike.
    Uniform,
}

/// How strictly a file is read.
#[derive(Clone, Copy, Debug, Default)]
pub struct ParseOptions {
    /// Unknown and unsupported parameters, types and directives are warnings where something sensible can stand in for them.
    pub lenient: bool,
}

/// Reads a scene file; the format goes by the extension (`.pbrt`, `.pbrt.gz`).
///
/// # Errors
///
/// [`Error::Scene`] with every problem found (at most some 50), in file order, [`Error::Io`] if `path` itself cannot be read,
/// [`Error::Usage`] if its extension is not known.
pub fn load(path: &Path, options: &ParseOptions) -> Result<SceneDesc> {
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    if name.ends_with(".pbrt") || name.ends_with(".pbrt.gz") {
        pbrt::load(path, options)
    } else {
        Err(Error::Usage(format!(
            "{}: not a scene file that Lucerna reads (expected the extension .pbrt or .pbrt.gz)",
            path.display()
        )))
    }
}
