//! Densities over an interval.

use super::into_unit;

/// A number in [0, 1] with density proportional to the line from `a` at 0 to `b` at 1. Neither is negative, and not both
/// are zero.
#[inline]
pub fn sample_linear(u: f32, a: f32, b: f32) -> f32 {
    // The root of the quadratic in the form that has no cancellation; its denominator is 0 only for u = a = 0.
    if u == 0.0 {
        return 0.0;
    }
    let x = u * (a + b) / (a + (a * a * (1.0 - u) + b * b * u).sqrt());
    x.min(1.0)
}

/// The density of [`sample_linear`] at `x`; 0 outside [0, 1].
#[inline]
pub fn linear_pdf(x: f32, a: f32, b: f32) -> f32 {
    if !(0.0..=1.0).contains(&x) {
        return 0.0;
    }
    2.0 * (a * (1.0 - x) + b * x) / (a + b)
}

/// The number that [`sample_linear`] maps to `x`.
pub fn invert_linear(x: f32, a: f32, b: f32) -> f32 {
    into_unit(x * (a * (2.0 - x) + b * x) / (a + b))
}

/// A number in [-radius, radius] with density proportional to radius - |x|: the triangle filter.
#[inline(always)]
pub fn sample_tent(u: f32, radius: f32) -> f32 {
    // Without a branch, which would be taken every other time: of a choice between x and -x the compiler makes one.
    let (to_left, to_right) = (2.0 * u, 2.0 - 2.0 * u);
    let inwards = if to_left < to_right { to_left } else { to_right };
    let x = inwards.sqrt() - 1.0;
    let sign = u32::from(u >= 0.5) << 31;
    radius * f32::from_bits(x.to_bits() ^ sign)
}

/// The density of [`sample_tent`] at `x`; 0 outside [-radius, radius].
#[inline]
pub fn tent_pdf(x: f32, radius: f32) -> f32 {
    (1.0 - x.abs() / radius).max(0.0) / radius
}

/// The number that [`sample_tent`] maps to `x`.
pub fn invert_tent(x: f32, radius: f32) -> f32 {
    let rest = 1.0 - x.abs() / radius;
    let tail = 0.5 * rest * rest;
    into_unit(if x < 0.0 { tail } else { 1.0 - tail })
}
