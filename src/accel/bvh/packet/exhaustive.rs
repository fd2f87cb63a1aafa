//! A packet of any rays against all primitives of a world that has few.
//!
//! What triangles have in common is computed once: corners, edges, and where boxes begin and end. The few rays that single precision cannot
//! decide about are left to be traced alone.

use super::Packet;
use super::seen::Seen;
use crate::accel::bvh::few::Facet;
use crate::accel::bvh::lanes::Lanes;
use crate::accel::bvh::query::Candidate;
use crate::geometry::HitPacket;

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
        let tnear = s.load(&self.prepared.rays.tnear);
        let wide = s.widen(&self.prepared.rays);
        let (mut open, mut unclear) = (all, 0);
        for facet in &seen.few.facets {
            let through = open & seen.through(facet);
            if through == 0 {
                continue;
            }
            let tfar = s.load(&self.prepared.rays.tfar);
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
            let within = s.and(s.lt(tnear, t), s.le(t, tfar));
            self.take_all(s, t, lanes & s.bits(within), &candidate(facet));
        }
        if let (true, Some(facet)) = (ANY, seen.few.facets.first()) {
            // Which one they have met does not matter.
            self.mark(s, all & !open, &candidate(facet));
        }
        unclear
    }
}

/// A hit with a triangle.
#[inline(always)]
fn candidate(facet: &Facet) -> Candidate {
    let [geometry, primitive] = facet.ids;
    Candidate {
        t: 0.0,
        geometry,
        primitive,
        instance: HitPacket::NONE,
    }
}
