//! Rays that have little in common, one by one, but several at a time.
//!
//! A ray's next step waits for the last one: for the memory that it reads, and for the processor to find out where it goes. So
//! several rays are on their way, and each takes a step in turn. What a ray does next is kept as bits of sets (who is at a node, who at
//! a leaf), and the members of a set do the same, so that there are few branches to predict. What a step will read is fetched when it
//! becomes known, one round before.
//!
//! Rays are prepared packet by packet and stay there, a lane each: to give each a place of its own would take longer than some need
//! to come to their ends.

mod mates;

use super::kernel::{Kernel, TriangleHits};
use super::lanes::Lanes;
use super::leaf::{Block, FixedBlock};
use super::node::{ChildRef, FixedNode, WIDTH};
use super::query::{Asked, Candidate};
use super::traverse::{STACK, TREE_STACK, Walk};
use super::tree::FixedTree;
use crate::geometry::{LANES, RayPacket};

pub use self::mates::{Mates, Member};

/// Rays on their way at a time: a bit for each.
const SLOTS: usize = 32;

/// Below everything on a stack.
const END: u32 = u32::MAX;

/// The bits of a [`ChildRef`] that say where it is.
const INDEX: u32 = (1 << 30) - 1;

/// What is still to be visited, by distance and name; and room to write eight more than there are.
pub struct Stack {
    /// Bits of distances, at most those where the boxes are entered.
    pub distance: [u32; TREE_STACK + 1 + WIDTH],
    /// See [`ChildRef`]. The first is [`END`].
    pub child: [u32; TREE_STACK + 1 + WIDTH],
}

/// What came off a stack.
#[derive(Clone, Copy)]
pub struct Top {
    /// See [`Stack::child`].
    pub child: u32,
    /// See [`Stack::distance`]; without meaning for occlusion.
    pub distance: u32,
    /// How many things are left.
    pub depth: usize,
}

impl Stack {
    /// Takes the top off.
    #[inline(always)]
    pub fn pop(&self, depth: usize) -> Top {
        let depth = depth - 1;
        Top {
            child: self.child[depth],
            distance: self.distance[depth],
            depth,
        }
    }
}

/// A set of instructions that can do it.
pub trait Interleaved: Kernel + Lanes<LANES> {
    /// Puts the children of a node that a ray meets on its stack, of which `depth` is the depth, and takes off the nearest; with `ANY`,
    /// one of them; if there is none, what was on top.
    fn spread<const ANY: bool>(self, node: &FixedNode, ray: Member, stack: &mut Stack, depth: usize) -> Top;

    /// Which triangles of a block a ray meets, as [`Kernel::triangles`]; with `any` it does not matter where, nor are all named.
    fn triangles_of(self, block: &FixedBlock, ray: Member, any: bool) -> TriangleHits;

    /// [`Trip::trace`] compiled for these instructions, as a function of its own: within a larger one it would get fewer registers.
    fn trip<const ANY: bool>(
        self,
        trip: &Trip<'_, '_, Self>,
        packets: &[RayPacket],
        room: &mut Room,
        single_stack: &mut [u64; STACK],
        done: &mut dyn FnMut(&Mates),
    );

    /// Fetches what is at an address into the cache, if anything is.
    fn fetch(self, place: usize);
}

/// Where rays are, and what is known of them: memory of a thread.
pub struct Room {
    mates: Vec<Mates>,
    stacks: Vec<Stack>,
    slots: Slots,
}

/// By ray on its way.
struct Slots {
    /// What it visits next.
    current: [ChildRef; SLOTS],
    /// How many things are on its stack.
    depth: [usize; SLOTS],
    /// Its packet among the [`Mates`].
    mates: [usize; SLOTS],
    /// Its lane there.
    lane: [usize; SLOTS],
}

impl Room {
    /// With no rays.
    pub fn new() -> Self {
        Self {
            mates: Vec::new(),
            stacks: Vec::new(),
            slots: Slots {
                current: [ChildRef::ROOT; SLOTS],
                depth: [0; SLOTS],
                mates: [0; SLOTS],
                lane: [0; SLOTS],
            },
        }
    }

    /// Room for as many rays as there can be.
    fn parts(&mut self) -> Option<(&mut [Mates; SLOTS], &mut [Stack; SLOTS], &mut Slots)> {
        // A packet stays until none of its rays is on its way.
        self.mates.resize_with(SLOTS, Mates::none);
        self.stacks.resize_with(SLOTS, || {
            let mut child = [0; _];
            child[0] = END;
            Stack {
                distance: [0; _],
                child,
            }
        });
        let mates = self.mates.first_chunk_mut()?;
        Some((mates, self.stacks.first_chunk_mut()?, &mut self.slots))
    }
}

