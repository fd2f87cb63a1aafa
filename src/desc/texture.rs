//! Textures: numbers and spectra that vary over surfaces, and the parameters that may be given one.

use glam::{DAffine3, DVec3};

use super::SpectrumDesc;
use crate::error::Span;

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
}
