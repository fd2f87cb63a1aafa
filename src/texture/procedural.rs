//! Patterns that are functions of coordinates: checkerboards, dots, and what is made of noise.

use super::mapping::{Coordinates2, Coordinates3, TextureSpace};
use super::noise::{fbm, noise, turbulence};
use crate::math::{Vec2, Vec3};

/// How much there is of the second texture of a checkerboard of unit squares, in a triangle filter of 1.5 times the footprint; 0
/// around (1/2, 1/2).
pub(super) fn checkerboard2(c: &Coordinates2) -> f32 {
    let radius = 1.5 * c.dstdx.abs().max(c.dstdy.abs());
    0.5 - 0.5 * filtered_square_wave(c.st.x, radius.x) * filtered_square_wave(c.st.y, radius.y)
}

/// [`checkerboard2`] of unit cubes.
pub(super) fn checkerboard3(c: &Coordinates3) -> f32 {
    let radius = 1.5 * c.dpdx.abs().max(c.dpdy.abs());
    let waves = [0, 1, 2].map(|axis| filtered_square_wave(c.p[axis], radius[axis]));
    0.5 - 0.5 * waves[0] * waves[1] * waves[2]
}

/// The function that is 1 on [0, 1), -1 on [1, 2) and so on, convolved with a triangle of half width `radius`: the second
/// difference of its second integral.
fn filtered_square_wave(x: f32, radius: f32) -> f32 {
    if (x - radius).floor() == (x + radius).floor() {
        return if x.rem_euclid(2.0) < 1.0 { 1.0 } else { -1.0 };
    }
    // In double precision: the differences cancel.
    let (x, r) = (f64::from(x), f64::from(radius));
    ((second_integral(x + r) - 2.0 * second_integral(x) + second_integral(x - r)) / (r * r)) as f32
}

/// The periodic part of the second integral of the square wave; the linear part falls out of second differences.
fn second_integral(x: f64) -> f64 {
    let y = x.rem_euclid(2.0);
    // The integral of the triangle wave that rises from 0 to 1 and falls back, less its mean.
    if y < 1.0 {
        0.5 * y * y - 0.5 * y
    } else {
        0.5 * (y - 1.0) - 0.5 * (y - 1.0) * (y - 1.0)
    }
}

/// Whether a point is inside one of the dots of radius 0.35 that some of the unit cells have.
pub(super) fn is_in_dot(st: Vec2) -> bool {
    const RADIUS: f32 = 0.35;
    const MOST_SHIFT: f32 = 0.5 - RADIUS;
    let cell = (st + 0.5).floor();
    let chance = |offset: [f32; 2]| noise(Vec3::new(cell.x + offset[0], cell.y + offset[1], 0.5));
    if chance([0.5, 0.5]) <= 0.0 {
        return false;
    }
    let shift = Vec2::new(chance([1.5, 2.8]), chance([4.5, 9.8]));
    (st - cell - MOST_SHIFT * shift).length_squared() < RADIUS * RADIUS
}

/// Numbers made of noise, over texture space.
#[derive(Clone, Copy, Debug)]
pub struct NoiseTexture {
    /// The space.
    pub space: TextureSpace,
    /// How the noise is summed.
    pub kind: NoiseKind,
}

/// How noise is summed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoiseKind {
    /// Octaves of noise, each `roughness` times the one before.
    Fbm {
        /// At most so many.
        octaves: u32,
        /// The factor.
        roughness: f32,
    },
    /// The same of the noise's magnitude.
    Wrinkled {
        /// At most so many.
        octaves: u32,
        /// The factor.
        roughness: f32,
    },
    /// Waves, where there is wind.
    Windy,
}

impl NoiseTexture {
    pub(super) fn evaluate(&self, context: &super::TextureContext) -> f32 {
        let c = self.space.map(context);
        match self.kind {
            NoiseKind::Fbm { octaves, roughness } => fbm(&c, roughness, octaves),
            NoiseKind::Wrinkled { octaves, roughness } => turbulence(&c, roughness, octaves),
            NoiseKind::Windy => fbm(&scaled(&c, 0.1), 0.5, 3).abs() * fbm(&c, 0.5, 6),
        }
    }
}

/// Layers of stone, over texture space.
#[derive(Clone, Copy, Debug)]
pub struct Marble {
    /// The space.
    pub space: TextureSpace,
    /// Octaves of the noise that bends the layers.
    pub octaves: u32,
    /// Factor from octave to octave.
    pub roughness: f32,
    /// Factor of the coordinates.
    pub scale: f32,
    /// How far the noise bends the layers.
    pub variation: f32,
}

/// The control points of the colours along a layer, as in pbrt-v4.
const MARBLE: [[f32; 3]; 9] = [
    [0.58, 0.58, 0.6],
    [0.58, 0.58, 0.6],
    [0.58, 0.58, 0.6],
    [0.5, 0.5, 0.5],
    [0.6, 0.59, 0.58],
    [0.58, 0.58, 0.6],
    [0.58, 0.58, 0.6],
    [0.2, 0.2, 0.33],
    [0.58, 0.58, 0.6],
];

