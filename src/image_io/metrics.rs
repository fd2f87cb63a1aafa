//! How far an image is from a reference.

use super::{Image, flip, image_error, read};
use crate::{Error, Result};
use serde::Serialize;
use std::path::Path;

/// The difference of an image A from a reference B, over the colour channels of linear values; alpha and other channels do not
/// take part. A grey image counts as one with three equal channels.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// The mean of (A - B)² over pixels and channels.
    pub mse: f64,
    /// The mean of (A - B)² / (B² + 0.01) over pixels and channels.
    pub relmse: f64,
    /// The mean of A over pixels and channels.
    pub mean_a: f64,
    /// The mean of B over pixels and channels.
    pub mean_b: f64,
    /// How much brighter A is, as a fraction: (`mean_a` - `mean_b`) / `mean_b`. 0 if the means are equal; `None`, in JSON `null`, if
    /// only `mean_b` is 0.
    pub mean_difference: Option<f64>,
    /// The mean over pixels of LDR-FLIP at 67 pixels a degree, of both images clamped to [0, 1] and shown as sRGB: 0 (no visible
    /// difference) to 1. See [`flip`].
    pub flip: f64,
}

/// The term that keeps `relmse` finite where B is black.
const RELMSE_EPSILON: f64 = 0.01;

impl Comparison {
    /// Compares two files of any kind that [`read`] reads. Only the sizes of the data windows must agree, not their places: a crop
    /// saved as PNG does not know its own.
    ///
    /// # Errors
    /// [`Error::Usage`] if the sizes differ; [`Error::Image`] if a file cannot be decoded or has a value that is infinite or not a
    /// number; [`Error::Io`] if a file cannot be read.
    pub fn of_files(a: &Path, b: &Path) -> Result<Self> {
        let (image_a, image_b) = (read(a)?, read(b)?);
        for (path, image) in [(a, &image_a), (b, &image_b)] {
            check_finite(image).map_err(|message| image_error(path, message))?;
        }
        Self::of_images(&image_a, &image_b)
    }

    /// Compares two images; see [`Comparison::of_files`].
    ///
    /// # Errors
    /// [`Error::Usage`] if the sizes differ, an image has no colour channels, or one has a value that is infinite or not a number.
    pub fn of_images(a: &Image, b: &Image) -> Result<Self> {
        let size = |image: &Image| (image.width(), image.height());
        if size(a) != size(b) {
            let ((wa, ha), (wb, hb)) = (size(a), size(b));
            return Err(Error::Usage(format!(
                "images of different sizes cannot be compared: A is {wa}x{ha} pixels, B is {wb}x{hb}"
            )));
        }
        let colours = |name: &str, image: &Image| {
            check_finite(image).map_err(|message| Error::Usage(format!("image {name}: {message}")))?;
            let missing = || Error::Usage(format!("image {name} has no channels R, G, B or Y"));
            image.to_rgb().ok_or_else(missing)
        };
        let (pixels_a, pixels_b) = (colours("A", a)?, colours("B", b)?);

        let values = || {
            let pairs = pixels_a.as_flattened().iter().zip(pixels_b.as_flattened());
            pairs.map(|(&a, &b)| (f64::from(a), f64::from(b)))
        };
        let mean = |of: fn((f64, f64)) -> f64| values().map(of).sum::<f64>() / (3.0 * pixels_a.len() as f64);
        let (mean_a, mean_b) = (mean(|(a, _)| a), mean(|(_, b)| b));
        let errors = flip::error_map(&pixels_a, &pixels_b, a.width(), flip::PIXELS_PER_DEGREE);
        Ok(Self {
            mse: mean(|(a, b)| (a - b).powi(2)),
            relmse: mean(|(a, b)| (a - b).powi(2) / (b * b + RELMSE_EPSILON)),
            mean_a,
            mean_b,
            mean_difference: relative_difference(mean_a, mean_b),
            flip: errors.iter().map(|&e| f64::from(e)).sum::<f64>() / errors.len() as f64,
        })
    }
}

