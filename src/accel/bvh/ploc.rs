//! A binary tree in little time: parallel locally-ordered clustering (Meister and Bittner 2018, "Parallel Locally-Ordered Clustering for
//! Bounding Volume Hierarchy Construction").
//!
//! Items are sorted along a Morton curve, and those that are in one cell of the curve, up to a block of them, make a leaf, as in a linear
//! BVH (Lauterbach et al. 2009, "Fast BVH Construction on GPUs"). Each cluster (at first each leaf) looks for the neighbour on the curve with which it
//! shares the box of least area; two that find each other become one, until one is left. The tree is a function of the items alone.

use std::ops::Range;

use rayon::prelude::*;

use super::bins::extent_of;
use super::build::{Binary, LEAST_PARALLEL, Leaf, MOST_LEVELS, is_leaf};
use super::item::{Box4, Extent, Item};
use crate::math::{Bounds3, Vec3};

/// How far along the curve a cluster looks, to either side.
const RADIUS: usize = 8;

/// Clusters that one task takes at a time.
const CHUNK: usize = 4096;

/// Rounds after which it is given up: of usual clusters two thirds are left after each.
const MOST_ROUNDS: usize = 200;

#[derive(Clone, Copy)]
struct Cluster {
    bounds: Box4,
    /// A place among the leaves, or, from their number on, among the pairs.
    node: u32,
}

/// Two clusters that became one.
#[derive(Clone, Copy)]
struct Pair {
    bounds: Box4,
    children: [u32; 2],
    leaves: u32,
    levels: u32,
}

/// Builds a tree over `items`, of which there is at least one, and puts them into another order. `None` if the tree would be too deep, or
/// take too long, for boxes of unusual sizes. With a box around all. Of `triangles` see [`BuildParams`](super::build::BuildParams).
pub fn build(items: &mut Vec<Item>, triangles: u32) -> Option<(Binary, Bounds3)> {
    let codes = sort(items);
    let mut leaves = Vec::with_capacity(items.len() / 2);
    divide(items, &codes, 0..items.len(), triangles, &mut leaves);
    drop(codes);
    let mut clusters: Vec<Cluster> = leaves
        .iter()
        .enumerate()
        .map(|(place, leaf)| Cluster {
            bounds: bounds_of(items, *leaf),
            node: place as u32,
        })
        .collect();
    let mut tree = Tree {
        leaves,
        pairs: Vec::with_capacity(clusters.len()),
    };
    let mut rounds = 0;
    while clusters.len() > 1 {
        let nearest = nearest(&clusters);
        clusters = tree.merge(&clusters, &nearest);
        rounds += 1;
        if rounds > MOST_ROUNDS {
            return None;
        }
    }
    let Cluster { bounds, node: root } = *clusters.first()?;
    (tree.levels(root) <= MOST_LEVELS).then(|| (tree.binary(root), bounds.bounds()))
}

fn bounds_of(items: &[Item], leaf: Leaf) -> Box4 {
    let boxes = items[leaf.range()].iter().map(Item::box4);
    boxes.fold(Box4::EMPTY, Box4::union)
}

/// Sorts items along a Morton curve through the box of their centres, and returns their codes.
fn sort(items: &mut Vec<Item>) -> Vec<u64> {
    let extent: Extent = extent_of(items);
    let cells = (1u32 << 21) as f32 * (1.0 - f32::EPSILON) / extent.spread();
    let scale = Vec3::select(cells.cmplt(Vec3::INFINITY), cells, Vec3::ZERO);
    let low = extent.centers.low.truncate();
    let mut keys: Vec<(u64, u32)> = items
        .par_iter()
        .enumerate()
        .map(|(place, item)| {
            let cell = (item.center().truncate() - low) * scale;
            (morton([cell.x, cell.y, cell.z].map(|x| x as u64)), place as u32)
        })
        .collect();
    keys.par_sort_unstable();
    *items = keys.par_iter().map(|&(_, place)| items[place as usize]).collect();
    keys.into_iter().map(|(code, _)| code).collect()
}

/// Divides a range of sorted items where their codes first differ, or in the middle if they do not, down to leaves.
fn divide(items: &[Item], codes: &[u64], range: Range<usize>, triangles: u32, leaves: &mut Vec<Leaf>) {
    if is_leaf(&items[range.clone()], triangles) {
        leaves.push(Leaf {
            first: range.start as u32,
            count: range.len() as u32,
        });
        return;
    }
    let (first, last) = (codes[range.start], codes[range.end - 1]);
    let middle = if first == last {
        range.start + range.len() / 2
    } else {
        // All codes from the first with the highest bit in which they differ.
        let bit = 63 - (first ^ last).leading_zeros();
        let border = last >> bit << bit;
        range.start + codes[range.clone()].partition_point(|&code| code < border)
    };
    divide(items, codes, range.start..middle, triangles, leaves);
    divide(items, codes, middle..range.end, triangles, leaves);
}

