//! Spectra of colours that are found while rendering: the texels of images. (For emission there is [`RgbEmission`](super::RgbEmission).)

use super::table::reflectance;
use super::{ColorMode, SampledSpectrum, Wavelengths};

/// Turns linear sRGB into what a path carries. In rgb mode that is the colour itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RgbSampler {
    mode: ColorMode,
    kind: RgbKind,
}

/// What a colour is, as pbrt-v4 tells them apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RgbKind {
    /// A reflectance: what is outside [0, 1] is clamped.
    Albedo,
    /// A quantity that is not negative.
    Unbounded,
}

impl RgbSampler {
    /// For one colour mode and kind of colours.
    pub fn new(mode: ColorMode, kind: RgbKind) -> Self {
        if mode == ColorMode::Spectral {
            super::table::prepare();
        }
        Self { mode, kind }
    }

    /// The values at the wavelengths of a path; in rgb mode (r, g, b, 0).
    #[inline]
    pub fn sample(&self, rgb: [f32; 3], lambda: &Wavelengths) -> SampledSpectrum {
        let rgb = match self.kind {
            RgbKind::Albedo => rgb.map(|c| c.clamp(0.0, 1.0)),
            RgbKind::Unbounded => rgb.map(|c| c.max(0.0)),
        };
        if self.mode == ColorMode::Rgb {
            return SampledSpectrum([rgb[0], rgb[1], rgb[2], 0.0]);
        }
        match self.kind {
            RgbKind::Albedo => reflectance(rgb, lambda),
            RgbKind::Unbounded => unbounded(rgb, lambda),
        }
    }
}

/// Twice the largest component times the reflectance of the rest.
fn unbounded(rgb: [f32; 3], lambda: &Wavelengths) -> SampledSpectrum {
    let scale = 2.0 * rgb[0].max(rgb[1]).max(rgb[2]);
    if scale == 0.0 {
        return SampledSpectrum::ZERO;
    }
    reflectance(rgb.map(|c| c / scale), lambda) * scale
}
