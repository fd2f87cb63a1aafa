//! A tree in the least time: a linear BVH (Lauterbach et al. 2009, "Fast BVH Construction on GPUs") of eight children a node.
//!
//! Primitives are sorted along a Morton curve. A node's part of the curve is divided where the codes first differ, then that of its parts which
//! has the largest cell, until there are eight. Where all codes are the same the curve is drawn anew through the box of what is there, and where they
//! still are, by number. The tree is a function of the primitives alone.

use std::ops::Range;

use rayon::prelude::*;

use super::bins::TO_INTEGER;
use super::build::{Leaf, MOST_LEVELS};
use super::item::Box4;
use super::leaf::LANES;
use super::node::{Child, ChildRef, WIDTH};
use super::pages::vec_in_large_pages;
use super::primitives::{Census, Primitives};
use super::topology::Topology;
use crate::math::Vec3;

/// Primitives that one task takes at a time.
const CHUNK: usize = 32 * 1024;

/// Bits of codes by which keys are first dealt out.
const BUCKET_BITS: u32 = 11;

/// Cells along an axis, in bits, at most: as many as [`TO_INTEGER`] leaves room for, and a key.
const MOST_CELL_BITS: u32 = 21;

/// Of a primitive, its code along the curve above its number.
type Key = u64;

/// How keys are made of codes and numbers.
#[derive(Clone, Copy)]
struct Format {
    /// Bits of a number, as many as the largest needs.
    index_bits: u32,
    /// Cells along an axis, in bits: as many as there is place for.
    cell_bits: u32,
}

impl Format {
    fn new(count: usize) -> Self {
        let index_bits = usize::BITS - count.leading_zeros();
        Self {
            index_bits,
            cell_bits: ((Key::BITS - index_bits) / 3).min(MOST_CELL_BITS),
        }
    }

    #[inline]
    fn index(self, key: Key) -> u32 {
        (key & ((1 << self.index_bits) - 1)) as u32
    }

    #[inline]
    fn code(self, key: Key) -> u64 {
        key >> self.index_bits
    }
}

/// Builds a tree over primitives, of which there is at least one; with their numbers in the order of its leaves.
pub fn build(primitives: &impl Primitives) -> (Topology, Vec<u32>) {
    let census = primitives.census();
    let format = Format::new(census.count());
    let curve = Curve::through(Box4::within_reach(&primitives.bounds_of_all()), format);
    let mut keys = sorted(census.count() as u32, format, |index| curve.key(index, primitives));
    let builder = Builder {
        primitives,
        census,
        format,
    };
    let mut topology = Topology::default();
    builder.node(&mut keys, 0, Division::Curve, &mut topology);
    let mut order = vec_in_large_pages(keys.len());
    keys.par_iter()
        .map(|&key| format.index(key))
        .collect_into_vec(&mut order);
    (topology, order)
}

/// A Morton curve through a box.
struct Curve {
    /// The lower corner of the box, twice.
    low: Vec3,
    /// Cells a unit of length, halved.
    scale: Vec3,
    format: Format,
}

impl Curve {
    fn through(bounds: Box4, format: Format) -> Self {
        let cells = ((1 << format.cell_bits) - 1) as f32;
        let scale = 0.5 * cells / (bounds.high - bounds.low).truncate();
        Self {
            low: 2.0 * bounds.low.truncate(),
            // An axis without extent has all in its first cell.
            scale: Vec3::select(scale.cmplt(Vec3::INFINITY), scale, Vec3::ZERO),
            format,
        }
    }

    /// The key of a primitive. What is far outside of the box, as only boxes that were cut off are, is in any cell.
    #[inline]
    fn key(&self, index: u32, primitives: &impl Primitives) -> Key {
        let bounds = primitives.bounds(index);
        let cell = (bounds.min + bounds.max - self.low) * self.scale + TO_INTEGER;
        let mask = (1 << self.format.cell_bits) - 1;
        let along = |x: f32| spread(x.to_bits() & mask);
        let code = along(cell.x) | along(cell.y) << 1 | along(cell.z) << 2;
        code << self.format.index_bits | Key::from(index)
    }
}

