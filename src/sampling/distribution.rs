//! Distributions given by tables.

use super::BELOW_ONE;

/// Draws an index in proportion to given weights, in constant time (Walker 1974, Vose 1991).
#[derive(Clone, Debug)]
pub struct AliasTable {
    bins: Vec<Bin>,
}

#[derive(Clone, Copy, Debug)]
struct Bin {
    /// The probability of this index.
    pmf: f32,
    /// The share of the bin that this index keeps; the rest belongs to `alias`.
    keep: f32,
    alias: u32,
}

impl AliasTable {
    /// A table for `weights`. `None` if there is none, more than 2^32 of them, one is negative or not finite, or all are
    /// zero.
    pub fn new(weights: &[f32]) -> Option<Self> {
        let sum: f64 = weights.iter().map(|&w| f64::from(w)).sum();
        let valid = weights.iter().all(|&w| w >= 0.0) && sum > 0.0 && sum.is_finite();
        if !valid || u32::try_from(weights.len()).is_err() {
            return None;
        }
        let mut bins: Vec<Bin> = weights
            .iter()
            .enumerate()
            .map(|(i, &w)| Bin {
                pmf: (f64::from(w) / sum) as f32,
                keep: 1.0,
                alias: i as u32,
            })
            .collect();
        // The height of an index's column where the mean is 1: what short bins lack is taken from tall ones.
        let mut heights: Vec<f64> = weights
            .iter()
            .map(|&w| f64::from(w) / sum * weights.len() as f64)
            .collect();
        let (mut short, mut tall): (Vec<usize>, Vec<usize>) = (0..weights.len()).partition(|&i| heights[i] < 1.0);
        while let (Some(low), Some(&high)) = (short.pop(), tall.last()) {
            bins[low].keep = heights[low] as f32;
            bins[low].alias = high as u32;
            heights[high] -= 1.0 - heights[low];
            if heights[high] < 1.0 {
                tall.pop();
                short.push(high);
            }
        }
        // Whatever is left differs from 1 by rounding alone, unless it weighs nothing, which must never be drawn.
        for i in short {
            if weights[i] == 0.0 {
                bins[i].keep = 0.0;
                bins[i].alias = bins.iter().position(|b| b.pmf > 0.0)? as u32;
            }
        }
        Some(Self { bins })
    }

    /// How many indices there are, at least 1.
    #[expect(clippy::len_without_is_empty, reason = "a table is never empty")]
    pub fn len(&self) -> usize {
        self.bins.len()
    }

    /// The probability of `index`.
    #[inline]
    pub fn pmf(&self, index: usize) -> f32 {
        self.bins[index].pmf
    }

    /// The index that `u` in [0, 1) draws, its probability, and a number in [0, 1) that is uniform again and independent of
    /// the index; it has log2(len) bits less than `u` had.
    #[inline]
    pub fn sample(&self, u: f32) -> (usize, f32, f32) {
        let scaled = u * self.bins.len() as f32;
        let index = (scaled as usize).min(self.bins.len() - 1);
        let bin = self.bins[index];
        let rest = scaled - index as f32;
        let (index, remapped) = if rest < bin.keep {
            (index, rest / bin.keep)
        } else {
            (bin.alias as usize, (rest - bin.keep) / (1.0 - bin.keep))
        };
        (index, self.bins[index].pmf, remapped.clamp(0.0, BELOW_ONE))
    }
}

/// A density proportional to the absolute value of a step function over an interval. The sign is kept: an estimate with
/// signed weights, as for a pixel filter with negative lobes, is `value(cell) / pdf`.
#[derive(Clone, Debug)]
pub struct PiecewiseConstant1D {
    values: Vec<f32>,
    /// `cdf[i]` is the probability of the cells before `i`; one more entry than there are cells.
    cdf: Vec<f32>,
    /// `guide[i]` is how many entries of `cdf` are at most i over their number: where the search begins (Chen and Asau 1974).
    guide: Vec<u32>,
    min: f32,
    max: f32,
    integral: f32,
    signed_integral: f32,
}

