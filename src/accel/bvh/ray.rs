//! A ray, prepared for the boxes and triangles of one space.

use super::triangle::Shear;
use crate::math::Vec3;

/// Unit roundoff of `f32`.
const U: f32 = f32::EPSILON / 2.0;

/// How far a box must grow so that it is never missed by a ray that the triangle test lets hit what is in it: this, times the
/// coordinate along the axis plus the greatest coordinate, of the box and of the ray's origin.
///
/// The triangle test moves a corner across the ray by the rounding of x - sx z, where x and z are differences to the origin and
/// |sx| <= 1: at most 2u|x| + 4u|z| and terms in u². (Woop, Benthin and Wald 2013 take 5u for the same. They widen all boxes
/// by the extent of the scene as the ray sees it; here each box has its own share built in and the ray has the rest.)
pub const MARGIN: f32 = 6.0 * U;

/// Distances to planes are taken as (plane - origin) / direction, in three roundings: at most 3u off, relatively. The near one
/// is made shorter and the far one longer by these factors, more than that (Ize 2013, "Robust BVH Ray Traversal", JCGT 2(2)).
pub const NEAR_SLACK: f32 = 1.0 - 8.0 * U;
/// See [`NEAR_SLACK`].
pub const FAR_SLACK: f32 = 1.0 + 8.0 * U;

/// The part of a ray that the box test needs. Near and far are by the sign of the direction.
#[derive(Clone, Copy, Debug)]
pub struct Slab {
    /// Origin for the near planes, moved forward.
    pub near_origin: [f32; 3],
    /// Origin for the far planes, moved backward.
    pub far_origin: [f32; 3],
    /// Reciprocal direction; infinite for zero.
    pub scale: [f32; 3],
    /// 1 where the direction is negative, so that the near plane is the upper one; else 0.
    pub negative: [usize; 3],
}

impl Slab {
    #[inline(always)]
    fn new(origin: [f32; 3], direction: [f32; 3]) -> Self {
        let size = origin.map(f32::abs);
        let greatest = size[0].max(size[1]).max(size[2]);
        let mut slab = Self {
            near_origin: [0.0; 3],
            far_origin: [0.0; 3],
            scale: [0.0; 3],
            negative: [0; 3],
        };
        for i in 0..3 {
            let margin = (MARGIN * (size[i] + greatest)).copysign(direction[i]);
            slab.near_origin[i] = origin[i] + margin;
            slab.far_origin[i] = origin[i] - margin;
            slab.scale[i] = 1.0 / direction[i];
            slab.negative[i] = usize::from(direction[i].is_sign_negative());
        }
        slab
    }
}

/// A ray in the space of the boxes and triangles it is tested against.
#[derive(Clone, Copy, Debug)]
pub struct LocalRay {
    /// Origin.
    pub origin: Vec3,
    /// Direction; distances are in its units.
    pub direction: Vec3,
    /// For boxes.
    pub slab: Slab,
    /// For triangles.
    pub shear: Shear,
}

impl LocalRay {
    /// Prepares a ray whose direction is not zero.
    #[inline(always)]
    pub fn new(origin: Vec3, direction: Vec3) -> Self {
        let (o, d) = (origin.to_array(), direction.to_array());
        Self {
            origin,
            direction,
            slab: Slab::new(o, d),
            shear: Shear::new(o, d),
        }
    }
}

/// The power of two that brings a direction into the range where its reciprocal is safe; 1 for all but absurd ones. Distances
/// along the scaled direction are those along the given one divided by it.
#[inline(always)]
pub fn direction_scale(direction: Vec3) -> f32 {
    const LEAST: f32 = 1e-30;
    const GREATEST: f32 = 1e30;
    let size = direction.abs().max_element();
    if (LEAST..=GREATEST).contains(&size) {
        1.0
    } else if size < LEAST {
        // 2^100: the least subnormal becomes 1e-15.
        f32::from_bits((127 + 100) << 23)
    } else {
        f32::from_bits((127 - 100) << 23)
    }
}