/// Bits that are spread at a time.
const SPREAD_BITS: u32 = 11;

/// Numbers of eleven bits with two zeros between each.
const SPREAD: [u32; 1 << SPREAD_BITS] = {
    let mut table = [0; 1 << SPREAD_BITS];
    let mut x = 0;
    while x < table.len() {
        let mut bit = 0;
        while bit < SPREAD_BITS {
            table[x] |= ((x >> bit & 1) as u32) << (3 * bit);
            bit += 1;
        }
        x += 1;
    }
    table
};

/// Puts two zeros between the lowest 21 bits of a number.
#[inline]
fn spread(x: u32) -> u64 {
    let part = |index: u32| {
        let bits = x >> (SPREAD_BITS * index) & ((1 << SPREAD_BITS) - 1);
        u64::from(SPREAD[bits as usize]) << (3 * SPREAD_BITS * index)
    };
    part(0) | part(1)
}

/// Makes keys and sorts them: a chunk at a time they are dealt out by their highest bits, then each bucket is sorted.
fn sorted(count: u32, format: Format, key: impl Fn(u32) -> Key + Sync) -> Vec<Key> {
    let chunk = |chunk: usize| {
        let first = (chunk * CHUNK) as u32;
        (first..count.min(first.saturating_add(CHUNK as u32))).map(&key)
    };
    let chunks = (count as usize).div_ceil(CHUNK);
    if chunks == 1 {
        let mut keys: Vec<Key> = chunk(0).collect();
        keys.sort_unstable();
        return keys;
    }
    let shift = format.index_bits + 3 * format.cell_bits - BUCKET_BITS;
    let bucket = |key: Key| (key >> shift) as usize;
    // With where the buckets end.
    let deal = |index: usize| {
        let keys: Vec<Key> = chunk(index).collect();
        let mut next = vec![0; 1 << BUCKET_BITS];
        for &key in &keys {
            next[bucket(key)] += 1;
        }
        let mut first = 0;
        for next in &mut next {
            (*next, first) = (first, first + *next);
        }
        let mut dealt = vec![0; keys.len()];
        for &key in &keys {
            let next = &mut next[bucket(key)];
            dealt[*next as usize] = key;
            *next += 1;
        }
        (dealt, next)
    };
    let dealt: Vec<(Vec<Key>, Vec<u32>)> = (0..chunks).into_par_iter().map(deal).collect();
    let part = |bucket: usize| {
        dealt.iter().map(move |(keys, ends)| {
            let first = bucket.checked_sub(1).map_or(0, |before| ends[before]);
            &keys[first as usize..ends[bucket] as usize]
        })
    };
    let mut keys = vec_in_large_pages(count as usize);
    keys.resize(count as usize, 0);
    let mut rest = keys.as_mut_slice();
    let mut buckets = Vec::with_capacity(1 << BUCKET_BITS);
    for bucket in 0..1 << BUCKET_BITS {
        let (keys, others) = rest.split_at_mut(part(bucket).map(<[Key]>::len).sum());
        buckets.push(keys);
        rest = others;
    }
    buckets.into_par_iter().enumerate().for_each(|(bucket, keys)| {
        let mut rest = &mut *keys;
        for part in part(bucket) {
            let (place, others) = rest.split_at_mut(part.len());
            place.copy_from_slice(part);
            rest = others;
        }
        keys.sort_unstable();
    });
    keys
}

/// How keys are divided.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Division {
    /// By the curve through all.
    Curve,
    /// By one through them alone.
    OwnCurve,
    /// In halves.
    Number,
}

/// Levels of nodes, at most. Of a node's seven divisions none is of a smaller cell than what they leave whole, so that a node below another by the
/// same curve has a cell of at most an eighth of its size, and one by number an eighth of its keys. There are two curves, and where one
/// way of dividing follows another a node may have but few keys less than the one above it.
const MOST_NODE_LEVELS: u32 = 2 * MOST_CELL_BITS + 11 + 2;

const _: () = assert!(MOST_NODE_LEVELS < MOST_LEVELS);

