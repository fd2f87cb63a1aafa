//! A call's rays among few primitives: packets of neighbours. Functions of their own, or the others would get fewer registers.
//! They have no filter, as few primitives never do ([`Few`]).

use super::{Call, neighbours};
use crate::accel::bvh::Scene;
use crate::accel::bvh::few::Few;
use crate::accel::bvh::interleave::Interleaved;
use crate::accel::bvh::lanes::{Lanes, lanes_of};
use crate::accel::bvh::order::Room;
use crate::geometry::{HitPacket, LANES, RayPacket};

/// Nearest hits among few primitives, which all rays are tested against.
#[inline(always)]
pub fn intersect_few<S: Lanes<N>, K: Interleaved, const N: usize>(
    s: S,
    kernel: K,
    (scene, few): (&Scene, &Few),
    packets: &[RayPacket],
    hits: &mut [HitPacket],
) {
    let Some(tree) = &scene.top.fixed else { return };
    let call = Call::new(s, kernel, scene, tree, None);
    let mut room = Room::take();
    let Room { stack, seen, .. } = &mut *room;
    let mut seen = seen.of(few);
    for (given, hits) in packets.chunks(N / LANES).zip(hits.chunks_mut(N / LANES)) {
        let (rays, lanes) = neighbours(given);
        let (packet, rest) = call.exhaust::<false>(&mut seen, rays, lanes);
        call.keep(&packet, rest, given, hits, stack);
    }
    room.put();
}

/// Whether there is any hit among few primitives.
#[inline(always)]
pub fn occluded_few<S: Lanes<N>, K: Interleaved, const N: usize>(
    s: S,
    kernel: K,
    (scene, few): (&Scene, &Few),
    packets: &mut [RayPacket],
) {
    let Some(tree) = &scene.top.fixed else { return };
    let call = Call::new(s, kernel, scene, tree, None);
    let mut room = Room::take();
    let Room { stack, seen, .. } = &mut *room;
    let mut seen = seen.of(few);
    for given in packets.chunks_mut(N / LANES) {
        let (rays, lanes) = neighbours(given);
        let (packet, rest) = call.exhaust::<true>(&mut seen, rays, lanes);
        let mut found = packet.hits(s) & lanes;
        for lane in lanes_of(rest) {
            if let Some(query) = call.alone::<true>(&given[lane / LANES], lane % LANES, stack) {
                found |= u32::from(query.is_hit()) << lane;
            }
        }
        for lane in lanes_of(found) {
            given[lane / LANES].tfar[lane % LANES] = f32::NEG_INFINITY;
        }
    }
    room.put();
}
