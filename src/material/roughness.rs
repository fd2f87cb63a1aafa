//! How rough a microfacet surface is, from place to place.

use std::sync::Arc;

use super::Ggx;
use crate::geometry::SurfaceInteraction;
use crate::texture::FloatTexture;

/// Roughness of a surface. Cheap to clone.
#[derive(Clone, Debug)]
pub enum Roughness {
    /// The same everywhere; `None` is smooth.
    Constant(Option<Ggx>),
    /// From textures.
    Textured(Arc<TexturedRoughness>),
}

/// Roughness along the two tangents. A value below 0 counts as 0.
#[derive(Clone, Debug)]
pub struct TexturedRoughness {
    u: FloatTexture,
    v: FloatTexture,
    /// Whether the values are pbrt's roughness, not slopes.
    remap: bool,
}

impl Roughness {
    /// Of `u` and `v` along the tangents: pbrt-v4's perceptual roughness with `remap`, else the slopes themselves.
    pub fn new(u: FloatTexture, v: FloatTexture, remap: bool) -> Self {
        match (&u, &v) {
            (FloatTexture::Constant(u), FloatTexture::Constant(v)) => Self::Constant(distribution(*u, *v, remap)),
            _ => Self::Textured(Arc::new(TexturedRoughness { u, v, remap })),
        }
    }

    /// The microfacets at a surface point; `None` where it is smooth.
    #[inline]
    pub fn at(&self, si: &SurfaceInteraction) -> Option<Ggx> {
        match self {
            Self::Constant(ggx) => *ggx,
            Self::Textured(textures) => distribution(textures.u.at(si), textures.v.at(si), textures.remap),
        }
    }
}

impl From<Option<Ggx>> for Roughness {
    fn from(ggx: Option<Ggx>) -> Self {
        Self::Constant(ggx)
    }
}

fn distribution(u: f32, v: f32, remap: bool) -> Option<Ggx> {
    let alpha = |r: f32| {
        let r = r.max(0.0);
        if remap { Ggx::alpha_from_roughness(r) } else { r }
    };
    Ggx::new(alpha(u), alpha(v))
}
