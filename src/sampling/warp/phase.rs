//! Directions by the phase function of Henyey and Greenstein (1941), relative to +z, along which light went before: g is the mean
//! cosine of the angle by which it turns, in (-1, 1).

use std::f32::consts::{FRAC_1_PI, PI};

use super::into_unit;
use crate::math::{Vec2, Vec3};
use crate::sampling::SolidAnglePdf;

/// Below this |g| the inversion would lose all digits, and is that of g = 0.
const ISOTROPIC: f32 = 1e-3;

/// A direction; the azimuth goes by `u.y`.
#[inline]
pub fn sample_henyey_greenstein(u: Vec2, g: f32) -> Vec3 {
    let cos = if g.abs() < ISOTROPIC {
        1.0 - 2.0 * u.x
    } else {
        let s = (1.0 - g * g) / (1.0 - g + 2.0 * g * u.x);
        ((1.0 + g * g - s * s) / (2.0 * g)).clamp(-1.0, 1.0)
    };
    let sin = (1.0 - cos * cos).max(0.0).sqrt();
    let (sin_phi, cos_phi) = (2.0 * PI * u.y).sin_cos();
    Vec3::new(sin * cos_phi, sin * sin_phi, cos)
}

/// The density of [`sample_henyey_greenstein`] where light turns by an angle of this cosine.
#[inline]
pub fn henyey_greenstein_pdf(cos: f32, g: f32) -> SolidAnglePdf {
    let g = if g.abs() < ISOTROPIC { 0.0 } else { g };
    let denominator = (1.0 + g * g - 2.0 * g * cos).max(1e-6);
    SolidAnglePdf(0.25 * FRAC_1_PI * (1.0 - g * g) / (denominator * denominator.sqrt()))
}

/// The numbers that [`sample_henyey_greenstein`] makes `w` of.
pub fn invert_henyey_greenstein(w: Vec3, g: f32) -> Vec2 {
    let x = if g.abs() < ISOTROPIC {
        0.5 * (1.0 - w.z)
    } else {
        let s = (1.0 + g * g - 2.0 * g * w.z).max(0.0).sqrt();
        ((1.0 - g * g) / s - (1.0 - g)) / (2.0 * g)
    };
    let phi = w.y.atan2(w.x);
    let phi = if phi < 0.0 { phi + 2.0 * PI } else { phi };
    Vec2::new(into_unit(x), into_unit(phi / (2.0 * PI)))
}
