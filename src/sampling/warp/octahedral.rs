//! The square and the sphere, by equal areas: the octahedral map of Clarberg (2008), "Fast equal-area mapping of the (hemi)sphere
//! using SIMD", in which pbrt-v4 stores environment maps. The centre of the square is +z, its corners are -z.

use std::f32::consts::{FRAC_2_PI, FRAC_PI_4};

use glam::{Vec2, Vec3};

use super::into_unit;

/// The direction (of unit length) of a point of the unit square. Uniform points give directions uniform by solid angle.
#[inline]
pub fn equal_area_square_to_sphere(p: Vec2) -> Vec3 {
    let [u, v] = (2.0 * p - Vec2::ONE).to_array();
    let (up, vp) = (u.abs(), v.abs());
    // Positive in the inner square, which is the hemisphere z > 0.
    let signed_distance = 1.0 - (up + vp);
    let r = 1.0 - signed_distance.abs();
    let phi = if r == 0.0 { 1.0 } else { (vp - up) / r + 1.0 } * FRAC_PI_4;
    let (sin, cos) = phi.sin_cos();
    let radius = r * (2.0 - r * r).max(0.0).sqrt();
    Vec3::new(
        cos.copysign(u) * radius,
        sin.copysign(v) * radius,
        (1.0 - r * r).copysign(signed_distance),
    )
}

/// The point that [`equal_area_square_to_sphere`] maps to the unit vector `w`.
#[inline]
pub fn invert_equal_area_square_to_sphere(w: Vec3) -> Vec2 {
    let [x, y, z] = w.abs().to_array();
    // sqrt(1 - z) without cancellation.
    let r = ((x * x + y * y) / (1.0 + z)).sqrt();
    let (large, small) = (x.max(y), x.min(y));
    let turn = if large == 0.0 {
        0.0
    } else {
        (small / large).atan() * FRAC_2_PI
    };
    let v = if x < y { 1.0 - turn } else { turn } * r;
    let u = r - v;
    let (u, v) = if w.z < 0.0 { (1.0 - v, 1.0 - u) } else { (u, v) };
    Vec2::new(
        into_unit(0.5 * (u.copysign(w.x) + 1.0)),
        into_unit(0.5 * (v.copysign(w.y) + 1.0)),
    )
}
