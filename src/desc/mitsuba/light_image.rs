//! Pictures of lights. Mitsuba interpolates between their pixels, here each pixel is a constant: small pictures are made larger.

use std::f32::consts::PI;

use glam::Vec3;

use crate::image_io::{Image, Window};

/// No picture is made larger than some so many pixels.
const MOST_PIXELS: usize = 1 << 20;

/// Pixels by row.
struct Pixels {
    rgb: Vec<[f32; 3]>,
    width: usize,
    height: usize,
}

impl Pixels {
    fn new(image: &Image) -> Self {
        Self {
            // The reader has seen to it that there are colours.
            rgb: image
                .to_rgb()
                .unwrap_or_else(|| vec![[0.0; 3]; image.width() * image.height()]),
            width: image.width(),
            height: image.height(),
        }
    }

    /// At a row and a column; columns and rows repeat.
    fn at(&self, x: i64, y: i64) -> Vec3 {
        let x = x.rem_euclid(self.width as i64) as usize;
        let y = y.rem_euclid(self.height as i64) as usize;
        self.rgb[y * self.width + x].into()
    }

    /// Between four pixels, at coordinates where their middles are integers.
    fn between(&self, x: f32, y: f32) -> Vec3 {
        let (x0, y0) = (x.floor(), y.floor());
        let row = |y: i64| self.at(x0 as i64, y).lerp(self.at(x0 as i64 + 1, y), x - x0);
        row(y0 as i64).lerp(row(y0 as i64 + 1), y - y0)
    }

    /// How many times larger each way the picture is made.
    fn factor(&self) -> usize {
        let room = (MOST_PIXELS / (self.width * self.height)).max(1);
        room.isqrt().clamp(1, 16)
    }
}

/// A picture of so many pixels, by where they are from 0 to 1 each way.
fn picture(width: usize, height: usize, color: impl Fn(f32, f32) -> Vec3) -> Option<Image> {
    let middle = |i: usize, size: usize| (i as f32 + 0.5) / size as f32;
    let pixels = (0..width * height).map(|i| color(middle(i % width, width), middle(i / width, height)));
    let data = pixels.flat_map(|pixel| pixel.to_array()).collect();
    let window = Window::of_size(width as i32, height as i32);
    Image::rgb(window, window, data).ok()
}

/// An image that repeats, its pixels at their middles.
pub(super) fn smooth(image: &Image) -> Image {
    let pixels = Pixels::new(image);
    let factor = pixels.factor();
    let (width, height) = (pixels.width as f32, pixels.height as f32);
    let larger = picture(pixels.width * factor, pixels.height * factor, |u, v| {
        pixels.between(u * width - 0.5, v * height - 0.5)
    });
    larger.unwrap_or_else(|| image.clone())
}

/// An environment: columns have their pixels at their middles, the first row is at one pole and the last at the other. The result is
/// twice as wide as high.
pub(super) fn environment(image: &Image) -> Image {
    let pixels = Pixels::new(image);
    let width = (pixels.width * pixels.factor()).next_multiple_of(2);
    let (columns, last) = (pixels.width as f32, (pixels.height - 1) as f32);
    let larger = picture(width, width / 2, |u, v| {
        pixels.between(u * columns - 0.5, (v * last).min(last))
    });
    larger.unwrap_or_else(|| image.clone())
}

/// The intensities of a projector that makes `irradiance` times pi on a screen at distance 1, whose half width and height these are.
pub(super) fn projected(irradiance: &Image, half: [f64; 2]) -> Image {
    let smooth = Pixels::new(&smooth(irradiance));
    let half = half.map(|side| side as f32);
    let larger = picture(smooth.width, smooth.height, |u, v| {
        let (x, y) = ((2.0 * u - 1.0) * half[0], (2.0 * v - 1.0) * half[1]);
        let pixel = smooth.at((u * smooth.width as f32) as i64, (v * smooth.height as f32) as i64);
        // Over the cube of the cosine.
        pixel * (PI * (1.0 + x * x + y * y).powf(1.5))
    });
    larger.unwrap_or_else(|| irradiance.clone())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn two_by_one() -> Image {
        let window = Window::of_size(2, 1);
        Image::rgb(window, window, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0]).unwrap()
    }

    #[test]
    fn larger_pictures_keep_their_mean_and_blend() {
        let larger = smooth(&two_by_one());
        let rgb = larger.to_rgb().unwrap();
        let mean = rgb.iter().map(|p| p[0]).sum::<f32>() / rgb.len() as f32;
        assert!((mean - 0.5).abs() < 1e-5, "{mean}");
        assert!(rgb.iter().any(|p| (0.4..0.6).contains(&p[0])));
    }

    #[test]
    fn environments_are_twice_as_wide_as_high() {
        let larger = environment(&two_by_one());
        assert_eq!(larger.width(), 2 * larger.height());
    }

    #[test]
    fn projectors_are_brighter_towards_their_edges() {
        let window = Window::of_size(1, 1);
        let white = Image::rgb(window, window, vec![1.0; 3]).unwrap();
        let rgb = projected(&white, [1.0, 1.0]).to_rgb().unwrap();
        let (corner, middle) = (rgb[0][0], rgb[rgb.len() / 2 + larger_half(&rgb)][0]);
        assert!(corner > 4.0 * PI && corner < 3.0_f32.powf(1.5) * PI, "{corner}");
        assert!(middle < 1.02 * PI, "{middle}");
    }

    /// Half a row of a square.
    fn larger_half(rgb: &[[f32; 3]]) -> usize {
        rgb.len().isqrt() / 2
    }
}
