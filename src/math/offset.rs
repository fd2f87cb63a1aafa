//! Where a ray that leaves a surface may start.

use super::Vec3;

/// Bound of the relative error of `n` rounded `f32` operations in a row: n u / (1 - n u), with u = 2^-24 (Higham 2002).
pub const fn gamma(n: u32) -> f32 {
    let nu = n as f32 * (f32::EPSILON / 2.0);
    nu / (1.0 - nu)
}

/// The origin of a ray that leaves point `p` in direction `w`, when the surface (of unit normal `n`) that a backend sees may be
/// `error` away from `p` along the normal: the nearest point that is surely on the side that `w` points to (after Pharr, Jakob,
/// Humphreys 2023, section 6.8.6).
#[inline]
pub fn offset_ray_origin(p: Vec3, error: f32, n: Vec3, w: Vec3) -> Vec3 {
    let offset = if w.dot(n) < 0.0 { -error * n } else { error * n };
    let q = p + offset;
    Vec3::new(
        round_away(q.x, offset.x),
        round_away(q.y, offset.y),
        round_away(q.z, offset.z),
    )
}

/// The neighbour of `x` in the direction of `towards`, as the addition before may have rounded the other way.
#[inline]
fn round_away(x: f32, towards: f32) -> f32 {
    if towards > 0.0 {
        x.next_up()
    } else if towards < 0.0 {
        x.next_down()
    } else {
        x
    }
}
