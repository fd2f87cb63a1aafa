//! What is special to the Beckmann distribution of microfacets: Gaussian slopes. Its formulas are those of Walter et al. 2007 and
//! Heitz 2014; everything here is for a surface stretched so that its roughness is 1.

use crate::math::{Vec2, Vec3};

/// 1 / sqrt(pi).
const FRAC_1_SQRT_PI: f64 = 0.564_189_583_547_756_3;

/// Facets steeper than this slope are fewer than 1e-10 of all.
const STEEPEST: f64 = 4.8;

/// The complementary error function, with a relative error below 1.2e-7 (the Chebyshev fit of Numerical Recipes, section 6.2).
pub(super) fn erfc(x: f64) -> f64 {
    const C: [f64; 10] = [
        -1.265_512_23,
        1.000_023_68,
        0.374_091_96,
        0.096_784_18,
        -0.186_288_06,
        0.278_868_07,
        -1.135_203_98,
        1.488_515_87,
        -0.822_152_23,
        0.170_872_77,
    ];
    let t = 1.0 / (1.0 + 0.5 * x.abs());
    let series = C.iter().rev().fold(0.0, |sum, c| sum * t + c);
    let tail = t * (series - x * x).exp();
    if x < 0.0 { 2.0 - tail } else { tail }
}

/// Smith's Lambda of a direction whose cotangent over the roughness is `a`; negative, as its definition continues, for one that
/// goes down.
#[inline]
pub(super) fn lambda(a: f32) -> f32 {
    let a = f64::from(a);
    if a > STEEPEST {
        return 0.0;
    }
    ((-a * a).exp() * FRAC_1_SQRT_PI / (2.0 * a) - 0.5 * erfc(a)) as f32
}

/// The slope of a facet seen from `w`, a unit vector of either hemisphere.
///
/// Along the azimuth of `w` the visible slopes have the density (cos - x sin) exp(-x²), up to where they face away; its integral
/// is inverted by Newton's method, kept within a bracket. Across, they are Gaussian.
pub(super) fn sample_visible_slope(w: Vec3, u: Vec2) -> Vec2 {
    let cos = f64::from(w.z);
    let sin = f64::from(w.x).hypot(f64::from(w.y));
    let along = {
        let integral = |x: f64| 0.5 * (cos * erfc(-x) + sin * FRAC_1_SQRT_PI * (-x * x).exp());
        let steepest = if cos < STEEPEST * sin {
            (cos / sin).max(-STEEPEST)
        } else {
            STEEPEST
        };
        let wanted = f64::from(u.x) * integral(steepest);
        let (mut low, mut high) = (-STEEPEST - 2.0, steepest);
        // Where the surface is seen steeply from above, the slopes are nearly the Gaussian's.
        let mut x = (f64::from(inverse_erf(2.0 * u.x - 1.0))).clamp(low, high);
        for _ in 0..20 {
            let excess = integral(x) - wanted;
            if excess > 0.0 {
                high = x;
            } else {
                low = x;
            }
            let density = (cos - x * sin) * FRAC_1_SQRT_PI * (-x * x).exp();
            let newton = x - excess / density;
            let next = if newton > low && newton < high {
                newton
            } else {
                0.5 * (low + high)
            };
            let step = (next - x).abs();
            x = next;
            if step < 1e-7 {
                break;
            }
        }
        x as f32
    };
    let across = inverse_erf(2.0 * u.y - 1.0);
    let (cos_phi, sin_phi) = if sin > 0.0 {
        (w.x / sin as f32, w.y / sin as f32)
    } else {
        (1.0, 0.0)
    };
    Vec2::new(cos_phi * along - sin_phi * across, sin_phi * along + cos_phi * across)
}

/// The inverse of the error function for single precision (Giles 2012, "Approximating the erfinv function").
fn inverse_erf(y: f32) -> f32 {
    const NEAR: [f32; 9] = [
        1.501_409_4,
        0.246_640_72,
        -0.004_177_681_6,
        -0.001_253_725,
        0.000_218_580_87,
        -4.391_506_5e-6,
        -3.523_387_7e-6,
        3.432_739_4e-7,
        2.810_226_4e-8,
    ];
    const FAR: [f32; 9] = [
        2.832_976_8,
        1.001_674,
        0.009_438_87,
        -0.007_622_461_3,
        0.005_739_507_7,
        -0.003_673_428_4,
        0.001_349_343_2,
        0.000_100_950_56,
        -0.000_200_214_26,
    ];
    let y = y.clamp(-0.999_999_9, 0.999_999_9);
    let w = -((1.0 - y) * (1.0 + y)).ln();
    let (coefficients, t) = if w < 5.0 {
        (NEAR, w - 2.5)
    } else {
        (FAR, w.sqrt() - 3.0)
    };
    coefficients.iter().rev().fold(0.0, |sum, c| sum * t + c) * y
}

#[cfg(test)]
mod tests {
    use super::*;
    use statrs::function::erf;

    #[test]
    fn error_functions_agree_with_a_library() {
        for i in -400..=400 {
            let x = f64::from(i) * 0.01;
            assert!((erfc(x) / erf::erfc(x) - 1.0).abs() < 2e-7, "{x}");
            let y = erf::erf(x) as f32;
            if y.abs() < 0.9999 {
                assert!(
                    (f64::from(inverse_erf(y)) - erf::erf_inv(f64::from(y))).abs() < 2e-6,
                    "{y}"
                );
            }
        }
    }
}
