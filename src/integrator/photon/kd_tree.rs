//! The points near a point: a balanced, implicit k-d tree.
//!
//! Points are split at a median of the widest extent of their box, again and again, until leaves have [`LEAF`](nodes::LEAF) points. There are no
//! pointers: points lie leaf after leaf, and a point's position in this order is its *place*. Three splits in a row make a node of
//! [`WIDTH`] children, so that node `i` of one level has children `8 i..8 i + 8` of the level below. A split gives its left side the
//! greatest power of two of full leaves that leaves something for the right: so all leaves but the last are full, and all have the
//! same depth.
//!
//! A node has the tight boxes of its children, not the planes between them: points of surfaces fill little of the cells that planes
//! bound, and eight boxes are tested by the same few vector instructions as one.
//!
//! Distances are compared as squares in `f32`, computed as `(dx dx + dy dy) + dz dz`. The distance to a box is computed in the same
//! way, and each step rounds monotonically: it is at most the computed distance of any point within, exactly.
//!
//! J. L. Bentley, Multidimensional binary search trees used for associative searching, CACM 18(9), 1975.

mod batch;
mod bracket;
mod build;
mod candidates;
mod nodes;
mod search;
mod select;
mod simd;
#[cfg(test)]
mod tests;

use std::ops::Range;

pub use candidates::Nearest;
use nodes::{Leaf, Node, WIDTH};

use simd::Dispatch;

use crate::math::Vec3;

/// A balanced, implicit k-d tree over points.
#[derive(Clone, Debug, Default)]
pub struct KdTree {
    dispatch: Dispatch,
    /// The index of the point at each place.
    order: Vec<u32>,
    leaves: Vec<Leaf>,
    /// Level after level, from the parents of leaves up to the root.
    nodes: Vec<Node>,
    /// The least index of a point in each child of each node.
    first_indices: Vec<[u32; WIDTH]>,
    /// Where each level is in `nodes`.
    levels: Vec<Range<usize>>,
}

impl KdTree {
    /// The tree over `points`, which are finite and fewer than 2^32 - 1. It is built on the current pool of threads, and is the same
    /// for any number of them.
    pub fn build(points: &[Vec3]) -> Self {
        build::build(points)
    }

    /// The number of points.
    pub fn len(&self) -> usize {
        self.order.len()
    }

    /// Whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.order.is_empty()
    }

    /// The index of the point at each place, as the points were given: what belongs to points is best laid out in this order.
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// Finds the `k` points nearest to `p` among those that are at most `max_distance` away and whose place `accept` takes; fewer, if
    /// there are fewer. Of points equally far from `p` those with lower indices come first: what is found depends on the points
    /// and their indices alone.
    ///
    /// `max_distance` may be infinite. Distances whose square overflows count as too far. None is found if `max_distance` is
    /// negative or no number.
    ///
    /// `accept` is asked at most once about a place if `found` was new, else at most twice.
    #[inline]
    pub fn nearest(&self, p: Vec3, k: usize, max_distance: f32, accept: impl Fn(u32) -> bool, found: &mut Nearest) {
        self.dispatch.run(search::NearestSearch {
            tree: self,
            p,
            k,
            max_distance,
            accept,
            found,
        });
    }

    /// Calls `visit` with place and squared distance of each point at most `radius` away from `p`, in the order of places.
    #[inline]
    pub fn within(&self, p: Vec3, radius: f32, visit: impl FnMut(u32, f32)) {
        self.dispatch.run(search::WithinSearch {
            tree: self,
            p,
            radius,
            visit,
        });
    }

    /// [`nearest`](Self::nearest) for many points, in an order that is good for the cache: neighbours one after the other. `accept`
    /// and `each` are given the index of the query first; `each` is called once for every query with what it found.
    pub fn nearest_batch(
        &self,
        queries: &[Vec3],
        k: usize,
        max_distance: f32,
        accept: impl Fn(usize, u32) -> bool,
        found: &mut Nearest,
        mut each: impl FnMut(usize, &Nearest),
    ) {
        for query in batch::along_curve(queries) {
            self.nearest(queries[query], k, max_distance, |place| accept(query, place), found);
            each(query, found);
        }
    }
}