impl PiecewiseConstant1D {
    /// The function whose value on the i-th of equal cells of [`min`, `max`] is `values[i]`. `None` if the interval is
    /// empty, there is no cell, a value is not finite, or all are zero.
    pub fn new(values: &[f32], min: f32, max: f32) -> Option<Self> {
        let cell = (f64::from(max) - f64::from(min)) / values.len() as f64;
        let sum: f64 = values.iter().map(|&v| f64::from(v.abs())).sum();
        if !(cell > 0.0 && cell.is_finite() && sum > 0.0 && sum.is_finite()) {
            return None;
        }
        let signed: f64 = values.iter().map(|&v| f64::from(v)).sum();
        let mut cdf = Vec::with_capacity(values.len() + 1);
        let mut below = 0.0;
        cdf.push(0.0);
        for &v in values {
            below += f64::from(v.abs());
            cdf.push((below / sum) as f32);
        }
        let count = values.len() as f32;
        let guide = (0..values.len()).map(|i| cdf.partition_point(|&c| c <= i as f32 / count) as u32);
        Some(Self {
            values: values.to_vec(),
            guide: guide.collect(),
            cdf,
            min,
            max,
            integral: (sum * cell) as f32,
            signed_integral: (signed * cell) as f32,
        })
    }

    /// The integral of the function's absolute value over the interval.
    pub fn integral(&self) -> f32 {
        self.integral
    }

    /// The integral of the function itself.
    pub fn signed_integral(&self) -> f32 {
        self.signed_integral
    }

    /// The number of cells, at least 1.
    pub fn cell_count(&self) -> usize {
        self.values.len()
    }

    /// The function's signed value on a cell.
    #[inline]
    pub fn value(&self, cell: usize) -> f32 {
        self.values[cell]
    }

    /// The point that `u` in [0, 1) draws, its density, and its cell. A cell of value zero is never drawn.
    #[inline]
    pub fn sample(&self, u: f32) -> (f32, f32, usize) {
        // The last cell that begins at or below u has a positive width in the cdf, unless u is beyond all of them.
        let begins = self.begins(u);
        let mut cell = begins.saturating_sub(1).min(self.values.len() - 1);
        while self.values[cell] == 0.0 && cell > 0 {
            cell -= 1;
        }
        let (low, high) = (self.cdf[cell], self.cdf[cell + 1]);
        let within = if high > low {
            ((u - low) / (high - low)).min(1.0)
        } else {
            0.5
        };
        let x = self.min + (cell as f32 + within) * self.cell_width();
        (x.min(self.max), self.values[cell].abs() / self.integral, cell)
    }

    /// How many cells, and the end, begin at or below `u`.
    #[inline]
    fn begins(&self, u: f32) -> usize {
        let place = ((u * self.guide.len() as f32) as usize).min(self.guide.len() - 1);
        let mut begins = self.guide[place] as usize;
        // The product may have been rounded up.
        while begins > 0 && self.cdf[begins - 1] > u {
            begins -= 1;
        }
        while begins < self.cdf.len() && self.cdf[begins] <= u {
            begins += 1;
        }
        begins
    }

    /// The density at `x`; 0 outside the interval.
    pub fn pdf(&self, x: f32) -> f32 {
        self.cell(x).map_or(0.0, |cell| self.values[cell].abs() / self.integral)
    }

    /// The number that [`Self::sample`] maps to `x`: the cumulative distribution there. `None` outside the interval.
    pub fn invert(&self, x: f32) -> Option<f32> {
        let cell = self.cell(x)?;
        let within = ((x - self.min) / self.cell_width() - cell as f32).clamp(0.0, 1.0);
        let u = self.cdf[cell] + within * (self.cdf[cell + 1] - self.cdf[cell]);
        Some(u.min(BELOW_ONE))
    }

    fn cell_width(&self) -> f32 {
        (self.max - self.min) / self.values.len() as f32
    }

