//! What a film keeps of the surfaces that its pixels see first, as pbrt-v4's `gbuffer`, and how much their samples vary.
//!
//! Sums are exact, as those of colours: what is known to be bounded is added in 64 bits, in steps that fit its range. Each value is
//! less than 2^38 steps, and 2^24 samples of a pixel fit a sum.

use super::sums::quantize;
use crate::math::{Vec2, Vec3};

/// The channels of a G-buffer, in the order of [`super::Film::develop_layers`]: the albedo of surfaces in the colours of the picture under
/// its white (0 where there is none), position, change of the z of positions by pixel, geometric and shading normals on the side of
/// the camera, texture coordinates, and of the samples' colours the variance and that over the mean.
pub const GBUFFER_CHANNELS: [&str; 22] = [
    "Albedo.R",
    "Albedo.G",
    "Albedo.B",
    "P.X",
    "P.Y",
    "P.Z",
    "dzdx",
    "dzdy",
    "N.X",
    "N.Y",
    "N.Z",
    "Ns.X",
    "Ns.Y",
    "Ns.Z",
    "u",
    "v",
    "Variance.R",
    "Variance.G",
    "Variance.B",
    "RelativeVariance.R",
    "RelativeVariance.G",
    "RelativeVariance.B",
];

/// A surface that a camera sample sees first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceSample {
    /// The share of light that it scatters, in the picture's colours under its white.
    pub albedo: [f32; 3],
    /// Where it is.
    pub p: Vec3,
    /// Change of the position's z by a pixel to the right, and by one down, on the tangent plane.
    pub dz: Vec2,
    /// Geometric normal, unit length, on the side of the camera.
    pub n: Vec3,
    /// Shading normal, likewise.
    pub ns: Vec3,
    /// Texture coordinates.
    pub uv: Vec2,
}

/// Sums of one pixel.
#[derive(Clone, Copy, Debug, Default)]
struct PixelSurfaces {
    /// Filter weights of the samples that see a surface.
    weight: i64,
    /// The first 16 channels, weighted.
    values: [i64; VALUES],
    /// Samples, and sums of their colours in steps of 2^-64.
    count: u64,
    sums: [i128; 3],
    /// Sums of the squares of colours, in steps of 2^-48.
    squares: [i128; 3],
}

/// The channels that are means over surfaces.
const VALUES: usize = 16;
/// The first of them, which are means over all samples.
const ALBEDO: usize = 3;

/// The surfaces seen by the pixels of a tile.
#[derive(Clone, Debug)]
pub(super) struct GBuffer {
    pixels: Vec<PixelSurfaces>,
    /// Steps of a unit, by channel.
    scales: [f64; VALUES],
    /// Samples that were out of range.
    pub dropped: u64,
}

/// Where a value in steps begins not to fit.
const MOST_STEPS: f64 = (1_u64 << 38) as f64;
/// Weights, normals and albedos are below 4 in magnitude.
const UNIT_SCALE: f64 = MOST_STEPS / 4.0;
/// Texture coordinates are below 2^14.
const UV_SCALE: f64 = MOST_STEPS / 16384.0;
const SQUARE_SCALE: f64 = (1_u64 << 48) as f64;

impl GBuffer {
    /// For `pixels` pixels of a scene where no coordinate of a position is more than `reach`.
    pub fn new(pixels: usize, reach: f64) -> Self {
        // A power of two, so that steps are numbers without rounding; filters weigh by less than 4.
        let exponent = (4.0 * reach.clamp(1e-30, 1e30)).log2().ceil();
        let position = MOST_STEPS / exponent.exp2();
        let mut scales = [UNIT_SCALE; VALUES];
        scales[3..8].fill(position);
        scales[14..16].fill(UV_SCALE);
        Self {
            pixels: vec![PixelSurfaces::default(); pixels],
            scales,
            dropped: 0,
        }
    }

    /// Adds a sample of pixel `index`: its filter weight, its colour, and the surface that it sees.
    pub fn add(&mut self, index: usize, weight: f32, rgb: Option<[f32; 3]>, surface: Option<&SurfaceSample>) {
        let pixel = &mut self.pixels[index];
        pixel.count += 1;
        if let Some(rgb) = rgb {
            for (channel, value) in rgb.into_iter().enumerate() {
                let value = f64::from(value);
                if let (Some(sum), true) = (quantize(value), value.abs() < 1e9) {
                    pixel.sums[channel] += sum;
                    pixel.squares[channel] += (value * value * SQUARE_SCALE) as i128;
                }
            }
        }
        let Some(surface) = surface else { return };
        let weight = f64::from(weight);
        let largest_dz = (MOST_STEPS / self.scales[6] / 4.0) as f32;
        let dz = surface.dz.clamp(Vec2::splat(-largest_dz), Vec2::splat(largest_dz));
        let [r, g, b] = surface.albedo;
        let (p, n, ns, uv) = (surface.p, surface.n, surface.ns, surface.uv);
        let values = [
            r, g, b, p.x, p.y, p.z, dz.x, dz.y, n.x, n.y, n.z, ns.x, ns.y, ns.z, uv.x, uv.y,
        ];
        let mut steps = [0; VALUES];
        let mut fits = weight.abs() < 4.0;
        for ((steps, value), scale) in steps.iter_mut().zip(values).zip(self.scales) {
            let scaled = f64::from(value) * weight * scale;
            fits &= scaled.abs() < MOST_STEPS;
            *steps = scaled as i64;
        }
        if fits {
            pixel.weight += (weight * UNIT_SCALE) as i64;
            for (sum, steps) in pixel.values.iter_mut().zip(steps) {
                *sum += steps;
            }
        } else {
            self.dropped += 1;
        }
    }

