//! Reflectances of rgb colours by interpolation in tables (`table_builder.rs` says how they are laid out). That of sRGB was made by the
//! build script; those of wider spaces, coarser, are made when they are first needed, which takes some tenths of a second.

use std::sync::{LazyLock, OnceLock};

use super::rgb2spec::SigmoidPolynomial;
use super::{ColorSpace, SampledSpectrum, Wavelengths, table_builder};
use crate::math::Vec3;

/// `SIZE` nodes along each axis.
struct Table<const SIZE: usize> {
    coefficients: Vec<[f32; 3]>,
    /// Values of the largest component.
    nodes: [f32; SIZE],
}

static TABLE: LazyLock<Table<64>> = LazyLock::new(|| {
    let bytes = include_bytes!(concat!(env!("OUT_DIR"), "/rgb_table.bin"));
    let (words, _) = bytes.as_chunks::<4>();
    let (entries, _) = words.as_chunks::<3>();
    Table::new(entries.iter().map(|entry| entry.map(f32::from_le_bytes)).collect())
});

/// Nodes along each axis of the tables of wide spaces.
const WIDE: usize = 48;

fn wide(space: ColorSpace) -> &'static Table<WIDE> {
    static TABLES: [OnceLock<Table<WIDE>>; ColorSpace::ALL.len()] = [const { OnceLock::new() }; ColorSpace::ALL.len()];
    TABLES[space as usize].get_or_init(|| {
        let coefficients = table_builder::approximate::<WIDE>(space);
        let (entries, _) = coefficients.as_chunks::<3>();
        Table::new(entries.to_vec())
    })
}

/// Has the table of a space ready, so that no lookup pays for it.
pub(super) fn prepare(space: ColorSpace) {
    match space {
        ColorSpace::Srgb => {
            LazyLock::force(&TABLE);
        }
        _ => {
            wide(space);
        }
    }
}

/// The reflectance of a colour in linear sRGB, each component in [0, 1], at the wavelengths of a path. Greys are exact.
#[inline]
pub(super) fn reflectance(rgb: [f32; 3], lambda: &Wavelengths) -> SampledSpectrum {
    if rgb[0] == rgb[1] && rgb[1] == rgb[2] {
        return SampledSpectrum::splat(rgb[0]);
    }
    TABLE.polynomial(rgb).sample(lambda)
}

/// The polynomial of a colour's reflectance in any space but sRGB, each component in [0, 1], not all equal.
pub(super) fn wide_polynomial(space: ColorSpace, rgb: [f32; 3]) -> SigmoidPolynomial {
    wide(space).polynomial(rgb)
}

impl<const SIZE: usize> Table<SIZE> {
    fn new(coefficients: Vec<[f32; 3]>) -> Self {
        let smooth = |t: f32| t * t * (3.0 - 2.0 * t);
        Self {
            coefficients,
            nodes: std::array::from_fn(|i| smooth(smooth(i as f32 / (SIZE - 1) as f32))),
        }
    }