    fn cell(&self, x: f32) -> Option<usize> {
        (self.min..=self.max)
            .contains(&x)
            .then(|| (((x - self.min) / self.cell_width()) as usize).min(self.values.len() - 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums over a fine grid of u what each index gets and checks that the remapped numbers are uniform.
    #[test]
    fn alias_table_draws_by_weight_and_remaps_uniformly() {
        let weights = [1.0, 0.0, 3.0, 8.0, 0.5, 0.0, 3.5];
        let table = AliasTable::new(&weights).expect("valid weights");
        let n = 1 << 20;
        let mut counts = [0_u32; 7];
        let mut moments = [0.0_f64; 7];
        for i in 0..n {
            let (index, pmf, rest) = table.sample(i as f32 / n as f32);
            assert_eq!(pmf, table.pmf(index));
            assert!((0.0..1.0).contains(&rest));
            counts[index] += 1;
            moments[index] += f64::from(rest);
        }
        for (i, w) in weights.iter().enumerate() {
            // Each index owns at most 7 intervals of u, each of which the grid measures within one step.
            let expected = f64::from(*w) / 16.0 * f64::from(n);
            assert!(
                (f64::from(counts[i]) - expected).abs() <= 7.0,
                "{i}: {} and {expected}",
                counts[i]
            );
            if counts[i] > 0 {
                assert!((moments[i] / f64::from(counts[i]) - 0.5).abs() < 1e-3);
            }
        }
    }

    #[test]
    fn alias_table_of_one_and_of_nothing() {
        let one = AliasTable::new(&[2.0]).expect("one weight");
        assert_eq!(one.sample(0.75), (0, 1.0, 0.75));
        for bad in [&[][..], &[0.0, 0.0], &[1.0, -1.0], &[f32::NAN], &[f32::INFINITY]] {
            assert!(AliasTable::new(bad).is_none(), "{bad:?}");
        }
    }

    #[test]
    fn step_function_density_sign_and_inverse() {
        let d = PiecewiseConstant1D::new(&[0.0, 1.0, -2.0, 0.0, 5.0, 0.0], -3.0, 3.0).expect("valid");
        assert_eq!((d.integral(), d.signed_integral()), (8.0, 4.0));
        let mut mean = 0.0;
        for i in 0..4096 {
            let u = i as f32 / 4096.0;
            let (x, pdf, cell) = d.sample(u);
            assert!(pdf > 0.0 && (d.pdf(x) == pdf || x.fract() == 0.0));
            assert!((d.invert(x).expect("inside") - u).abs() < 1e-6);
            mean += f64::from(d.value(cell) / pdf) / 4096.0;
        }
        assert!((mean - 4.0).abs() < 1e-5, "the estimate of the signed integral: {mean}");
        assert_eq!((d.pdf(-3.1), d.pdf(3.1), d.pdf(-2.5)), (0.0, 0.0, 0.0));
        assert_eq!(d.invert(4.0), None);
    }

    #[test]
    fn the_guided_search_is_the_binary_search() {
        for cells in [1, 2, 7, 500] {
            let values: Vec<f32> = (0..cells).map(|i| ((i * i) as f32 * 0.37).cos().max(0.0)).collect();
            let d = PiecewiseConstant1D::new(&values, -1.0, 1.0).expect("valid");
            let grid = (0..10_000).map(|i| i as f32 / 10_000.0);
            for u in grid.chain(d.cdf.iter().copied()).chain([BELOW_ONE, 1.0, 2.0, -1.0]) {
                assert_eq!(d.begins(u), d.cdf.partition_point(|&c| c <= u), "{u} of {cells}");
            }
        }
    }

    #[test]
    fn step_function_rejects_what_it_cannot_sample() {
        for bad in [&[][..], &[0.0], &[f32::NAN], &[f32::INFINITY]] {
            assert!(PiecewiseConstant1D::new(bad, 0.0, 1.0).is_none(), "{bad:?}");
        }
        assert!(PiecewiseConstant1D::new(&[1.0], 1.0, 1.0).is_none());
    }
}
