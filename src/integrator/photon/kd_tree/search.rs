//! Goes down the tree, nearest children first.

use super::KdTree;
use super::candidates::{Candidates, Nearest};
use super::nodes::WIDTH;
use super::nodes::{Center, LEAF};
use super::simd::{EIGHT, Simd, Task};
use crate::math::Vec3;

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

impl<A: Fn(u32) -> bool> Task for NearestSearch<'_, A> {
    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { tree, p, k, .. } = self;
        let Some(limit) = squared_limit(self.max_distance).filter(|_| k > 0) else {
            self.found.set_empty();
            return;
        };
        let center = Center::new(simd, p);
        let mut bound = self.found.likely_bound(p, k).min(limit);
        loop {
            let candidates = self.found.start(k, bound);
            tree.collect(simd, &center, &self.accept, candidates);
            if candidates.is_full() || bound == limit {
                break;
            }
            bound = limit;
        }
        self.found.finish(simd, &tree.order, p, limit);
    }
}

/// See [`KdTree::within`].
pub struct WithinSearch<'a, V> {
    pub tree: &'a KdTree,
    pub p: Vec3,
    pub radius: f32,
    pub visit: V,
}

impl<V: FnMut(u32, f32)> Task for WithinSearch<'_, V> {
    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { tree, p, mut visit, .. } = self;
        let Some(limit) = squared_limit(self.radius) else {
            return;
        };
        let center = Center::new(simd, p);
        let bound = simd.splat(limit);
        let mut stack = [Entry::default(); STACK];
        stack[0] = Entry::new(0.0, tree.levels.len(), 0);
        let mut top = usize::from(!tree.is_empty());
        while top > 0 {
            top -= 1;
            let (level, number) = (stack[top].level(), stack[top].number());
            if level == 0 {
                for (i, v) in tree.leaves[number].distances(simd, &center).into_iter().enumerate() {
                    let mut near = simd.at_most(v, bound);
                    let distances = simd.store(v);
                    while near != 0 {
                        let lane = near.trailing_zeros() as usize;
                        near &= near - 1;
                        visit((number * LEAF + i * EIGHT + lane) as u32, distances[lane]);
                    }
                }
                continue;
            }
            let level = level - 1;
            let distances = tree.nodes[tree.levels[level].start + number].distances(simd, &center);
            let mut near = simd.at_most(distances, bound);
            // The last is put aside first, so that the first is visited first.
            while near != 0 {
                let lane = near.ilog2() as usize;
                near ^= 1 << lane;
                stack[top] = Entry::new(0.0, level, number * WIDTH + lane);
                top += 1;
            }
        }
    }
}

impl KdTree {
    /// Adds to `candidates` what is within their bound.
    #[inline(always)]
    fn collect<S: Simd>(
        &self,
        simd: S,
        center: &Center<S::Vector>,
        accept: impl Fn(u32) -> bool,
        candidates: &mut Candidates,
    ) {
        let mut stack = [Entry::default(); STACK];
        stack[0] = Entry::new(0.0, self.levels.len(), 0);
        let mut top = usize::from(!self.is_empty());
        while top > 0 {
            top -= 1;
            let entry = stack[top];
            if candidates.excludes(entry.distance(), || self.first_index(entry)) {
                continue;
            }
            let number = entry.number();
            if entry.level() == 0 {
                let distances = self.leaves[number].distances(simd, center);
                candidates.add(simd, number as u32, distances, &self.order, &accept);
                continue;
            }
            let level = entry.level() - 1;
            let distances = self.nodes[self.levels[level].start + number].distances(simd, center);
            let mut near = simd.at_most(distances, simd.splat(candidates.bound()));
            let distances = simd.store(distances);
            let base = top;
            while near != 0 {
                let lane = near.trailing_zeros() as usize;
                near &= near - 1;
                let child = Entry::new(distances[lane], level, number * WIDTH + lane);
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