/// What stays the same for all rays of a call.
pub struct Trip<'a, 'b, K> {
    /// Where they go.
    walk: Walk<'b, K>,
    /// Through which tree.
    tree: &'b FixedTree,
    /// Who decides on hits.
    asked: Asked<'a>,
    places: Places,
}

/// Where things are, by the tag of a [`ChildRef`]: in a table, as which it is cannot be predicted.
struct Places {
    bases: [usize; 4],
    sizes: [usize; 4],
}

/// Gives rays, packet by packet.
struct Feed<'b> {
    packets: &'b [RayPacket],
    /// The packet to be taken next.
    next: usize,
    /// The [`Mates`] of the one before.
    at: usize,
    /// Its rays that are still to be given.
    waiting: u32,
    /// Room for packets: a bit for each.
    free: u32,
}

/// Who does what in the next round, after the tags of a [`ChildRef`]: who is at a node, who at a block, who at the end or at something
/// else, and who pops again.
type Round = [u32; 4];

/// See [`Round`].
const POP: u32 = 3;

/// Members of a set.
#[inline(always)]
fn first(set: &mut u32) -> Option<usize> {
    let i = set.trailing_zeros() as usize;
    let any = *set != 0;
    *set &= set.wrapping_sub(1);
    any.then_some(i % SLOTS)
}

impl<'a, 'b, K: Interleaved> Trip<'a, 'b, K> {
    /// Through a tree.
    #[inline(always)]
    pub fn new(walk: Walk<'b, K>, tree: &'b FixedTree, asked: Asked<'a>) -> Self {
        let (root, blocks) = (tree.nodes.as_ptr() as usize, tree.blocks.as_ptr() as usize);
        Self {
            walk,
            tree,
            asked,
            places: Places {
                bases: [root, blocks, root, root],
                sizes: [size_of::<FixedNode>(), size_of::<FixedBlock>(), 0, 0],
            },
        }
    }

    /// Traces the rays of packets. Each packet is handed back to `done`, when none of its rays is on its way.
    #[inline(always)]
    pub fn trace<const ANY: bool>(
        &self,
        packets: &[RayPacket],
        room: &mut Room,
        single_stack: &mut [u64; STACK],
        done: &mut dyn FnMut(&Mates),
    ) {
        let Some((mates, stacks, slots)) = room.parts() else {
            return;
        };
        let mut feed = Feed {
            packets,
            next: 0,
            at: 0,
            waiting: 0,
            free: u32::MAX,
        };
        let mut next: Round = [0; 4];
        for i in 0..SLOTS {
            if !self.begin::<ANY>(i, &mut feed, mates, slots, single_stack, done) {
                break;
            }
            next[0] |= 1 << i;
        }
        while next != [0; 4] {
            let [mut nodes, mut blocks, mut others, mut pops] = std::mem::take(&mut next);
            while let Some(i) = first(&mut nodes) {
                let ray = slots.ray(i, mates);
                let node = &self.tree.nodes[slots.current[i].0 as usize];
                let stack = &mut stacks[i];
                let top = self.walk.kernel.spread::<ANY>(node, ray, stack, slots.depth[i]);
                self.visit::<ANY>(i, top, ray, slots, &mut next);
            }
            while let Some(i) = first(&mut blocks) {
                let (at, lane) = slots.place(i);
                let block = &self.tree.blocks[(slots.current[i].0 & INDEX) as usize];
                let found = self.block::<ANY>(block, &mut mates[at], lane);
                let depth = if ANY && found { 1 } else { slots.depth[i] };
                self.visit::<ANY>(i, stacks[i].pop(depth), slots.ray(i, mates), slots, &mut next);
            }
            while let Some(i) = first(&mut pops) {
                let top = stacks[i].pop(slots.depth[i]);
                self.visit::<ANY>(i, top, slots.ray(i, mates), slots, &mut next);
            }
            while let Some(i) = first(&mut others) {
                let (at, lane) = slots.place(i);
                if slots.current[i].0 == END {
                    feed.end(&mut mates[at], at, lane, done);
                    let more = self.begin::<ANY>(i, &mut feed, mates, slots, single_stack, done);
                    next[0] |= u32::from(more) << i;
                    continue;
                }
                let found = self.other::<ANY>(slots.current[i], &mut mates[at], lane, single_stack);
                let depth = if ANY && found { 1 } else { slots.depth[i] };
                self.visit::<ANY>(i, stacks[i].pop(depth), slots.ray(i, mates), slots, &mut next);
            }
        }
    }

