//! The rule by which a picture agrees with one by another program (the README of the reference images): both are noisy, ours
//! is rendered at least 16 times with different seeds, and blocks of 4 x 4 pixels are compared.
//!
//! Images are plain arrays of r, g, b by pixel, rows from the top.

use std::fmt;

use super::means::{Estimate, FEWEST_RUNS};

/// The width and height of a block in pixels.
const BLOCK: usize = 4;
const CHANNELS: usize = 3;

/// Our renders, reduced to block means.
#[derive(Clone, Debug)]
pub struct Runs {
    grid: Grid,
    /// One list a run: by channel, then by block.
    block_means: Vec<Vec<f64>>,
}

/// Another program's picture.
#[derive(Clone, Debug)]
pub struct Reference {
    pub width: usize,
    pub height: usize,
    /// The mean, by pixel and channel.
    pub mean: Vec<f32>,
    /// The variance of that mean.
    pub variance: Vec<f32>,
}

/// The limits of the rule.
#[derive(Clone, Debug)]
pub struct Rule {
    /// What the reference's block variance is multiplied by: 1.9 where its pixels are correlated by a splatted tent filter.
    pub variance_factor: f64,
    /// The limit of the relative difference of the means over the image.
    pub mean_difference: f64,
    /// One entry a pixel, true where the z-values are not to be judged; a block is left out if any of its pixels is.
    pub left_out: Option<Vec<bool>>,
}

impl Default for Rule {
    /// Uncorrelated pixels, 0.4 % of the mean, nothing left out.
    fn default() -> Self {
        Self {
            variance_factor: 1.0,
            mean_difference: 0.004,
            left_out: None,
        }
    }
}

/// What came of a comparison. Each figure is that of the channel where it is worst.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// The share of blocks in which ours is too noisy to tell.
    pub inconclusive: f64,
    /// Root mean square of z.
    pub rms_z: f64,
    /// The largest |z|, as z, and its channel and block (column, row).
    pub worst_z: (f64, usize, (usize, usize)),
    /// The share of blocks with |z| <= 4.
    pub within_4: f64,
    /// The number of blocks in the largest touching group above 3 of one sign.
    pub largest_cluster: usize,
    /// (ours - reference) / reference of the mean over the image, by channel.
    pub mean_difference: [f64; CHANNELS],
    /// The share of blocks that were left out of the judgement of z.
    pub left_out: f64,
    /// The limit of `mean_difference`.
    pub mean_limit: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Grid {
    width: usize,
    height: usize,
}

impl Grid {
    fn columns(self) -> usize {
        self.width.div_ceil(BLOCK)
    }

    fn blocks(self) -> usize {
        self.columns() * self.height.div_ceil(BLOCK)
    }

    /// The pixels of a block; those at the right and lower edge may have fewer.
    fn pixels(self, block: usize) -> impl Iterator<Item = usize> + Clone {
        let (x0, y0) = (block % self.columns() * BLOCK, block / self.columns() * BLOCK);
        let xs = x0..(x0 + BLOCK).min(self.width);
        (y0..(y0 + BLOCK).min(self.height)).flat_map(move |y| xs.clone().map(move |x| y * self.width + x))
    }

    /// The sum over a block of a channel, and how many pixels it has.
    fn block_sum(self, image: &[f32], channel: usize, block: usize) -> (f64, f64) {
        let pixels = self.pixels(block);
        let sum = pixels.clone().map(|p| f64::from(image[p * CHANNELS + channel])).sum();
        (sum, pixels.count() as f64)
    }

    fn block_means(self, image: &[f32]) -> Vec<f64> {
        assert_eq!(
            image.len(),
            self.width * self.height * CHANNELS,
            "the size of the image"
        );
        let each = (0..CHANNELS).flat_map(|channel| (0..self.blocks()).map(move |block| (channel, block)));
        each.map(|(channel, block)| {
            let (sum, count) = self.block_sum(image, channel, block);
            sum / count
        })
        .collect()
    }
}

impl Runs {
    /// No run yet, of pictures of this size.
    pub fn new(width: usize, height: usize) -> Self {
        Self {
            grid: Grid { width, height },
            block_means: Vec::new(),
        }
    }

    /// Adds a picture rendered with a seed of its own.
    pub fn add(&mut self, image: &[f32]) {
        self.block_means.push(self.grid.block_means(image));
    }
}

/// Compares at least 16 of our renders with a reference.
pub fn compare(runs: &Runs, reference: &Reference, rule: &Rule) -> Report {
    assert!(
        runs.block_means.len() >= FEWEST_RUNS,
        "{} runs are too few",
        runs.block_means.len()
    );
    let grid = Grid {
        width: reference.width,
        height: reference.height,
    };
    assert_eq!(runs.grid, grid, "sizes differ");
    let means = grid.block_means(&reference.mean);
    let judged: Vec<bool> = (0..grid.blocks())
        .map(|block| {
            !rule
                .left_out
                .as_ref()
                .is_some_and(|mask| grid.pixels(block).any(|p| mask[p]))
        })
        .collect();
    let mut report = Report {
        within_4: 1.0,
        mean_limit: rule.mean_difference,
        left_out: share(judged.iter().map(|j| !j)),
        ..Report::default()
    };
    for channel in 0..CHANNELS {
        let mut imprecise = Vec::new();
        let mut z = Vec::new();
        let (mut ours, mut theirs) = (0.0, 0.0);
        let channel_means = &means[channel * grid.blocks()..][..grid.blocks()];
        // What is dark but for the far tails of a distribution is black.
        let nothing = 1e-7 * channel_means.iter().sum::<f64>() / grid.blocks() as f64;
        for block in 0..grid.blocks() {
            let index = channel * grid.blocks() + block;
            let a = Estimate::of(runs.block_means.iter().map(|run| run[index]));
            let r = means[index];
            let (variance, count) = grid.block_sum(&reference.variance, channel, block);
            let v_r = rule.variance_factor * variance / (count * count);
            imprecise.push(a.variance.sqrt() > v_r.sqrt().max(0.005 * r));
            let spread = (a.variance + v_r + (0.003 * r).powi(2) + nothing * nothing).sqrt();
            z.push(if a.mean == r { 0.0 } else { (a.mean - r) / spread });
            ours += a.mean * count;
            theirs += r * count;
        }
        report.inconclusive = report.inconclusive.max(share(imprecise.into_iter()));
        report.mean_difference[channel] = if ours == theirs { 0.0 } else { ours / theirs - 1.0 };
        report.judge_z(&z, &judged, grid, channel);
    }
    report
}

