//! How rough a microfacet surface is, from place to place.

use std::sync::Arc;

use super::{Distribution, Microfacets};
use crate::geometry::SurfaceInteraction;
use crate::texture::FloatTexture;

/// Roughness of a surface. Cheap to clone.
#[derive(Clone, Debug)]
pub enum Roughness {
    /// The same everywhere; `None` is smooth.
    Constant(Option<Microfacets>),
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
    distribution: Distribution,
    /// See [`Microfacets::with_separable_masking`].
    separable: bool,
}

impl Roughness {
    /// Whether a surface may be smooth somewhere.
    pub(super) fn may_be_smooth(&self) -> bool {
        match self {
            Self::Constant(facets) => facets.is_none(),
            Self::Textured(_) => true,
        }
    }

    /// Of `u` and `v` along the tangents: pbrt-v4's perceptual roughness with `remap`, else the slopes themselves.
    pub fn new(u: FloatTexture, v: FloatTexture, remap: bool, distribution: Distribution) -> Self {
        match (&u, &v) {
            (FloatTexture::Constant(u), FloatTexture::Constant(v)) => {
                Self::Constant(microfacets(*u, *v, remap, distribution))
            }
            _ => Self::Textured(Arc::new(TexturedRoughness {
                u,
                v,
                remap,
                distribution,
                separable: false,
            })),
        }
    }

    /// See [`Microfacets::with_separable_masking`].
    #[must_use]
    pub fn with_separable_masking(self, separable: bool) -> Self {
        match self {
            Self::Constant(facets) => Self::Constant(facets.map(|facets| facets.with_separable_masking(separable))),
            Self::Textured(textures) => Self::Textured(Arc::new(TexturedRoughness {
                separable,
                ..(*textures).clone()
            })),
        }
    }

    /// The microfacets at a surface point; `None` where it is smooth.
    #[inline]
    pub fn at(&self, si: &SurfaceInteraction) -> Option<Microfacets> {
        match self {
            Self::Constant(facets) => *facets,
            Self::Textured(textures) => {
                let (u, v) = (textures.u.at(si), textures.v.at(si));
                let facets = microfacets(u, v, textures.remap, textures.distribution);
                facets.map(|facets| facets.with_separable_masking(textures.separable))
            }
        }
    }
}

impl From<Option<Microfacets>> for Roughness {
    fn from(facets: Option<Microfacets>) -> Self {
        Self::Constant(facets)
    }
}

fn microfacets(u: f32, v: f32, remap: bool, distribution: Distribution) -> Option<Microfacets> {
    let alpha = |r: f32| {
        let r = r.max(0.0);
        if remap { Microfacets::alpha_from_roughness(r) } else { r }
    };
    Microfacets::new(distribution, alpha(u), alpha(v))
}
