//! Student's and Welch's t-tests of the means of independently seeded runs, block by block and over the whole.
//!
//! The variance is always that between runs: what the samples of one run say is not the error of correlated points, splats
//! or photon passes.

use std::fmt;

use statrs::distribution::{ContinuousCDF, StudentsT};

use super::sidak;

/// Fewer runs than this say too little about their variance.
pub const FEWEST_RUNS: usize = 16;

/// The mean of some runs and the variance of that mean.
#[derive(Clone, Copy, Debug)]
pub struct Estimate {
    pub mean: f64,
    pub variance: f64,
    pub degrees_of_freedom: f64,
}

impl Estimate {
    /// From one value a run, of which there are at least two.
    pub fn of(values: impl Iterator<Item = f64> + Clone) -> Self {
        let n = values.clone().count() as f64;
        let mean = values.clone().sum::<f64>() / n;
        let squares: f64 = values.map(|v| (v - mean).powi(2)).sum();
        Self {
            mean,
            variance: squares / (n - 1.0) / n,
            degrees_of_freedom: n - 1.0,
        }
    }

    /// A value that is known exactly.
    pub fn exact(mean: f64) -> Self {
        Self {
            mean,
            variance: 0.0,
            degrees_of_freedom: f64::INFINITY,
        }
    }

    /// The difference to `other`, with the degrees of freedom of Welch (1947) and Satterthwaite.
    fn minus(self, other: Self) -> Self {
        let variance = self.variance + other.variance;
        let part = |e: Self| e.variance * e.variance / e.degrees_of_freedom;
        let spread = part(self) + part(other);
        Self {
            mean: self.mean - other.mean,
            variance,
            degrees_of_freedom: if spread > 0.0 {
                variance * variance / spread
            } else {
                1.0
            },
        }
    }

    fn student(self) -> StudentsT {
        StudentsT::new(0.0, 1.0, self.degrees_of_freedom.max(1.0)).expect("positive degrees of freedom")
    }

    /// The probability of a mean this far from zero, where up to `slack` is not held against it.
    fn p_value(self, slack: f64) -> f64 {
        let excess = (self.mean.abs() - slack).max(0.0);
        if excess.is_nan() || self.variance.is_nan() {
            0.0
        } else if excess == 0.0 {
            1.0
        } else if self.variance == 0.0 {
            0.0
        } else {
            2.0 * self.student().sf(excess / self.variance.sqrt())
        }
    }

    /// The error that a test at `level` notices with probability 0.99, `slack` included.
    fn detectable(self, level: f64, slack: f64) -> f64 {
        let student = self.student();
        let reach = student.inverse_cdf(1.0 - 0.5 * level) + student.inverse_cdf(0.99);
        slack + reach * self.variance.sqrt()
    }
}

/// How runs are compared.
#[derive(Clone, Copy, Debug)]
pub struct Means {
    /// The probability that a comparison fails though both means are the same.
    pub significance: f64,
    /// How much of the expected value a mean may be off by without counting: the known error of what it is compared with.
    pub slack: f64,
}

impl Default for Means {
    /// One failure in a hundred, no slack.
    fn default() -> Self {
        Self {
            significance: 0.01,
            slack: 0.0,
        }
    }
}

/// What came of a comparison.
#[derive(Clone, Debug)]
pub struct MeansReport {
    /// The block that agrees least.
    pub worst_block: usize,
    /// Its mean, what was expected, and the p-value.
    pub worst: (f64, f64, f64),
    /// The p-value below which a block fails.
    pub block_level: f64,
    /// The mean over all blocks, what was expected, and the p-value.
    pub whole: (f64, f64, f64),
    /// The p-value below which the whole fails.
    pub whole_level: f64,
    /// The relative error of one block (the least sensitive) and of the whole that are noticed with probability 0.99.
    pub detectable: (f64, f64),
}

impl Means {
    /// Compares runs (one slice each, of the same blocks) with values known exactly.
    pub fn against_exact(self, runs: &[Vec<f64>], expected: &[f64]) -> MeansReport {
        let exact = |block: Option<usize>| Estimate::exact(block.map_or_else(|| average(expected), |b| expected[b]));
        self.compare(runs, exact, expected.len())
    }

    /// Compares the runs of two programs (Welch's test).
    pub fn against_runs(self, runs: &[Vec<f64>], others: &[Vec<f64>]) -> MeansReport {
        assert!(others.len() >= FEWEST_RUNS, "{} runs are too few", others.len());
        self.compare(runs, |block| estimate(others, block), others[0].len())
    }

    fn compare(self, runs: &[Vec<f64>], expected: impl Fn(Option<usize>) -> Estimate, blocks: usize) -> MeansReport {
        assert!(runs.len() >= FEWEST_RUNS, "{} runs are too few", runs.len());
        assert!(runs.iter().all(|run| run.len() == blocks), "runs differ in length");
        // Half of the significance for the blocks together, half for the whole.
        let block_level = sidak(0.5 * self.significance, blocks);
        let whole_level = 0.5 * self.significance;
        let test = |block: Option<usize>, level: f64| {
            let (ours, theirs) = (estimate(runs, block), expected(block));
            let difference = ours.minus(theirs);
            let slack = self.slack * theirs.mean.abs();
            let detectable = difference.detectable(level, slack) / theirs.mean.abs();
            ((ours.mean, theirs.mean, difference.p_value(slack)), detectable)
        };
        let tested: Vec<_> = (0..blocks).map(|block| test(Some(block), block_level)).collect();
        let worst_block = (0..blocks)
            .min_by(|&a, &b| tested[a].0.2.total_cmp(&tested[b].0.2))
            .expect("at least one block");
        let (whole, detectable_whole) = test(None, whole_level);
        MeansReport {
            worst_block,
            worst: tested[worst_block].0,
            block_level,
            whole,
            whole_level,
            detectable: (tested.iter().map(|t| t.1).fold(0.0, f64::max), detectable_whole),
        }
    }
}

/// The estimate of one block, or of the mean over all.
fn estimate(runs: &[Vec<f64>], block: Option<usize>) -> Estimate {
    match block {
        Some(block) => Estimate::of(runs.iter().map(|run| run[block])),
        None => Estimate::of(runs.iter().map(|run| average(run))),
    }
}

fn average(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

impl MeansReport {
    /// Whether every block and the whole agree.
    pub fn agrees(&self) -> bool {
        self.worst.2 >= self.block_level && self.whole.2 >= self.whole_level
    }

    /// Panics with the report unless every block and the whole agree.
    #[track_caller]
    pub fn assert_agrees(&self, name: &str) {
        assert!(self.agrees(), "{name}: {self}");
    }

    /// Panics unless an error of `block` in one block and of `whole` in all would be noticed with probability 0.99 (both
    /// relative).
    #[track_caller]
    pub fn assert_power(&self, name: &str, block: f64, whole: f64) {
        let (in_block, in_whole) = self.detectable;
        assert!(
            in_block <= block && in_whole <= whole,
            "{name} has too little power: {self}"
        );
    }
}

impl fmt::Display for MeansReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let line = |(ours, expected, p): (f64, f64, f64), level: f64| {
            let percent = 100.0 * (ours / expected - 1.0);
            format!("{ours} where {expected} is expected ({percent:+.3} %), p = {p:.2e}, level {level:.2e}")
        };
        write!(
            f,
            "whole: {}; worst block {}: {}; an error of {:.2} % in the whole or of {:.2} % in any block would be noticed",
            line(self.whole, self.whole_level),
            self.worst_block,
            line(self.worst, self.block_level),
            100.0 * self.detectable.1,
            100.0 * self.detectable.0
        )
    }
}
