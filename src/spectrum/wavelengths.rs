//! The wavelengths that a path carries, and their densities.

use super::{LANES, SampledSpectrum};

/// Shortest wavelength that is sampled, in nm.
pub const LAMBDA_MIN: f32 = 360.0;
/// Longest wavelength that is sampled, in nm.
pub const LAMBDA_MAX: f32 = 830.0;

/// The wavelength of a lane in rgb mode, in nm: the helium d line, where catalogues state refractive indices.
pub const LAMBDA_D: f32 = 587.6;

/// The density of visible wavelengths is `NORM / cosh^2(SLOPE (lambda - PEAK))`, about proportional to their weight in
/// the sensor's response (Radziszewski, Boryczko, Alda 2009; constants as in pbrt-v4).
const NORM: f32 = 0.003_939_804_2;
const SLOPE: f32 = 0.0072;
const PEAK: f32 = 538.0;

/// The four wavelengths of a path, in nm, the hero first, and the density of each, in nm⁻¹.
///
/// An estimate of an integral over wavelength is the mean over the lanes of value / pdf, where a lane with pdf 0 counts
/// as 0 ([`SampledSpectrum::safe_div`]).
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Wavelengths {
    /// In nm.
    pub lambda: [f32; LANES],
    /// Density of each wavelength, in nm⁻¹; 0 for those that have been terminated.
    pub pdf: [f32; LANES],
}

impl Wavelengths {
    /// Four wavelengths from 360 to 830 nm by their visual importance, stratified: lane `i` uses `u + i/4` modulo 1. `u`
    /// is in [0, 1).
    pub fn sample_visible(u: f32) -> Self {
        // The density's integral is NORM / SLOPE times (tanh + TANH_START), so that tanh is linear in the uniform number.
        const TANH_START: f32 = 0.856_910_62;
        let mut wavelengths = Self {
            lambda: [0.0; LANES],
            pdf: [0.0; LANES],
        };
        for lane in 0..LANES {
            let shifted = u + lane as f32 / LANES as f32;
            let up = if shifted >= 1.0 { shifted - 1.0 } else { shifted };
            let tanh = up * (SLOPE / NORM) - TANH_START;
            let lambda = PEAK + tanh.atanh() / SLOPE;
            wavelengths.lambda[lane] = lambda.clamp(LAMBDA_MIN, LAMBDA_MAX);
            wavelengths.pdf[lane] = NORM * (1.0 - tanh * tanh);
        }
        wavelengths
    }

    /// The stand-in for rgb mode: 587.6 nm and density 1 in every lane.
    #[inline]
    pub fn rgb() -> Self {
        Self {
            lambda: [LAMBDA_D; LANES],
            pdf: [1.0; LANES],
        }
    }

    /// The density with which [`Self::sample_visible`] draws `lambda` (nm) in any one lane, in nm⁻¹; 0 outside 360 to 830.
    pub fn visible_pdf(lambda: f32) -> f32 {
        if !(LAMBDA_MIN..=LAMBDA_MAX).contains(&lambda) {
            return 0.0;
        }
        let cosh = (SLOPE * (lambda - PEAK)).cosh();
        NORM / (cosh * cosh)
    }

    /// The densities as a spectrum, to divide by.
    #[inline]
    pub fn pdf(&self) -> SampledSpectrum {
        SampledSpectrum(self.pdf)
    }

    /// Leaves only the hero: the path is about to do what differs between wavelengths. The other densities become 0, the
    /// hero's is divided by 4, which makes up for the mean over lanes. Does nothing the second time.
    pub fn terminate_secondary(&mut self) {
        if self.secondary_terminated() {
            return;
        }
        self.pdf = [self.pdf[0] / LANES as f32, 0.0, 0.0, 0.0];
    }

    /// Whether [`Self::terminate_secondary`] has taken effect.
    #[inline]
    pub fn secondary_terminated(&self) -> bool {
        self.pdf[1..].iter().all(|&pdf| pdf == 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_four_are_in_range_with_the_stated_density() {
        for i in 0..1000 {
            let w = Wavelengths::sample_visible(i as f32 / 1000.0);
            for (&lambda, &pdf) in w.lambda.iter().zip(&w.pdf) {
                assert!((LAMBDA_MIN..=LAMBDA_MAX).contains(&lambda));
                let expected = Wavelengths::visible_pdf(lambda);
                assert!((pdf / expected - 1.0).abs() < 1e-4, "{lambda}: {pdf} and {expected}");
            }
        }
        let last = Wavelengths::sample_visible(1.0 - f32::EPSILON / 2.0);
        assert!(last.lambda.iter().all(|l| (LAMBDA_MIN..=LAMBDA_MAX).contains(l)));
    }

    #[test]
    fn each_lane_integrates_what_it_samples() {
        // The mean over u of f / pdf is the integral of f; f(lambda) = lambda has the integral (830^2 - 360^2) / 2.
        let n = 20_000;
        let mut sums = [0.0_f64; LANES];
        for i in 0..n {
            let w = Wavelengths::sample_visible((i as f32 + 0.5) / n as f32);
            for (sum, (&lambda, &pdf)) in sums.iter_mut().zip(w.lambda.iter().zip(&w.pdf)) {
                *sum += f64::from(lambda) / f64::from(pdf);
            }
        }
        for sum in sums {
            let integral = (830.0_f64.powi(2) - 360.0_f64.powi(2)) / 2.0;
            assert!((sum / f64::from(n) / integral - 1.0).abs() < 1e-4);
        }
    }

    #[test]
    fn termination_happens_once() {
        let mut w = Wavelengths::sample_visible(0.3);
        let hero = w.pdf[0];
        assert!(!w.secondary_terminated());
        w.terminate_secondary();
        w.terminate_secondary();
        assert!(w.secondary_terminated());
        assert_eq!(w.pdf, [hero / 4.0, 0.0, 0.0, 0.0]);
    }
}
