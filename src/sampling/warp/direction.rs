//! Directions about +z. Uniform ones are drawn through 1 - cos θ instead of cos θ, which keeps its digits for cones as
//! small as the sun's or a star's.

use std::f32::consts::{FRAC_1_PI, PI, TAU};

use glam::{Vec2, Vec3};

use super::plane::sin_cos_of_octant;
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
#[inline(always)]
pub fn sample_uniform_cone(u: Vec2, one_minus_cos_max: f32) -> Vec3 {
    let one_minus_cos = u.x * one_minus_cos_max;
    let sin = (one_minus_cos * (2.0 - one_minus_cos)).max(0.0).sqrt();
    let (sin_phi, cos_phi) = sin_cos_of_turn(u.y);
    Vec3::new(sin * cos_phi, sin * sin_phi, 1.0 - one_minus_cos)
}

/// Sine and cosine of the part `u`, in [0, 1], of a full turn: within 2e-7, without calls and branches.
#[inline(always)]
pub fn sin_cos_of_turn(u: f32) -> (f32, f32) {
    /// Numbers of at least this size have no fractions: their lowest bits are the integer that was added.
    const TO_INTEGER: f32 = 8_388_608.0;
    // The eighth of a turn on either side of the nearest quarter, which nothing is rounded for.
    let shifted = 4.0 * u + TO_INTEGER;
    let (sin, cos) = sin_cos_of_octant(2.0 * (4.0 * u - (shifted - TO_INTEGER)));
    let quarter = shifted.to_bits();
    let is_odd = quarter & 1 != 0;
    let (y, x) = if is_odd { (cos, sin) } else { (sin, cos) };
    let negative = |bits: u32, v: f32| f32::from_bits(v.to_bits() ^ ((bits & 2) << 30));
    (negative(quarter, y), negative(quarter + 1, x))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_has_the_sine_and_the_cosine_of_its_angle() {
        let steps = 1_000_003;
        for i in 0..=steps {
            let u = i as f32 / steps as f32;
            let (sin, cos) = sin_cos_of_turn(u);
            let (right_sin, right_cos) = (std::f64::consts::TAU * f64::from(u)).sin_cos();
            let error = (f64::from(sin) - right_sin)
                .abs()
                .max((f64::from(cos) - right_cos).abs());
            assert!(error < 2e-7, "{u}: {error:e}");
        }
        assert_eq!([sin_cos_of_turn(0.25), sin_cos_of_turn(1.0)], [(1.0, 0.0), (0.0, 1.0)]);
    }
}
