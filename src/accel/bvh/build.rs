//! A binary tree by the binned surface area heuristic (Wald 2007, "On fast Construction of SAH-based Bounding Volume
//! Hierarchies"), in parallel. The tree is a function of the items alone: minima, maxima and counts do not depend on the order
//! in which threads take them.

use std::ops::Range;

use super::bins::{self, Split};
use super::leaf::LANES;
use crate::math::{Bounds3, Vec3};

/// Something to be put into a tree.
#[derive(Clone, Copy, Debug)]
pub struct Item {
    /// A box around it.
    pub bounds: Bounds3,
    /// What it is, to the caller.
    pub index: u32,
}

impl Item {
    /// The middle of its box; zero along axes where that is infinite.
    #[inline]
    pub fn center(&self) -> Vec3 {
        let c = self.bounds.min * 0.5 + self.bounds.max * 0.5;
        if c.is_finite() {
            c
        } else {
            Vec3::select(c.abs().cmplt(Vec3::INFINITY), c, Vec3::ZERO)
        }
    }
}

/// How to build.
#[derive(Clone, Copy, Debug)]
pub struct BuildParams {
    /// Bins along an axis, at most [`bins::MOST`].
    pub bins: usize,
    /// Items of lesser index are triangles and may share a leaf, as many as a block holds; others have one to themselves.
    pub triangles: u32,
}

/// A binary tree.
#[derive(Debug)]
pub struct Binary {
    /// A box around all of it.
    pub bounds: Bounds3,
    /// What is in it.
    pub content: Content,
}

/// What a binary tree holds.
#[derive(Debug)]
pub enum Content {
    /// These of the items, which the build has reordered.
    Leaf(Range<usize>),
    /// Two trees.
    Inner(Box<[Binary; 2]>),
}

/// Levels of a binary tree. Where splits by the heuristic threaten to need more, items are halved by number, which needs no
/// more than 32.
pub const MOST_LEVELS: u32 = 64;

/// Below this many items a task is not worth its overhead.
const LEAST_PARALLEL: usize = 4096;

/// Builds a tree over `items`, of which there is at least one.
pub fn build(items: &mut [Item], params: &BuildParams) -> Binary {
    build_range(items, 0, 0, params)
}

fn build_range(items: &mut [Item], first: usize, level: u32, params: &BuildParams) -> Binary {
    let (bounds, centers) = bins::bounds_of(items);
    if is_leaf(items, params) {
        return Binary {
            bounds,
            content: Content::Leaf(first..first + items.len()),
        };
    }
    let middle = divide(items, &centers, level, params);
    let (left, right) = items.split_at_mut(middle);
    let parallel = left.len() + right.len() > LEAST_PARALLEL;
    let mut build_left = || build_range(left, first, level + 1, params);
    let mut build_right = || build_range(right, first + middle, level + 1, params);
    let (left, right) = if parallel {
        rayon::join(build_left, build_right)
    } else {
        (build_left(), build_right())
    };
    Binary {
        bounds,
        content: Content::Inner(Box::new([left, right])),
    }
}

fn is_leaf(items: &[Item], params: &BuildParams) -> bool {
    items.len() <= 1 || (items.len() <= LANES && items.iter().all(|item| item.index < params.triangles))
}

/// Reorders items into two sets that are not empty and returns the size of the first.
fn divide(items: &mut [Item], centers: &Bounds3, level: u32, params: &BuildParams) -> usize {
    let halving_levels = usize::BITS - items.len().leading_zeros();
    if level + halving_levels < MOST_LEVELS
        && let Some(split) = bins::best_split(items, centers, params.bins)
    {
        let middle = partition(items, &split);
        if middle > 0 && middle < items.len() {
            return middle;
        }
    }
    halve(items, centers)
}

/// Moves the items of the split's lower side to the front and returns how many they are.
fn partition(items: &mut [Item], split: &Split) -> usize {
    let (mut low, mut high) = (0, items.len());
    while low < high {
        if split.is_below(&items[low]) {
            low += 1;
        } else {
            high -= 1;
            items.swap(low, high);
        }
    }
    low
}

/// Divides by number, along the axis of greatest extent.
fn halve(items: &mut [Item], centers: &Bounds3) -> usize {
    let axis = centers.extent().max_position();
    let middle = items.len() / 2;
    items.select_nth_unstable_by(middle, |a, b| {
        let by_center = a.center()[axis].total_cmp(&b.center()[axis]);
        by_center.then(a.index.cmp(&b.index))
    });
    middle
}

#[cfg(test)]
mod tests {
    use super::*;

    fn levels(tree: &Binary) -> u32 {
        match &tree.content {
            Content::Leaf(_) => 1,
            Content::Inner(children) => 1 + levels(&children[0]).max(levels(&children[1])),
        }
    }

    fn leaves(tree: &Binary, out: &mut Vec<Range<usize>>) {
        match &tree.content {
            Content::Leaf(range) => out.push(range.clone()),
            Content::Inner(children) => children.iter().for_each(|child| leaves(child, out)),
        }
    }

    fn check(mut items: Vec<Item>) -> Binary {
        let count = items.len();
        let params = BuildParams {
            bins: 16,
            triangles: u32::MAX,
        };
        let tree = build(&mut items, &params);
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
        let mut seen: Vec<u32> = items.iter().map(|item| item.index).collect();
        seen.sort_unstable();
        assert!(seen.iter().enumerate().all(|(i, &index)| i as u32 == index));
        tree
    }

    fn item(index: usize, min: Vec3, max: Vec3) -> Item {
        Item {
            bounds: Bounds3 { min, max },
            index: index as u32,
        }
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
