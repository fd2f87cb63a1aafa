//! Textures: numbers and spectra that vary over surfaces, and the parameters that may be given one.

use std::path::PathBuf;
use std::sync::Arc;

use glam::{DAffine3, DVec3, Mat2, Vec2, Vec3};

use super::SpectrumDesc;
use crate::error::Span;
use crate::image_io::{Encoding, Image};
use crate::spectrum::ColorSpace;

/// Index into [`SceneDesc::textures`](super::SceneDesc::textures).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct TextureId(pub u32);

/// A value, or the texture of the same class that gives it.
#[derive(Clone, Debug, PartialEq)]
pub enum Textured<V> {
    /// The same everywhere.
    Value(V),
    /// From a texture.
    Texture(TextureId),
}

/// What a texture's values are. Each class has its own names, as in pbrt-v4.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TextureClass {
    /// Numbers.
    Float,
    /// Spectra.
    Spectrum,
}

impl TextureClass {
    /// As in a scene file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Float => "float",
            Self::Spectrum => "spectrum",
        }
    }
}

/// A texture of a scene. A texture refers only to textures that were defined before it: there are no cycles; and at most
/// [`TextureDesc::DEEPEST`] textures refer to one another in a row.
#[derive(Clone, Debug)]
pub struct TextureDesc {
    /// Distinct among the textures of a class.
    pub name: String,
    /// What it is.
    pub kind: ClassedTexture,
    /// The current transform at its definition, the start of it if that moves.
    pub world_from_texture: DAffine3,
    /// The type in the `Texture` directive; where it is not defined, the first use.
    pub span: Span,
}

impl TextureDesc {
    /// How many textures may refer to one another in a row.
    pub const DEEPEST: u32 = 64;
}

/// What a texture is, by class.
#[derive(Clone, Debug)]
pub enum ClassedTexture {
    /// Of numbers.
    Float(TextureKind<f32>),
    /// Of spectra.
    Spectrum(TextureKind<SpectrumDesc>),
}

/// The kinds of textures over values `V`, with pbrt-v4's parameters.
#[derive(Clone, Debug)]
pub enum TextureKind<V> {
    /// The same everywhere.
    Constant(V),
    /// A texture times a number.
    Scale {
        /// The texture.
        tex: Textured<V>,
        /// The number.
        scale: Textured<f32>,
    },
    /// (1 - amount) times the first plus amount times the second.
    Mix {
        /// The two.
        textures: [Textured<V>; 2],
        /// How much there is of the second.
        amount: Textured<f32>,
    },
    /// |cos| of the normal to `direction` times the first, and the rest of the second.
    DirectionMix {
        /// The two.
        textures: [Textured<V>; 2],
        /// In texture space; not zero.
        direction: DVec3,
    },
    /// The two in turn, over unit squares.
    Checkerboard2 {
        /// The first is around (1/2, 1/2).
        textures: [Textured<V>; 2],
        /// Of the squares.
        mapping: MappingDesc,
    },
    /// The two in turn, over unit cubes of texture space.
    Checkerboard3 {
        /// The first is around (1/2, 1/2, 1/2).
        textures: [Textured<V>; 2],
    },
    /// Round dots in some of the unit squares.
    Dots {
        /// In the dots.
        inside: Textured<V>,
        /// Around them.
        outside: Textured<V>,
        /// Of the squares.
        mapping: MappingDesc,
    },
    /// Between values at the corners of the unit square.
    Bilerp {
        /// At (0, 0), (0, 1), (1, 0) and (1, 1).
        corners: [V; 4],
        /// Of the square.
        mapping: MappingDesc,
    },
    /// An image.
    Image(ImageMapDesc),
    /// What the mesh that it lies on has under a name ([`MeshAttributeDesc`](super::MeshAttributeDesc)); 0 on shapes that have none.
    MeshAttribute {
        /// Of the attribute.
        name: String,
        /// Factor of the values.
        scale: f32,
    },
    /// Noise: octaves added up. Of numbers only.
    Fbm(OctavesDesc),
    /// The magnitude of noise: octaves added up. Of numbers only.
    Wrinkled(OctavesDesc),
    /// Waves. Of numbers only.
    Windy,
    /// Layers of stone. Of spectra only.
    Marble {
        /// Of the noise that bends the layers.
        octaves: OctavesDesc,
        /// Factor of the coordinates.
        scale: f32,
        /// How far the noise bends them.
        variation: f32,
    },
}

