//! A call's rays, put together to packets of rays that are likely to stay together.

use super::Scene;
use super::kernel::Kernel;
use super::lanes::Lanes;
use super::packet::{Packet, Rays};
use super::query::{Asked, Query};
use super::traverse::{Level, STACK, Walk};
use super::tree::FixedTree;
use crate::accel::{HitFilter, RayKind};
use crate::geometry::{HitPacket, LANES, RayPacket};

impl Scene {
    /// Whether packets can be traced: all that moves is in instances.
    pub fn takes_packets(&self) -> bool {
        self.top.fixed.is_some() && self.top.moving.is_empty()
    }
}

/// Classes of rays: see [`class`].
const CLASSES: usize = 24;

/// Rays that are sorted at a time.
const BATCH: usize = 4096;

fn active(packet: &RayPacket) -> u32 {
    (0..LANES).fold(0, |bits, lane| bits | u32::from(packet.is_active(lane)) << lane)
}

fn rays(packet: &RayPacket) -> Rays<LANES> {
    Rays {
        origin: [packet.org_x, packet.org_y, packet.org_z],
        direction: [packet.dir_x, packet.dir_y, packet.dir_z],
        tnear: packet.tnear,
        tfar: packet.tfar,
        time: packet.time,
        mask: packet.mask,
        id: packet.id,
    }
}

/// Where a ray of a call is: packet * LANES + lane.
type Place = u16;

/// Puts rays in the order of their classes; those that take no part are left out. Returns how many there are.
fn sort(packets: &[RayPacket], places: &mut [Place; BATCH]) -> usize {
    let mut classes = [0u8; BATCH];
    let mut counts = [0u16; CLASSES + 1];
    for (packet, classes) in packets.iter().zip(classes.chunks_exact_mut(LANES)) {
        for lane in 0..LANES {
            let [x, y, z] = [packet.dir_x[lane], packet.dir_y[lane], packet.dir_z[lane]];
            let sign = |x: f32| x.to_bits() >> 31;
            let (ax, ay, az) = (x.abs(), y.abs(), z.abs());
            let is_x = (ax > ay) & (ax > az);
            let axis = if is_x { 0 } else { 1 + u32::from(az >= ay) };
            let class = axis << 3 | sign(z) << 2 | sign(y) << 1 | sign(x);
            classes[lane] = if packet.is_active(lane) {
                class as u8
            } else {
                CLASSES as u8
            };
        }
        for &class in &*classes {
            counts[class as usize] += 1;
        }
    }
    let mut first = 0;
    for count in &mut counts {
        first += std::mem::replace(count, first);
    }
    for (place, &class) in classes[..packets.len() * LANES].iter().enumerate() {
        let next = &mut counts[class as usize];
        places[*next as usize] = place as Place;
        *next += 1;
    }
    counts[CLASSES - 1] as usize
}

/// The rays at the given places, and which lanes there are.
fn gather(packets: &[RayPacket], places: &[Place]) -> Rays<LANES> {
    let mut rays = Rays {
        origin: [[0.0; LANES]; 3],
        direction: [[0.0; LANES], [0.0; LANES], [1.0; LANES]],
        tnear: [0.0; LANES],
        tfar: [0.0; LANES],
        time: [0.0; LANES],
        mask: [0; LANES],
        id: [0; LANES],
    };
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
struct Call<'a, S> {
    s: S,
    scene: &'a Scene,
    tree: &'a FixedTree,
    level: Level<'a>,
    asked: Asked<'a>,
    filter: Option<&'a dyn HitFilter>,
}

