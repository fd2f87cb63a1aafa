//! A call's rays, put together to packets of rays that are likely to stay together.

mod few;

use super::Scene;
use super::few::Few;
use super::interleave::{self, Interleaved, Mates, Trip};
use super::lanes::{Lanes, lanes_of};
use super::order::{BATCH, Place, Room, rays_of_class, sort};
use super::packet::{Packet, Seen};
use super::prepare::Rays;
use super::query::{Asked, Query};
use super::traverse::{Level, STACK, Walk};
use super::tree::FixedTree;
use crate::accel::HitFilter;
use crate::geometry::{HitPacket, LANES, RayPacket};

pub use self::few::{intersect_few, occluded_few};

impl Scene {
    /// Whether packets can be traced: all that moves is in instances.
    pub fn takes_packets(&self) -> bool {
        self.top.fixed.is_some() && self.top.moving.is_empty()
    }

    /// All primitives, if to test them takes at most `tests` tests of triangles, or spheres are among them, which a tree is asked about ray
    /// by ray.
    pub fn few_within(&self, tests: usize) -> Option<&Few> {
        let is_within = |few: &&Few| few.tests() <= tests || (tests > 0 && !few.balls.is_empty());
        self.few.as_ref().filter(is_within)
    }
}

/// How the rays of a call are put together.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// Rays are tested against all primitives if that takes at most so many tests of triangles; see [`Scene::few_within`].
    pub exhaustive: usize,
    /// Whether neighbours go together as they come; else rays are sorted. Not for occlusion.
    pub as_they_come: bool,
    /// When the others go together: if one of these holds.
    pub together: &'static [Together],
    /// Packets of a call of which the rays go one by one whatever the tree: few have little in common. Not for occlusion.
    pub few_packets: usize,
}

/// Rays that go together.
#[derive(Clone, Copy, Debug)]
pub struct Together {
    /// How alike they are at least: rays of a class, on average.
    pub alike: usize,
    /// Nodes of the tree at most: what rays do not share is to be fetched from memory, which packets wait for.
    pub nodes: usize,
    /// Nodes that a ray is expected to visit at most ([`FixedTree::expected_nodes`]): on a long way rays part.
    pub expected: f64,
}

impl Plan {
    /// Whether rays go through the tree together.
    #[inline(always)]
    fn is_together<S: Lanes<LANES>>(&self, s: S, scene: &Scene, tree: &FixedTree, packets: &[RayPacket]) -> bool {
        let of_tree = |rule: &&Together| tree.nodes.len() <= rule.nodes && scene.expected_nodes <= rule.expected;
        let Some(least) = self.together.iter().filter(of_tree).map(|rule| rule.alike).min() else {
            return false;
        };
        least == 0 || least <= rays_of_class(s, packets, &tree.bounds)
    }
}

fn active(packet: &RayPacket) -> u32 {
    (0..LANES).fold(0, |bits, lane| bits | u32::from(packet.is_active(lane)) << lane)
}

/// The rays of neighbouring packets, as many as there are up to N / LANES, and which take part.
#[inline(always)]
fn neighbours<const N: usize>(packets: &[RayPacket]) -> (Rays<N>, u32) {
    let mut rays = Rays::none();
    let mut lanes = 0;
    for (i, packet) in packets.iter().enumerate() {
        let at = i * LANES..(i + 1) * LANES;
        let origin = [&packet.org_x, &packet.org_y, &packet.org_z];
        let direction = [&packet.dir_x, &packet.dir_y, &packet.dir_z];
        for axis in 0..3 {
            rays.origin[axis][at.clone()].copy_from_slice(origin[axis]);
            rays.direction[axis][at.clone()].copy_from_slice(direction[axis]);
        }
        rays.tnear[at.clone()].copy_from_slice(&packet.tnear);
        rays.tfar[at.clone()].copy_from_slice(&packet.tfar);
        rays.time[at.clone()].copy_from_slice(&packet.time);
        rays.mask[at.clone()].copy_from_slice(&packet.mask);
        rays.id[at].copy_from_slice(&packet.id);
        lanes |= active(packet) << (i * LANES);
    }
    (rays, lanes)
}

/// The rays at the given places, at most N.
#[inline(always)]
fn gather<const N: usize>(packets: &[RayPacket], places: &[Place]) -> Rays<N> {
    let mut rays = Rays::none();
    for (lane, &place) in places.iter().enumerate() {
        let (packet, from) = (&packets[place as usize / LANES], place as usize % LANES);
        rays.origin[0][lane] = packet.org_x[from];
        rays.origin[1][lane] = packet.org_y[from];
        rays.origin[2][lane] = packet.org_z[from];
        rays.direction[0][lane] = packet.dir_x[from];
        rays.direction[1][lane] = packet.dir_y[from];
        rays.direction[2][lane] = packet.dir_z[from];
        rays.tnear[lane] = packet.tnear[from];
        rays.tfar[lane] = packet.tfar[from];
        rays.time[lane] = packet.time[from];
        rays.mask[lane] = packet.mask[from];
        rays.id[lane] = packet.id[from];
    }
    rays
}