impl Report {
    fn judge_z(&mut self, z: &[f64], judged: &[bool], grid: Grid, channel: usize) {
        let kept = || z.iter().zip(judged).filter(|(_, judged)| **judged).map(|(z, _)| *z);
        let count = kept().count().max(1) as f64;
        // NaN is not within anything; `max` would hide it.
        self.rms_z = worse(self.rms_z, (kept().map(|z| z * z).sum::<f64>() / count).sqrt());
        self.within_4 = self.within_4.min(share(kept().map(|z| z.abs() <= 4.0)));
        for (block, &value) in z.iter().enumerate().filter(|(block, _)| judged[*block]) {
            if value.is_nan() || value.abs() > self.worst_z.0.abs() {
                self.worst_z = (value, channel, (block % grid.columns(), block / grid.columns()));
            }
        }
        for sign in [1.0, -1.0] {
            let above: Vec<bool> = (0..z.len()).map(|b| judged[b] && sign * z[b] > 3.0).collect();
            self.largest_cluster = self.largest_cluster.max(largest_group(&above, grid));
        }
    }

    /// What breaks the rule, or `None`.
    pub fn problem(&self) -> Option<String> {
        self.broken(self.inconclusive)
    }

    /// What breaks the rule apart from its first clause, for a comparison that has fewer samples than it would take to agree.
    pub fn problem_but_precision(&self) -> Option<String> {
        self.broken(0.0)
    }

    fn broken(&self, inconclusive: f64) -> Option<String> {
        let mean_ok = |d: &f64| d.abs() < self.mean_limit;
        let rules = [
            (
                inconclusive <= 0.05,
                "inconclusive: ours is too noisy in more than 5 % of the blocks",
            ),
            (self.rms_z <= 1.25, "the root mean square of z is above 1.25"),
            (self.within_4 >= 0.995, "|z| > 4 in more than 0.5 % of the blocks"),
            (self.worst_z.0.abs() <= 7.0, "a block has |z| > 7"),
            (
                self.largest_cluster < 4,
                "four or more touching blocks are above 3 of one sign",
            ),
            (
                self.mean_difference.iter().all(mean_ok),
                "the means over the image differ too much",
            ),
        ];
        let broken: Vec<&str> = rules.iter().filter(|(ok, _)| !ok).map(|(_, what)| *what).collect();
        (!broken.is_empty()).then(|| format!("{}\n{self}", broken.join("; ")))
    }

    /// Panics with the report if the rule is broken.
    #[track_caller]
    pub fn assert_agrees(&self, name: &str) {
        if let Some(problem) = self.problem() {
            panic!("{name}: {problem}");
        }
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (z, channel, (column, row)) = self.worst_z;
        let [r, g, b] = self.mean_difference.map(|d| 100.0 * d);
        write!(
            f,
            "z: rms {:.3}, worst {z:.2} in channel {channel} at pixel ({}, {}), {:.2} % within 4, largest cluster {}; means \
             differ by {r:+.3} %, {g:+.3} %, {b:+.3} %; inconclusive {:.2} %, left out {:.2} %",
            self.rms_z,
            column * BLOCK,
            row * BLOCK,
            100.0 * self.within_4,
            self.largest_cluster,
            100.0 * self.inconclusive,
            100.0 * self.left_out,
        )
    }
}

fn worse(a: f64, b: f64) -> f64 {
    if b.is_nan() || b > a { b } else { a }
}

/// The share of what is true.
fn share(values: impl Iterator<Item = bool>) -> f64 {
    let (mut yes, mut all) = (0.0, 0.0_f64);
    for value in values {
        yes += f64::from(u8::from(value));
        all += 1.0;
    }
    yes / all.max(1.0)
}

/// The size of the largest group of marked blocks that touch by an edge or a corner.
fn largest_group(marked: &[bool], grid: Grid) -> usize {
    let columns = grid.columns();
    let mut left = marked.to_vec();
    let mut largest = 0;
    for start in 0..marked.len() {
        let mut waiting = vec![start];
        let mut size = 0;
        while let Some(block) = waiting.pop() {
            if !std::mem::replace(&mut left[block], false) {
                continue;
            }
            size += 1;
            let (x, y) = (block % columns, block / columns);
            let near = |v: usize, end: usize| v.saturating_sub(1)..(v + 2).min(end);
            for y in near(y, marked.len() / columns) {
                waiting.extend(near(x, columns).map(|x| y * columns + x));
            }
        }
        largest = largest.max(size);
    }
    largest
}
