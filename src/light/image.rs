//! Images that emit.

use crate::math::Vec2;
use crate::spectrum::{EmissionPixel, RgbEmission, SampledSpectrum, Wavelengths};

/// An image whose pixels are emission: (1, 1, 1) is the white of its colour space, with the luminance that a light of spectrum 1 has.
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
            luminances: rgb.iter().map(|&pixel| emission.luminance(pixel)).collect(),
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

    /// The emission at texture coordinates, between the middles of the pixels: (0, 0) is the lower left corner of the image, (1, 1)
    /// the upper right one, and outside its edges go on.
    pub fn sample_bilinear(&self, uv: Vec2, lambda: &Wavelengths) -> SampledSpectrum {
        let mut sum = SampledSpectrum::ZERO;
        for (x, y, weight) in self.neighbours(uv) {
            if weight > 0.0 {
                sum += self.sample(x, y, lambda) * weight;
            }
        }
        sum
    }

    /// The luminance of [`Self::sample_bilinear`].
    pub fn luminance_bilinear(&self, uv: Vec2) -> f32 {
        let pixels = self.neighbours(uv).into_iter();
        pixels.map(|(x, y, weight)| self.luminance(x, y) * weight).sum()
    }

    /// The four pixels around a point, and their weights.
    fn neighbours(&self, uv: Vec2) -> [(usize, usize, f32); 4] {
        let [width, height] = self.size;
        let along = |c: f32, count: usize| {
            let at = (c * count as f32 - 0.5).clamp(0.0, (count - 1) as f32);
            let first = (at as usize).min(count - 1);
            (first, (first + 1).min(count - 1), at - first as f32)
        };
        let (x0, x1, fx) = along(uv.x, width);
        let (y0, y1, fy) = along(1.0 - uv.y, height);
        [
            (x0, y0, (1.0 - fx) * (1.0 - fy)),
            (x1, y0, fx * (1.0 - fy)),
            (x0, y1, (1.0 - fx) * fy),
            (x1, y1, fx * fy),
        ]
    }

    /// The luminance on average over all pixels.
    pub fn mean_luminance(&self) -> f32 {
        let [width, height] = self.size;
        self.sum(|_, _| 1.0) / (width * height) as f32
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
