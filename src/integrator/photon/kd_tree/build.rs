//! Builds a tree.

use rayon::prelude::*;

use super::KdTree;
use super::nodes::{LEAF, Leaf, Node, WIDTH};
use super::select::{self, Item};
use super::simd::Dispatch;
use crate::math::{Vec3, Vec4};

/// So many points are split by one thread.
const SEQUENTIAL: usize = 1 << 12;

/// What a parent has to know of a leaf or a node.
struct Summary {
    min: [f32; 3],
    max: [f32; 3],
    first_index: u32,
}

pub fn build(points: &[Vec3]) -> KdTree {
    // Adding zero makes zeros positive.
    let item = |(p, index): (&Vec3, u32)| Item((*p + Vec3::ZERO).extend(f32::from_bits(index)));
    let mut items: Vec<_> = points.par_iter().zip(0..u32::MAX).map(item).collect();
    split(&mut items);
    let (mut leaves, mut summaries) = (Vec::new(), Vec::new());
    let of_leaf = |items: &[Item]| (leaf(items), summary(items));
    items
        .par_chunks(LEAF)
        .map(of_leaf)
        .unzip_into_vecs(&mut leaves, &mut summaries);
    let (mut nodes, mut first_indices, mut levels) = (Vec::new(), Vec::new(), Vec::new());
    while !summaries.is_empty() {
        let start = nodes.len();
        let (level, firsts): (Vec<_>, Vec<_>) = summaries.par_chunks(WIDTH).map(node).unzip();
        summaries = if level.len() > 1 {
            level.par_iter().zip(&firsts).map(summary_of_node).collect()
        } else {
            Vec::new()
        };
        nodes.extend(level);
        first_indices.extend(firsts);
        levels.push(start..nodes.len());
    }
    KdTree {
        dispatch: Dispatch::default(),
        order: items.par_iter().map(Item::index).collect(),
        leaves,
        nodes,
        first_indices,
        levels,
    }
}

/// Puts items in the order of their places. They are ordered by coordinate and index, so that where a split puts them does not depend
/// on how they lay, and equal points stay in the order of their indices.
fn split(items: &mut [Item]) {
    if items.len() <= LEAF {
        return;
    }
    let left = items.len().div_ceil(LEAF).next_power_of_two() / 2 * LEAF;
    match widest_axis(items) {
        0 => select::least_first::<0>(items, left),
        1 => select::least_first::<1>(items, left),
        _ => select::least_first::<2>(items, left),
    }
    let (left, right) = items.split_at_mut(left);
    if right.len() > SEQUENTIAL {
        rayon::join(|| split(left), || split(right));
    } else {
        split(left);
        split(right);
    }
}

fn widest_axis(items: &[Item]) -> usize {
    let (min, max) = bounds(items);
    let extent = [0, 1, 2].map(|axis| max[axis] - min[axis]);
    if extent[0] >= extent[1] && extent[0] >= extent[2] {
        0
    } else if extent[1] >= extent[2] {
        1
    } else {
        2
    }
}

/// The box of points. Four are made side by side, so that none waits for the last.
fn bounds(items: &[Item]) -> (Vec4, Vec4) {
    let (mut min, mut max) = ([Vec4::INFINITY; 4], [Vec4::NEG_INFINITY; 4]);
    let (chunks, rest) = items.as_chunks::<4>();
    for chunk in chunks {
        for i in 0..4 {
            min[i] = min[i].min(chunk[i].0);
            max[i] = max[i].max(chunk[i].0);
        }
    }
    for item in rest {
        min[0] = min[0].min(item.0);
        max[0] = max[0].max(item.0);
    }
    (
        min[0].min(min[1]).min(min[2].min(min[3])),
        max[0].max(max[1]).max(max[2].max(max[3])),
    )
}

fn summary(items: &[Item]) -> Summary {
    let (min, max) = bounds(items);
    let first_index = items.iter().fold(u32::MAX, |first, item| first.min(item.index()));
    Summary {
        min: min.truncate().to_array(),
        max: max.truncate().to_array(),
        first_index,
    }
}

fn leaf(items: &[Item]) -> Leaf {
    let mut leaf = Leaf::EMPTY;
    for (lane, item) in items.iter().enumerate() {
        for axis in 0..3 {
            leaf.0[axis].as_flattened_mut()[lane] = item.0[axis];
        }
    }
    leaf
}

fn node(children: &[Summary]) -> (Node, [u32; WIDTH]) {
    let (mut node, mut first_indices) = (Node::EMPTY, [u32::MAX; WIDTH]);
    for (lane, child) in children.iter().enumerate() {
        for axis in 0..3 {
            node.min[axis][lane] = child.min[axis];
            node.max[axis][lane] = child.max[axis];
        }
        first_indices[lane] = child.first_index;
    }
    (node, first_indices)
}

fn summary_of_node((node, first_indices): (&Node, &[u32; WIDTH])) -> Summary {
    let (min, max) = node.bounds();
    Summary {
        min,
        max,
        first_index: first_indices.iter().copied().fold(u32::MAX, u32::min),
    }
}