    /// The channels of a pixel whose samples have this weight in all.
    pub fn develop(&self, index: usize, total_weight: f64, out: &mut [f32]) {
        let pixel = &self.pixels[index];
        let surface_weight = pixel.weight as f64 / UNIT_SCALE;
        for (i, out) in out[..VALUES].iter_mut().enumerate() {
            let weight = if i < ALBEDO { total_weight } else { surface_weight };
            let sum = pixel.values[i] as f64 / self.scales[i];
            *out = if weight == 0.0 { 0.0 } else { (sum / weight) as f32 };
        }
        // As in pbrt-v4 changes are magnitudes, and means of normals have unit length.
        out[6] = out[6].abs();
        out[7] = out[7].abs();
        for first in [8, 11] {
            let mean = Vec3::from_slice(&out[first..first + 3]).normalize_or_zero();
            mean.write_to_slice(&mut out[first..first + 3]);
        }
        let n = pixel.count as f64;
        for channel in 0..3 {
            let mean = pixel.sums[channel] as f64 / 18_446_744_073_709_551_616.0 / n.max(1.0);
            let square = pixel.squares[channel] as f64 / SQUARE_SCALE / n.max(1.0);
            let variance = if n > 1.0 {
                (square - mean * mean).max(0.0) * n / (n - 1.0)
            } else {
                0.0
            };
            out[VALUES + channel] = variance as f32;
            out[VALUES + 3 + channel] = if mean == 0.0 { 0.0 } else { (variance / mean) as f32 };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn surface(x: f32) -> SurfaceSample {
        SurfaceSample {
            albedo: [0.5, 0.25, 1.0],
            p: Vec3::new(x, 2.0, -3.0),
            dz: Vec2::new(-0.5, 1e9),
            n: Vec3::Z,
            ns: Vec3::new(0.0, 0.6, 0.8),
            uv: Vec2::new(0.25, 100.0),
        }
    }

    #[test]
    fn means_are_over_those_that_see_a_surface() {
        let mut buffer = GBuffer::new(1, 10.0);
        let mut out = [0.0; 22];
        for (x, rgb) in [(1.0, 1.0), (3.0, 2.0)] {
            buffer.add(0, 1.0, Some([rgb; 3]), Some(&surface(x)));
        }
        buffer.add(0, 2.0, Some([0.0; 3]), None);
        buffer.develop(0, 4.0, &mut out);
        // Half of the weight sees nothing.
        assert_eq!(out[..3], [0.25, 0.125, 0.5]);
        assert_eq!(out[3..7], [2.0, 2.0, -3.0, 0.5]);
        assert!(out[7] > 10.0 && out[7] < 100.0, "{}", out[7]);
        assert_eq!(out[8..11], [0.0, 0.0, 1.0]);
        assert!((out[12] - 0.6).abs() < 1e-6 && (out[13] - 0.8).abs() < 1e-6);
        assert_eq!(out[14..16], [0.25, 100.0]);
        // Of 1, 2 and 0: mean 1, variance 1.
        assert_eq!(out[16..], [1.0; 6]);
        assert_eq!(buffer.dropped, 0);
    }

    #[test]
    fn what_is_out_of_range_is_counted_and_changes_nothing() {
        let mut buffer = GBuffer::new(1, 10.0);
        buffer.add(0, 1.0, None, Some(&surface(1e6)));
        buffer.add(0, 1.0, None, Some(&surface(f32::NAN)));
        let mut out = [1.0; 22];
        buffer.develop(0, 2.0, &mut out);
        assert_eq!(buffer.dropped, 2);
        assert!(out.iter().all(|&v| v == 0.0), "{out:?}");
    }

    #[test]
    fn the_order_does_not_matter() {
        let samples: Vec<_> = (0..1000)
            .map(|i| (0.1 + i as f32 * 1e-3, surface((i as f32).sin() * 9.0)))
            .collect();
        let develop = |samples: &mut dyn Iterator<Item = &(f32, SurfaceSample)>| {
            let mut buffer = GBuffer::new(1, 10.0);
            for (weight, surface) in samples {
                buffer.add(0, *weight, Some([surface.p.x; 3]), Some(surface));
            }
            let mut out = [0.0; 22];
            buffer.develop(0, 1.0, &mut out);
            out
        };
        assert_eq!(develop(&mut samples.iter()), develop(&mut samples.iter().rev()));
    }
}
