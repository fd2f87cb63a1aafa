//! Stratified points: one in each cell of a grid of columns and rows, and one in each of as many slices of either axis.
//!
//! Chiu, Shirley and Wang 1994 ("Multi-jittered sampling"): pbrt-v4's `stratified` for pairs of numbers and for single ones at
//! once. Each column and each row has a permutation of its own: one for all of them (Kensler 2013) would let errors add up.

use super::hash::{GOLDEN, mix32, mix64, split_mix, unit_f32};
use super::permutation::permute;

/// How a unit square is cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Strata {
    /// Cells along the first number of a pair, at least 1.
    pub columns: u32,
    /// Cells along the second, at least 1.
    pub rows: u32,
    /// Whether points are at random places of their cells; if not, they are in the middle of their slices, and what is estimated
    /// has a bias.
    pub jitter: bool,
}

impl Default for Strata {
    /// Four by four, jittered, as in pbrt-v4.
    fn default() -> Self {
        Self {
            columns: 4,
            rows: 4,
            jitter: true,
        }
    }
}

impl Strata {
    /// These strata if there are `samples` of them, else the `samples` (at least 1) strata that are nearest to squares.
    #[must_use]
    pub(super) fn for_samples(self, samples: u32) -> Self {
        if u64::from(self.columns) * u64::from(self.rows) == u64::from(samples) {
            return self;
        }
        let rows = (1..=samples.isqrt()).rev().find(|rows| samples.is_multiple_of(*rows));
        let rows = rows.unwrap_or(1);
        Self {
            columns: samples / rows,
            rows,
            ..self
        }
    }
}

/// The four numbers of `group` in each lane: two pairs, independent of each other.
#[inline(always)]
pub(super) fn draw<const N: usize>(keys: [u64; N], indices: [u32; N], strata: Strata, group: u32) -> [[f32; N]; 4] {
    let hashes = keys.map(|key| split_mix(key, u64::from(group)));
    let [x, y] = pair(indices, hashes, strata);
    let [z, w] = pair(indices, hashes.map(|hash| mix64(hash ^ GOLDEN)), strata);
    [x, y, z, w]
}

#[inline(always)]
fn pair<const N: usize>(indices: [u32; N], hashes: [u64; N], strata: Strata) -> [[f32; N]; 2] {
    let Strata { columns, rows, jitter } = strata;
    let count = columns * rows;
    let within = hashes.map(|hash| mix64(hash.wrapping_add(GOLDEN)));
    let cells = permute(indices, count, hashes.map(|hash| hash as u32));
    let per_row = 1.0 / f64::from(columns);
    // The half keeps products of exact quotients off the integer below.
    let row = cells.map(|cell| ((f64::from(cell.cast_signed()) + 0.5) * per_row) as i32 as u32);
    let column: [u32; N] = std::array::from_fn(|i| cells[i] - row[i] * columns);
    let seeds = |line: [u32; N], shift: u32| -> [u32; N] {
        std::array::from_fn(|i| mix32((within[i] >> shift) as u32 ^ line[i].wrapping_mul(0x9e37_79b9)))
    };
    let slice_in_column = permute(row, rows, seeds(column, 0));
    let slice_in_row = permute(column, columns, seeds(row, 32));
    let scale = 1.0 / f64::from(count);
    let mut points = [[0.0; N]; 2];
    for i in 0..N {
        let bits = split_mix(within[i], u64::from(indices[i]));
        let offsets = if jitter {
            [bits as u32, (bits >> 32) as u32].map(unit_f32)
        } else {
            [0.5; 2]
        };
        points[0][i] = unit(column[i] * rows + slice_in_column[i], offsets[0], scale);
        points[1][i] = unit(row[i] * columns + slice_in_row[i], offsets[1], scale);
    }
    points
}

/// The place `offset` in [0, 1) of slice `slice`, whose width is `scale`: rounded down, so that it stays below 1.
#[inline(always)]
fn unit(slice: u32, offset: f32, scale: f64) -> f32 {
    let place = (f64::from(slice.cast_signed()) + f64::from(offset)) * scale;
    (place * 16_777_216.0).min(16_777_215.0) as i32 as f32 * (1.0 / 16_777_216.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strata_are_as_square_as_can_be() {
        let of = |samples| {
            let strata = Strata::default().for_samples(samples);
            (strata.columns, strata.rows)
        };
        assert_eq!(
            [1, 7, 12, 16, 64, 1000].map(of),
            [(1, 1), (7, 1), (4, 3), (4, 4), (8, 8), (40, 25)]
        );
        let given = Strata {
            columns: 2,
            rows: 8,
            jitter: false,
        };
        assert_eq!(given.for_samples(16), given);
    }
}
