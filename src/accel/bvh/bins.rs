//! Where to split: the bins of the surface area heuristic.

use rayon::prelude::*;

use super::build::Item;
use super::leaf::LANES;
use crate::math::{Bounds3, Vec3};

/// Bins along an axis, at most.
pub const MOST: usize = 32;

/// Items that one task takes at a time.
const CHUNK: usize = 16 * 1024;

/// A plane that divides items by the bins of their centres.
#[derive(Clone, Copy, Debug)]
pub struct Split {
    axis: usize,
    /// Bins below this are on the lower side.
    bin: usize,
    grid: Grid,
}

impl Split {
    /// Whether an item is on the lower side.
    #[inline]
    pub fn is_below(&self, item: &Item) -> bool {
        self.grid.bin(item.center()[self.axis], self.axis) < self.bin
    }
}

/// Cuts the box of the centres into equal bins.
#[derive(Clone, Copy, Debug)]
struct Grid {
    low: Vec3,
    scale: Vec3,
    bins: usize,
}

impl Grid {
    fn new(centers: &Bounds3, bins: usize) -> Self {
        let scale = bins as f32 * (1.0 - 2.0 * f32::EPSILON) / centers.extent();
        Self {
            low: centers.min,
            // An axis without extent, or with one that overflows, has all in its first bin.
            scale: Vec3::select(scale.cmplt(Vec3::INFINITY), scale, Vec3::ZERO),
            bins,
        }
    }

    #[inline]
    fn bin(&self, center: f32, axis: usize) -> usize {
        (((center - self.low[axis]) * self.scale[axis]) as usize).min(self.bins - 1)
    }
}

#[derive(Clone, Copy)]
struct Bin {
    bounds: Bounds3,
    count: usize,
}

impl Bin {
    const EMPTY: Self = Self {
        bounds: Bounds3::EMPTY,
        count: 0,
    };

    #[inline]
    fn union(self, other: Self) -> Self {
        Self {
            bounds: self.bounds.union(other.bounds),
            count: self.count + other.count,
        }
    }

    /// What it costs to intersect, up to a factor: its area times the blocks that its items fill.
    fn cost(&self) -> f64 {
        half_area(&self.bounds) * self.count.div_ceil(LANES) as f64
    }
}

/// As [`Bounds3::half_area`], without overflow.
pub fn half_area(bounds: &Bounds3) -> f64 {
    if bounds.is_empty() {
        return 0.0;
    }
    let d = bounds.max.as_dvec3() - bounds.min.as_dvec3();
    d.x * d.y + d.y * d.z + d.z * d.x
}

type Histogram = [[Bin; MOST]; 3];

/// A box around the items and one around their centres.
pub fn bounds_of(items: &[Item]) -> (Bounds3, Bounds3) {
    let of_chunk = |chunk: &[Item]| {
        chunk
            .iter()
            .fold((Bounds3::EMPTY, Bounds3::EMPTY), |(bounds, centers), item| {
                (bounds.union(item.bounds), centers.grow(item.center()))
            })
    };
    let union = |a: (Bounds3, Bounds3), b: (Bounds3, Bounds3)| (a.0.union(b.0), a.1.union(b.1));
    if items.len() <= CHUNK {
        return of_chunk(items);
    }
    items
        .par_chunks(CHUNK)
        .map(of_chunk)
        .reduce(|| (Bounds3::EMPTY, Bounds3::EMPTY), union)
}

/// The split of least cost between bins; `None` if all centres are in one bin.
pub fn best_split(items: &[Item], centers: &Bounds3, bins: usize) -> Option<Split> {
    // Few items do not need many bins.
    let grid = Grid::new(centers, bins.min(4 + items.len() / 8));
    let histogram = histogram(items, &grid);
    let mut best = None;
    let mut least = f64::INFINITY;
    for (axis, bins) in histogram.iter().enumerate() {
        if grid.scale[axis] == 0.0 {
            continue;
        }
        let bins = &bins[..grid.bins];
        // The cost of all bins from each on, then a sweep from the other side.
        let mut above = [0.0; MOST];
        let mut upper = Bin::EMPTY;
        for bin in (1..bins.len()).rev() {
            upper = upper.union(bins[bin]);
            above[bin] = upper.cost();
        }
        let mut lower = Bin::EMPTY;
        for bin in 1..bins.len() {
            lower = lower.union(bins[bin - 1]);
            let cost = lower.cost() + above[bin];
            if lower.count > 0 && lower.count < items.len() && cost < least {
                least = cost;
                best = Some(Split { axis, bin, grid });
            }
        }
    }
    best
}

fn histogram(items: &[Item], grid: &Grid) -> Histogram {
    let of_chunk = |chunk: &[Item]| {
        let mut histogram = [[Bin::EMPTY; MOST]; 3];
        for item in chunk {
            let center = item.center();
            for (axis, bins) in histogram.iter_mut().enumerate() {
                let bin = &mut bins[grid.bin(center[axis], axis)];
                bin.bounds = bin.bounds.union(item.bounds);
                bin.count += 1;
            }
        }
        histogram
    };
    if items.len() <= CHUNK {
        return of_chunk(items);
    }
    items.par_chunks(CHUNK).map(of_chunk).reduce(
        || [[Bin::EMPTY; MOST]; 3],
        |a, b| std::array::from_fn(|axis| std::array::from_fn(|bin| a[axis][bin].union(b[axis][bin]))),
    )
}
