//! Packets: rays of like direction that go through the tree together, a lane for each.
//!
//! At a node, the packet is tested against one child after the other; those that any of its rays meets are visited nearest first,
//! by these rays. Where few are left they go on alone. Triangles are tested by the same operations in the same order as by a ray
//! alone, so that the answers are the same to the last bit.

// Distances are written for the children that are visited only; places among few primitives are not checked each time.
#![allow(unsafe_code)]

mod balls;
mod exhaustive;
mod seen;
mod stack;
mod triangles;

use std::mem::MaybeUninit;

pub use self::seen::{Seen, SeenRoom};
use self::stack::Stack;
use super::kernel::Kernel;
use super::lanes::{Lanes, lanes_of};
use super::node::{Child, ChildRef, Node, Planes, WIDTH};
use super::prepare::{Prepared, Rays, Row};
use super::query::{Asked, CULL_SLACK, Query};
use super::traverse::Walk;
use super::tree::FixedTree;
use crate::geometry::HitPacket;

/// As many rays as this, or fewer, go on alone.
const FEW: u32 = 1;

/// Rays that are traced together, and what they have hit.
#[repr(C, align(64))]
pub struct Packet<'a, const N: usize> {
    /// The rays, up to their nearest hits.
    pub prepared: Prepared<N>,
    /// Of the class at work: see [`Shear::axes`](super::triangle::Shear::axes).
    axes: [usize; 3],
    /// Of the class at work: see [`Slab::negative`](super::ray::Slab::negative).
    negative: [usize; 3],
    /// Nearest hits: geometries, primitives, instances.
    pub ids: [[u32; N]; 3],
    asked: Asked<'a>,
}

impl<'a, const N: usize> Packet<'a, N> {
    /// Prepares rays.
    #[inline(always)]
    pub fn new<S: Lanes<N>>(s: S, rays: Rays<N>, asked: Asked<'a>) -> Self {
        Self::prepared(Prepared::new(s, rays), asked)
    }

    /// Prepares rays that no tree is asked for.
    #[inline(always)]
    pub fn treeless<S: Lanes<N>>(s: S, rays: Rays<N>, asked: Asked<'a>) -> Self {
        let mut prepared = Prepared {
            rays,
            ..Prepared::none()
        };
        prepared.prepare_shears(s);
        Self::prepared(prepared, asked)
    }

    #[inline(always)]
    fn prepared(prepared: Prepared<N>, asked: Asked<'a>) -> Self {
        Self {
            prepared,
            axes: [0, 1, 2],
            negative: [0; 3],
            ids: [[HitPacket::NONE; N]; 3],
            asked,
        }
    }

    /// Traces the rays of `lanes` through a tree. Returns those that it leaves out, as their directions are of an unusual size.
    #[inline(always)]
    pub fn trace<S: Lanes<N>, K: Kernel, const ANY: bool>(
        &mut self,
        s: S,
        walk: &Walk<'_, K>,
        tree: &FixedTree,
        lanes: u32,
        stack: &mut [u64],
    ) -> u32 {
        let mut rest = lanes & self.prepared.usual;
        while rest != 0 {
            let mates = self.mates(rest);
            rest &= !mates;
            let first = mates.trailing_zeros() as usize;
            self.axes = self.prepared.axes(first);
            self.negative = self.prepared.negative.map(|signs| (signs >> first & 1) as usize);
            self.together::<S, K, ANY>(s, walk, tree, mates, stack);
        }
        lanes & !self.prepared.usual
    }

    /// The rays of `rest` that have the signs of direction and the axis of its greatest component in common with the first.
    #[inline(always)]
    fn mates(&self, rest: u32) -> u32 {
        let first = rest.trailing_zeros();
        let Prepared { negative, greatest, .. } = &self.prepared;
        let like_first = |mates: u32, bits: &u32| mates & if bits >> first & 1 == 1 { *bits } else { !bits };
        negative.iter().chain(greatest).fold(rest, like_first)
    }

    /// Traces rays of one class.
    #[inline(always)]
    fn together<S: Lanes<N>, K: Kernel, const ANY: bool>(
        &mut self,
        s: S,
        walk: &Walk<'_, K>,
        tree: &FixedTree,
        mates: u32,
        single_stack: &mut [u64],
    ) {
        let mut stack = Stack::new();
        let mut current = ChildRef::ROOT;
        let mut lanes = mates;
        let mut alive = mates;
        loop {
            if lanes.count_ones() <= FEW {
                self.alone::<K, ANY>(walk, tree, current, lanes, single_stack);
            } else {
                match current.get() {
                    Child::Node(index) => {
                        if let Some(next) = self.node::<S, K, ANY>(s, walk, tree, index, lanes, &mut stack) {
                            (current, lanes) = next;
                            continue;
                        }
                    }
                    Child::Block(index) => self.block::<S, ANY>(s, &tree.blocks[index], lanes, walk.level.instance),
                    Child::Analytic(_) | Child::Instance(_) => {
                        for lane in lanes_of(lanes) {
                            let mut query = self.query(lane);
                            let line = self.prepared.line(lane);
                            walk.other::<_, _, ANY>(tree, current, line, &mut query, single_stack);
                            self.take(lane, &query);
                        }
                    }
                }
            }
            if ANY {
                alive = mates & !self.hits(s);
            }
            // The nearest of what is left, for the rays that have not hit something before it.
            loop {
                if alive == 0 {
                    return;
                }
                let Some((child, rays, distance)) = stack.pop::<ANY>() else {
                    return;
                };
                lanes = rays & alive;
                if let Some(distance) = distance {
                    lanes &= s.bits(s.le(s.load(distance), self.cull(s)));
                }
                if lanes != 0 {
                    current = child;
                    break;
                }
            }
        }
    }