/// The parts of a node's keys that its children are over.
struct Parts {
    count: usize,
    /// Where each begins, and where the last ends.
    starts: [usize; WIDTH + 1],
    /// How soon each is to be divided; 0 if it is a leaf.
    urgency: [u64; WIDTH],
    division: [Division; WIDTH],
}

impl Parts {
    /// One of all.
    fn new(keys: usize, urgency: u64, division: Division) -> Self {
        let mut parts = Self {
            count: 1,
            starts: [0; WIDTH + 1],
            urgency: [0; WIDTH],
            division: [division; WIDTH],
        };
        parts.starts[1] = keys;
        parts.urgency[0] = urgency;
        parts
    }

    /// The one that is to be divided next, if any is.
    fn next(&self) -> Option<usize> {
        let sooner = |a, b| if self.urgency[b] > self.urgency[a] { b } else { a };
        let next = (1..WIDTH).fold(0, sooner);
        (self.urgency[next] > 0).then_some(next)
    }

    /// Where one is.
    fn range(&self, part: usize) -> Range<usize> {
        self.starts[part]..self.starts[part + 1]
    }

    /// Makes two of one.
    fn split(&mut self, part: usize, middle: usize, urgencies: [u64; 2]) {
        self.starts.copy_within(part + 1..=self.count, part + 2);
        self.urgency.copy_within(part + 1..self.count, part + 2);
        self.division.copy_within(part..self.count, part + 1);
        self.starts[part + 1] = middle;
        [self.urgency[part], self.urgency[part + 1]] = urgencies;
        self.count += 1;
    }
}

struct Builder<'a, P> {
    primitives: &'a P,
    census: Census,
    format: Format,
}

impl<P: Primitives> Builder<'_, P> {
    /// How soon keys are to be divided: those in the largest cell first, the most first of these; 0 if they are a leaf.
    fn urgency(&self, keys: &[Key], division: Division) -> u64 {
        let is_triangle = |&key: &Key| self.format.index(key) < self.census.triangles;
        if keys.len() <= 1 || (keys.len() <= LANES && keys.iter().all(is_triangle)) {
            return 0;
        }
        let differing = match division {
            Division::Curve | Division::OwnCurve => keys[0] ^ keys[keys.len() - 1],
            Division::Number => 0,
        };
        u64::from(Key::BITS - differing.leading_zeros()) << 32 | keys.len() as u64
    }

    /// Adds a node over keys, of which the first is at a place among all, and what is below it.
    fn node(&self, keys: &mut [Key], first: usize, division: Division, topology: &mut Topology) {
        let node = topology.add_node();
        let mut parts = Parts::new(keys.len(), self.urgency(keys, division), division);
        while parts.count < WIDTH
            && let Some(part) = parts.next()
        {
            let Range { start, end } = parts.range(part);
            let middle = start + self.divide(&mut keys[start..end], &mut parts.division[part]);
            let division = parts.division[part];
            let (first, second) = keys[start..end].split_at(middle - start);
            let urgencies = [self.urgency(first, division), self.urgency(second, division)];
            parts.split(part, middle, urgencies);
        }
        let is_parallel = keys.len() > CHUNK;
        let mut below = Vec::new();
        let mut rest = keys;
        for slot in 0..parts.count {
            let range = parts.range(slot);
            let (keys, others) = rest.split_at_mut(range.len());
            rest = others;
            let first = first + range.start;
            let division = parts.division[slot];
            if parts.urgency[slot] == 0 {
                topology.nodes[node][slot] = self.leaf(keys, first, topology);
            } else if is_parallel {
                below.push((slot, (keys, first, division)));
            } else {
                topology.nodes[node][slot] = ChildRef::new(Child::Node(topology.nodes.len()));
                self.node(keys, first, division, topology);
            }
        }
        topology.append_all(node, below, |(keys, first, division), tree| {
            tree.reserve(keys.len());
            self.node(keys, first, division, tree);
        });
    }

    fn leaf(&self, keys: &[Key], first: usize, topology: &mut Topology) -> ChildRef {
        let index = self.format.index(keys[0]);
        if index < self.census.triangles {
            topology.add_block(Leaf {
                first: first as u32,
                count: keys.len() as u32,
            })
        } else {
            self.census.child(index)
        }
    }

    /// Where codes first differ; if two leaves do, the first place where these have room.
    fn divide(&self, keys: &mut [Key], division: &mut Division) -> usize {
        let differing =
            |keys: &[Key], places: [usize; 2]| self.format.code(keys[places[0]]) ^ self.format.code(keys[places[1]]);
        if keys.len() > LANES && keys.len() <= 2 * LANES {
            let places = keys.len() - LANES..=LANES;
            let middle = places.max_by_key(|&place| differing(keys, [place - 1, place]));
            return middle.unwrap_or(LANES);
        }
        let ends = [0, keys.len() - 1];
        if *division == Division::Curve && differing(keys, ends) == 0 {
            self.redraw(keys);
            *division = Division::OwnCurve;
        }
        let differing = differing(keys, ends);
        if differing == 0 {
            *division = Division::Number;
        }
        if *division == Division::Number {
            return keys.len() / 2;
        }
        // All codes from the first with the highest bit in which they differ.
        let bit = 63 - differing.leading_zeros();
        let border = self.format.code(keys[keys.len() - 1]) >> bit << bit;
        keys.partition_point(|&key| self.format.code(key) < border)
    }

    /// Sorts keys along a curve through the box of their centres.
    fn redraw(&self, keys: &mut [Key]) {
        let centers = keys.iter().fold(Box4::EMPTY, |centers, &key| {
            let bounds = self.primitives.bounds(self.format.index(key));
            centers.grow(Box4::within_reach(&bounds).twice_center() * 0.5)
        });
        let curve = Curve::through(centers, self.format);
        for key in &mut *keys {
            *key = curve.key(self.format.index(*key), self.primitives);
        }
        keys.sort_unstable();
    }
}

