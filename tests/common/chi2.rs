//! Pearson's chi-squared test of samples against the density that they claim to have, over a two-dimensional domain.
//!
//! After the harness of Mitsuba 3: the domain is cut into cells, the density is integrated over each, cells that expect too
//! few samples are pooled. Samples that fail (`None`) are a cell of their own, expected as often as the density's integral
//! falls short of 1.

use std::f64::consts::PI;
use std::fmt::Write;

use glam::Vec3;
use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::random::Random;
use super::sidak;

/// The setting of a test.
#[derive(Clone, Debug)]
pub struct Chi2 {
    /// `[from, to]` of each coordinate.
    pub domain: [[f64; 2]; 2],
    /// Cells along each coordinate; 1 for a coordinate that is not there.
    pub bins: [usize; 2],
    /// How many samples are drawn.
    pub samples: usize,
    /// The seed of the numbers that they are drawn from.
    pub seed: u64,
    /// The probability that any of `tests` such tests fails for a correct density.
    pub significance: f64,
    /// How many tests there are.
    pub tests: usize,
}

/// What came of a test.
#[derive(Clone, Debug)]
pub struct Chi2Report {
    /// The probability of a deviation at least as large if the density is right.
    pub p_value: f64,
    /// The p-value below which the test fails.
    pub level: f64,
    /// The integral of the density over the domain.
    pub mass: f64,
    /// The sum of (observed - expected)² / expected over the cells.
    pub statistic: f64,
    /// Cells after pooling, less one.
    pub degrees_of_freedom: usize,
    /// The cells that contribute most: what they are, observed, expected.
    pub worst: Vec<(String, f64, f64)>,
    /// Samples in places of density zero, outside the domain included, and failures where the density integrates to 1.
    pub impossible: usize,
}

/// Expected counts below this are pooled: the statistic is then close enough to its limit (Cochran's rule).
const SMALLEST_EXPECTED: f64 = 5.0;

/// How far the quadrature may put a correct density's integral above 1.
const MASS_TOLERANCE: f64 = 1e-4;

impl Chi2 {
    /// 32 x 32 cells, 400,000 samples, a level of 1 % for one test.
    pub fn new(domain: [[f64; 2]; 2]) -> Self {
        Self {
            domain,
            bins: [32, 32],
            samples: 400_000,
            seed: 1,
            significance: 0.01,
            tests: 1,
        }
    }

    /// For directions by azimuth and z, whose area element is that of solid angle.
    pub fn sphere() -> Self {
        Self::new([[-PI, PI], [-1.0, 1.0]])
    }

    /// For directions with z >= 0.
    pub fn hemisphere() -> Self {
        Self::new([[-PI, PI], [0.0, 1.0]])
    }

    /// For one test of `tests`.
    pub fn of(self, tests: usize) -> Self {
        Self { tests, ..self }
    }

    /// Tests points: `sample` makes one from four uniform numbers, `pdf` is its density in the domain's coordinates.
    pub fn run(
        &self,
        mut sample: impl FnMut([f32; 4]) -> Option<[f64; 2]>,
        pdf: impl Fn([f64; 2]) -> f64,
    ) -> Chi2Report {
        let [columns, rows] = self.bins;
        let mut expected: Vec<f64> = (0..columns * rows)
            .map(|cell| self.samples as f64 * self.integrate(&pdf, self.bounds(cell), 0))
            .collect();
        let mut random = Random::new(self.seed);
        let mut observed = vec![0_usize; columns * rows];
        let (mut failed, mut outside) = (0_usize, 0);
        for _ in 0..self.samples {
            match sample(random.unit4()).map(|p| (p, self.cell(p))) {
                None => failed += 1,
                Some((_, None)) => outside += 1,
                Some((point, Some(cell))) => {
                    observed[cell] += 1;
                    // The quadrature may miss a corner where the density is positive.
                    if expected[cell] == 0.0 && pdf(point) > 0.0 {
                        expected[cell] = f64::MIN_POSITIVE;
                    }
                }
            }
        }
        let mass = expected.iter().sum::<f64>() / self.samples as f64;
        let mut cells: Vec<(String, f64, f64)> = (0..columns * rows)
            .map(|i| (format!("{:.4?}", self.bounds(i)), observed[i] as f64, expected[i]))
            .collect();
        let shortfall = self.samples as f64 * (1.0 - mass).max(0.0);
        cells.push(("failed samples".to_owned(), failed as f64, shortfall));
        self.judge(cells, mass, outside)
    }

    /// Tests directions, of unit length, over the sphere or hemisphere: `pdf` is per solid angle.
    pub fn run_directions(
        &self,
        mut sample: impl FnMut([f32; 4]) -> Option<Vec3>,
        pdf: impl Fn(Vec3) -> f32,
    ) -> Chi2Report {
        self.run(
            |u| sample(u).map(|w| [f64::from(w.y).atan2(f64::from(w.x)), f64::from(w.z)]),
            |[azimuth, z]| {
                let sin = (1.0 - z * z).max(0.0).sqrt();
                let w = [sin * azimuth.cos(), sin * azimuth.sin(), z].map(|c| c as f32);
                f64::from(pdf(Vec3::from(w)))
            },
        )
    }

