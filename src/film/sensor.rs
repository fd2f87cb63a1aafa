//! From spectral radiance to linear sRGB.

use crate::spectrum::{ColorMode, SampledSpectrum, Wavelengths, cie};

/// What a film records of light: the CIE 1931 observer, as linear sRGB, times the imaging ratio (exposure time x ISO / 100).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensor {
    mode: ColorMode,
    imaging_ratio: f32,
}

impl Sensor {
    /// A sensor for spectral or rgb transport.
    pub fn new(mode: ColorMode, imaging_ratio: f64) -> Self {
        Self { mode, imaging_ratio: imaging_ratio as f32 }
    }

    /// Linear sRGB of the spectral radiance `l` of one sample: an estimate of its integral against the colour matching functions.
    /// Negative where the colour lies outside sRGB.
    #[inline]
    pub fn to_rgb(&self, l: SampledSpectrum, lambda: &Wavelengths) -> [f32; 3] {
        let rgb = match self.mode {
            ColorMode::Rgb => [l.0[0], l.0[1], l.0[2]],
            ColorMode::Spectral => {
                let weighted = l.safe_div(lambda.pdf());
                let mut xyz = [0.0_f32; 3];
                for (lambda, value) in lambda.lambda.into_iter().zip(weighted.0) {
                    for (sum, response) in xyz.iter_mut().zip(cie::cmf(lambda)) {
                        *sum += response * value;
                    }
                }
                cie::xyz_to_srgb(xyz.map(|sum| sum * 0.25))
            }
        };
        rgb.map(|c| c * self.imaging_ratio)
    }
}
