//! From spectral radiance to linear sRGB.

use crate::spectrum::{ColorMode, SampledSpectrum, Wavelengths, cie};

/// What a film records of light: the CIE 1931 observer, as linear sRGB, times the imaging ratio (exposure time x ISO / 100).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensor {
    mode: ColorMode,
    /// Linear sRGB of XYZ, by rows, the imaging ratio included.
    rgb_from_xyz: [[f32; 3]; 3],
    imaging_ratio: f32,
}

impl Sensor {
    /// A sensor for spectral or rgb transport.
    pub fn new(mode: ColorMode, imaging_ratio: f64) -> Self {
        let imaging_ratio = imaging_ratio as f32;
        let rgb_from_xyz = cie::srgb_from_xyz_rows().map(|row| row.map(|c| c * imaging_ratio));
        Self {
            mode,
            rgb_from_xyz,
            imaging_ratio,
        }
    }

    /// Linear sRGB of the spectral radiance `l` of one sample: an estimate of its integral against the colour matching functions.
    /// Negative where the colour lies outside sRGB.
    #[inline]
    pub fn to_rgb(&self, l: SampledSpectrum, lambda: &Wavelengths) -> [f32; 3] {
        match self.mode {
            ColorMode::Rgb => [l.0[0], l.0[1], l.0[2]].map(|c| c * self.imaging_ratio),
            ColorMode::Spectral => {
                let l = l.safe_div(lambda.pdf());
                let xyz = cie::xyz_bar(lambda).map(|bar| (bar * l).mean());
                self.rgb_from_xyz
                    .map(|row| row[0] * xyz[0] + row[1] * xyz[1] + row[2] * xyz[2])
            }
        }
    }
}
