//! What is special to the Beckmann distribution of microfacets: Gaussian slopes. Its formulas are those of Walter et al. 2007 and
//! Heitz 2014; everything here is for a surface stretched so that its roughness is 1.

use crate::math::{Vec2, Vec3, exp_minus, inverse_erf_of_less_one, ln, scaled_erfc};

/// 1 / sqrt(pi).
const FRAC_1_SQRT_PI: f32 = 0.564_189_6;

/// Facets steeper than this slope are fewer than 1e-10 of all.
const STEEPEST: f32 = 4.8;

/// What the part of the slopes seen is at least taken to grow by with 1 + erf of the slope: where it grows less is less than 1e-6 of it.
const LEAST_SLOPE: f32 = 1e-3;

/// Uniform numbers are kept so far from 0, or from both ends, that the logarithms of what they are turned into exist.
const LEAST_NUMBER: f32 = 1e-7;

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
/// goes down. Infinite for 0.
#[inline(always)]
pub(super) fn lambda(a: f32) -> f32 {
    let x = a.abs();
    let seen = exp_minus(x * x) * (0.5 * FRAC_1_SQRT_PI / x - 0.5 * scaled_erfc(x.min(STEEPEST)));
    let up = if x > STEEPEST { 0.0 } else { seen.max(0.0) };
    if a < 0.0 { -1.0 - up } else { up }
}

/// The slope of a facet seen from `w`, a unit vector of the upper hemisphere.
///
/// Along the azimuth of `w` the visible slopes have the density (cos - x sin) exp(-x²), up to where they face away; across, they are
/// Gaussian. The integral of the former is inverted by Newton's method for z = 1 + erf(x), of which it is a concave function, nearly
/// linear (Jakob 2014, "An Improved Visible Normal Sampling Routine for the Beckmann Distribution"): three steps bring it
/// within 3e-6 of the number wanted.
#[inline(always)]
pub(super) fn sample_visible_slope(w: Vec3, u: Vec2) -> Vec2 {
    let cos = w.z;
    let sin = (w.x * w.x + w.y * w.y).sqrt();
    let steepest = if cos < STEEPEST * sin { cos / sin } else { STEEPEST };
    let gaussian = exp_minus(steepest * steepest);
    let most = 2.0 - gaussian * scaled_erfc(steepest);
    let whole = cos * most + sin * FRAC_1_SQRT_PI * gaussian;
    let u_along = u.x.max(LEAST_NUMBER);
    let wanted = u_along * whole;
    // Right where the surface is seen at a grazing angle, too low elsewhere: from there the steps do not go too far.
    let z = most * u_along * scaled_erfc((-ln(u_along)).sqrt());
    // A loop would not be unrolled, and the one over lanes around it not be made vectors of.
    let seen = Seen { cos, sin, wanted, most };
    let z = seen.step(seen.step(seen.step(z)));
    let along = inverse_erf_of_less_one(z).min(steepest);
    in_azimuth(w, sin, along, u.y)
}

/// What is seen along the azimuth of a direction, and what part of it is wanted; both with the factor 2.
struct Seen {
    cos: f32,
    sin: f32,
    wanted: f32,
    /// 1 + erf of the steepest slope.
    most: f32,
}

impl Seen {
    /// A step of Newton's method from `z`, 1 + erf of a slope.
    #[inline(always)]
    fn step(&self, z: f32) -> f32 {
        let x = inverse_erf_of_less_one(z);
        let excess = self.cos * z + self.sin * FRAC_1_SQRT_PI * exp_minus(x * x) - self.wanted;
        // Next to the steepest, where next to nothing is seen, there is no slope that rounding does not make.
        let next = z - excess / (self.cos - x * self.sin).max(LEAST_SLOPE);
        let next = if next < self.most { next } else { self.most };
        next.clamp(1e-11, 2.0 - LEAST_NUMBER)
    }
}