    fn polynomial(&self, rgb: [f32; 3]) -> SigmoidPolynomial {
        let [r, g, b] = rgb;
        let largest = if r > g {
            if r > b { 0 } else { 2 }
        } else if g > b {
            1
        } else {
            2
        };
        let brightest = rgb[largest];
        let along = |c: f32| {
            let position = (c / brightest * (SIZE - 1) as f32).clamp(0.0, (SIZE - 1) as f32);
            let cell = (position as usize).min(SIZE - 2);
            (cell, position - cell as f32)
        };
        let (x, dx) = along(rgb[(largest + 1) % 3]);
        let (y, dy) = along(rgb[(largest + 2) % 3]);
        let above = self.nodes.partition_point(|&node| node <= brightest);
        let z = above.clamp(1, SIZE - 1) - 1;
        let dz = (brightest - self.nodes[z]) / (self.nodes[z + 1] - self.nodes[z]);
        let corner = ((largest * SIZE + z) * SIZE + y) * SIZE + x;
        // All three coefficients of a corner at once: they are side by side.
        let at = |index: usize| Vec3::from(self.coefficients[index]);
        let lerp = |t: f32, a: Vec3, b: Vec3| a + (b - a) * t;
        let row = |first: usize| lerp(dx, at(first), at(first + 1));
        let face = |first: usize| lerp(dy, row(first), row(first + SIZE));
        SigmoidPolynomial::from_coefficients(lerp(dz, face(corner), face(corner + SIZE * SIZE)).to_array())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::{cie, named};

    /// The colour, under D65, of what the table gives for a colour.
    fn round_trip(rgb: [f32; 3]) -> [f64; 3] {
        let polynomial = TABLE.polynomial(rgb);
        let xyz = cie::integrate_xyz(|nm| polynomial.at(nm) * named::d65().at(nm));
        cie::xyz_to_srgb(xyz).map(|c| c / f64::from(cie::y_integral()))
    }

    #[test]
    fn colours_survive_the_round_trip() {
        let (mut worst, mut sum, mut count) = ((0.0, [0.0; 3]), 0.0, 0);
        for i in 0..1000 {
            // Between the nodes, and not only there; the edges and corners of the cube too.
            let rgb = [i / 100, i / 10 % 10, i % 10].map(|c| c as f32 / 9.0);
            if rgb[0] == rgb[1] && rgb[1] == rgb[2] {
                continue;
            }
            for (a, b) in round_trip(rgb).into_iter().zip(rgb) {
                let error = (a - f64::from(b)).abs();
                sum += error;
                count += 1;
                if error > worst.0 {
                    worst = (error, rgb);
                }
            }
        }
        // An 8-bit code is 4e-3 wide.
        assert!(worst.0 < 2e-3, "{worst:?}");
        assert!(sum / f64::from(count) < 4e-4, "{}", sum / f64::from(count));
    }

    #[test]
    fn the_table_agrees_with_the_solver() {
        for rgb in [[0.8, 0.1, 0.05], [0.2, 0.5, 0.3], [0.01, 0.02, 0.7], [0.9, 0.85, 0.2]] {
            let exact = super::super::rgb2spec::solve(crate::spectrum::ColorSpace::Srgb, rgb);
            let table = TABLE.polynomial(rgb);
            for nm in [400.0, 480.0, 550.0, 620.0, 700.0] {
                let (a, b) = (table.at(nm), exact.at(nm));
                assert!((a - b).abs() < 3e-3, "{rgb:?} at {nm}: {a} and {b}");
            }
        }
    }

    #[test]
    fn black_white_and_greys_are_exact() {
        let lambda = Wavelengths::sample_visible(0.4);
        for grey in [0.0, 0.3, 1.0] {
            assert_eq!(reflectance([grey; 3], &lambda), SampledSpectrum::splat(grey));
        }
        let dark = reflectance([1e-7, 0.0, 1e-8], &lambda);
        assert!(dark.max_value() < 1e-5 && dark.min_value() >= 0.0, "{dark:?}");
    }

    /// The colours of sRGB in the wider spaces.
    #[test]
    fn wide_spaces_have_tables() {
        for space in [ColorSpace::DciP3, ColorSpace::Rec2020, ColorSpace::Aces2065] {
            let light = space.illuminant();
            let white = cie::integrate_y(|nm| light.at(nm));
            let (mut worst, mut sum) = ((0.0, [0.0; 3]), 0.0);
            for i in 0..1000 {
                let srgb = [i / 100, i / 10 % 10, i % 10].map(|c| f64::from(c) / 9.0);
                let rgb = space
                    .xyz_to_rgb(cie::srgb_to_xyz(srgb))
                    .map(|c| c.clamp(0.0, 1.0) as f32);
                if rgb[0] == rgb[1] && rgb[1] == rgb[2] {
                    continue;
                }
                let polynomial = wide_polynomial(space, rgb);
                let xyz = cie::integrate_xyz(|nm| polynomial.at(nm) * light.at(nm));
                for (a, b) in space.xyz_to_rgb(xyz).into_iter().zip(rgb) {
                    let error = (a / white - f64::from(b)).abs();
                    sum += error;
                    if error > worst.0 {
                        worst = (error, rgb);
                    }
                }
            }
            // The worst are bright: what is a little brighter no reflectance has.
            assert!(
                worst.0 < 5e-2 && sum / 3000.0 < 1e-3,
                "{space:?}: {worst:?}, mean {}",
                sum / 3000.0
            );
        }
    }
}