impl Marble {
    /// The albedo in linear sRGB.
    pub(super) fn evaluate(&self, context: &super::TextureContext) -> [f32; 3] {
        let c = scaled(&self.space.map(context), self.scale);
        let layer = c.p.y + self.variation * fbm(&c, self.roughness, self.octaves);
        let segments = MARBLE.len() - 3;
        let along = (0.5 + 0.5 * layer.sin()) * segments as f32;
        let first = (along as usize).min(segments - 1);
        (cubic_bezier(&MARBLE[first..first + 4], along - first as f32) * 1.5).into()
    }
}

fn cubic_bezier(points: &[[f32; 3]], t: f32) -> Vec3 {
    let s = 1.0 - t;
    let weights = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
    points
        .iter()
        .zip(weights)
        .map(|(&p, weight)| Vec3::from(p) * weight)
        .sum()
}

fn scaled(c: &Coordinates3, factor: f32) -> Coordinates3 {
    Coordinates3 {
        p: c.p * factor,
        dpdx: c.dpdx * factor,
        dpdy: c.dpdy * factor,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unfiltered_squares_alternate() {
        let at = |s: f32, t: f32| {
            checkerboard2(&Coordinates2 {
                st: Vec2::new(s, t),
                dstdx: Vec2::ZERO,
                dstdy: Vec2::ZERO,
            })
        };
        assert_eq!(
            [at(0.5, 0.5), at(1.5, 0.5), at(1.5, 1.5), at(-0.5, 0.5)],
            [0.0, 1.0, 0.0, 1.0]
        );
        let cube = |p| {
            checkerboard3(&Coordinates3 {
                p,
                dpdx: Vec3::ZERO,
                dpdy: Vec3::ZERO,
            })
        };
        assert_eq!(cube(Vec3::new(0.5, 0.5, 0.5)), 0.0);
        assert_eq!(cube(Vec3::new(0.5, -0.5, 1.5)), 0.0);
        assert_eq!(cube(Vec3::new(0.5, 0.5, 1.5)), 1.0);
    }

    #[test]
    fn filtered_squares_are_the_filter_s_mean() {
        // Against a sum over the triangle filter.
        for (x, r) in [(0.3, 0.5), (0.9, 0.2), (1.05, 1.7), (-0.4, 3.3), (7.6, 0.11)] {
            let n = 20_000;
            let (mut sum, mut weights) = (0.0, 0.0);
            for i in 0..n {
                let offset = (f64::from(i) + 0.5) / f64::from(n) * 2.0 - 1.0;
                let weight = 1.0 - offset.abs();
                let at = f64::from(x) + offset * f64::from(r);
                sum += weight * if at.rem_euclid(2.0) < 1.0 { 1.0 } else { -1.0 };
                weights += weight;
            }
            let expected = sum / weights;
            let found = f64::from(filtered_square_wave(x, r));
            assert!((found - expected).abs() < 1e-3, "{x} {r}: {found} and {expected}");
        }
    }

    #[test]
    fn the_mean_of_a_checkerboard_is_a_half_however_wide_the_filter() {
        for width in [0.0, 0.2, 0.7, 1.9, 30.0] {
            let n = 64;
            let mut mean = 0.0;
            for i in 0..n * n {
                let st = Vec2::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) * (2.0 / n as f32);
                mean += checkerboard2(&Coordinates2 {
                    st,
                    dstdx: Vec2::splat(width),
                    dstdy: Vec2::ZERO,
                }) / (n * n) as f32;
            }
            assert!((mean - 0.5).abs() < 1e-4, "{width}: {mean}");
        }
        let wide = Coordinates2 {
            st: Vec2::new(0.5, 0.5),
            dstdx: Vec2::splat(100.0),
            dstdy: Vec2::ZERO,
        };
        assert!((checkerboard2(&wide) - 0.5).abs() < 1e-3);
    }

    #[test]
    fn dots_lie_in_their_cells_and_about_half_of_the_cells_have_one() {
        let (mut with, cells) = (0, 400);
        for i in 0..cells {
            let cell = Vec2::new((i % 20) as f32, (i / 20) as f32);
            // The middle of a cell is inside any dot: it is shifted by less than its radius.
            let has = is_in_dot(cell);
            with += usize::from(has);
            for corner in [Vec2::new(0.5, 0.5), Vec2::new(-0.5, 0.5)] {
                assert!(!is_in_dot(cell + corner * 0.999), "a dot reaches a corner of its cell");
            }
        }
        assert!((cells / 3..cells * 2 / 3).contains(&with), "{with}");
    }

    #[test]
    fn marble_is_a_reflectance() {
        let marble = Marble {
            space: TextureSpace::new(&crate::math::DAffine3::IDENTITY),
            octaves: 8,
            roughness: 0.5,
            scale: 1.0,
            variation: 0.2,
        };
        let at = |y: f32| {
            marble.evaluate(&super::super::TextureContext {
                p: Vec3::new(0.0, y, 0.0),
                dpdx: Vec3::ZERO,
                dpdy: Vec3::ZERO,
                n: Vec3::Z,
                uv: Vec2::ZERO,
                duvdx: Vec2::ZERO,
                duvdy: Vec2::ZERO,
                place: None,
            })
        };
        for i in 0..1000 {
            assert!(
                at(i as f32 * 0.013)
                    .iter()
                    .all(|c| (0.3 - 1e-6..=0.9 + 1e-6).contains(c))
            );
        }
        // At the origin noise is 0: the middle of the curve, with the parameter 0 of segment 3: its first control point.
        let expected = [0.5 * 1.5; 3];
        assert!(at(0.0).iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6));
    }
}
