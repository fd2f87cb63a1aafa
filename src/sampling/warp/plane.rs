//! The disk and the triangle.

use std::f32::consts::{FRAC_1_PI, FRAC_PI_2, FRAC_PI_4};

use glam::{Vec2, Vec3};

use super::into_unit;

/// A point of the unit disk, uniform by area: the concentric map of Shirley and Chiu (1997), which keeps neighbours
/// together.
#[inline]
pub fn sample_uniform_disk(u: Vec2) -> Vec2 {
    let offset = 2.0 * u - Vec2::ONE;
    if offset == Vec2::ZERO {
        return Vec2::ZERO;
    }
    let (radius, angle) = if offset.x.abs() > offset.y.abs() {
        (offset.x, FRAC_PI_4 * (offset.y / offset.x))
    } else {
        (offset.y, FRAC_PI_2 - FRAC_PI_4 * (offset.x / offset.y))
    };
    let (sin, cos) = angle.sin_cos();
    radius * Vec2::new(cos, sin)
}

/// The density of [`sample_uniform_disk`] by area, 1/π inside the disk.
#[inline]
pub fn uniform_disk_pdf() -> f32 {
    FRAC_1_PI
}

/// The numbers that [`sample_uniform_disk`] maps to `p`.
pub fn invert_uniform_disk(p: Vec2) -> Vec2 {
    let radius = p.length();
    if radius == 0.0 {
        return Vec2::splat(0.5);
    }
    let offset = if p.x.abs() > p.y.abs() {
        let x = radius.copysign(p.x);
        Vec2::new(x, x * (p.y / p.x).atan() / FRAC_PI_4)
    } else {
        let y = radius.copysign(p.y);
        Vec2::new(y * (p.x / p.y).atan() / FRAC_PI_4, y)
    };
    Vec2::new(into_unit(0.5 * (offset.x + 1.0)), into_unit(0.5 * (offset.y + 1.0)))
}

/// Barycentric coordinates of a point of a triangle, uniform by area: the map of Heitz (2019), "A low-distortion map
/// between triangle and square". They are not negative and sum to 1 up to rounding.
#[inline]
pub fn sample_uniform_triangle(u: Vec2) -> Vec3 {
    let (b0, b1) = if u.x < u.y {
        let b0 = 0.5 * u.x;
        (b0, u.y - b0)
    } else {
        let b1 = 0.5 * u.y;
        (u.x - b1, b1)
    };
    Vec3::new(b0, b1, (1.0 - b0 - b1).max(0.0))
}

/// The density of [`sample_uniform_triangle`] over the plane of the first two barycentric coordinates, which is 2. By area
/// it is 1 / area.
#[inline]
pub fn uniform_triangle_pdf() -> f32 {
    2.0
}

/// The numbers that [`sample_uniform_triangle`] maps to the barycentric coordinates `b`.
pub fn invert_uniform_triangle(b: Vec3) -> Vec2 {
    let u = if b.x > b.y {
        Vec2::new(b.x + b.y, 2.0 * b.y)
    } else {
        Vec2::new(2.0 * b.x, b.x + b.y)
    };
    Vec2::new(into_unit(u.x), into_unit(u.y))
}
