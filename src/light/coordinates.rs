//! Texture coordinates of points that are sampled on area lights.

use crate::math::{DMat3, DVec3, Vec2};

/// Where texture coordinates of sampled points come from.
#[derive(Clone, Copy, Debug)]
pub enum Coordinates {
    /// Those of a triangle's corners.
    Corners([Vec2; 3]),
    /// Longitude and latitude of a sphere that does not move, which this takes to its own space.
    Sphere(DMat3),
    /// Each sampled point knows its own.
    Own,
}

impl Coordinates {
    /// The longer side of what the surface shows of an image of `size`, in pixels.
    pub(super) fn extent_in(&self, size: [usize; 2]) -> f32 {
        let size = Vec2::new(size[0] as f32, size[1] as f32);
        match self {
            Self::Corners([p, q, r]) => ((p.max(*q).max(*r) - p.min(*q).min(*r)) * size).max_element(),
            Self::Sphere(_) | Self::Own => size.max_element(),
        }
    }
}

/// Texture coordinates of a point of a sphere, by its unit direction from the centre in object space.
pub(super) fn sphere_uv(outward: DVec3) -> Vec2 {
    let turn = outward.y.atan2(outward.x) / std::f64::consts::TAU;
    let turn = if turn < 0.0 { turn + 1.0 } else { turn };
    let height = 1.0 - outward.z.clamp(-1.0, 1.0).acos() / std::f64::consts::PI;
    Vec2::new(turn as f32, height as f32)
}
