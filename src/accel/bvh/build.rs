//! A binary tree by the binned surface area heuristic (Wald 2007, "On fast Construction of SAH-based Bounding Volume
//! Hierarchies"), with spatial splits where they are asked for, in parallel. The tree is a function of the items alone: minima, maxima and
//! counts do not depend on the order in which threads take them, and how many fragments a subtree may add is decided above it.

use std::ops::Range;

use rayon::prelude::*;

use super::bins::{self, Split};
use super::item::{Box4, Extent, Item};
use super::leaf::LANES;
use super::pages::vec_in_large_pages;
use super::primitives::Primitives;
use super::spatial::{self, Plane};

/// A node of a binary tree, which is a list of them: what is below a node precedes it, that of its first child, then that of its second;
/// the root is the last. Parts of it can be joined as they are.
#[derive(Clone, Copy, Debug)]
pub enum BinaryNode {
    /// Some of the items, which the build has reordered.
    Leaf(Leaf),
    /// Two trees, of which the second's root is just before.
    Inner {
        /// Half of the area of the box around both.
        half_area: f64,
        /// How far before the first's root is.
        back: u32,
    },
}

const _: () = assert!(size_of::<BinaryNode>() == 16);

/// Items one after another.
#[derive(Clone, Copy, Debug)]
pub struct Leaf {
    /// The first. There are fewer than 2^32, room for fragments included: memory has no place for more.
    pub first: u32,
    /// How many.
    pub count: u32,
}

impl Leaf {
    /// Where they are among all items.
    pub fn range(self) -> Range<usize> {
        self.first as usize..self.first as usize + self.count as usize
    }
}

/// Levels of a binary tree. Where splits by the heuristic threaten to need more, items are halved by number, which needs no
/// more than 32.
pub const MOST_LEVELS: u32 = 64;

/// Below this many items a task is not worth its overhead.
pub const LEAST_PARALLEL: usize = 4096;

/// Fragments that spatial splits may add, as a part of all triangles.
const MOST_FRAGMENTS: f64 = 0.3;

/// How to build.
#[derive(Clone, Copy, Debug)]
pub struct BuildParams {
    /// Bins along an axis, at most [`bins::MOST`].
    pub bins: usize,
    /// Whether triangles may be split.
    pub splits: bool,
}

/// A tree, and what is in its leaves.
pub struct Built {
    /// The tree.
    pub tree: Vec<BinaryNode>,
    /// Items in the order of its leaves, with gaps between those of different leaves if triangles were split.
    pub items: Vec<Item>,
}

/// Builds a tree over primitives, of which there is at least one.
pub fn build(primitives: &impl Primitives, params: BuildParams) -> Built {
    let census = primitives.census();
    let count = census.count();
    let room = if params.splits {
        (f64::from(census.triangles) * MOST_FRAGMENTS) as usize
    } else {
        0
    };
    let mut items = vec_in_large_pages(count + room);
    (0..count as u32)
        .into_par_iter()
        .map(|index| Item::new(&primitives.bounds(index), index))
        .collect_into_vec(&mut items);
    let extent = bins::extent_of(&items);
    items.resize(count + room, items[0]);
    let builder = Builder {
        primitives,
        params,
        triangles: census.triangles,
        least_overlap: extent.bounds.half_area() * spatial::LEAST_OVERLAP,
    };
    let mut tree = Vec::new();
    builder.range(&mut items, Place { first: 0, level: 0 }, count, extent, &mut tree);
    Built { tree, items }
}

struct Builder<'a, P> {
    primitives: &'a P,
    params: BuildParams,
    triangles: u32,
    least_overlap: f32,
}

/// Where a range of items is among all, and how deep in the tree.
#[derive(Clone, Copy)]
struct Place {
    first: usize,
    level: u32,
}

/// Items divided: those of the lower side are first in the range, those of the other at its end, and both have room behind them.
struct Divided {
    /// How many, by side.
    counts: [usize; 2],
    extents: [Extent; 2],
    /// Where the part of the other side begins.
    middle: usize,
}