    #[inline(always)]
    fn cull<S: Lanes<N>>(&self, s: S) -> S::F {
        s.mul(s.load(&self.prepared.rays.tfar), s.splat(CULL_SLACK))
    }

    /// The lanes that have hit something.
    #[inline(always)]
    pub fn hits<S: Lanes<N>>(&self, s: S) -> u32 {
        !s.bits(s.none(s.load_u(&self.ids[0])))
    }

    /// Where the rays enter one of the boxes of a node, and which of `lanes` meet it.
    #[inline(always)]
    fn slab<S: Lanes<N>>(&self, s: S, planes: &Planes, slot: usize, lanes: u32) -> (S::F, u32) {
        let rays = &self.prepared;
        let near = |axis: usize| {
            let plane = s.splat(planes.0[2 * axis + (self.negative[axis] & 1)][slot]);
            s.fused(plane, s.load(&rays.near_scale[axis]), s.load(&rays.near_shift[axis]))
        };
        let far = |axis: usize| {
            let plane = s.splat(planes.0[2 * axis + 1 - (self.negative[axis] & 1)][slot]);
            s.fused(plane, s.load(&rays.far_scale[axis]), s.load(&rays.far_shift[axis]))
        };
        let tnear = s.load(&rays.rays.tnear);
        let enter = s.greatest(s.greatest(near(0), near(1)), s.greatest(near(2), tnear));
        let leave = s.least(s.least(far(0), far(1)), s.least(far(2), self.cull(s)));
        (enter, s.bits(s.le(enter, leave)) & lanes)
    }

    /// Puts all children that any ray meets but one on the stack and returns that one, with its rays.
    #[inline(always)]
    fn node<S: Lanes<N>, K: Kernel, const ANY: bool>(
        &self,
        s: S,
        walk: &Walk<'_, K>,
        tree: &FixedTree,
        index: usize,
        lanes: u32,
        stack: &mut Stack<N>,
    ) -> Option<(ChildRef, u32)> {
        let node = &tree.nodes[index];
        let planes = node.fixed_planes();
        let mut distances = [const { MaybeUninit::<Row<N>>::uninit() }; WIDTH];
        let mut met = [(ChildRef::ROOT, 0); WIDTH];
        let mut order: [u64; WIDTH] = std::array::from_fn(|place| place as u64);
        let mut count = 0;
        for slot in 0..WIDTH {
            // Children come first.
            if planes.is_empty(slot) {
                break;
            }
            let (enter, some) = self.slab(s, planes, slot, lanes);
            met[count] = (node.children()[slot], some);
            if !ANY {
                // SAFETY: it is written whole before it is read, and any bits are numbers.
                let distance = unsafe { &mut *distances[count].as_mut_ptr() };
                s.store(enter, distance);
                // By the entry of one of the rays.
                let key = distance[some.trailing_zeros() as usize % N].to_bits();
                order[count] = u64::from(key) << 32 | count as u64;
            }
            count += usize::from(some != 0);
        }
        if !ANY && count > 1 {
            sort_descending(&mut order[..count]);
        }
        let (last, others) = order[..count].split_last()?;
        for &place in others {
            let place = place as usize % WIDTH;
            let (child, lanes) = met[place];
            // SAFETY: with no `ANY`, those of the first `count` were written.
            let distance = (!ANY).then(|| unsafe { distances[place].assume_init_ref() });
            stack.push(child, lanes, distance);
            walk.fetch(tree, child);
        }
        Some(met[*last as usize % WIDTH])
    }

    #[inline(always)]
    fn query(&self, lane: usize) -> Query<'a> {
        Query {
            ids: self.ids.map(|row| row[lane]),
            ..self.prepared.query(lane, self.asked)
        }
    }

    #[inline(always)]
    fn take(&mut self, lane: usize, query: &Query) {
        self.prepared.rays.tfar[lane] = query.tfar;
        (0..3).for_each(|i| self.ids[i][lane] = query.ids[i]);
    }

    /// Traces rays one by one from `start` on.
    #[inline(always)]
    fn alone<K: Kernel, const ANY: bool>(
        &mut self,
        walk: &Walk<'_, K>,
        tree: &FixedTree,
        start: ChildRef,
        lanes: u32,
        stack: &mut [u64],
    ) {
        for lane in lanes_of(lanes) {
            let ray = self.prepared.local(lane);
            let mut query = self.query(lane);
            walk.kernel.fixed::<ANY>(walk, tree, start, &ray, &mut query, stack);
            self.take(lane, &query);
        }
    }
}

#[inline(always)]
fn sort_descending(keys: &mut [u64]) {
    for i in 1..keys.len() {
        let key = keys[i];
        let mut place = i;
        while place > 0 && keys[place - 1] < key {
            keys[place] = keys[place - 1];
            place -= 1;
        }
        keys[place] = key;
    }
}
