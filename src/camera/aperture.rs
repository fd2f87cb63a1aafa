//! The shape of a lens.

use std::f32::consts::PI;

use crate::desc::ApertureDesc;
use crate::math::Vec2;
use crate::sampling::warp;

/// The shape of the lens, of radius 1.
#[derive(Clone, Copy, Debug)]
pub(super) enum Aperture {
    Round,
    /// Corners, and cosine and sine of the angle of the first.
    Polygon(u32, Vec2),
}

impl Aperture {
    pub fn new(desc: ApertureDesc) -> Self {
        match desc {
            ApertureDesc::Round => Self::Round,
            ApertureDesc::Polygon { blades, rotation } => {
                Self::Polygon(blades, Vec2::from_angle(rotation.to_radians() as f32))
            }
        }
    }

    /// A point of it, uniform by area.
    #[inline]
    pub fn sample(self, u: Vec2) -> Vec2 {
        match self {
            Self::Round => warp::sample_uniform_disk(u),
            Self::Polygon(blades, turn) => turn.rotate(warp::sample_regular_polygon(u, blades)),
        }
    }

    /// Its area.
    #[inline]
    pub fn area(self) -> f32 {
        match self {
            Self::Round => PI,
            Self::Polygon(blades, _) => 1.0 / warp::regular_polygon_pdf(blades),
        }
    }
}
