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
/// by the extent of the scene as the ray sees it; here each box has its own share built in and the ray has the rest.) Distances
/// to planes are taken as plane * scale + shift, where the rounding of the product, if it is rounded, moves the plane by u of
/// itself and that of the shift the origin by u of itself. And [`LEAST_SLOPE`] turns the ray by 2^-16 u.
pub const MARGIN: f32 = 8.0 * U;

/// The other roundings, of the reciprocal, of the factor below and of the sum, put a distance off by at most 3u, relatively. The
/// near one is made shorter and the far one longer by these factors, more than that (Ize 2013, "Robust BVH Ray Traversal", JCGT
/// 2(2)).
pub const NEAR_SLACK: f32 = 1.0 - 8.0 * U;
/// See [`NEAR_SLACK`].
pub const FAR_SLACK: f32 = 1.0 + 8.0 * U;

/// For boxes, no direction component counts as less than this part of the greatest, 2^-40: its reciprocal is finite.
pub const LEAST_SLOPE: f32 = 1.0 / (1u64 << 40) as f32;

/// The part of a ray that the box test needs: the distance to a plane is plane * scale + shift. Near and far are by the sign of
/// the direction.
#[derive(Clone, Copy, Debug)]
pub struct Slab {
    /// For near planes, by axis: the reciprocal direction, made smaller, and minus the origin, moved forward, times that.
    pub near: [[f32; 2]; 3],
    /// For far planes: the reciprocal direction, made larger, and minus the origin, moved backward, times that.
    pub far: [[f32; 2]; 3],
    /// 1 where the direction is negative, so that the near plane is the upper one; else 0.
    pub negative: [usize; 3],
}

/// What the kernels ask of a ray, by axis.
pub trait Slabs: Copy {
    /// See [`Slab::near`].
    fn near(self, axis: usize) -> [f32; 2];
    /// See [`Slab::far`].
    fn far(self, axis: usize) -> [f32; 2];
    /// See [`Slab::negative`].
    fn negative(self, axis: usize) -> usize;
}

impl Slabs for &Slab {
    #[inline(always)]
    fn near(self, axis: usize) -> [f32; 2] {
        self.near[axis]
    }
    #[inline(always)]
    fn far(self, axis: usize) -> [f32; 2] {
        self.far[axis]
    }
    #[inline(always)]
    fn negative(self, axis: usize) -> usize {
        self.negative[axis]
    }
}

impl Slab {
    #[inline(always)]
    fn new(origin: [f32; 3], direction: [f32; 3]) -> Self {
        let size = origin.map(f32::abs);
        let greatest = size[0].max(size[1]).max(size[2]);
        let slope = direction.map(f32::abs);
        let least = LEAST_SLOPE * slope[0].max(slope[1]).max(slope[2]);
        let mut slab = Self {
            near: [[0.0; 2]; 3],
            far: [[0.0; 2]; 3],
            negative: [0; 3],
        };
        for i in 0..3 {
            let margin = (MARGIN * (size[i] + greatest)).copysign(direction[i]);
            let scale = 1.0 / slope[i].max(least).copysign(direction[i]);
            let (near, far) = (scale * NEAR_SLACK, scale * FAR_SLACK);
            slab.near[i] = [near, -(origin[i] + margin) * near];
            slab.far[i] = [far, -(origin[i] - margin) * far];
            slab.negative[i] = usize::from(direction[i].is_sign_negative());
        }
        slab
    }
}

/// Where a ray starts and goes.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    /// Origin.
    pub origin: Vec3,
    /// Direction; distances are in its units.
    pub direction: Vec3,
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

    /// What of it is no computation.
    #[inline(always)]
    pub fn line(&self) -> Line {
        Line {
            origin: self.origin,
            direction: self.direction,
        }
    }
}

/// Directions whose greatest component is in this range are taken as they are.
pub const USUAL_SIZES: std::ops::RangeInclusive<f32> = 1e-6..=1e6;

/// The power of two that brings a direction into the range where products of its reciprocals with coordinates are finite; 1 for
/// all but absurd ones. Distances along the scaled direction are those along the given one divided by it.
#[inline(always)]
pub fn direction_scale(direction: Vec3) -> f32 {
    let size = direction.abs().max_element();
    if USUAL_SIZES.contains(&size) {
        1.0
    } else {
        // To a size in [1, 2); of a subnormal, which has an exponent of 0, to one above 1e-7.
        let exponent = size.to_bits() >> 23;
        f32::from_bits((254 - exponent) << 23)
    }
}