/// [`sample_visible_slope`] from below the horizon, where it is seldom asked for. There what is seen is the tail of the Gaussian, in
/// which differences take double precision, and Newton's steps are kept within a bracket.
pub(super) fn sample_visible_slope_from_below(w: Vec3, u: Vec2) -> Vec2 {
    let steepest_of_all = f64::from(STEEPEST);
    let frac_1_sqrt_pi = std::f64::consts::FRAC_2_SQRT_PI / 2.0;
    let cos = f64::from(w.z);
    let sin = f64::from(w.x).hypot(f64::from(w.y));
    let integral = |x: f64| 0.5 * (cos * erfc(-x) + sin * frac_1_sqrt_pi * (-x * x).exp());
    let steepest = (cos / sin).max(-steepest_of_all);
    let wanted = f64::from(u.x) * integral(steepest);
    let (mut low, mut high) = (-steepest_of_all - 2.0, steepest);
    let mut x = 0.5 * (low + high);
    for _ in 0..40 {
        let excess = integral(x) - wanted;
        if excess > 0.0 {
            high = x;
        } else {
            low = x;
        }
        let density = (cos - x * sin) * frac_1_sqrt_pi * (-x * x).exp();
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
    in_azimuth(w, sin as f32, x as f32, u.y)
}

/// The slope that is `along` the azimuth of `w`, whose sine is `sin`, and across it that of the number `u`.
#[inline(always)]
fn in_azimuth(w: Vec3, sin: f32, along: f32, u: f32) -> Vec2 {
    let across = inverse_erf_of_less_one((2.0 * u).clamp(LEAST_NUMBER, 2.0 - LEAST_NUMBER));
    let is_tilted = sin > 0.0;
    let cos_phi = if is_tilted { w.x / sin } else { 1.0 };
    let sin_phi = if is_tilted { w.y / sin } else { 0.0 };
    Vec2::new(cos_phi * along - sin_phi * across, sin_phi * along + cos_phi * across)
}

#[cfg(test)]
mod tests {
    use super::*;
    use statrs::function::erf;

    #[test]
    fn the_error_function_agrees_with_a_library() {
        for i in -400..=400 {
            let x = f64::from(i) * 0.01;
            assert!((erfc(x) / erf::erfc(x) - 1.0).abs() < 2e-7, "{x}");
        }
    }

    /// Cotangents of directions, steep and grazing.
    const COTANGENTS: [f64; 12] = [1e-4, 0.01, 0.1, 0.3, 0.7, 1.0, 2.0, 3.0, 4.5, 5.0, 100.0, 1e5];

    #[test]
    fn lambda_is_its_integral() {
        for a in COTANGENTS {
            let right = (-a * a).exp() / (2.0 * a * std::f64::consts::PI.sqrt()) - 0.5 * erf::erfc(a);
            let error = |value: f32, right: f64| ((f64::from(value) - right) / (1.0 + right.abs())).abs();
            assert!(error(lambda(a as f32), right) < 4e-7, "{a}");
            assert!(error(lambda(-a as f32), -1.0 - right) < 4e-7, "{a}");
        }
        assert_eq!(lambda(0.0), f32::INFINITY);
        assert_eq!(lambda(f32::INFINITY), 0.0);
    }

    /// The part of what is seen under `cot` that has slopes below `x`.
    fn part_below(cot: f64, x: f64) -> f64 {
        let (sin, cos) = (1.0 / (1.0 + cot * cot).sqrt(), cot / (1.0 + cot * cot).sqrt());
        let integral = |x: f64| cos * erf::erfc(-x) + sin * (-x * x).exp() / std::f64::consts::PI.sqrt();
        let steepest = cot.min(6.0);
        integral(x.min(steepest)) / integral(steepest)
    }

    #[test]
    fn slopes_are_as_frequent_as_they_are_seen() {
        for cot in COTANGENTS.into_iter().chain([-0.01, -0.3, -1.0, -2.5]) {
            let w = Vec3::new(1.0, 0.0, cot as f32).normalize();
            for i in 0..=2000 {
                // Evenly, and close to both ends.
                let s = f64::from(i % 1000 + 1) / 1001.0;
                let near = 0.5 * s.powi(4);
                let u = ([s, near, 1.0 - near][i as usize % 3] as f32).min(1.0 - f32::EPSILON / 2.0);
                let sample = if cot < 0.0 {
                    sample_visible_slope_from_below
                } else {
                    sample_visible_slope
                };
                let along = sample(w, Vec2::new(u, 0.5)).x;
                let error = (part_below(cot, f64::from(along)) - f64::from(u)).abs();
                assert!(error < 4e-6, "{error:e} for {u} under {cot}");
            }
        }
    }
}
