//! Puts the least of some points first: the median split that a tree is built by.
//!
//! R. W. Floyd and R. L. Rivest, Expected time bounds for selection, CACM 18(3), 1975: a sample tells two numbers between which the wanted
//! one probably is. The first leaves little more than the smaller side, the second next to nothing: for a median some 1.5 comparisons a
//! point where there are many, 2 where there are few. Points are compared by coordinate alone, and moved without branches
//! that depend on them; indices matter only among those of the same coordinate.

use std::cell::Cell;
use std::cmp::Ordering;

use crate::math::Vec4;

/// A point on its way to its place: its coordinates, and the bits of its index, so that it is one vector.
#[derive(Clone, Copy, Debug)]
pub struct Item(pub Vec4);

impl Item {
    pub fn index(&self) -> u32 {
        self.0.w.to_bits()
    }
}

/// So few are left to a simpler way.
const FEW: usize = 24;
/// Samples at most.
const MOST_SAMPLES: usize = 1 << 11;
/// As many are enough for fewer items than [`FEW_SAMPLES_DO`].
const FEW_SAMPLES: usize = 1 << 6;
const FEW_SAMPLES_DO: usize = 1 << 12;
/// Standard deviations between where a number probably is among the samples and the one that is taken.
const MARGIN: f32 = 0.4;
/// After so many partitions something is odd about the points.
const PARTITIONS: u32 = 24;

/// Puts the least items first, as many as `left`: less by coordinate, or by index where coordinates are equal.
pub fn least_first<const AXIS: usize>(mut items: &mut [Item], mut left: usize) {
    for _ in 0..PARTITIONS {
        if left == 0 || left >= items.len() {
            return;
        }
        if items.len() <= FEW {
            break;
        }
        let pivot = if items.len() < FEW_SAMPLES_DO {
            pivot::<AXIS>(items, left, &mut [0.0; FEW_SAMPLES])
        } else {
            pivot::<AXIS>(items, left, &mut [0.0; MOST_SAMPLES])
        };
        let mut below = partition(items, |item| item.0[AXIS] < pivot);
        if below == 0 {
            below = partition(items, |item| item.0[AXIS] <= pivot);
            if left < below {
                items[..below].select_nth_unstable_by_key(left, Item::index);
                return;
            }
        }
        let (low, high) = items.split_at_mut(below);
        if left < below {
            items = low;
        } else {
            items = high;
            left -= below;
        }
    }
    if left < items.len() {
        items.select_nth_unstable_by(left, order::<AXIS>);
    }
}

/// Moves those that fulfil `is_first` to the front; how many they are.
#[inline(always)]
fn partition(items: &mut [Item], is_first: impl Fn(&Item) -> bool) -> usize {
    let items = Cell::from_mut(items).as_slice_of_cells();
    let mut count = 0;
    let mut step = |item: &Cell<Item>| {
        let (moved, first) = (item.get(), &items[count]);
        item.set(first.get());
        first.set(moved);
        count += usize::from(is_first(&moved));
    };
    let (fours, rest) = items.as_chunks::<4>();
    for [a, b, c, d] in fours {
        step(a);
        step(b);
        step(c);
        step(d);
    }
    rest.iter().for_each(step);
    count
}

/// The coordinate of an item that is probably a little farther from the nearer end than the item of rank `left`.
fn pivot<const AXIS: usize>(items: &[Item], left: usize, samples: &mut [f32]) -> f32 {
    // Some half of the number to the power of 2/3.
    let count = (1_usize << (2 * items.len().ilog2() / 3 - 1)).min(samples.len());
    let samples = &mut samples[..count];
    // Evenly spread by the golden ratio, whatever period the items may have.
    let mut at = 0_u32;
    for sample in &mut *samples {
        let place = (u64::from(at) * items.len() as u64) >> 32;
        *sample = items[place as usize].0[AXIS];
        at = at.wrapping_add(0x9e37_79b9);
    }
    let part = left as f32 / items.len() as f32;
    let rank = part * count as f32;
    let margin = MARGIN * (rank * (1.0 - part)).sqrt() + 0.5;
    let rank = if 2 * left <= items.len() {
        rank + margin
    } else {
        rank - margin
    };
    // Conversion saturates at 0.
    let rank = (rank as usize).min(count - 1);
    *samples.select_nth_unstable_by(rank, f32::total_cmp).1
}

fn order<const AXIS: usize>(a: &Item, b: &Item) -> Ordering {
    let (x, y) = (a.0[AXIS], b.0[AXIS]);
    if (x < y) | ((x == y) & (a.index() < b.index())) {
        Ordering::Less
    } else if a.index() == b.index() {
        Ordering::Equal
    } else {
        Ordering::Greater
    }
}