    /// Sends the next ray on its way, if there is one.
    #[inline(always)]
    fn begin<const ANY: bool>(
        &self,
        i: usize,
        feed: &mut Feed,
        mates: &mut [Mates; SLOTS],
        slots: &mut Slots,
        single_stack: &mut [u64; STACK],
        done: &mut dyn FnMut(&Mates),
    ) -> bool {
        while feed.waiting == 0 {
            let Some(packet) = feed.packets.get(feed.next) else {
                return false;
            };
            let at = feed.free.trailing_zeros() as usize % SLOTS;
            let mates = &mut mates[at];
            mates.load(self.walk.kernel, feed.next, packet);
            feed.next += 1;
            let active = (0..LANES).fold(0, |bits, lane| bits | u32::from(packet.is_active(lane)) << lane);
            let usual = active & mates.prepared.usual;
            if usual != active {
                self.unusual::<ANY>(packet, active & !usual, mates, single_stack);
            }
            if usual == 0 {
                done(mates);
                continue;
            }
            (feed.at, feed.waiting, mates.left) = (at, usual, usual);
            feed.free &= !(1 << at);
        }
        slots.mates[i] = feed.at;
        slots.lane[i] = feed.waiting.trailing_zeros() as usize;
        slots.current[i] = ChildRef::ROOT;
        slots.depth[i] = 1;
        feed.waiting &= feed.waiting - 1;
        true
    }

    /// Finds out when a ray visits what came off its stack.
    #[inline(always)]
    fn visit<const ANY: bool>(&self, i: usize, top: Top, ray: Member, slots: &mut Slots, next: &mut Round) {
        let child = top.child;
        slots.depth[i] = top.depth;
        slots.current[i] = ChildRef(child);
        let near = ANY || f32::from_bits(top.distance) <= ray.mates.cull[ray.lane % LANES];
        let tag = child >> 30;
        let kind = if near { tag.min(2) } else { POP };
        next[kind as usize & 3] |= 1 << i;
        // Of what is no node and no block, the root is fetched: an address at which there is nothing takes long to find out.
        let tag = tag as usize & 3;
        let offset = self.places.sizes[tag] * (child & INDEX) as usize;
        self.walk.kernel.fetch(self.places.bases[tag].wrapping_add(offset));
    }

    /// Tests a ray against the triangles of a block; says whether it hits one.
    #[inline(always)]
    fn block<const ANY: bool>(&self, block: &FixedBlock, mates: &mut Mates, lane: usize) -> bool {
        let ids = block.ids();
        let any = ANY && self.asked.filter.is_none();
        let hits = self.walk.kernel.triangles_of(block, Member { mates, lane }, any);
        let mut rest = hits.mask;
        let mut found = false;
        while rest != 0 {
            let triangle = rest.trailing_zeros() as usize;
            rest &= rest - 1;
            let candidate = Candidate {
                t: hits.t[triangle],
                geometry: ids.geometry[triangle],
                primitive: ids.primitive[triangle],
                instance: self.walk.level.instance,
            };
            let corners = || block.fixed_corners().lane(triangle);
            found |= mates.offer(lane, &candidate, self.asked, |shear| shear.barycentrics(&corners()));
            if ANY && found {
                mates.found |= 1 << lane;
                return true;
            }
        }
        found
    }

    /// Tests a ray against what is no node and no triangle; says whether it hits it.
    #[inline(always)]
    fn other<const ANY: bool>(
        &self,
        current: ChildRef,
        mates: &mut Mates,
        lane: usize,
        single_stack: &mut [u64; STACK],
    ) -> bool {
        let line = mates.prepared.line(lane);
        let mut query = mates.query(lane, self.asked);
        let found = self
            .walk
            .other::<_, _, ANY>(self.tree, current, line, &mut query, single_stack);
        mates.take(lane, &query);
        mates.found |= u32::from(found) << lane;
        found
    }

    /// Traces rays whose directions are of an unusual size.
    #[cold]
    #[inline(never)]
    fn unusual<const ANY: bool>(
        &self,
        packet: &RayPacket,
        mut lanes: u32,
        mates: &mut Mates,
        single_stack: &mut [u64; STACK],
    ) {
        let Walk { kernel, scene, .. } = self.walk;
        while let Some(lane) = first(&mut lanes) {
            if let Some(query) = scene.trace::<K, ANY>(kernel, packet, lane, self.asked.filter, single_stack) {
                mates.take(lane, &query);
                mates.found |= u32::from(query.is_hit()) << lane;
            }
        }
    }
}

impl Feed<'_> {
    /// A ray has come to its end.
    #[inline(always)]
    fn end(&mut self, mates: &mut Mates, at: usize, lane: usize, done: &mut dyn FnMut(&Mates)) {
        mates.left &= !(1 << lane);
        if mates.left == 0 {
            done(mates);
            self.free |= 1 << at;
        }
    }
}

impl Slots {
    /// Where a ray is prepared.
    #[inline(always)]
    fn place(&self, i: usize) -> (usize, usize) {
        (self.mates[i] % SLOTS, self.lane[i] % LANES)
    }

    #[inline(always)]
    fn ray<'a>(&self, i: usize, mates: &'a [Mates; SLOTS]) -> Member<'a> {
        let (at, lane) = self.place(i);
        Member {
            mates: &mates[at],
            lane,
        }
    }
}
