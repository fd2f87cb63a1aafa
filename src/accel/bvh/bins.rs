//! Where to split: the bins of the surface area heuristic.

use rayon::prelude::*;

use super::item::{Box4, Extent, Item};
use super::leaf::LANES;
use crate::math::{Vec3, Vec4};

/// Bins along an axis, at most.
pub const MOST: usize = 32;

/// Items that one task takes at a time.
pub const CHUNK: usize = 16 * 1024;

/// A plane that divides items by the bins of their centres.
#[derive(Clone, Copy, Debug)]
pub struct Split {
    /// The axis that it is across.
    pub axis: usize,
    /// Bins below this are on the lower side.
    bin: usize,
    grid: Grid,
    /// What the two sides cost, by [`cost`].
    pub cost: f64,
    /// The area that their boxes have in common, halved.
    pub overlap: f64,
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
    low: Vec4,
    scale: Vec4,
    bins: usize,
}

impl Grid {
    fn new(extent: &Extent, bins: usize) -> Self {
        let scale = bins as f32 * (1.0 - 2.0 * f32::EPSILON) / extent.spread();
        Self {
            low: extent.centers.low,
            // An axis without extent, or with one that overflows, has all in its first bin.
            scale: Vec3::select(scale.cmplt(Vec3::INFINITY), scale, Vec3::ZERO).extend(0.0),
            bins,
        }
    }

    #[inline]
    fn bin(&self, center: f32, axis: usize) -> usize {
        (((center - self.low[axis]) * self.scale[axis]) as usize).min(self.bins - 1)
    }

    #[inline]
    fn bins(&self, center: Vec4) -> [usize; 3] {
        let scaled = ((center - self.low) * self.scale).to_array();
        [scaled[0], scaled[1], scaled[2]].map(|x| (x as usize).min(self.bins - 1))
    }
}

#[derive(Clone, Copy)]
struct Bin {
    bounds: Box4,
    count: usize,
}

impl Bin {
    const EMPTY: Self = Self {
        bounds: Box4::EMPTY,
        count: 0,
    };

    #[inline]
    fn union(self, other: Self) -> Self {
        Self {
            bounds: self.bounds.union(other.bounds),
            count: self.count + other.count,
        }
    }

    fn cost(&self) -> f64 {
        cost(&self.bounds, self.count)
    }
}

/// What items in a box cost to intersect, up to a factor: its area times the blocks that they fill.
pub fn cost(bounds: &Box4, count: usize) -> f64 {
    bounds.half_area() * count.div_ceil(LANES) as f64
}

type Histogram<const N: usize> = [[Bin; N]; 3];

/// Bins along an axis that are enough for few items: most nodes have few, and their histograms are to stay small.
const FEW: usize = 8;

/// Boxes around items and around their centres.
pub fn extent_of(items: &[Item]) -> Extent {
    let of_chunk = |chunk: &[Item]| chunk.iter().fold(Extent::EMPTY, Extent::with);
    if items.len() <= CHUNK {
        return of_chunk(items);
    }
    items
        .par_chunks(CHUNK)
        .map(of_chunk)
        .reduce(|| Extent::EMPTY, Extent::union)
}

/// The split of least cost between bins; `None` if all centres are in one bin.
pub fn best_split(items: &[Item], extent: &Extent, bins: usize) -> Option<Split> {
    // Few items do not need many bins.
    let grid = Grid::new(extent, bins.min(4 + items.len() / 8));
    if grid.bins <= FEW {
        best_of::<FEW>(items, &grid)
    } else {
        best_of::<MOST>(items, &grid)
    }
}

fn best_of<const N: usize>(items: &[Item], grid: &Grid) -> Option<Split> {
    let histogram = histogram::<N>(items, grid);
    let mut best = None;
    let mut least = f64::INFINITY;
    for (axis, bins) in histogram.iter().enumerate() {
        if grid.scale[axis] == 0.0 {
            continue;
        }
        let bins = &bins[..grid.bins];
        // All bins from each on, then a sweep from the other side.
        let mut above = [(Box4::EMPTY, 0.0); N];
        let mut upper = Bin::EMPTY;
        for bin in (1..bins.len()).rev() {
            upper = upper.union(bins[bin]);
            above[bin] = (upper.bounds, upper.cost());
        }
        let mut lower = Bin::EMPTY;
        for bin in 1..bins.len() {
            lower = lower.union(bins[bin - 1]);
            let (upper, upper_cost) = above[bin];
            let cost = lower.cost() + upper_cost;
            if lower.count > 0 && lower.count < items.len() && cost < least {
                least = cost;
                best = Some(Split {
                    axis,
                    bin,
                    grid: *grid,
                    cost,
                    overlap: lower.bounds.intersection(upper).half_area(),
                });
            }
        }
    }
    best
}

fn histogram<const N: usize>(items: &[Item], grid: &Grid) -> Histogram<N> {
    let of_chunk = |chunk: &[Item]| {
        let mut histogram = [[Bin::EMPTY; N]; 3];
        for item in chunk {
            let places = grid.bins(item.center());
            for (bins, place) in histogram.iter_mut().zip(places) {
                let bin = &mut bins[place];
                bin.bounds = bin.bounds.union(item.box4());
                bin.count += 1;
            }
        }
        histogram
    };
    if items.len() <= CHUNK {
        return of_chunk(items);
    }
    items.par_chunks(CHUNK).map(of_chunk).reduce(
        || [[Bin::EMPTY; N]; 3],
        |a, b| std::array::from_fn(|axis| std::array::from_fn(|bin| a[axis][bin].union(b[axis][bin]))),
    )
}
