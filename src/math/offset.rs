//! Where a ray that leaves a surface may start.

use super::Vec3;

/// Bound of the relative error of `n` rounded `f32` operations in a row: n u / (1 - n u), with u = 2^-24 (Higham 2002).
pub const fn gamma(n: u32) -> f32 {
    let nu = n as f32 * (f32::EPSILON / 2.0);
    nu / (1.0 - nu)
}

/// The origin of a ray that leaves point `p` in direction `w`, when the surface (of unit normal `n`) that a backend sees may be
/// `error` away from `p` along the normal: surely on the side that `w` points to (after Pharr, Jakob, Humphreys 2023, section
/// 6.8.6). `error` must allow for the rounding of the result.
#[inline]
pub fn offset_ray_origin(p: Vec3, error: f32, n: Vec3, w: Vec3) -> Vec3 {
    p + n * error.copysign(w.dot(n))
}
