//! Cells of a grid, drawn in proportion to their weights by inversion, which keeps neighbouring numbers together.

use glam::Vec2;

use super::BELOW_ONE;

/// A distribution over the cells of a grid: a row by the sum of its weights, then a column.
#[derive(Clone, Debug)]
pub struct CellDistribution {
    width: usize,
    /// Probability of the rows before each, and 1.
    rows: Vec<f32>,
    /// The same of the columns of each row, row by row; width + 1 entries each.
    columns: Vec<f32>,
}

/// A cell, and a point of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// Its column.
    pub x: usize,
    /// Its row.
    pub y: usize,
    /// Where in it, each coordinate in [0, 1).
    pub offset: Vec2,
}

impl CellDistribution {
    /// For `weights` row by row, `width` a row. `None` if there is no whole row, a weight is negative or not finite, or all are 0.
    pub fn new(weights: &[f32], width: usize) -> Option<Self> {
        let valid = width > 0 && weights.len().is_multiple_of(width) && weights.iter().all(|w| *w >= 0.0);
        if !valid {
            return None;
        }
        let mut columns = Vec::with_capacity(weights.len() + weights.len() / width);
        let sums: Vec<f64> = weights
            .chunks_exact(width)
            .map(|row| append_cdf(&mut columns, row.iter().map(|&w| f64::from(w))))
            .collect();
        let mut rows = Vec::with_capacity(sums.len() + 1);
        let sum = append_cdf(&mut rows, sums.iter().copied());
        (sum > 0.0 && sum.is_finite()).then_some(Self { width, rows, columns })
    }

    fn columns_of(&self, y: usize) -> &[f32] {
        &self.columns[y * (self.width + 1)..][..=self.width]
    }

    /// The cell that `u` in [0, 1)² draws, never one of weight 0, and its probability.
    #[inline]
    pub fn sample(&self, u: Vec2) -> (Cell, f32) {
        let (y, offset_y, p_row) = invert_cdf(&self.rows, u.y);
        let (x, offset_x, p_column) = invert_cdf(self.columns_of(y), u.x);
        let offset = Vec2::new(offset_x, offset_y);
        (Cell { x, y, offset }, p_row * p_column)
    }

    /// The probability of the cell in column `x` and row `y`.
    #[inline]
    pub fn probability(&self, x: usize, y: usize) -> f32 {
        let columns = self.columns_of(y);
        (self.rows[y + 1] - self.rows[y]) * (columns[x + 1] - columns[x])
    }

    /// The numbers that [`Self::sample`] maps to a point of a cell.
    pub fn invert(&self, cell: &Cell) -> Vec2 {
        let columns = self.columns_of(cell.y);
        let at = |cdf: &[f32], i: usize, offset: f32| (cdf[i] + offset * (cdf[i + 1] - cdf[i])).min(BELOW_ONE);
        Vec2::new(
            at(columns, cell.x, cell.offset.x),
            at(&self.rows, cell.y, cell.offset.y),
        )
    }
}

/// Appends the cumulative distribution of weights; their sum. Without any weight all are alike.
fn append_cdf(to: &mut Vec<f32>, weights: impl Iterator<Item = f64> + Clone) -> f64 {
    let sum: f64 = weights.clone().sum();
    let mut below = 0.0;
    to.push(0.0);
    let last = to.len() - 1 + weights.clone().count();
    for (i, weight) in weights.enumerate() {
        below += if sum > 0.0 { weight } else { 1.0 };
        to.push(if sum > 0.0 { below / sum } else { below / (i + 1) as f64 } as f32);
    }
    to[last] = 1.0;
    sum
}

/// The interval of a cumulative distribution that `u` is in, where in it, and its probability.
#[inline]
fn invert_cdf(cdf: &[f32], u: f32) -> (usize, f32, f32) {
    // The last interval that begins at or below u is not empty, as the next begins above it.
    let index = (cdf.partition_point(|&c| c <= u) - 1).min(cdf.len() - 2);
    let probability = cdf[index + 1] - cdf[index];
    let offset = ((u - cdf[index]) / probability).min(BELOW_ONE);
    (index, offset, probability)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_drawn_by_weight_and_inverted() {
        let weights = [0.0, 2.0, 1.0, 0.0, 0.0, 0.0, 4.0, 0.0, 1.0, 0.5, 0.0, 0.0];
        let distribution = CellDistribution::new(&weights, 3).expect("valid weights");
        const N: usize = 512;
        let mut counts = [0_u32; 12];
        for i in 0..N * N {
            let u = Vec2::new((i % N) as f32 + 0.5, (i / N) as f32 + 0.5) / N as f32;
            let (cell, probability) = distribution.sample(u);
            counts[cell.y * 3 + cell.x] += 1;
            assert!((probability - distribution.probability(cell.x, cell.y)).abs() < 1e-7);
            assert!(cell.offset.min_element() >= 0.0 && cell.offset.max_element() < 1.0);
            assert!((distribution.invert(&cell) - u).abs().max_element() < 1e-6);
        }
        for (i, weight) in weights.into_iter().enumerate() {
            let expected = f64::from(weight) / 8.5;
            let found = f64::from(counts[i]) / (N * N) as f64;
            // A grid of numbers measures each side of a cell's rectangle within one step.
            assert!((found - expected).abs() < 2.0 / N as f64, "{i}: {found} and {expected}");
            assert!(weight > 0.0 || counts[i] == 0);
            assert!((f64::from(distribution.probability(i % 3, i / 3)) - expected).abs() < 1e-7);
        }
    }

    #[test]
    fn what_cannot_be_drawn_from_is_refused() {
        for bad in [
            &[][..],
            &[0.0; 4],
            &[1.0, -1.0],
            &[f32::NAN, 1.0],
            &[f32::INFINITY, 1.0],
            &[1.0; 3],
        ] {
            assert!(CellDistribution::new(bad, 2).is_none(), "{bad:?}");
        }
        assert!(CellDistribution::new(&[1.0], 0).is_none());
    }
}