/// Interleaves the lowest 21 bits of three numbers.
fn morton(cell: [u64; 3]) -> u64 {
    let spread = |x: u64| {
        let mut x = x & 0x1f_ffff;
        x = (x | x << 32) & 0x001f_0000_0000_ffff;
        x = (x | x << 16) & 0x001f_0000_ff00_00ff;
        x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
        x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
        (x | x << 2) & 0x1249_2492_4924_9249
    };
    spread(cell[0]) | spread(cell[1]) << 1 | spread(cell[2]) << 2
}

/// Half the area of the box around two, in single precision; what overflows, or is nothing times infinity, is infinite.
#[inline]
fn distance(a: &Box4, b: &Box4) -> f32 {
    let both = a.union(*b);
    let d = both.high - both.low;
    let area = d.x * d.y + d.y * d.z + d.z * d.x;
    if area < f32::INFINITY { area } else { f32::INFINITY }
}

/// Of each cluster, the place of the one it would be put together with.
///
/// Where distances are equal, the one whose place differs from its own in the lower bits: so identical boxes find each other in pairs.
fn nearest(clusters: &[Cluster]) -> Vec<u32> {
    let of_chunk = |first: usize| {
        let last = (first + CHUNK).min(clusters.len());
        // Distances to the clusters behind, which these have to those before.
        let from = first.saturating_sub(RADIUS);
        let mut best = [(f32::INFINITY, usize::MAX, 0); CHUNK + RADIUS];
        for i in from..last {
            for j in i + 1..(i + 1 + RADIUS).min(clusters.len()) {
                let key = (distance(&clusters[i].bounds, &clusters[j].bounds), i ^ j);
                for (me, other) in [(i, j), (j, i)] {
                    if let Some(best) = best.get_mut(me - from)
                        && (key.0 < best.0 || (key.0 == best.0 && key.1 < best.1))
                    {
                        *best = (key.0, key.1, other as u32);
                    }
                }
            }
        }
        best[first - from..last - from]
            .iter()
            .map(|best| best.2)
            .collect::<Vec<_>>()
    };
    let chunks: Vec<Vec<u32>> = (0..clusters.len())
        .into_par_iter()
        .step_by(CHUNK)
        .map(of_chunk)
        .collect();
    chunks.concat()
}

struct Tree {
    leaves: Vec<Leaf>,
    pairs: Vec<Pair>,
}

impl Tree {
    fn pair(&self, node: u32) -> Option<&Pair> {
        (node as usize)
            .checked_sub(self.leaves.len())
            .map(|place| &self.pairs[place])
    }

    fn levels(&self, node: u32) -> u32 {
        self.pair(node).map_or(1, |pair| pair.levels)
    }

    fn leaves(&self, node: u32) -> u32 {
        self.pair(node).map_or(1, |pair| pair.leaves)
    }

    /// Puts clusters together that found each other; the others stay.
    fn merge(&mut self, clusters: &[Cluster], nearest: &[u32]) -> Vec<Cluster> {
        let mut next = Vec::with_capacity(clusters.len());
        for (i, cluster) in clusters.iter().enumerate() {
            let other = nearest[i] as usize;
            if nearest[other] as usize != i {
                next.push(*cluster);
            } else if i < other {
                let bounds = cluster.bounds.union(clusters[other].bounds);
                let children = [cluster.node, clusters[other].node];
                next.push(Cluster {
                    bounds,
                    node: (self.leaves.len() + self.pairs.len()) as u32,
                });
                self.pairs.push(Pair {
                    bounds,
                    children,
                    leaves: children.iter().map(|&child| self.leaves(child)).sum(),
                    levels: 1 + children.iter().map(|&child| self.levels(child)).fold(0, u32::max),
                });
            }
        }
        next
    }

    /// The tree below a node.
    fn binary(&self, node: u32) -> Binary {
        let Some(pair) = self.pair(node) else {
            return Binary::Leaf(self.leaves[node as usize]);
        };
        let [left, right] = pair.children;
        let children = if pair.leaves as usize > LEAST_PARALLEL {
            rayon::join(|| self.binary(left), || self.binary(right))
        } else {
            (self.binary(left), self.binary(right))
        };
        Binary::Inner {
            half_area: pair.bounds.half_area(),
            children: Box::new(children.into()),
        }
    }
}
