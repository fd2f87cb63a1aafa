//! Builds a tree.

use rayon::prelude::*;

use super::KdTree;
use super::nodes::{LEAF, Leaf, Node, WIDTH};
use crate::math::{Vec3, Vectorizer};

/// So many points are split by one thread.
const SEQUENTIAL: usize = 1 << 12;

/// A point on its way to its place.
#[derive(Clone, Copy, Debug)]
struct Item {
    p: [f32; 3],
    index: u32,
}

/// What a parent has to know of a leaf or a node.
struct Summary {
    min: [f32; 3],
    max: [f32; 3],
    first_index: u32,
}

pub fn build(points: &[Vec3]) -> KdTree {
    // Adding zero makes zeros positive.
    let item = |(p, index): (&Vec3, u32)| Item {
        p: (*p + Vec3::ZERO).to_array(),
        index,
    };
    let mut items: Vec<_> = points.par_iter().zip(0..u32::MAX).map(item).collect();
    split(&mut items);
    let leaves = items.par_chunks(LEAF).map(leaf).collect();
    let mut summaries: Vec<_> = items.par_chunks(LEAF).map(summary).collect();
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
        vectorizer: Vectorizer::default(),
        order: items.par_iter().map(|item| item.index).collect(),
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
    let axis = widest_axis(items);
    items.select_nth_unstable_by_key(left, |item| {
        (u64::from(sortable(item.p[axis])) << 32) | u64::from(item.index)
    });
    let (left, right) = items.split_at_mut(left);
    if right.len() > SEQUENTIAL {
        rayon::join(|| split(left), || split(right));
    } else {
        split(left);
        split(right);
    }
}

/// Bits that are ordered as the numbers are.
fn sortable(x: f32) -> u32 {
    let bits = x.to_bits();
    bits ^ (((bits as i32 >> 31) as u32) | 0x8000_0000)
}

fn widest_axis(items: &[Item]) -> usize {
    let Summary { min, max, .. } = summary(items);
    let extent = [0, 1, 2].map(|axis| max[axis] - min[axis]);
    if extent[0] >= extent[1] && extent[0] >= extent[2] {
        0
    } else if extent[1] >= extent[2] {
        1
    } else {
        2
    }
}

fn summary(items: &[Item]) -> Summary {
    let mut all = Summary::EMPTY;
    for item in items {
        all.add(&Summary {
            min: item.p,
            max: item.p,
            first_index: item.index,
        });
    }
    all
}

fn leaf(items: &[Item]) -> Leaf {
    let mut leaf = Leaf::EMPTY;
    for (lane, item) in items.iter().enumerate() {
        for axis in 0..3 {
            leaf.0[axis][lane] = item.p[axis];
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

impl Summary {
    const EMPTY: Self = Self {
        min: [f32::INFINITY; 3],
        max: [f32::NEG_INFINITY; 3],
        first_index: u32::MAX,
    };

    fn add(&mut self, other: &Self) {
        for axis in 0..3 {
            self.min[axis] = self.min[axis].min(other.min[axis]);
            self.max[axis] = self.max[axis].max(other.max[axis]);
        }
        self.first_index = self.first_index.min(other.first_index);
    }
}
