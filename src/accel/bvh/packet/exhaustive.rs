//! A packet of any rays against all primitives of a world that has few.
//!
//! What triangles have in common is computed once: corners, edges, and where boxes begin and end. The few rays that single precision cannot
//! decide about are left to be traced alone.

use super::Packet;
use super::seen::Seen;
use crate::accel::bvh::lanes::{Lanes, lanes_of};

impl<const N: usize> Packet<'_, N> {
    /// Tests the rays of `lanes` against all primitives. Returns those that it leaves out, as single precision cannot decide about them or their
    /// directions are of an unusual size.
    #[inline(always)]
    pub fn exhaust<S: Lanes<N>, const ANY: bool>(&mut self, s: S, seen: &mut Seen<'_>, lanes: u32) -> u32 {
        let mask = s.meet(s.load_u(&self.prepared.rays.mask), s.splat_u(seen.few.mask));
        let met = lanes & s.bits(mask);
        let mut clear = met & self.prepared.usual;
        for ball in &seen.few.balls {
            self.ball(s, ball, clear);
        }
        if !seen.few.facets.is_empty() {
            clear &= seen.look(s, &self.prepared);
            let open = if ANY { clear & !self.hits(s) } else { clear };
            clear &= !self.facets::<S, ANY>(s, seen, open);
        }
        met & !clear
    }

    /// Tests the rays of `all` against all triangles. Returns those that single precision cannot decide about: they pass through one but
    /// miss its box by rounding, or are parallel to it.
    #[inline(always)]
    fn facets<S: Lanes<N>, const ANY: bool>(&mut self, s: S, seen: &Seen<'_>, all: u32) -> u32 {
        let wide = s.widen(&self.prepared.rays);
        let (tnear, mut tfar) = (s.load(&self.prepared.rays.tnear), s.load(&self.prepared.rays.tfar));
        // What is met stays in registers: the next triangle would wait for memory.
        let [mut geometries, mut primitives] = [s.load_u(&self.ids[0]), s.load_u(&self.ids[1])];
        let (mut open, mut unclear) = (all, 0);
        for facet in &seen.few.facets {
            let through = open & seen.through(facet);
            if through == 0 {
                continue;
            }
            let [first, last] = seen.range(s, facet);
            unclear |= through & s.bits(s.lt(last, first));
            let mut lanes = through & s.bits(s.and(s.lt(tnear, last), s.le(first, tfar)));
            if lanes == 0 {
                continue;
            }
            if ANY {
                // Wherever in its box the triangle is met, that counts.
                let certain = lanes & s.bits(s.and(s.lt(tnear, first), s.le(last, tfar)));
                open &= !certain;
                lanes &= !certain;
                if lanes == 0 {
                    if open == 0 {
                        break;
                    }
                    continue;
                }
            }
            let distances = s.plane_distance(&facet.plane, &wide);
            let finite = s.bits(s.lt(s.abs(distances), s.splat(f32::INFINITY)));
            unclear |= lanes & !finite;
            let t = s.least(s.greatest(distances, first), last);
            let inside = lanes & s.bits(s.and(s.lt(tnear, t), s.le(t, tfar)));
            let mut closer = inside & s.bits(s.lt(t, tfar));
            if closer != inside {
                closer |= preceding(s, inside & !closer, facet.ids, [geometries, primitives]);
            }
            let closer = s.mask(closer);
            let [geometry, primitive] = facet.ids;
            tfar = s.blend(closer, tfar, t);
            geometries = s.blend_u(closer, geometries, s.splat_u(geometry));
            primitives = s.blend_u(closer, primitives, s.splat_u(primitive));
        }
        if ANY {
            // Which one they have met does not matter.
            geometries = s.blend_u(s.mask(all & !open), geometries, s.splat_u(0));
        }
        s.store(tfar, &mut self.prepared.rays.tfar);
        s.store_u(geometries, &mut self.ids[0]);
        s.store_u(primitives, &mut self.ids[1]);
        unclear
    }
}

/// Of `lanes`, which meet a triangle with these ids at the distance of what they have met, those that it precedes.
#[cold]
#[inline(always)]
fn preceding<S: Lanes<N>, const N: usize>(s: S, lanes: u32, ids: [u32; 2], met: [S::U; 2]) -> u32 {
    let mut rows = [[0; N]; 2];
    s.store_u(met[0], &mut rows[0]);
    s.store_u(met[1], &mut rows[1]);
    let precedes = |&lane: &usize| ids < [rows[0][lane], rows[1][lane]];
    lanes_of(lanes).filter(precedes).fold(0, |bits, lane| bits | 1 << lane)
}
