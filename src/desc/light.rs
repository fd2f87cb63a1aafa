//! Lights: those at a point, from a direction, from all around; and shapes that emit.

use glam::DVec3;

use super::{MotionDesc, SpectrumDesc};
use crate::error::Span;

/// A light that is not a shape.
///
/// As in pbrt-v4, the spectrum is divided by its integral against the CIE y curve (for an RGB value: by that of the colour space's
/// illuminant alone) and multiplied by `scale` and, if given, by `photometric` over the geometric factor: 4 pi for a point light, 1
/// for a distant one, pi for an infinite one.
#[derive(Clone, Debug)]
pub struct LightDesc {
    /// The type in the `LightSource` directive.
    pub span: Span,
    /// Where it is.
    pub kind: LightKind,
    /// `I` or `L`; `None`: the colour space's illuminant.
    pub spectrum: Option<SpectrumDesc>,
    /// A factor; default 1; not negative.
    pub scale: f32,
    /// `power` of a point light in lumen, `illuminance` of a distant or infinite one in lux; positive.
    pub photometric: Option<f32>,
    /// pbrt's current transform; `from` and `to` are in light space.
    pub world_from_light: MotionDesc,
}

/// The kinds of lights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// At a point, alike in all directions.
    Point {
        /// Default the origin.
        from: DVec3,
    },
    /// Parallel light that travels from `from` towards `to`.
    Distant {
        /// Default the origin.
        from: DVec3,
        /// Default (0, 0, 1); not `from`.
        to: DVec3,
    },
    /// The same radiance from all directions.
    Infinite,
}

/// What a shape emits: the same radiance in all directions, on the side its normal points to. Normalised as for [`LightDesc`]; the
/// geometric factor of `power` is pi times the area, twice that if two-sided.
#[derive(Clone, Debug)]
pub struct AreaLightDesc {
    /// The type in the `AreaLightSource` directive.
    pub span: Span,
    /// `L`; `None`: the colour space's illuminant.
    pub l: Option<SpectrumDesc>,
    /// A factor; default 1; not negative.
    pub scale: f32,
    /// Total emitted power in lumen (per light, as in pbrt-v4: for each triangle of a mesh); positive.
    pub power: Option<f32>,
    /// Whether both sides emit.
    pub two_sided: bool,
}
