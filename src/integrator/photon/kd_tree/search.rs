//! Goes down the tree, nearest children first.

use super::KdTree;
use super::candidates::Nearest;
use super::nodes::WIDTH;
use crate::math::{Kernel, Vec3};

/// More than a search puts aside: a tree of 2^32 points has 27 binary levels above leaves, that is 9 of nodes.
const STACK: usize = 9 * WIDTH + 1;
/// Bits of an entry's number within its level.
const NUMBER_BITS: u32 = 28;

/// A leaf or a node put aside, with its squared distance: nearer ones are less, then those of a lower level, then those to the left.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
struct Entry(u64);

impl Entry {
    /// `level` is 0 for a leaf, and one more than in [`KdTree::levels`] for a node.
    #[inline(always)]
    fn new(distance: f32, level: usize, number: usize) -> Self {
        Self((u64::from(distance.to_bits()) << 32) | ((level as u64) << NUMBER_BITS) | number as u64)
    }

    #[inline(always)]
    fn distance(self) -> f32 {
        f32::from_bits((self.0 >> 32) as u32)
    }

    #[inline(always)]
    fn level(self) -> usize {
        (self.0 as u32 >> NUMBER_BITS) as usize
    }

    #[inline(always)]
    fn number(self) -> usize {
        self.0 as usize & ((1 << NUMBER_BITS) - 1)
    }
}

/// See [`KdTree::nearest`].
pub struct NearestSearch<'a, A> {
    pub tree: &'a KdTree,
    pub p: Vec3,
    pub k: usize,
    pub max_distance: f32,
    pub accept: A,
    pub found: &'a mut Nearest,
}

impl<A: Fn(u32) -> bool> Kernel for NearestSearch<'_, A> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { tree, p, k, .. } = self;
        let Some(limit) = squared_limit(self.max_distance).filter(|_| k > 0) else {
            self.found.set_empty();
            return;
        };
        let candidates = self.found.start(k, limit);
        let mut stack = [Entry::default(); STACK];
        stack[0] = Entry::new(0.0, tree.levels.len(), 0);
        let mut top = usize::from(!tree.is_empty());
        while top > 0 {
            top -= 1;
            let entry = stack[top];
            if candidates.excludes(entry.distance(), || tree.first_index(entry)) {
                continue;
            }
            let number = entry.number();
            if entry.level() == 0 {
                let lanes = tree.leaves[number].distances(p);
                candidates.add(number as u32, lanes, &tree.order, &self.accept);
                continue;
            }
            let level = entry.level() - 1;
            let distances = tree.nodes[tree.levels[level].start + number].distances(p);
            let base = top;
            for (lane, distance) in distances.into_iter().enumerate() {
                if distance <= candidates.bound() {
                    let child = Entry::new(distance, level, number * WIDTH + lane);
                    let mut at = top;
                    while at > base && stack[at - 1] < child {
                        stack[at] = stack[at - 1];
                        at -= 1;
                    }
                    stack[at] = child;
                    top += 1;
                }
            }
        }
        self.found.finish(&tree.order, limit);
    }
}

/// See [`KdTree::within`].
pub struct WithinSearch<'a, V> {
    pub tree: &'a KdTree,
    pub p: Vec3,
    pub radius: f32,
    pub visit: V,
}

impl<V: FnMut(u32, f32)> Kernel for WithinSearch<'_, V> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { tree, p, mut visit, .. } = self;
        let Some(limit) = squared_limit(self.radius) else {
            return;
        };
        let mut stack = [Entry::default(); STACK];
        stack[0] = Entry::new(0.0, tree.levels.len(), 0);
        let mut top = usize::from(!tree.is_empty());
        while top > 0 {
            top -= 1;
            let (level, number) = (stack[top].level(), stack[top].number());
            if level == 0 {
                let lanes = tree.leaves[number].distances(p);
                for (place, d) in (number * lanes.len()..).zip(lanes) {
                    if d <= limit {
                        visit(place as u32, d);
                    }
                }
                continue;
            }
            let level = level - 1;
            let distances = tree.nodes[tree.levels[level].start + number].distances(p);
            // The last is put aside first, so that the first is visited first.
            for (lane, distance) in distances.into_iter().enumerate().rev() {
                if distance <= limit {
                    stack[top] = Entry::new(distance, level, number * WIDTH + lane);
                    top += 1;
                }
            }
        }
    }
}

impl KdTree {
    /// The least index of a point within.
    #[cold]
    fn first_index(&self, entry: Entry) -> u32 {
        let Some(parents) = self.levels.get(entry.level()) else {
            return 0;
        };
        self.first_indices[parents.start + entry.number() / WIDTH][entry.number() % WIDTH]
    }
}

/// The square of a distance, unless nothing can be so near.
#[inline(always)]
fn squared_limit(distance: f32) -> Option<f32> {
    (distance >= 0.0).then(|| (distance * distance).min(f32::MAX))
}