fn relative_difference(mean_a: f64, mean_b: f64) -> Option<f64> {
    if mean_a == mean_b {
        Some(0.0)
    } else {
        (mean_b != 0.0).then(|| (mean_a - mean_b) / mean_b)
    }
}

/// Says where the first value is that no difference can be taken of.
fn check_finite(image: &Image) -> Result<(), String> {
    let Some(index) = image.data().iter().position(|value| !value.is_finite()) else {
        return Ok(());
    };
    let channels = image.channels().len();
    let pixel = index / channels;
    Err(format!(
        "channel {} of pixel ({}, {}) is {}, not a finite number",
        image.channels()[index % channels],
        pixel % image.width(),
        pixel / image.width(),
        image.data()[index]
    ))
}

#[cfg(test)]
mod tests {
    use super::super::Window;
    use super::*;

    fn rgb(width: i32, height: i32, value: impl Fn(usize) -> f32) -> Image {
        let window = Window::of_size(width, height);
        Image::rgb(window, window, (0..window.pixel_count() * 3).map(value).collect()).unwrap()
    }

    #[test]
    fn measures_follow_their_definitions() {
        // Pixel 0: A 0.5, B 0.25; pixel 1: A 1, B 2, in all channels, exact in binary.
        let a = rgb(2, 1, |i| if i < 3 { 0.5 } else { 1.0 });
        let b = rgb(2, 1, |i| if i < 3 { 0.25 } else { 2.0 });
        let c = Comparison::of_images(&a, &b).unwrap();
        assert_eq!(c.mse, (0.0625 + 1.0) / 2.0);
        assert!((c.relmse - (0.0625 / 0.0725 + 1.0 / 4.01) / 2.0).abs() < 1e-15);
        assert_eq!((c.mean_a, c.mean_b), (0.75, 1.125));
        assert_eq!(c.mean_difference, Some(-0.375 / 1.125));
        assert!(c.flip > 0.0 && c.flip < 1.0);
    }

    #[test]
    fn equal_images_do_not_differ() {
        let a = rgb(5, 7, |i| (i % 11) as f32 * 0.3);
        let c = Comparison::of_images(&a, &a).unwrap();
        assert_eq!((c.mse, c.relmse, c.mean_difference, c.flip), (0.0, 0.0, Some(0.0), 0.0));
    }

    #[test]
    fn a_black_reference_has_no_relative_difference() {
        let (a, b) = (rgb(2, 2, |_| 0.5), rgb(2, 2, |_| 0.0));
        assert_eq!(Comparison::of_images(&a, &b).unwrap().mean_difference, None);
        assert_eq!(Comparison::of_images(&b, &b).unwrap().mean_difference, Some(0.0));
    }

    #[test]
    fn flip_sees_the_clamped_images_only() {
        let (a, b) = (rgb(8, 8, |_| 1.0), rgb(8, 8, |i| 1.0 + i as f32));
        let c = Comparison::of_images(&a, &b).unwrap();
        assert!(c.mse > 1.0);
        assert_eq!(c.flip, 0.0);
    }

    #[test]
    fn what_cannot_be_compared_is_refused() {
        let a = rgb(2, 3, |_| 0.5);
        let Err(Error::Usage(message)) = Comparison::of_images(&a, &rgb(3, 2, |_| 0.5)) else {
            panic!("different sizes must be refused");
        };
        assert!(message.contains("2x3") && message.contains("3x2"), "{message}");
        for bad in [f32::NAN, f32::INFINITY] {
            let b = rgb(2, 3, |i| if i == 7 { bad } else { 0.5 });
            let Err(Error::Usage(message)) = Comparison::of_images(&a, &b) else {
                panic!("{bad} must be refused");
            };
            assert!(message.contains("channel G of pixel (0, 1)"), "{message}");
        }
    }
}
