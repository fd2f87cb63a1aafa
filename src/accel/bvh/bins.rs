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
    /// The number of the first bin of the upper side, along its axis; along the others a number below all.
    border: Vec4,
    grid: Grid,
    /// What the two sides cost, by [`cost`].
    pub cost: f32,
    /// Boxes around the sides.
    pub bounds: [Box4; 2],
}

impl Split {
    /// Whether an item is on the lower side, by [`Item::twice_center`].
    #[inline]
    pub fn is_below(&self, twice_center: Vec4) -> bool {
        self.grid.numbers(twice_center).cmplt(self.border).any()
    }

    /// The area that the boxes have in common, halved.
    pub fn overlap(&self) -> f32 {
        self.bounds[0].intersection(self.bounds[1]).half_area()
    }
}

/// Cuts the box of the centres into equal bins.
#[derive(Clone, Copy, Debug)]
struct Grid {
    /// Corner of the box, twice.
    low: Vec4,
    scale: Vec4,
    bins: usize,
}

/// Added to a number from 0 to 2^22, it leaves the nearest integer in the last bits.
pub const TO_INTEGER: f32 = (3 << 22) as f32;

impl Grid {
    fn new(extent: &Extent, bins: usize) -> Self {
        let scale = bins as f32 * (1.0 - 2.0 * f32::EPSILON) / extent.spread();
        Self {
            low: extent.centers.low,
            // An axis without extent has all in its first bin.
            scale: Vec3::select(scale.cmplt(Vec3::INFINITY), scale, Vec3::ZERO).extend(0.0),
            bins,
        }
    }

    /// The bins that a centre is in, by axis, plus [`TO_INTEGER`].
    #[inline]
    fn numbers(&self, twice_center: Vec4) -> Vec4 {
        let place = (twice_center - self.low) * self.scale - 0.5;
        place.max(Vec4::ZERO) + TO_INTEGER
    }

    #[inline]
    fn bins<const N: usize>(&self, twice_center: Vec4) -> [usize; 3] {
        let [x, y, z, _] = self.numbers(twice_center).to_array();
        [x, y, z].map(|x| x.to_bits() as usize % N)
    }
}

#[derive(Clone, Copy)]
struct Bin {
    bounds: Box4,
    count: u32,
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

    fn cost(&self) -> f32 {
        cost(&self.bounds, self.count)
    }
}

/// What items in a box cost to intersect, up to a factor: its area times the blocks that they fill.
#[inline]
pub fn cost(bounds: &Box4, count: u32) -> f32 {
    bounds.half_area() * count.div_ceil(LANES as u32) as f32
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
    let mut least = f32::INFINITY;
    for (axis, bins) in histogram.iter().enumerate() {
        if grid.scale[axis] == 0.0 {
            continue;
        }
        let bins = &bins[..grid.bins];
        // All bins from each on, then a sweep from the other side.
        let mut above = [0.0; N];
        let mut upper = Bin::EMPTY;
        for bin in (1..bins.len()).rev() {
            upper = upper.union(bins[bin]);
            above[bin] = upper.cost();
        }
        let mut lower = Bin::EMPTY;
        for bin in 1..bins.len() {
            lower = lower.union(bins[bin - 1]);
            let cost = lower.cost() + above[bin];
            if lower.count > 0 && lower.count < items.len() as u32 && cost < least {
                least = cost;
                best = Some((axis, bin));
            }
        }
    }
    let (axis, bin) = best?;
    let (lower, upper) = histogram[axis][..grid.bins].split_at(bin);
    let mut border = Vec4::NEG_INFINITY;
    border[axis] = bin as f32 + TO_INTEGER;
    Some(Split {
        border,
        grid: *grid,
        cost: least,
        bounds: [lower, upper].map(|bins| bins.iter().fold(Box4::EMPTY, |bounds, bin| bounds.union(bin.bounds))),
    })
}

fn histogram<const N: usize>(items: &[Item], grid: &Grid) -> Histogram<N> {
    let of_chunk = |chunk: &[Item]| {
        let mut histogram = [[Bin::EMPTY; N]; 3];
        for item in chunk {
            let places = grid.bins::<N>(item.twice_center());
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
