//! Directions about +z. Uniform ones are drawn through 1 - cos θ instead of cos θ, which keeps its digits for cones as
//! small as the sun's or a star's.

use std::f32::consts::{FRAC_1_PI, PI, TAU};

use glam::{Vec2, Vec3};

use super::{into_unit, invert_uniform_disk, sample_uniform_disk};
use crate::sampling::SolidAnglePdf;

/// A direction of the upper hemisphere with density cos θ / π.
#[inline]
pub fn sample_cosine_hemisphere(u: Vec2) -> Vec3 {
    let p = sample_uniform_disk(u);
    p.extend((1.0 - p.length_squared()).max(0.0).sqrt())
}

/// The density of [`sample_cosine_hemisphere`] for a direction with this z; 0 for one of the lower hemisphere.
#[inline]
pub fn cosine_hemisphere_pdf(cos_theta: f32) -> SolidAnglePdf {
    SolidAnglePdf(cos_theta.max(0.0) * FRAC_1_PI)
}

/// The numbers that [`sample_cosine_hemisphere`] maps to `w`.
pub fn invert_cosine_hemisphere(w: Vec3) -> Vec2 {
    invert_uniform_disk(w.truncate())
}

/// A direction of the upper hemisphere, uniform by solid angle.
#[inline]
pub fn sample_uniform_hemisphere(u: Vec2) -> Vec3 {
    sample_uniform_cone(u, 1.0)
}

/// The density of [`sample_uniform_hemisphere`] in its hemisphere, 1 / 2π.
#[inline]
pub fn uniform_hemisphere_pdf() -> SolidAnglePdf {
    uniform_cone_pdf(1.0)
}

/// The numbers that [`sample_uniform_hemisphere`] maps to `w`.
pub fn invert_uniform_hemisphere(w: Vec3) -> Vec2 {
    invert_uniform_cone(w, 1.0)
}

/// A direction, uniform by solid angle.
#[inline]
pub fn sample_uniform_sphere(u: Vec2) -> Vec3 {
    sample_uniform_cone(u, 2.0)
}

/// The density of [`sample_uniform_sphere`], 1 / 4π.
#[inline]
pub fn uniform_sphere_pdf() -> SolidAnglePdf {
    uniform_cone_pdf(2.0)
}

/// The numbers that [`sample_uniform_sphere`] maps to `w`.
pub fn invert_uniform_sphere(w: Vec3) -> Vec2 {
    invert_uniform_cone(w, 2.0)
}

/// 1 - cos θ of the angle up to 90° whose squared sine is `sin_squared`, without cancellation.
#[inline]
pub fn one_minus_cos(sin_squared: f32) -> f32 {
    sin_squared / (1.0 + (1.0 - sin_squared).max(0.0).sqrt())
}

/// A direction within the angle θ of +z, uniform by solid angle, where `one_minus_cos_max` is 1 - cos θ (in (0, 2]; see
/// [`one_minus_cos`]). The sample's own 1 - cos is `u.x` times that.
#[inline]
pub fn sample_uniform_cone(u: Vec2, one_minus_cos_max: f32) -> Vec3 {
    direction_of_cone(u.x, sin_cos_of_turn(u.y).into(), one_minus_cos_max)
}

/// Sine and cosine of the part `u` of a full turn.
#[inline]
pub(crate) fn sin_cos_of_turn(u: f32) -> (f32, f32) {
    (TAU * u).sin_cos()
}

/// [`sample_uniform_cone`] for its first number, and for sine and cosine of the turn that is its second.
#[inline(always)]
pub(crate) fn direction_of_cone(u: f32, sin_cos: Vec2, one_minus_cos_max: f32) -> Vec3 {
    let one_minus_cos = u * one_minus_cos_max;
    let sin = (one_minus_cos * (2.0 - one_minus_cos)).max(0.0).sqrt();
    Vec3::new(sin * sin_cos.y, sin * sin_cos.x, 1.0 - one_minus_cos)
}

/// The density of [`sample_uniform_cone`] inside the cone: one over its solid angle 2π (1 - cos θ).
#[inline]
pub fn uniform_cone_pdf(one_minus_cos_max: f32) -> SolidAnglePdf {
    SolidAnglePdf(1.0 / (2.0 * PI * one_minus_cos_max))
}

/// The numbers that [`sample_uniform_cone`] maps to `w`, a direction of the cone.
pub fn invert_uniform_cone(w: Vec3, one_minus_cos_max: f32) -> Vec2 {
    let one_minus_cos = if w.z > 0.0 {
        w.truncate().length_squared() / (1.0 + w.z)
    } else {
        1.0 - w.z
    };
    let turn = w.y.atan2(w.x) / TAU;
    let turn = if turn < 0.0 { turn + 1.0 } else { turn };
    Vec2::new(into_unit(one_minus_cos / one_minus_cos_max), into_unit(turn))
}
