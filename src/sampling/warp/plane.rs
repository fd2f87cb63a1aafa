//! The disk, the triangle and regular polygons.

use std::f32::consts::{FRAC_1_PI, FRAC_PI_4, TAU};

use glam::{Vec2, Vec3};

use super::into_unit;

/// A point of the unit disk, uniform by area: the concentric map of Shirley and Chiu (1997), which keeps neighbours
/// together.
#[inline]
pub fn sample_uniform_disk(u: Vec2) -> Vec2 {
    let offset = 2.0 * u - Vec2::ONE;
    let x_is_radius = offset.x.abs() > offset.y.abs();
    let (radius, along) = if x_is_radius {
        (offset.x, offset.y)
    } else {
        (offset.y, offset.x)
    };
    let octant = if radius == 0.0 { 0.0 } else { along / radius };
    let (sin, cos) = sin_cos_of_octant(octant);
    radius
        * if x_is_radius {
            Vec2::new(cos, sin)
        } else {
            Vec2::new(sin, cos)
        }
}

/// Sine and cosine of π/4 times `t`, for `t` in [-1, 1]: their Taylor polynomials, within one unit in the last place of 1. No call
/// and no branch, as the standard library's have.
#[inline(always)]
pub(super) fn sin_cos_of_octant(t: f32) -> (f32, f32) {
    let x = FRAC_PI_4 * t;
    let x2 = x * x;
    let sin = x * (1.0 + x2 * (-1.0 / 6.0 + x2 * (1.0 / 120.0 + x2 * (-1.0 / 5040.0 + x2 * (1.0 / 362_880.0)))));
    let cos = 1.0 + x2 * (-0.5 + x2 * (1.0 / 24.0 + x2 * (-1.0 / 720.0 + x2 * (1.0 / 40_320.0))));
    (sin, cos)
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

/// A point of the regular polygon with `corners` corners (3 or more) on the unit circle, the first at (1, 0), uniform by area. The
/// first number chooses the triangle between the centre and a side, then goes on as good as new.
#[inline]
pub fn sample_regular_polygon(u: Vec2, corners: u32) -> Vec2 {
    let scaled = u.x * corners as f32;
    let side = (scaled as u32).min(corners - 1);
    let b = sample_uniform_triangle(Vec2::new(into_unit(scaled - side as f32), u.y));
    let [first, second] = side_of_polygon(side, corners);
    first * b.x + second * b.y
}

/// The density of [`sample_regular_polygon`] by area, 1 / area inside the polygon.
#[inline]
pub fn regular_polygon_pdf(corners: u32) -> f32 {
    let corners = corners as f32;
    1.0 / (0.5 * corners * (TAU / corners).sin())
}

/// The numbers that [`sample_regular_polygon`] maps to `p`.
pub fn invert_regular_polygon(p: Vec2, corners: u32) -> Vec2 {
    let turns = (p.y.atan2(p.x) / TAU).rem_euclid(1.0);
    let side = ((turns * corners as f32) as u32).min(corners - 1);
    let [first, second] = side_of_polygon(side, corners);
    let area = first.perp_dot(second);
    let (b0, b1) = (p.perp_dot(second) / area, first.perp_dot(p) / area);
    let u = invert_uniform_triangle(Vec3::new(b0, b1, 1.0 - b0 - b1));
    Vec2::new(into_unit((side as f32 + u.x) / corners as f32), u.y)
}

/// The corners at both ends of a side.
#[inline]
fn side_of_polygon(side: u32, corners: u32) -> [Vec2; 2] {
    [side, side + 1].map(|corner| Vec2::from_angle(TAU * (corner as f32 / corners as f32)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sine_and_cosine_of_an_octant_are_those_of_double_precision() {
        for i in -1000..=1000 {
            let t = i as f32 / 1000.0;
            let (sin, cos) = sin_cos_of_octant(t);
            let (exact_sin, exact_cos) = (f64::from(t) * std::f64::consts::FRAC_PI_4).sin_cos();
            let error = (f64::from(sin) - exact_sin)
                .abs()
                .max((f64::from(cos) - exact_cos).abs());
            assert!(error <= f64::from(f32::EPSILON), "{t}: {error}");
        }
    }
}