/// What all packets of a call have in common.
struct Call<'a, S, K, const N: usize> {
    s: S,
    kernel: K,
    scene: &'a Scene,
    tree: &'a FixedTree,
    level: Level<'a>,
    asked: Asked<'a>,
    filter: Option<&'a dyn HitFilter>,
}

impl<'a, S: Lanes<N>, K: Interleaved, const N: usize> Call<'a, S, K, N> {
    #[inline(always)]
    fn new(s: S, kernel: K, scene: &'a Scene, tree: &'a FixedTree, filter: Option<&'a dyn HitFilter>) -> Self {
        Self {
            s,
            kernel,
            scene,
            tree,
            level: Level {
                trees: &scene.top,
                instance: HitPacket::NONE,
            },
            asked: Asked {
                filter,
                filtered: &scene.filtered,
            },
            filter,
        }
    }

    /// Traces a packet; returns it, with the lanes that it left out.
    #[inline(always)]
    fn trace<const ANY: bool>(&self, rays: Rays<N>, lanes: u32, stack: &mut [u64]) -> (Packet<'a, N>, u32) {
        let walk = Walk {
            kernel: self.kernel,
            scene: self.scene,
            level: &self.level,
        };
        let mut packet = Packet::new(self.s, rays, self.asked);
        let rest = packet.trace::<S, K, ANY>(self.s, &walk, self.tree, lanes, stack);
        (packet, rest)
    }

    /// Tests a packet against all there is; returns it, with the lanes that it left out.
    #[inline(always)]
    fn exhaust<const ANY: bool>(&self, seen: &mut Seen<'_>, rays: Rays<N>, lanes: u32) -> (Packet<'a, N>, u32) {
        let mut packet = Packet::treeless(self.s, rays, self.asked);
        let rest = packet.exhaust::<S, ANY>(self.s, seen, lanes);
        (packet, rest)
    }

    /// Writes the hits of neighbouring packets, of which `rest` are still to be traced.
    #[inline(always)]
    fn keep(
        &self,
        packet: &Packet<'_, N>,
        rest: u32,
        given: &[RayPacket],
        hits: &mut [HitPacket],
        stack: &mut [u64; STACK],
    ) {
        for (i, hits) in hits.iter_mut().enumerate() {
            let at = |row: &[u32; N]| std::array::from_fn(|lane| row[i * LANES + lane]);
            *hits = HitPacket {
                geometry: at(&packet.ids[0]),
                primitive: at(&packet.ids[1]),
                instance: at(&packet.ids[2]),
                t: std::array::from_fn(|lane| packet.prepared.rays.tfar[i * LANES + lane]),
            };
        }
        for lane in lanes_of(rest) {
            let (at, lane) = (lane / LANES, lane % LANES);
            if let Some(query) = self.alone::<false>(&given[at], lane, stack) {
                query.store(&mut hits[at], lane);
            }
        }
    }

    /// Traces rays that have little in common.
    #[inline(always)]
    fn one_by_one<const ANY: bool>(
        &self,
        packets: &[RayPacket],
        (stack, room): (&mut [u64; STACK], &mut interleave::Room),
        mut done: impl FnMut(&Mates),
    ) {
        let walk = Walk {
            kernel: self.kernel,
            scene: self.scene,
            level: &self.level,
        };
        let trip = Trip::new(walk, self.tree, self.asked);
        if ANY {
            self.kernel.trip::<ANY>(&trip, packets, room, stack, &mut done);
        } else {
            // 3 % slower as a function of its own.
            trip.trace::<ANY>(packets, room, stack, &mut done);
        }
    }

    /// Traces one ray.
    #[cold]
    fn alone<const ANY: bool>(&self, packet: &RayPacket, lane: usize, stack: &mut [u64; STACK]) -> Option<Query<'a>> {
        self.scene
            .trace::<K, ANY>(self.kernel, packet, lane, self.filter, stack)
    }
}

