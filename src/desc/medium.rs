//! Participating media.

use super::{MediumId, SpectrumDesc};
use crate::error::Span;

/// What fills space: the same everywhere in it.
#[derive(Clone, Debug)]
pub struct MediumDesc {
    /// Distinct among the media of a scene.
    pub name: String,
    /// Absorption, in 1 / scene units once multiplied by `scale`.
    pub sigma_a: SpectrumDesc,
    /// Scattering, in the same units.
    pub sigma_s: SpectrumDesc,
    /// A factor of both, not negative.
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

/// The media on the two sides of a surface where they differ; `None` is the vacuum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MediumInterfaceDesc {
    /// On the side that the normal points away from.
    pub interior: Option<MediumId>,
    /// On the side that the normal points to.
    pub exterior: Option<MediumId>,
}
