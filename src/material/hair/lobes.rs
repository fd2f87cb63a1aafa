//! How light spreads along a fibre and around it.

use std::f32::consts::{PI, TAU};

use crate::math::Vec2;

/// M: the density, by solid angle over the azimuth's, of a direction with this sine and cosine of theta around that of `wo`, of a
/// variance: d'Eon et al. (2011), equation 7. It integrates to 1 over cos theta d theta.
pub(super) fn longitudinal([sin_i, cos_i]: [f32; 2], [sin_o, cos_o]: [f32; 2], variance: f32) -> f32 {
    // Exponents of some ten thousand nearly cancel.
    let v = f64::from(variance);
    let a = f64::from(cos_i) * f64::from(cos_o) / v;
    let b = f64::from(sin_i) * f64::from(sin_o) / v;
    let density = if v <= 0.1 {
        // The hyperbolic sine of 1 / v is half of its exponential.
        (ln_bessel(a) - b - 1.0 / v - v.ln()).exp()
    } else {
        (ln_bessel(a) - b).exp() / ((1.0 / v).sinh() * 2.0 * v)
    };
    density as f32
}

/// Sine and cosine of theta by that density.
pub(super) fn sample_longitudinal([sin_o, cos_o]: [f32; 2], variance: f32, u: Vec2) -> [f32; 2] {
    // The cosine of the angle to the direction that is reflected along the fibre.
    let end = (-2.0 / variance).exp();
    let x = (u.x.max(1e-30) + (1.0 - u.x) * end).ln();
    // 1 - cos is small where it matters.
    let below = (-variance * x).clamp(0.0, 2.0);
    let cos = 1.0 - below;
    let sin = (below * (2.0 - below)).max(0.0).sqrt();
    let sin_i = (-cos * sin_o + sin * (TAU * u.y).cos() * cos_o).clamp(-1.0, 1.0);
    [sin_i, (1.0 - sin_i * sin_i).max(0.0).sqrt()]
}

/// The logarithm of the modified Bessel function I_0.
fn ln_bessel(x: f64) -> f64 {
    if x < 12.0 {
        // The power series.
        let quarter = 0.25 * x * x;
        let (mut term, mut sum) = (1.0, 1.0);
        for i in 1..40 {
            term *= quarter / f64::from(i * i);
            sum += term;
        }
        f64::ln(sum)
    } else {
        let y = 1.0 / (8.0 * x);
        // Each coefficient is the one before times (2 k - 1)² / k.
        let (mut term, mut series) = (1.0, 1.0);
        for k in 1..8 {
            term *= y * f64::from((2 * k - 1) * (2 * k - 1)) / f64::from(k);
            series += term;
        }
        x - 0.5 * (2.0 * std::f64::consts::PI * x).ln() + f64::ln(series)
    }
}

/// The density of a logistic distribution of this scale, trimmed to half a turn each way.
pub(super) fn trimmed_logistic(x: f32, scale: f32) -> f32 {
    let e = (-x.abs() / scale).exp();
    let within = logistic_cdf(PI, scale) - logistic_cdf(-PI, scale);
    e / (scale * (1.0 + e) * (1.0 + e)) / within
}

/// A number by that density.
pub(super) fn sample_trimmed_logistic(u: f32, scale: f32) -> f32 {
    let start = logistic_cdf(-PI, scale);
    let within = logistic_cdf(PI, scale) - start;
    let cdf = f64::from(u) * f64::from(within) + f64::from(start);
    let x = -f64::from(scale) * (1.0 / cdf - 1.0).ln();
    (x as f32).clamp(-PI, PI)
}

fn logistic_cdf(x: f32, scale: f32) -> f32 {
    1.0 / (1.0 + (-x / scale).exp())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bessel_function_is_that_of_tables() {
        for (x, expected) in [
            (0.0_f64, 1.0_f64),
            (1.0, 1.266_065_877_752_008),
            (5.0, 27.239_871_823_604_44),
        ] {
            assert!((ln_bessel(x) - expected.ln()).abs() < 1e-13);
        }
        // Abramowitz and Stegun, table 9.8: exp(-x) I_0(x) at 20.
        assert!((ln_bessel(20.0) - 20.0 - 0.089_780_311_884_826_f64.ln()).abs() < 1e-9);
        assert!((ln_bessel(12.0 - 1e-9) - ln_bessel(12.0)).abs() < 1e-7);
    }

    #[test]
    fn both_densities_integrate_to_one() {
        const STEPS: usize = 200_000;
        for variance in [5e-5_f32, 0.01, 0.09, 0.11, 1.0, 20.0] {
            for theta in [-1.2_f32, 0.0, 0.7] {
                let step = 2.0 / STEPS as f32;
                let sum: f64 = (0..STEPS)
                    .map(|i| {
                        let sin = -1.0 + (i as f32 + 0.5) * step;
                        let cos = (1.0 - sin * sin).max(0.0).sqrt();
                        f64::from(longitudinal([sin, cos], [theta.sin(), theta.cos()], variance))
                    })
                    .sum();
                let integral = sum * f64::from(step);
                assert!((integral - 1.0).abs() < 2e-3, "{variance} {theta}: {integral}");
            }
        }
        for scale in [0.002_f32, 0.1, 2.0] {
            let step = TAU / STEPS as f32;
            let sum: f64 = (0..STEPS)
                .map(|i| f64::from(trimmed_logistic(-PI + (i as f32 + 0.5) * step, scale)))
                .sum();
            assert!((sum * f64::from(step) - 1.0).abs() < 1e-3, "{scale}: {sum}");
        }
    }
}
