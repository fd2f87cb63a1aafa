//! Lights: those at a point, from a direction, from all around; and shapes that emit.

use std::sync::Arc;

use glam::DVec3;

use super::{MotionDesc, SpectrumDesc};
use crate::error::Span;
use crate::image_io::Image;

/// A light that is not a shape.
///
/// As in pbrt-v4, the spectrum is divided by its integral against the CIE y curve (for an RGB value and for images: by that of the
/// colour space's illuminant alone) and multiplied by `scale` and, if given, by `photometric` over the geometric factor, the power or
/// illuminance of the same light with a luminance of 1: 4 pi for a point light, 1 for a distant one, pi for an infinite one.
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
    /// `power` in lumen, of a distant or infinite light `illuminance` in lux; positive.
    pub photometric: Option<f32>,
    /// pbrt's current transform; `from` and `to` are in light space.
    pub world_from_light: MotionDesc,
}

/// The kinds of lights. Images are finite, in linear sRGB.
#[derive(Clone, Debug, PartialEq)]
pub enum LightKind {
    /// At a point, alike in all directions.
    Point {
        /// Default the origin.
        from: DVec3,
    },
    /// From a point into a cone.
    Spot {
        /// Default the origin.
        from: DVec3,
        /// A point on the axis, default (0, 0, 1); not `from`.
        to: DVec3,
        /// Between the axis and the rim, in degrees; default 30; more than 0, at most 180.
        angle: f64,
        /// Over how much of it the light falls off, in degrees; default 5; from 0 to `angle`.
        delta: f64,
        /// How it falls off.
        falloff: SpotFalloff,
    },
    /// At the origin, with an intensity by direction.
    Goniometric {
        /// Factors of the intensity, the mean of the channels: square, equal-area octahedral, its pole in the direction +y.
        image: Arc<Image>,
    },
    /// At the origin, throwing a picture towards +z.
    Projection {
        /// The picture.
        image: Arc<Image>,
        /// The angle of its shorter side, in degrees; default 90; between 0 and 180.
        fov: f64,
    },
    /// Parallel light that travels from `from` towards `to`.
    Distant {
        /// Default the origin.
        from: DVec3,
        /// Default (0, 0, 1); not `from`.
        to: DVec3,
    },
    /// From all directions.
    Infinite {
        /// Radiance by direction: equal-area octahedral if square, by latitude and longitude if twice as wide as high; its pole is
        /// +z. `None`: the same from all directions.
        image: Option<Arc<Image>>,
        /// A rectangle, world space, that all of it comes through; only points from which it lies in the direction
        /// (p3 - p0) x (p1 - p0) see it.
        portal: Option<[DVec3; 4]>,
    },
}

/// How the light of a spot falls off towards its rim.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SpotFalloff {
    /// By a smooth step over the cosine, as in pbrt.
    #[default]
    Smooth,
    /// In proportion to the angle to the rim, as in Mitsuba.
    Linear,
}

/// Whereto a shape's light goes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AreaSpread {
    /// The same radiance in all directions.
    #[default]
    Diffuse,
    /// Along the geometric normal only, as Mitsuba's `directionalarea`: what is said of radiance is the power that leaves a unit of
    /// area. Only paths from lights find it.
    Normal,
}

/// What a shape emits, on the side its normal points to. Normalised as for [`LightDesc`]; the geometric factor of `power` is the area,
/// times pi if it emits in all directions, times two if it is two-sided.
#[derive(Clone, Debug)]
pub struct AreaLightDesc {
    /// The type in the `AreaLightSource` directive.
    pub span: Span,
    /// `L`; `None`: the colour space's illuminant.
    pub l: Option<SpectrumDesc>,
    /// Radiance by texture coordinates instead of `l`: (0, 0) is the lower left corner of the image, (1, 1) the upper right one, and
    /// its edges go on outside.
    pub image: Option<Arc<Image>>,
    /// A factor; default 1; not negative.
    pub scale: f32,
    /// Total emitted power in lumen (per light, as in pbrt-v4: for each triangle of a mesh); positive.
    pub power: Option<f32>,
    /// Whether both sides emit.
    pub two_sided: bool,
    /// Whereto.
    pub spread: AreaSpread,
}
