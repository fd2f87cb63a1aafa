//! Emission given by the pixels of an image: what a light with an `rgb` value would have, for millions of values.
//!
//! The reflectance behind an rgb illuminant has a largest component of 1/2 (see [`Spectrum::rgb_illuminant`]), so that the sigmoid
//! polynomials of all colours are functions of two numbers: the ratios of the other components to the largest. They are
//! tabulated when first needed and interpolated. (Colours of wider spaces than sRGB go by the tables of reflectances.)
//!
//! [`Spectrum::rgb_illuminant`]: super::Spectrum::rgb_illuminant

use std::sync::{Arc, LazyLock};

use super::cie::{self, DenseTable};
use super::rgb2spec::{SigmoidPolynomial, solve};
use super::table::wide_polynomial;
use super::{ColorMode, ColorSpace, SampledSpectrum, Wavelengths};

/// Makes pixels in linear RGB of a colour space emit, scaled as lights are: its white has a luminance (times the integral of ȳ) of 1.
#[derive(Clone, Debug)]
pub struct RgbEmission {
    form: Form,
    space: ColorSpace,
}

#[derive(Clone, Debug)]
enum Form {
    /// The white over its photometric integral.
    Spectral(Arc<DenseTable>),
    Rgb,
}

/// The emission of a pixel, made ready for one [`RgbEmission`]: coefficients and a factor, or r, g, b and zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EmissionPixel([f32; 4]);

impl RgbEmission {
    /// Of pixels in linear sRGB.
    pub fn new(mode: ColorMode) -> Self {
        Self::in_space(mode, ColorSpace::Srgb)
    }

    /// Of pixels in linear RGB of a space.
    pub fn in_space(mode: ColorMode, space: ColorSpace) -> Self {
        let form = match mode {
            ColorMode::Rgb => Form::Rgb,
            ColorMode::Spectral => {
                let white = space.illuminant();
                let photometric = cie::integrate_y(|nm| white.at(nm)) as f32;
                Form::Spectral(Arc::new(DenseTable::from_fn(|nm| white.at(nm) / photometric)))
            }
        };
        Self { form, space }
    }

    /// Makes a pixel ready; negative components count as 0.
    pub fn pixel(&self, rgb: [f32; 3]) -> EmissionPixel {
        let rgb = rgb.map(|c| c.max(0.0));
        match &self.form {
            Form::Rgb => {
                let [r, g, b] = match self.space {
                    ColorSpace::Srgb => rgb,
                    // What is outside of the gamut is clipped.
                    space => cie::xyz_to_srgb(space.rgb_to_xyz(rgb.map(f64::from))).map(|c| c.max(0.0) as f32),
                };
                EmissionPixel([r, g, b, 0.0])
            }
            Form::Spectral(_) => {
                let largest = rgb[0].max(rgb[1]).max(rgb[2]);
                if largest == 0.0 {
                    return EmissionPixel::default();
                }
                let is_grey = rgb[0] == rgb[1] && rgb[1] == rgb[2];
                let [a, b, c] = match self.space {
                    _ if is_grey => [0.0; 3],
                    ColorSpace::Srgb => TABLE.coefficients(rgb, largest),
                    space => wide_polynomial(space, rgb.map(|c| 0.5 * c / largest)).coefficients(),
                };
                EmissionPixel([a, b, c, 2.0 * largest])
            }
        }
    }

    /// The emission of a pixel that [`Self::pixel`] made, at the wavelengths of a path.
    #[inline]
    pub fn sample(&self, pixel: &EmissionPixel, wavelengths: &Wavelengths) -> SampledSpectrum {
        match &self.form {
            Form::Rgb => SampledSpectrum(pixel.0),
            Form::Spectral(light) => {
                let [a, b, c, scale] = pixel.0;
                let reflectance = SigmoidPolynomial::from_coefficients([a, b, c]);
                reflectance.sample(wavelengths) * light.sample(wavelengths) * scale
            }
        }
    }

    /// The luminance of a pixel: the photometric value of what it emits.
    pub fn luminance(&self, rgb: [f32; 3]) -> f32 {
        self.space.rgb_to_xyz(rgb.map(|c| f64::from(c.max(0.0))))[1] as f32
    }
}

/// Nodes along each ratio.
const NODES: usize = 64;

/// Coefficients by the largest component and the ratios to it of the one after and the one before it, in the order r, g, b, r.
struct Table(Vec<[f32; 3]>);

static TABLE: LazyLock<Table> = LazyLock::new(Table::new);

/// The ratio at a node: closer together near 0, where colours are saturated and coefficients change fastest.
fn ratio(node: usize) -> f64 {
    (node as f64 / (NODES - 1) as f64).powi(3)
}