/// Nearest hits.
#[inline(always)]
pub fn intersect<S: Lanes<N>, K: Interleaved, const N: usize>(
    s: S,
    kernel: K,
    scene: &Scene,
    plan: Plan,
    packets: &[RayPacket],
    hits: &mut [HitPacket],
    filter: Option<&dyn HitFilter>,
) {
    let Some(tree) = &scene.top.fixed else { return };
    let call = Call::new(s, kernel, scene, tree, filter);
    let mut room = Room::take();
    if plan.as_they_come {
        as_they_come(&call, packets, hits, &mut room.stack);
    } else if packets.len() <= plan.few_packets || !plan.is_together(kernel, scene, tree, packets) {
        let Room { stack, interleave, .. } = &mut *room;
        call.one_by_one::<false>(packets, (stack, interleave), |mates| {
            let [geometry, primitive, instance] = mates.ids;
            let t = mates.prepared.rays.tfar;
            hits[mates.packet] = HitPacket {
                geometry,
                primitive,
                instance,
                t,
            };
        });
    } else {
        sorted(&call, packets, hits, &mut room);
    }
    room.put();
}

/// Nearest hits of rays that go together as they come.
#[inline(always)]
fn as_they_come<S: Lanes<N>, K: Interleaved, const N: usize>(
    call: &Call<'_, S, K, N>,
    packets: &[RayPacket],
    hits: &mut [HitPacket],
    stack: &mut [u64; STACK],
) {
    for (given, hits) in packets.chunks(N / LANES).zip(hits.chunks_mut(N / LANES)) {
        let (rays, lanes) = neighbours(given);
        let (packet, rest) = call.trace::<false>(rays, lanes, stack);
        call.keep(&packet, rest, given, hits, stack);
    }
}

/// Nearest hits of rays that are sorted.
#[inline(always)]
fn sorted<S: Lanes<N>, K: Interleaved, const N: usize>(
    call: &Call<'_, S, K, N>,
    packets: &[RayPacket],
    hits: &mut [HitPacket],
    room: &mut Room,
) {
    let Room {
        stack, classes, places, ..
    } = room;
    for (packets, hits) in packets.chunks(BATCH / LANES).zip(hits.chunks_mut(BATCH / LANES)) {
        for (packet, hits) in packets.iter().zip(&mut *hits) {
            *hits = HitPacket {
                t: packet.tfar,
                ..HitPacket::EMPTY
            };
        }
        let count = sort(call.kernel, packets, &call.tree.bounds, classes, places);
        for places in places[..count].chunks(N) {
            let lanes = (1 << places.len()) - 1;
            let (packet, rest) = call.trace::<false>(gather(packets, places), lanes, stack);
            for (lane, &place) in places.iter().enumerate() {
                let (at, to) = (place as usize / LANES, place as usize % LANES);
                if rest >> lane & 1 == 1 {
                    if let Some(query) = call.alone::<false>(&packets[at], to, stack) {
                        query.store(&mut hits[at], to);
                    }
                    continue;
                }
                hits[at].geometry[to] = packet.ids[0][lane];
                hits[at].primitive[to] = packet.ids[1][lane];
                hits[at].instance[to] = packet.ids[2][lane];
                hits[at].t[to] = packet.prepared.rays.tfar[lane];
            }
        }
    }
}

/// Whether there is any hit.
#[inline(always)]
pub fn occluded<S: Lanes<N>, K: Interleaved, const N: usize>(
    s: S,
    kernel: K,
    scene: &Scene,
    plan: Plan,
    packets: &mut [RayPacket],
    filter: Option<&dyn HitFilter>,
) {
    let Some(tree) = &scene.top.fixed else { return };
    let call = Call::new(s, kernel, scene, tree, filter);
    let mut room = Room::take();
    let Room {
        stack,
        interleave,
        classes,
        places,
        ..
    } = &mut *room;
    for packets in packets.chunks_mut(BATCH / LANES) {
        if !plan.is_together(kernel, scene, tree, packets) {
            let mut found = [0u8; BATCH / LANES];
            call.one_by_one::<true>(packets, (&mut *stack, &mut *interleave), |mates| {
                found[mates.packet] = mates.found as u8;
            });
            for (packet, &found) in packets.iter_mut().zip(&found) {
                lanes_of(found.into()).for_each(|lane| packet.tfar[lane] = f32::NEG_INFINITY);
            }
            continue;
        }
        let count = sort(kernel, packets, &tree.bounds, classes, places);
        for places in places[..count].chunks(N) {
            let lanes = (1 << places.len()) - 1;
            let (packet, rest) = call.trace::<true>(gather(packets, places), lanes, stack);
            let mut found = packet.hits(s) & lanes;
            for lane in lanes_of(rest) {
                let place = places[lane] as usize;
                if let Some(query) = call.alone::<true>(&packets[place / LANES], place % LANES, stack) {
                    found |= u32::from(query.is_hit()) << lane;
                }
            }
            for lane in lanes_of(found) {
                let place = places[lane] as usize;
                packets[place / LANES].tfar[place % LANES] = f32::NEG_INFINITY;
            }
        }
    }
    room.put();
}
