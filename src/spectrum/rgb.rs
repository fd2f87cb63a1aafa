//! Spectra of colours that are found while rendering: the texels of images. (For emission there is [`RgbEmission`](super::RgbEmission).)

use super::table::{prepare, reflectance, wide_polynomial};
use super::{ColorMode, ColorSpace, SampledSpectrum, Wavelengths};

/// Turns linear RGB of a colour space into what a path carries. In rgb mode that is the colour in linear sRGB.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RgbSampler {
    mode: ColorMode,
    kind: RgbKind,
    space: ColorSpace,
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
    /// For one colour mode, kind of colours and space that they are in.
    pub fn new(mode: ColorMode, kind: RgbKind, space: ColorSpace) -> Self {
        if mode == ColorMode::Spectral {
            prepare(space);
        }
        Self { mode, kind, space }
    }

    /// The values at the wavelengths of a path; in rgb mode (r, g, b, 0).
    #[inline]
    pub fn sample(&self, rgb: [f32; 3], lambda: &Wavelengths) -> SampledSpectrum {
        let rgb = match self.kind {
            RgbKind::Albedo => rgb.map(|c| c.clamp(0.0, 1.0)),
            RgbKind::Unbounded => rgb.map(|c| c.max(0.0)),
        };
        match (self.mode, self.kind) {
            (ColorMode::Rgb, _) => self.srgb(rgb),
            (ColorMode::Spectral, RgbKind::Albedo) => self.reflectance(rgb, lambda),
            (ColorMode::Spectral, RgbKind::Unbounded) => {
                // Twice the largest component times the reflectance of the rest.
                let scale = 2.0 * rgb[0].max(rgb[1]).max(rgb[2]);
                if scale == 0.0 {
                    return SampledSpectrum::ZERO;
                }
                self.reflectance(rgb.map(|c| c / scale), lambda) * scale
            }
        }
    }

    #[inline]
    fn reflectance(&self, rgb: [f32; 3], lambda: &Wavelengths) -> SampledSpectrum {
        let is_grey = rgb[0] == rgb[1] && rgb[1] == rgb[2];
        if self.space == ColorSpace::Srgb || is_grey {
            reflectance(rgb, lambda)
        } else {
            wide_polynomial(self.space, rgb).sample(lambda)
        }
    }

    /// In linear sRGB; outside of its gamut clipped.
    #[inline]
    fn srgb(&self, rgb: [f32; 3]) -> SampledSpectrum {
        let [r, g, b] = match self.space {
            ColorSpace::Srgb => rgb,
            space => {
                let largest = match self.kind {
                    RgbKind::Albedo => 1.0,
                    RgbKind::Unbounded => f32::INFINITY,
                };
                space.reflectance_to_srgb(rgb).map(|c| c.clamp(0.0, largest))
            }
        };
        SampledSpectrum([r, g, b, 0.0])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::{Spectrum, SpectrumRole};

    /// A texel reflects like a constant reflectance of its colour, in all spaces and both modes.
    #[test]
    fn texels_reflect_like_rgb_reflectances() {
        for space in ColorSpace::ALL {
            for mode in [ColorMode::Rgb, ColorMode::Spectral] {
                for (kind, spectrum) in [
                    (RgbKind::Albedo, Spectrum::rgb_albedo as fn([f32; 3]) -> Spectrum),
                    (RgbKind::Unbounded, Spectrum::rgb_unbounded),
                ] {
                    let sampler = RgbSampler::new(mode, kind, space);
                    for rgb in [[0.5, 0.3, 0.2], [0.3, 0.45, 0.25], [0.7; 3], [0.25, 0.3, 0.5], [0.0; 3]] {
                        let compiled = spectrum(rgb).in_space(space).compile(mode, SpectrumRole::Reflectance);
                        for u in [0.1, 0.35, 0.6, 0.9] {
                            let lambda = match mode {
                                ColorMode::Rgb => Wavelengths::rgb(),
                                ColorMode::Spectral => Wavelengths::sample_visible(u),
                            };
                            let (found, expected) = (sampler.sample(rgb, &lambda), compiled.sample(&lambda));
                            for (a, b) in found.0.into_iter().zip(expected.0) {
                                // In rgb mode a constant has no component beyond 1 or its spectrum's largest value.
                                let bound = if mode == ColorMode::Rgb { 1e-2 } else { 5e-3 };
                                assert!(
                                    (a - b).abs() < bound,
                                    "{space:?} {mode:?} {kind:?} {rgb:?}: {a} and {b}"
                                );
                            }
                        }
                    }
                }
            }
        }
    }
}
