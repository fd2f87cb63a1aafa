//! Images that emit.

use crate::spectrum::{EmissionPixel, RgbEmission, SampledSpectrum, Wavelengths, rgb_luminance};

/// An image in linear sRGB whose pixels are emission: (1, 1, 1) is D65 with the luminance that a light of spectrum 1 has.
#[derive(Clone, Debug)]
pub struct EmissionImage {
    size: [usize; 2],
    emission: RgbEmission,
    pixels: Vec<EmissionPixel>,
    /// By pixel, without `scale`.
    luminances: Vec<f32>,
    scale: f32,
}

impl EmissionImage {
    /// Of pixels row by row from the top, `width` a row; what is negative counts as 0. `None` without a pixel, or if the rows
    /// are not whole.
    pub fn new(rgb: &[[f32; 3]], width: usize, emission: RgbEmission) -> Option<Self> {
        let whole = width > 0 && !rgb.is_empty() && rgb.len().is_multiple_of(width);
        whole.then(|| Self {
            size: [width, rgb.len() / width],
            pixels: rgb.iter().map(|&pixel| emission.pixel(pixel)).collect(),
            luminances: rgb.iter().map(|&pixel| rgb_luminance(pixel)).collect(),
            emission,
            scale: 1.0,
        })
    }

    /// This image, `factor` times as bright.
    #[must_use]
    pub fn scaled(mut self, factor: f32) -> Self {
        self.scale *= factor;
        self
    }

    /// Width and height.
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// The emission of a pixel.
    #[inline]
    pub fn sample(&self, x: usize, y: usize, lambda: &Wavelengths) -> SampledSpectrum {
        self.emission.sample(&self.pixels[y * self.size[0] + x], lambda) * self.scale
    }

    /// The luminance of a pixel.
    #[inline]
    pub fn luminance(&self, x: usize, y: usize) -> f32 {
        self.luminances[y * self.size[0] + x] * self.scale
    }

    /// The sum over all pixels of luminance times a weight, by column and row.
    pub fn sum(&self, weight: impl Fn(usize, usize) -> f32) -> f32 {
        let [width, height] = self.size;
        let row = |y: usize| -> f64 {
            let pixel = |x| f64::from(self.luminance(x, y) * weight(x, y));
            (0..width).map(pixel).sum()
        };
        (0..height).map(row).sum::<f64>() as f32
    }
}
