//! The CIE 1931 observer, sums over wavelength, and the step between XYZ and linear sRGB.
//!
//! Tables have an entry per nm from 360 to 830. Between entries they are constant (each covers half a nm on either side), as
//! in pbrt-v4, so that sums over the entries are exactly what an estimate by random wavelengths converges to. An XYZ here is
//! the integral itself: as in the sensor of a film, nothing is divided by [`y_integral`].

use std::sync::LazyLock;

use super::wavelengths::{LAMBDA_MIN, Wavelengths};
use super::{ColorSpace, SampledSpectrum};

/// Entries of a table: 360 to 830 nm.
pub(super) const ENTRIES: usize = 471;

/// A function of wavelength, by nm from 360 to 830.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct DenseTable([f32; ENTRIES]);

impl DenseTable {
    /// Evaluates `f` at each nm.
    pub fn from_fn(f: impl Fn(f32) -> f32) -> Self {
        Self(std::array::from_fn(|i| f(wavelength(i))))
    }

    /// The value of the entry nearest to `lambda` (nm); beyond the ends that of the end.
    #[inline]
    pub fn at(&self, lambda: f32) -> f32 {
        self.0[entry(lambda)]
    }

    /// The values at the wavelengths of a path.
    #[inline]
    pub fn sample(&self, wavelengths: &Wavelengths) -> SampledSpectrum {
        SampledSpectrum(wavelengths.lambda.map(|lambda| self.at(lambda)))
    }

    /// The entries in order.
    pub fn values(&self) -> &[f32; ENTRIES] {
        &self.0
    }
}

/// The entry nearest to `lambda` (nm), the first or last if it is outside.
#[inline]
fn entry(lambda: f32) -> usize {
    // The cast sends what is negative to 0.
    ((lambda - (LAMBDA_MIN - 0.5)) as usize).min(ENTRIES - 1)
}

/// The wavelength of entry `i`, in nm.
pub(super) fn wavelength(i: usize) -> f32 {
    LAMBDA_MIN + i as f32
}

struct Observer {
    bars: [DenseTable; 3],
    y_integral: f32,
}

static OBSERVER: LazyLock<Observer> = LazyLock::new(|| {
    let mut bars = [const { DenseTable([0.0; ENTRIES]) }; 3];
    let rows = include_str!("data/cie_1931_2deg_xyz_1nm.csv").lines().skip(1);
    for (i, row) in rows.enumerate() {
        for (bar, field) in bars.iter_mut().zip(row.split(',').skip(1)) {
            bar.0[i] = field.parse().expect("the table that is compiled in is valid");
        }
    }
    let y_integral = bars[1].0.iter().map(|&y| f64::from(y)).sum::<f64>() as f32;
    Observer { bars, y_integral }
});

/// The colour matching functions x̄, ȳ, z̄ at the wavelengths of a path.
#[inline]
pub fn xyz_bar(wavelengths: &Wavelengths) -> [SampledSpectrum; 3] {
    let [x, y, z] = &OBSERVER.bars;
    let entries = wavelengths.lambda.map(entry);
    [x, y, z].map(|bar| SampledSpectrum(entries.map(|i| bar.0[i])))
}

/// The integral of ȳ over the visible range, in nm: about 106.857.
pub fn y_integral() -> f32 {
    OBSERVER.y_integral
}

/// The integrals of `f` (of a wavelength in nm) times x̄, ȳ and z̄.
pub fn integrate_xyz(f: impl Fn(f32) -> f32) -> [f64; 3] {
    let mut xyz = [0.0; 3];
    for i in 0..ENTRIES {
        let value = f64::from(f(wavelength(i)));
        for (sum, bar) in xyz.iter_mut().zip(&OBSERVER.bars) {
            *sum += value * f64::from(bar.0[i]);
        }
    }
    xyz
}

/// The integral of `f` times ȳ.
pub fn integrate_y(f: impl Fn(f32) -> f32) -> f64 {
    let bars = OBSERVER.bars[1].0.iter().enumerate();
    bars.map(|(i, &y)| f64::from(f(wavelength(i))) * f64::from(y)).sum()
}

/// Linear sRGB of an XYZ; linear, so the scale of the input is that of the output. Components are negative for colours
/// outside the gamut.
pub fn xyz_to_srgb(xyz: [f64; 3]) -> [f64; 3] {
    ColorSpace::Srgb.xyz_to_rgb(xyz)
}

/// XYZ of linear sRGB: (1, 1, 1) gives the white of D65 with Y = 1.
pub fn srgb_to_xyz(rgb: [f64; 3]) -> [f64; 3] {
    ColorSpace::Srgb.rgb_to_xyz(rgb)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::{LANES, named};

    #[test]
    fn observer_is_the_published_one() {
        assert!((y_integral() - 106.856_895).abs() < 1e-4);
        let at_560 = Wavelengths {
            lambda: [560.4; LANES],
            pdf: [1.0; LANES],
        };
        let [x, y, z] = xyz_bar(&at_560);
        assert_eq!((x.0[0], y.0[1], z.0[2]), (0.5945, 0.995, 0.0039));
        // Beyond the ends nothing panics.
        let ends = Wavelengths {
            lambda: [0.0, 360.0, 830.0, 1e9],
            pdf: [1.0; LANES],
        };
        assert_eq!(xyz_bar(&ends)[1].0, [3.917e-6, 3.917e-6, 4.5181e-7, 4.5181e-7]);
    }

    #[test]
    fn matrices_are_those_of_srgb() {
        // IEC 61966-2-1 prints them to four digits, for a white rounded to x = 0.3127, y = 0.3290.
        let printed = [
            [3.2406, -1.5372, -0.4986],
            [-0.9689, 1.8758, 0.0415],
            [0.0557, -0.2040, 1.0570],
        ];
        let rows = ColorSpace::Srgb.rgb_from_xyz().transpose().to_cols_array_2d();
        for (row, expected) in rows.iter().zip(&printed) {
            for (a, b) in row.iter().zip(expected) {
                assert!((a - b).abs() < 2e-3, "{row:?} and {expected:?}");
            }
        }
        let rgb = [0.2, 0.5, 0.8];
        let back = xyz_to_srgb(srgb_to_xyz(rgb));
        assert!(rgb.iter().zip(back).all(|(a, b)| (a - b).abs() < 1e-12));
    }

    #[test]
    fn white_is_d65() {
        let white = integrate_xyz(|nm| named::d65().at(nm));
        let rgb = xyz_to_srgb(white.map(|c| c / white[1]));
        assert!(rgb.iter().all(|c| (c - 1.0).abs() < 1e-9), "{rgb:?}");
        let sum: f64 = white.iter().sum();
        assert!((white[0] / sum - 0.3127).abs() < 1e-4 && (white[1] / sum - 0.3290).abs() < 1e-4);
    }
}
