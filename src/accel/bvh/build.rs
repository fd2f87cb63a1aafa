//! A binary tree by the binned surface area heuristic (Wald 2007, "On fast Construction of SAH-based Bounding Volume
//! Hierarchies"), with spatial splits where they are asked for, in parallel. The tree is a function of the items alone: minima, maxima and
//! counts do not depend on the order in which threads take them, and how many fragments a subtree may add is decided above it.

use std::ops::Range;

use super::bins::{self, Split};
use super::item::{Extent, Item};
use super::leaf::LANES;
use super::spatial::{self, Corners, Plane};
use crate::math::Bounds3;

/// How to build.
#[derive(Clone, Copy)]
pub struct BuildParams<'a> {
    /// Bins along an axis, at most [`bins::MOST`].
    pub bins: usize,
    /// Items of lesser index are triangles and may share a leaf, as many as a block holds; others have one to themselves.
    pub triangles: u32,
    /// The corners of triangles, for spatial splits; `None` for none.
    pub corners: Option<&'a dyn Corners>,
}

/// A binary tree. There are about as many as triangles, while memory is scarcest: so it has no more than is asked for.
#[derive(Debug)]
pub enum Binary {
    /// Some of the items, which the build has reordered.
    Leaf(Leaf),
    /// Two trees.
    Inner {
        /// Half of the area of the box around both, without overflow.
        half_area: f64,
        /// Them.
        children: Box<[Binary; 2]>,
    },
}

const _: () = assert!(size_of::<Binary>() == 16);

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

/// Builds a tree over `items`, of which there is at least one; they may become more, with gaps between those of different leaves. With a
/// box around all.
pub fn build(items: &mut Vec<Item>, params: &BuildParams<'_>) -> (Binary, Bounds3) {
    let extent = bins::extent_of(items);
    let count = items.len();
    if params.corners.is_some() {
        let room = (f64::from(params.triangles) * MOST_FRAGMENTS) as usize;
        items.resize(count + room, items[0]);
    }
    let builder = Builder {
        params,
        least_overlap: extent.bounds.half_area() * spatial::LEAST_OVERLAP,
    };
    let tree = builder.range(items, Place { first: 0, level: 0 }, count, extent);
    (tree, extent.bounds.bounds())
}

struct Builder<'a> {
    params: &'a BuildParams<'a>,
    least_overlap: f64,
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