    /// The cell of a point. The far ends belong to the domain, give or take the rounding of single precision.
    fn cell(&self, point: [f64; 2]) -> Option<usize> {
        let mut index = [0; 2];
        for axis in 0..2 {
            let [from, to] = self.domain[axis];
            let t = (point[axis] - from) / (to - from);
            if !(-1e-6..=1.0 + 1e-6).contains(&t) {
                return None;
            }
            index[axis] = ((t.max(0.0) * self.bins[axis] as f64) as usize).min(self.bins[axis] - 1);
        }
        Some(index[1] * self.bins[0] + index[0])
    }

    fn bounds(&self, cell: usize) -> [[f64; 2]; 2] {
        let index = [cell % self.bins[0], cell / self.bins[0]];
        std::array::from_fn(|axis| {
            let [from, to] = self.domain[axis];
            let at = |i: usize| from + (to - from) * i as f64 / self.bins[axis] as f64;
            [at(index[axis]), at(index[axis] + 1)]
        })
    }

    /// The integral of `pdf` over a rectangle, to a thousandth of the standard deviation of what is counted there.
    fn integrate(&self, pdf: &impl Fn([f64; 2]) -> f64, [x, y]: [[f64; 2]; 2], depth: u32) -> f64 {
        let half = |[a, b]: [f64; 2]| [[a, 0.5 * (a + b)], [0.5 * (a + b), b]];
        let coarse = gauss(pdf, [x, y]);
        let quarters = half(x).map(|x| half(y).map(|y| [x, y]));
        let fine: f64 = quarters.iter().flatten().map(|&quarter| gauss(pdf, quarter)).sum();
        let tolerance = 1e-3 * (fine.max(0.0) / self.samples as f64).sqrt() + 1e-3 / self.samples as f64;
        if (fine - coarse).abs() <= tolerance || depth == 7 {
            return fine;
        }
        quarters
            .iter()
            .flatten()
            .map(|&quarter| self.integrate(pdf, quarter, depth + 1))
            .sum()
    }

    fn judge(&self, mut cells: Vec<(String, f64, f64)>, mass: f64, outside: usize) -> Chi2Report {
        cells.sort_by(|a, b| b.2.total_cmp(&a.2));
        let mut impossible = outside;
        cells.retain(|(_, observed, expected)| {
            if *expected <= 0.0 {
                impossible += *observed as usize;
            }
            *expected > 0.0
        });
        // The sparse cells become one, and the sparsest of the others joins it if it is still too sparse.
        let split = cells.partition_point(|c| c.2 >= SMALLEST_EXPECTED);
        let mut pool = cells.split_off(split);
        while pool.iter().map(|c| c.2).sum::<f64>() < SMALLEST_EXPECTED && !pool.is_empty() && cells.len() > 1 {
            pool.extend(cells.pop());
        }
        if !pool.is_empty() {
            let [observed, expected] = [pool.iter().map(|c| c.1).sum(), pool.iter().map(|c| c.2).sum()];
            cells.push((format!("{} sparse cells", pool.len()), observed, expected));
        }
        let part = |c: &(String, f64, f64)| (c.1 - c.2).powi(2) / c.2;
        let statistic = cells.iter().map(part).sum();
        let degrees_of_freedom = cells.len().saturating_sub(1);
        let p_value = ChiSquared::new(degrees_of_freedom.max(1) as f64).map_or(f64::NAN, |d| d.sf(statistic));
        cells.sort_by(|a, b| part(b).total_cmp(&part(a)));
        cells.truncate(5);
        Chi2Report {
            p_value,
            level: sidak(self.significance, self.tests),
            mass,
            statistic,
            degrees_of_freedom,
            worst: cells,
            impossible,
        }
    }
}

impl Chi2Report {
    /// What is wrong, or `None` if nothing is.
    pub fn problem(&self) -> Option<String> {
        let mut text = String::new();
        if self.mass.is_nan() || self.mass > 1.0 + MASS_TOLERANCE {
            let _ = writeln!(text, "the density integrates to {}", self.mass);
        }
        if self.impossible > 0 {
            let _ = writeln!(
                text,
                "{} samples failed, or fell where the density is zero, though it promises none",
                self.impossible
            );
        }
        if self.p_value.is_nan() || self.p_value < self.level {
            let (p, level) = (self.p_value, self.level);
            let (statistic, freedom) = (self.statistic, self.degrees_of_freedom);
            let _ = writeln!(
                text,
                "chi² = {statistic:.1} with {freedom} degrees of freedom: p = {p:.2e} < {level:.2e}"
            );
            for (cell, observed, expected) in &self.worst {
                let _ = writeln!(text, "  {cell}: {observed} observed, {expected:.1} expected");
            }
        }
        (!text.is_empty()).then_some(text)
    }

    /// Panics with the problem, if there is one.
    #[track_caller]
    pub fn assert_ok(&self, name: &str) {
        if let Some(problem) = self.problem() {
            panic!("{name}: {problem}");
        }
    }
}

/// Gauss's rule of 4 x 4 points.
fn gauss(f: &impl Fn([f64; 2]) -> f64, [x, y]: [[f64; 2]; 2]) -> f64 {
    const NODES: [(f64, f64); 4] = [
        (-0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
        (-0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
        (0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
        (0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
    ];
    let at = |[a, b]: [f64; 2], node: f64| 0.5 * (a + b) + 0.5 * (b - a) * node;
    let mut sum = 0.0;
    for (u, weight_u) in NODES {
        for (v, weight_v) in NODES {
            sum += weight_u * weight_v * f([at(x, u), at(y, v)]);
        }
    }
    sum * 0.25 * (x[1] - x[0]) * (y[1] - y[0])
}
