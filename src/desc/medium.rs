//! Participating media.

use super::{MediumId, SpectrumDesc};
use crate::error::Span;

/// What fills space: the same everywhere in it.
#[derive(Clone, Debug)]
pub struct MediumDesc {
    /// Distinct among the media of a scene.
    pub name: String,
    /// How much it absorbs and scatters.
    pub coefficients: CoefficientsDesc,
    /// A factor of the coefficients, not negative.
    pub scale: f64,
    /// Mean cosine of the angle by which scattered light turns, in (-1, 1).
    pub g: f64,
    /// Radiance that it emits, which is scaled to unit luminance, as that of lights is.
    pub le: Option<SpectrumDesc>,
    /// A factor of `le`, not negative.
    pub le_scale: f64,
    /// Its definition.
    pub span: Span,
}

/// The coefficients of a medium, in 1 / scene units once multiplied by its scale.
#[derive(Clone, Debug, PartialEq)]
pub enum CoefficientsDesc {
    /// By what happens to light.
    Parts {
        /// Absorption.
        sigma_a: SpectrumDesc,
        /// Scattering.
        sigma_s: SpectrumDesc,
    },
    /// By how much happens and what of it is scattering.
    Whole {
        /// Extinction, the sum of both.
        sigma_t: SpectrumDesc,
        /// The part of it that is scattering; in [0, 1], without a unit.
        albedo: SpectrumDesc,
    },
}

/// The media on the two sides of a surface where they differ; `None` is the vacuum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MediumInterfaceDesc {
    /// On the side that the normal points away from.
    pub interior: Option<MediumId>,
    /// On the side that the normal points to.
    pub exterior: Option<MediumId>,
}