impl Builder<'_> {
    /// A tree over the first `count` items of a range; the rest of it is room for fragments.
    fn range(&self, items: &mut [Item], place: Place, count: usize, extent: Extent) -> Binary {
        if is_leaf(&items[..count], self.params.triangles) {
            return Binary::Leaf(Leaf {
                first: place.first as u32,
                count: count as u32,
            });
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
        let mut build_left = || self.range(left, at(place.first), counts[0], extents[0]);
        let mut build_right = || self.range(right, at(place.first + middle), counts[1], extents[1]);
        let (left, right) = if count > LEAST_PARALLEL {
            rayon::join(build_left, build_right)
        } else {
            (build_left(), build_right())
        };
        Binary::Inner {
            half_area: extent.bounds.half_area(),
            children: Box::new([left, right]),
        }
    }

    /// Reorders items into two sets that are not empty.
    fn divide(&self, items: &mut [Item], level: u32, count: usize, extent: &Extent) -> Divided {
        let halving_levels = usize::BITS - items.len().leading_zeros();
        if level + halving_levels < MOST_LEVELS {
            let split = bins::best_split(&items[..count], extent, self.params.bins);
            if let Some(divided) = self.divide_by_plane(items, count, extent, split.as_ref()) {
                return divided;
            }
            if let Some(split) = split {
                let (middle, extents) = partition(&mut items[..count], &split);
                if middle > 0 && middle < count {
                    return with_room(items, [middle, count - middle], extents);
                }
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
        let corners = self.params.corners?;
        let room = items.len() - count;
        let least_overlap = self.least_overlap.max(extent.bounds.half_area() * spatial::LEAST_SHARE);
        if room == 0 || count <= LANES || split.is_some_and(|split| split.overlap <= least_overlap) {
            return None;
        }
        let plane: Plane = spatial::best_plane(&items[..count], extent, corners)?;
        if plane.both == 0 || split.is_some_and(|split| split.cost <= plane.cost) {
            return None;
        }
        let sides = spatial::divide(&items[..count], &plane, corners, room);
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
pub fn is_leaf(items: &[Item], triangles: u32) -> bool {
    items.len() <= 1 || (items.len() <= LANES && items.iter().all(|item| item.index() < triangles))
}

/// Moves the items of the split's lower side to the front and returns how many they are, with the extents of both sides.
fn partition(items: &mut [Item], split: &Split) -> (usize, [Extent; 2]) {
    let (mut low, mut high) = (0, items.len());
    let mut extents = [Extent::EMPTY; 2];
    while low < high {
        if split.is_below(&items[low]) {
            extents[0] = extents[0].with(&items[low]);
            low += 1;
        } else {
            extents[1] = extents[1].with(&items[low]);
            high -= 1;
            items.swap(low, high);
        }
    }
    (low, extents)
}

/// Divides by number, along the axis of greatest extent.
fn halve(items: &mut [Item], extent: &Extent) -> usize {
    let axis = extent.spread().max_position();
    let middle = items.len() / 2;
    items.select_nth_unstable_by(middle, |a, b| {
        let by_center = a.center()[axis].total_cmp(&b.center()[axis]);
        by_center.then(a.index().cmp(&b.index()))
    });
    middle
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;

    fn levels(tree: &Binary) -> u32 {
        match tree {
            Binary::Leaf(_) => 1,
            Binary::Inner { children, .. } => 1 + levels(&children[0]).max(levels(&children[1])),
        }
    }

    fn leaves(tree: &Binary, out: &mut Vec<Range<usize>>) {
        match tree {
            Binary::Leaf(leaf) => out.push(leaf.range()),
            Binary::Inner { children, .. } => children.iter().for_each(|child| leaves(child, out)),
        }
    }

    fn check(mut items: Vec<Item>) -> Binary {
        let count = items.len();
        let params = BuildParams {
            bins: 16,
            triangles: u32::MAX,
            corners: None,
        };
        let (tree, _) = build(&mut items, &params);
        assert!(levels(&tree) <= MOST_LEVELS, "{} levels", levels(&tree));
        let mut ranges = Vec::new();
        leaves(&tree, &mut ranges);
        let mut next = 0;
        for range in ranges {
            assert_eq!(range.start, next);
            assert!((1..=LANES).contains(&range.len()));
            next = range.end;
        }
        assert_eq!(next, count);
        let mut seen: Vec<u32> = items.iter().map(Item::index).collect();
        seen.sort_unstable();
        assert!(seen.iter().enumerate().all(|(i, &index)| i as u32 == index));
        tree
    }

    fn item(index: usize, min: Vec3, max: Vec3) -> Item {
        Item::new(&Bounds3 { min, max }, index as u32)
    }

    #[test]
    fn identical_infinite_and_geometrically_spaced_boxes_keep_the_tree_shallow() {
        check((0..100_000).map(|i| item(i, Vec3::ZERO, Vec3::ONE)).collect());
        check((0..1000).map(|i| item(i, Vec3::NEG_INFINITY, Vec3::INFINITY)).collect());
        check(
            (0..1000)
                .map(|i| item(i, Vec3::splat(-f32::MAX), Vec3::splat(f32::MAX)))
                .collect(),
        );
        let spaced = |i: usize| Vec3::splat(2.0_f32.powi(i as i32 % 250 - 125)) * Vec3::new(1.0, -1.0, 0.5);
        check((0..2000).map(|i| item(i, spaced(i), spaced(i))).collect());
    }

    #[test]
    fn every_count_is_built() {
        for count in 1..70 {
            let place = |i: usize| Vec3::new((i * 7 % 13) as f32, (i * 5 % 11) as f32, i as f32);
            check((0..count).map(|i| item(i, place(i), place(i) + 1.0)).collect());
        }
    }
}