#[cfg(test)]
mod tests {
    use std::iter::repeat_n;

    use super::*;
    use crate::accel::bvh::primitives::tests::Boxes;

    fn levels(topology: &Topology, node: usize) -> u32 {
        let below = topology.nodes[node].iter().map(|child| match child.get() {
            Child::Node(0) | Child::Block(_) | Child::Analytic(_) | Child::Instance(_) => 0,
            Child::Node(index) => levels(topology, index),
        });
        1 + below.fold(0, u32::max)
    }

    /// Clusters of points, each a part of the size of the one before: nearly all cells of a curve are of one of them.
    fn clusters(count: usize, shrink: f32, each: usize) -> Boxes {
        let points = (0..count * each).map(|i| {
            let (size, within) = (shrink.powi((i / each) as i32), (i % each) as f32 / each as f32);
            let point = size * (Vec3::ONE + within * Vec3::new(0.5, -0.3, 0.7));
            [point, point]
        });
        Boxes::new(points)
    }

    #[test]
    fn trees_are_shallow_and_their_leaves_hold_all() {
        let same = Boxes::new(repeat_n([Vec3::ZERO, Vec3::ONE], 100_000));
        let infinite = Boxes::new(repeat_n([Vec3::NEG_INFINITY, Vec3::INFINITY], 1000));
        let far = Boxes::new((0..40_000).map(|i| [Vec3::splat(i as f32 - 2e4), Vec3::splat(2.0_f32.powi(i % 120))]));
        let few = Boxes::new(repeat_n([Vec3::ZERO, Vec3::ONE], 3));
        for boxes in [
            clusters(100, 0.5, 40),
            clusters(60, 0.3, 9),
            clusters(3000, 0.99, 12),
            same,
            infinite,
            far,
            few,
        ] {
            let (topology, order) = build(&boxes);
            let levels = levels(&topology, 0);
            assert!(levels <= MOST_NODE_LEVELS, "{levels} levels");
            let mut found: Vec<u32> = topology
                .blocks
                .iter()
                .flat_map(|leaf| &order[leaf.range()])
                .copied()
                .collect();
            found.sort_unstable();
            assert!(found.into_iter().eq(0..boxes.census().count() as u32));
            assert!(
                topology
                    .blocks
                    .iter()
                    .all(|leaf| (1..=LANES as u32).contains(&leaf.count))
            );
        }
    }
}