impl<'a, S: Lanes<LANES> + Kernel> Call<'a, S> {
    #[inline(always)]
    fn new(s: S, scene: &'a Scene, tree: &'a FixedTree, filter: Option<&'a dyn HitFilter>) -> Self {
        Self {
            s,
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
    fn trace<const ANY: bool>(&self, rays: Rays<LANES>, lanes: u32, stack: &mut [u64]) -> (Packet<'a, LANES>, u32) {
        let walk = Walk {
            kernel: self.s,
            scene: self.scene,
            level: &self.level,
        };
        let mut packet = Packet::new(self.s, rays, self.asked);
        let rest = packet.trace::<S, S, ANY>(self.s, &walk, self.tree, lanes, stack);
        (packet, rest)
    }

    /// Traces one ray.
    #[cold]
    fn alone<const ANY: bool>(&self, packet: &RayPacket, lane: usize, stack: &mut [u64; STACK]) -> Option<Query<'a>> {
        self.scene.trace::<S, ANY>(self.s, packet, lane, self.filter, stack)
    }
}

fn lanes_of(mut bits: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = bits.trailing_zeros() as usize;
        (bits != 0).then(|| {
            bits &= bits - 1;
            lane
        })
    })
}

/// Nearest hits.
#[inline(always)]
pub fn intersect<S: Lanes<LANES> + Kernel>(
    s: S,
    scene: &Scene,
    kind: RayKind,
    packets: &[RayPacket],
    hits: &mut [HitPacket],
    filter: Option<&dyn HitFilter>,
) {
    let Some(tree) = &scene.top.fixed else { return };
    let call = Call::new(s, scene, tree, filter);
    let mut stack = [0; STACK];
    if kind == RayKind::Camera {
        for (given, hits) in packets.iter().zip(hits) {
            let lanes = active(given);
            let (packet, rest) = call.trace::<false>(rays(given), lanes, &mut stack);
            *hits = HitPacket {
                geometry: packet.ids[0],
                primitive: packet.ids[1],
                instance: packet.ids[2],
                t: packet.rays.tfar,
            };
            for lane in lanes_of(rest) {
                if let Some(query) = call.alone::<false>(given, lane, &mut stack) {
                    query.store(hits, lane);
                }
            }
        }
        return;
    }
    let mut places = [0; BATCH];
    for (packets, hits) in packets.chunks(BATCH / LANES).zip(hits.chunks_mut(BATCH / LANES)) {
        for (packet, hits) in packets.iter().zip(&mut *hits) {
            *hits = HitPacket {
                t: packet.tfar,
                ..HitPacket::EMPTY
            };
        }
        let count = sort(packets, &mut places);
        for places in places[..count].chunks(LANES) {
            let lanes = (1 << places.len()) - 1;
            let (packet, rest) = call.trace::<false>(gather(packets, places), lanes, &mut stack);
            for (lane, &place) in places.iter().enumerate() {
                let (at, to) = (place as usize / LANES, place as usize % LANES);
                if rest >> lane & 1 == 1 {
                    if let Some(query) = call.alone::<false>(&packets[at], to, &mut stack) {
                        query.store(&mut hits[at], to);
                    }
                    continue;
                }
                hits[at].geometry[to] = packet.ids[0][lane];
                hits[at].primitive[to] = packet.ids[1][lane];
                hits[at].instance[to] = packet.ids[2][lane];
                hits[at].t[to] = packet.rays.tfar[lane];
            }
        }
    }
}

/// Whether there is any hit.
#[inline(always)]
pub fn occluded<S: Lanes<LANES> + Kernel>(
    s: S,
    scene: &Scene,
    packets: &mut [RayPacket],
    filter: Option<&dyn HitFilter>,
) {
    let Some(tree) = &scene.top.fixed else { return };
    let call = Call::new(s, scene, tree, filter);
    let mut stack = [0; STACK];
    let mut places = [0; BATCH];
    for packets in packets.chunks_mut(BATCH / LANES) {
        let count = sort(packets, &mut places);
        for places in places[..count].chunks(LANES) {
            let lanes = (1 << places.len()) - 1;
            let (packet, rest) = call.trace::<true>(gather(packets, places), lanes, &mut stack);
            let mut found = packet.hits(s) & lanes;
            for lane in lanes_of(rest) {
                let place = places[lane] as usize;
                if let Some(query) = call.alone::<true>(&packets[place / LANES], place % LANES, &mut stack) {
                    found |= u32::from(query.is_hit()) << lane;
                }
            }
            for lane in lanes_of(found) {
                let place = places[lane] as usize;
                packets[place / LANES].tfar[place % LANES] = f32::NEG_INFINITY;
            }
        }
    }
}