impl Table {
    fn new() -> Self {
        let colour = |largest: usize, i: usize, j: usize| {
            let mut rgb = [0.5_f32; 3];
            rgb[(largest + 1) % 3] = (0.5 * ratio(i)) as f32;
            rgb[(largest + 2) % 3] = (0.5 * ratio(j)) as f32;
            rgb
        };
        let mut table = Vec::with_capacity(3 * NODES * NODES);
        for largest in 0..3 {
            for i in 0..NODES {
                for j in 0..NODES {
                    table.push(solve(ColorSpace::Srgb, colour(largest, i, j)).coefficients());
                }
            }
        }
        Self(table)
    }

    /// Those of rgb / (2 largest).
    fn coefficients(&self, rgb: [f32; 3], largest: f32) -> [f32; 3] {
        let index = rgb.iter().position(|&c| c == largest).unwrap_or(0);
        let place = |c: f32| {
            let at = (c / largest).cbrt() * (NODES - 1) as f32;
            let node = (at as usize).min(NODES - 2);
            // Linear in the ratio itself between two nodes.
            let [low, high] = [ratio(node), ratio(node + 1)].map(|r| r as f32);
            (node, ((c / largest - low) / (high - low)).clamp(0.0, 1.0))
        };
        let (i, x) = place(rgb[(index + 1) % 3]);
        let (j, y) = place(rgb[(index + 2) % 3]);
        let at = |i: usize, j: usize| self.0[(index * NODES + i) * NODES + j];
        let corners = [at(i, j), at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)];
        let weights = [(1.0 - x) * (1.0 - y), (1.0 - x) * y, x * (1.0 - y), x * y];
        std::array::from_fn(|k| corners.iter().zip(weights).map(|(corner, w)| corner[k] * w).sum())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::{Spectrum, SpectrumRole};

    /// A pixel emits what a light of its colour does: white to rounding, colours as well as the table interpolates.
    #[test]
    fn pixels_emit_like_rgb_lights() {
        for mode in [ColorMode::Rgb, ColorMode::Spectral] {
            let emission = RgbEmission::new(mode);
            let levels = [0.0, 0.02, 0.1, 0.45, 0.8, 1.0, 3.0];
            let mut worst = 0.0_f32;
            for i in 0..levels.len().pow(3) {
                let rgb = [levels[i / 49], levels[i / 7 % 7], levels[i % 7]];
                let light = Spectrum::rgb_illuminant(rgb);
                let compiled = light
                    .compile(mode, SpectrumRole::Emission)
                    .scaled(1.0 / light.photometric());
                let pixel = emission.pixel(rgb);
                let largest = rgb.into_iter().fold(0.0, f32::max);
                for u in [0.05, 0.2, 0.4, 0.6, 0.9] {
                    let lambda = match mode {
                        ColorMode::Rgb => Wavelengths::rgb(),
                        ColorMode::Spectral => Wavelengths::sample_visible(u),
                    };
                    let (found, expected) = (emission.sample(&pixel, &lambda), compiled.sample(&lambda));
                    for (a, b) in found.0.into_iter().zip(expected.0) {
                        // Of the largest component, times the white.
                        let white = match mode {
                            ColorMode::Rgb => 1.0,
                            ColorMode::Spectral => 1.0 / cie::y_integral(),
                        };
                        let error = (a - b).abs() / (white * largest.max(1e-6));
                        let grey = rgb[0] == rgb[1] && rgb[1] == rgb[2];
                        assert!(error < 1e-6 || !grey, "{mode:?} {rgb:?}: {a} and {b}");
                        worst = worst.max(error);
                    }
                }
            }
            assert!(worst < 0.01, "{mode:?}: {worst}");
        }
    }

    /// The colour that a sensor sees is that of the pixel.
    #[test]
    fn colours_of_pixels_are_seen_again() {
        let emission = RgbEmission::new(ColorMode::Spectral);
        let mut worst = 0.0_f64;
        for i in 0..512 {
            let rgb = [i / 64, i / 8 % 8, i % 8].map(|c| ((c as f32 + 0.3) / 7.3).powi(2));
            let pixel = emission.pixel(rgb);
            let xyz = cie::integrate_xyz(|nm| {
                let lambda = Wavelengths {
                    lambda: [nm; 4],
                    pdf: [1.0; 4],
                };
                emission.sample(&pixel, &lambda).0[0]
            });
            let largest = rgb.into_iter().fold(0.0, f32::max);
            for (seen, c) in cie::xyz_to_srgb(xyz).into_iter().zip(rgb) {
                worst = worst.max((seen - f64::from(c)).abs() / f64::from(largest));
            }
            assert!(
                (f64::from(emission.luminance(rgb)) / xyz[1] - 1.0).abs() < 2e-3,
                "{rgb:?}"
            );
        }
        assert!(worst < 2e-3, "{worst}");
    }
}