impl<P: Primitives> Builder<'_, P> {
    /// Adds a tree over the first `count` items of a range; the rest of it is room for fragments.
    fn range(&self, items: &mut [Item], place: Place, count: usize, extent: Extent, tree: &mut Vec<BinaryNode>) {
        if is_leaf(&items[..count], self.triangles) {
            tree.push(BinaryNode::Leaf(Leaf {
                first: place.first as u32,
                count: count as u32,
            }));
            return;
        }
        let Divided {
            counts,
            extents,
            middle,
        } = self.divide(items, place.level, count, &extent);
        let (left, right) = items.split_at_mut(middle);
        let at = |first| Place {
            first,
            level: place.level + 1,
        };
        let build_left = |tree: &mut _| self.range(left, at(place.first), counts[0], extents[0], tree);
        let build_right = |tree: &mut _| self.range(right, at(place.first + middle), counts[1], extents[1], tree);
        let half_area = f64::from(extent.bounds.half_area());
        join(count > LEAST_PARALLEL, half_area, tree, build_left, build_right);
    }

    /// Reorders items into two sets that are not empty.
    fn divide(&self, items: &mut [Item], level: u32, count: usize, extent: &Extent) -> Divided {
        let halving_levels = usize::BITS - items.len().leading_zeros();
        if level + halving_levels < MOST_LEVELS {
            let split = bins::best_split(&items[..count], extent, self.params.bins);
            if self.params.splits
                && let Some(divided) = self.divide_by_plane(items, count, extent, split.as_ref())
            {
                return divided;
            }
            if let Some(split) = split {
                let (middle, extents) = partition(&mut items[..count], &split);
                return with_room(items, [middle, count - middle], extents);
            }
        }
        let middle = halve(&mut items[..count], extent);
        let extents = [&items[..middle], &items[middle..count]].map(bins::extent_of);
        with_room(items, [middle, count - middle], extents)
    }

    /// A spatial split, if one is worth it.
    fn divide_by_plane(
        &self,
        items: &mut [Item],
        count: usize,
        extent: &Extent,
        split: Option<&Split>,
    ) -> Option<Divided> {
        let room = items.len() - count;
        let least_overlap = self.least_overlap.max(extent.bounds.half_area() * spatial::LEAST_SHARE);
        if room == 0 || count <= LANES || split.is_some_and(|split| split.overlap() <= least_overlap) {
            return None;
        }
        let plane: Plane = spatial::best_plane(&items[..count], extent, self.primitives)?;
        if plane.both == 0 || split.is_some_and(|split| split.cost <= plane.cost) {
            return None;
        }
        let sides = spatial::divide(&items[..count], &plane, self.primitives, room);
        let counts = [sides[0].len(), sides[1].len()];
        if counts.contains(&0) || counts.contains(&count) {
            return None;
        }
        let middle = middle_of(items.len(), counts);
        items[..counts[0]].copy_from_slice(&sides[0]);
        items[middle..middle + counts[1]].copy_from_slice(&sides[1]);
        Some(Divided {
            counts,
            extents: [&sides[0], &sides[1]].map(|side| bins::extent_of(side)),
            middle,
        })
    }
}

/// Adds a node to a tree, and what two builders add below it, in parallel or one after the other.
fn join(
    is_parallel: bool,
    half_area: f64,
    tree: &mut Vec<BinaryNode>,
    left: impl FnOnce(&mut Vec<BinaryNode>) + Send,
    right: impl FnOnce(&mut Vec<BinaryNode>) + Send,
) {
    let second = if is_parallel {
        let mut other = Vec::new();
        rayon::join(|| left(tree), || right(&mut other));
        let first = tree.len();
        tree.append(&mut other);
        tree.len() - first
    } else {
        left(tree);
        let first = tree.len();
        right(tree);
        tree.len() - first
    };
    // There are fewer than two nodes for each item.
    let back = second as u32 + 1;
    tree.push(BinaryNode::Inner { half_area, back });
}

/// Where the second part of a range begins that has so many items: room is shared by number.
fn middle_of(length: usize, [left, right]: [usize; 2]) -> usize {
    let room = (length - left - right) as u128;
    left + (room * left as u128 / (left + right) as u128) as usize
}