impl<V> TextureKind<V> {
    /// From the surface to its texture coordinates, if it has any.
    pub fn mapping(&self) -> Option<&MappingDesc> {
        match self {
            Self::Checkerboard2 { mapping, .. } | Self::Dots { mapping, .. } | Self::Bilerp { mapping, .. } => {
                Some(mapping)
            }
            Self::Image(map) => Some(&map.mapping),
            _ => None,
        }
    }
}

/// From a surface to texture coordinates (s, t).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MappingDesc {
    /// The surface's coordinates times `scale` plus `delta`.
    Uv {
        /// `uscale` and `vscale`.
        scale: Vec2,
        /// `udelta` and `vdelta`.
        delta: Vec2,
    },
    /// The surface's coordinates times a matrix plus `delta`.
    Affine {
        /// Turns and shears them.
        matrix: Mat2,
        /// Added after.
        delta: Vec2,
    },
    /// Polar angle and azimuth in texture space.
    Spherical,
    /// Azimuth and z in texture space.
    Cylindrical,
    /// Dot products with two vectors in texture space, plus `delta`.
    Planar {
        /// `v1` and `v2`.
        vectors: [Vec3; 2],
        /// `udelta` and `vdelta`.
        delta: Vec2,
    },
}

/// Noise of several frequencies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OctavesDesc {
    /// How many at most.
    pub octaves: u32,
    /// Factor from each to the next.
    pub roughness: f32,
}

/// Index into [`SceneDesc::images`](super::SceneDesc::images).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ImageId(pub u32);

/// An image file that a scene names.
#[derive(Clone, Debug)]
pub struct ImageDesc {
    /// Where it is.
    pub path: PathBuf,
    /// The curve of its integer samples.
    pub encoding: Encoding,
    /// Its linear values, in the space that [`color_space_of`] says; it has the channels R, G and B, or Y.
    pub image: Arc<Image>,
}

/// What R, G and B of an image are, as in pbrt-v4: what an EXR file says by its chromaticities, if they are those of a space that has a
/// name; else sRGB.
pub fn color_space_of(image: &Image) -> ColorSpace {
    let named = image.chromaticities().and_then(ColorSpace::from_chromaticities);
    named.unwrap_or_default()
}

/// An image as a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageMapDesc {
    /// Which.
    pub image: ImageId,
    /// Where it lies on the surface.
    pub mapping: MappingDesc,
    /// How texels are combined.
    pub filter: ImageFilterDesc,
    /// What is beyond its edges.
    pub wrap: WrapDesc,
    /// Factor of the values.
    pub scale: f32,
    /// Whether 1 - value is meant, after scaling.
    pub invert: bool,
}

/// How texels are combined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ImageFilterDesc {
    /// The nearest one.
    Point,
    /// Four.
    Bilinear,
    /// Four of each of two levels.
    Trilinear,
    /// All within an ellipse.
    Ewa {
        /// The greatest ratio of its axes; at least 1.
        max_anisotropy: f32,
    },
}

/// What is beyond the edges of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WrapDesc {
    /// The image again.
    Repeat,
    /// Black.
    Black,
    /// Its edge.
    Clamp,
    /// The image and its mirror image in turn.
    Mirror,
    /// The image flipped, as an octahedral map of the sphere continues.
    OctahedralSphere,
}
