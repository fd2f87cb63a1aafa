//! Radiance by wavelength, as pbrt-v4's `spectral` film.

use super::sums::{dequantize, quantize};
use crate::desc::SpectralBins;
use crate::spectrum::{SampledSpectrum, Wavelengths, cie};

/// Sums of radiance by part of the spectrum, for the pixels of a tile: exact, in steps of 2^-64.
///
/// What is in a bin is the mean of radiance over its wavelengths, the samples being weighted by the pixel filter and by one over the density of
/// their wavelengths. It is multiplied by the integral of ȳ as in pbrt-v4, so that light of a constant spectrum and the luminance 1 is 1.
#[derive(Clone, Debug)]
pub(super) struct Bins {
    bins: SpectralBins,
    /// By pixel, then bin.
    sums: Vec<BinSums>,
}

#[derive(Clone, Copy, Debug, Default)]
struct BinSums {
    value: i128,
    weight: i128,
}

impl Bins {
    pub fn new(pixels: usize, bins: SpectralBins) -> Self {
        Self {
            bins,
            sums: vec![BinSums::default(); pixels * bins.count as usize],
        }
    }

    /// Adds a sample of pixel `index`, of the filter weight `weight`: its radiance, not divided by the density of the wavelengths. What is
    /// out of range is left out.
    pub fn add(&mut self, index: usize, weight: f32, l: SampledSpectrum, lambda: &Wavelengths) {
        let first = index * self.bins.count as usize;
        for ((&l, &nm), &pdf) in l.0.iter().zip(&lambda.lambda).zip(&lambda.pdf) {
            let Some(bin) = self.bins.index(nm).filter(|_| pdf > 0.0) else {
                continue;
            };
            let weight = f64::from(weight) / f64::from(pdf);
            if let (Some(weight), Some(value)) = (quantize(weight), quantize(weight * f64::from(l))) {
                let sums = &mut self.sums[first + bin];
                sums.value += value;
                sums.weight += weight;
            }
        }
    }

    /// The bins of a pixel; 0 where no wavelength was sampled.
    pub fn develop(&self, index: usize, out: &mut [f32]) {
        let count = self.bins.count as usize;
        for (out, sums) in out.iter_mut().zip(&self.sums[index * count..(index + 1) * count]) {
            let mean = if sums.weight == 0 {
                0.0
            } else {
                dequantize(sums.value) / dequantize(sums.weight)
            };
            *out = (mean * f64::from(cie::y_integral())) as f32;
        }
    }
}

/// The names of the channels of bins: by their middle, as the layout of Fichet, Pacanowski and Wilkie (2021) has it.
pub fn spectral_channels(bins: &SpectralBins) -> Vec<String> {
    (0..bins.count)
        .map(|i| format!("S0.{}nm", format!("{:.3}", bins.center(i)).replace('.', ",")))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const BINS: SpectralBins = SpectralBins {
        range: [400.0, 700.0],
        count: 3,
    };

    #[test]
    fn channels_are_named_by_their_middle() {
        assert_eq!(
            spectral_channels(&BINS),
            ["S0.450,000nm", "S0.550,000nm", "S0.650,000nm"]
        );
        assert_eq!(
            (BINS.index(400.0), BINS.index(500.0), BINS.index(700.0)),
            (Some(0), Some(1), Some(2))
        );
        assert_eq!((BINS.index(399.9), BINS.index(700.1)), (None, None));
    }

    #[test]
    fn a_bin_has_the_mean_radiance_of_its_wavelengths() {
        let mut bins = Bins::new(2, BINS);
        let n = 20_000;
        for i in 0..n {
            let mut lambda = Wavelengths::sample_visible((i as f32 + 0.5) / n as f32);
            // Of some paths only the hero is left.
            if i % 3 == 0 {
                lambda.terminate_secondary();
            }
            let l = SampledSpectrum(lambda.lambda.map(|nm| nm / 500.0));
            bins.add(1, 0.5 + (i % 2) as f32, l, &lambda);
        }
        let mut out = [0.0; 3];
        bins.develop(1, &mut out);
        for (i, value) in out.iter().enumerate() {
            let expected = BINS.center(i as u32) / 500.0 * f64::from(cie::y_integral());
            assert!(
                (f64::from(*value) / expected - 1.0).abs() < 2e-3,
                "{i}: {value} and {expected}"
            );
        }
        bins.develop(0, &mut out);
        assert_eq!(out, [0.0; 3]);
    }
}