/// Items that are in order, one side behind the other, with room behind both.
fn with_room(items: &mut [Item], counts: [usize; 2], extents: [Extent; 2]) -> Divided {
    let middle = middle_of(items.len(), counts);
    items.copy_within(counts[0]..counts[0] + counts[1], middle);
    Divided {
        counts,
        extents,
        middle,
    }
}

/// Whether items may share a leaf.
fn is_leaf(items: &[Item], triangles: u32) -> bool {
    items.len() <= 1 || (items.len() <= LANES && items.iter().all(|item| item.index() < triangles))
}

/// Moves the items of the split's lower side to the front and returns how many they are, with the extents of both sides.
fn partition(items: &mut [Item], split: &Split) -> (usize, [Extent; 2]) {
    let mut centers = [Box4::EMPTY; 2];
    let mut low = 0;
    // Which side an item is on cannot be foreseen, so that nothing here branches on it.
    for place in 0..items.len() {
        let item = items[place];
        let center = item.twice_center();
        let is_below = split.is_below(center);
        items[place] = items[low];
        items[low] = item;
        low += usize::from(is_below);
        let centers = &mut centers[usize::from(!is_below)];
        *centers = centers.grow(center);
    }
    let extent = |side: usize| Extent {
        bounds: split.bounds[side],
        centers: centers[side],
    };
    (low, [extent(0), extent(1)])
}

/// Divides by number, along the axis of greatest extent.
fn halve(items: &mut [Item], extent: &Extent) -> usize {
    let axis = extent.spread().max_position();
    let middle = items.len() / 2;
    items.select_nth_unstable_by(middle, |a, b| {
        let by_center = a.twice_center()[axis].total_cmp(&b.twice_center()[axis]);
        by_center.then(a.index().cmp(&b.index()))
    });
    middle
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accel::bvh::primitives::tests::Boxes;
    use crate::math::Vec3;

    fn levels(tree: &[BinaryNode], root: usize) -> u32 {
        match tree[root] {
            BinaryNode::Leaf(_) => 1,
            BinaryNode::Inner { back, .. } => 1 + levels(tree, root - back as usize).max(levels(tree, root - 1)),
        }
    }

    fn check(boxes: impl IntoIterator<Item = [Vec3; 2]>) {
        let boxes = Boxes::new(boxes);
        let count = boxes.census().count();
        let params = BuildParams {
            bins: 16,
            splits: false,
        };
        let Built { tree, items } = build(&boxes, params);
        let levels = levels(&tree, tree.len() - 1);
        assert!(levels <= MOST_LEVELS, "{levels} levels");
        let mut next = 0;
        for node in &tree {
            let BinaryNode::Leaf(leaf) = node else { continue };
            let range = leaf.range();
            assert_eq!(range.start, next);
            assert!((1..=LANES).contains(&range.len()));
            next = range.end;
        }
        assert_eq!(next, count);
        let mut seen: Vec<u32> = items.iter().map(Item::index).collect();
        seen.sort_unstable();
        assert!(seen.iter().enumerate().all(|(i, &index)| i as u32 == index));
    }

    #[test]
    fn identical_infinite_and_geometrically_spaced_boxes_keep_the_tree_shallow() {
        check((0..100_000).map(|_| [Vec3::ZERO, Vec3::ONE]));
        check((0..1000).map(|_| [Vec3::NEG_INFINITY, Vec3::INFINITY]));
        check((0..1000).map(|_| [Vec3::splat(-f32::MAX), Vec3::splat(f32::MAX)]));
        let spaced = |i: usize| Vec3::splat(2.0_f32.powi(i as i32 % 250 - 125)) * Vec3::new(1.0, -1.0, 0.5);
        check((0..2000).map(|i| [spaced(i); 2]));
    }

    #[test]
    fn every_count_is_built() {
        for count in 1..70 {
            let place = |i: usize| Vec3::new((i * 7 % 13) as f32, (i * 5 % 11) as f32, i as f32);
            check((0..count).map(|i| [place(i), place(i) + 1.0]));
        }
    }
}
