//! Rays that have little in common, one by one, but several at a time.
//!
//! A ray's next step waits for the last one: for the memory that it reads, and for the processor to find out where it goes. So
//! several rays are on their way, and each takes a step in turn. What a ray does next is kept as bits of sets (who pops its stack, who
//! is at a node, who at a leaf), and the members of a set do the same, so that there are few branches to predict. What a step will read
//! is fetched when it becomes known, one round before.

use super::kernel::Kernel;
use super::leaf::FixedBlock;
use super::node::{ChildRef, FixedNode, WIDTH};
use super::query::Query;
use super::ray::{LocalRay, Slab};
use super::traverse::{STACK, Walk};
use super::tree::FixedTree;

/// Rays on their way at a time: a bit for each.
const SLOTS: usize = 32;

/// Below everything on a stack.
const END: u32 = u32::MAX;

/// What is still to be visited, by distance and name; and room to write eight more than there are.
pub struct Stack {
    /// Bits of distances, at most those where the boxes are entered.
    pub distance: [u32; STACK + WIDTH],
    /// See [`ChildRef`].
    pub child: [u32; STACK + WIDTH],
    /// How many.
    pub depth: usize,
}

/// A set of instructions that can do it.
pub trait Interleaved: Kernel {
    /// Puts the children of a node that a ray meets on its stack, with the nearest on top; with `ANY`, in any order.
    fn spread<const ANY: bool>(self, node: &FixedNode, slab: &Slab, tnear: f32, tfar: f32, stack: &mut Stack);

    /// Fetches what is at an address into the cache, if anything is.
    fn fetch(self, place: usize);
}

/// Where rays come from.
pub trait Source<'a> {
    /// The next ray, with its place and query.
    fn next(&mut self) -> Option<(usize, LocalRay, Query<'a>)>;
}

/// A ray on its way.
struct Slot<'a> {
    /// Which it is, to the caller.
    place: usize,
    ray: LocalRay,
    query: Query<'a>,
    current: ChildRef,
}

impl<'a> Slot<'a> {
    #[inline(always)]
    fn new((place, ray, query): (usize, LocalRay, Query<'a>)) -> Self {
        Self {
            place,
            ray,
            query,
            current: ChildRef::ROOT,
        }
    }
}

impl Stack {
    /// With nothing on it, for stacks that are kept from call to call: clearing them takes longer than few rays.
    pub fn empty() -> Self {
        Self {
            distance: [0; STACK + WIDTH],
            child: [0; STACK + WIDTH],
            depth: 0,
        }
    }

    /// Puts the root on it, whatever there was before.
    #[inline(always)]
    fn begin(&mut self) {
        (self.child[0], self.child[1]) = (END, ChildRef::ROOT.0);
        self.distance[1] = 0;
        self.depth = 2;
    }
}

/// What rays do next, after the tags of a [`ChildRef`], the last two of which are one: pop again.
const POP: u32 = 3;

/// Traces all of `rays`, each with its place and query, and hands them back to `done`.
#[inline(always)]
pub fn trace<'a, K: Interleaved, const ANY: bool>(
    walk: &Walk<'_, K>,
    tree: &FixedTree,
    mut rays: impl Source<'a>,
    mut done: impl FnMut(usize, &Query<'a>),
    single_stack: &mut [u64],
    stacks: &mut Vec<Stack>,
) {
    let mut slots = Vec::with_capacity(SLOTS);
    while slots.len() < SLOTS
        && let Some(next) = rays.next()
    {
        slots.push(Slot::new(next));
    }
    if stacks.len() < slots.len() {
        stacks.resize_with(slots.len(), Stack::empty);
    }
    let stacks = &mut stacks[..slots.len()];
    stacks.iter_mut().for_each(Stack::begin);
    // Of what is no node and no block, the root is fetched: an address at which there is nothing takes long to find out.
    let root = tree.nodes.as_ptr() as usize;
    let bases = [root, tree.blocks.as_ptr() as usize, root, root];
    let sizes = [size_of::<FixedNode>(), size_of::<FixedBlock>(), 0, 0];
    let mut pop = ((1u64 << slots.len()) - 1) as u32;
    while pop != 0 {
        let mut next = [0u32; 4];
        let mut rest = pop;
        while rest != 0 {
            let i = rest.trailing_zeros() as usize;
            rest &= rest - 1;
            let (slot, stack) = (&mut slots[i], &mut stacks[i]);
            let depth = stack.depth - 1;
            stack.depth = depth;
            let child = stack.child[depth];
            let near = ANY || f32::from_bits(stack.distance[depth]) <= slot.query.cull;
            slot.current = ChildRef(child);
            let tag = child >> 30;
            let kind = if near { tag.min(2) } else { POP };
            next[kind as usize & 3] |= 1 << i;
            let tag = tag as usize;
            walk.kernel
                .fetch(bases[tag].wrapping_add(sizes[tag] * (child & ((1 << 30) - 1)) as usize));
        }
        pop = next[3];
        let mut rest = next[0];
        pop |= rest;
        while rest != 0 {
            let i = rest.trailing_zeros() as usize;
            rest &= rest - 1;
            let slot = &mut slots[i];
            let node = &tree.nodes[slot.current.0 as usize];
            walk.kernel
                .spread::<ANY>(node, &slot.ray.slab, slot.query.tnear, slot.query.cull, &mut stacks[i]);
        }
        let mut rest = next[1];
        pop |= rest;
        while rest != 0 {
            let i = rest.trailing_zeros() as usize;
            rest &= rest - 1;
            let slot = &mut slots[i];
            let block = &tree.blocks[(slot.current.0 & ((1 << 30) - 1)) as usize];
            if walk.block::<_, ANY>(block, block.fixed_corners(), &slot.ray, &mut slot.query) && ANY {
                stacks[i].depth = 1;
            }
        }
        let mut rest = next[2];
        while rest != 0 {
            let i = rest.trailing_zeros() as usize;
            rest &= rest - 1;
            let slot = &mut slots[i];
            if slot.current.0 == END {
                done(slot.place, &slot.query);
                if let Some(next) = rays.next() {
                    *slot = Slot::new(next);
                    stacks[i].begin();
                    pop |= 1 << i;
                }
                continue;
            }
            let (ray, query) = (&slot.ray, &mut slot.query);
            if walk
                .kernel
                .fixed::<ANY>(walk, tree, slot.current, ray, query, single_stack)
                && ANY
            {
                stacks[i].depth = 1;
            }
            pop |= 1 << i;
        }
    }
}
