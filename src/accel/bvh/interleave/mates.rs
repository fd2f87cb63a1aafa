//! Rays of a packet that are on their way, each by itself.

use super::LANES;
use crate::accel::bvh::lanes::Lanes;
use crate::accel::bvh::prepare::{Prepared, Row};
use crate::accel::bvh::query::{Asked, CULL_SLACK, Candidate, Query};
use crate::accel::bvh::ray::Slabs;
use crate::accel::bvh::triangle::{Shear, Shears};
use crate::geometry::{HitPacket, RayPacket};

/// The rays of a packet, prepared, and what they have hit.
#[repr(C, align(64))]
pub struct Mates {
    /// The rays, up to their nearest hits.
    pub prepared: Prepared<LANES>,
    /// Boxes beyond this are passed over.
    pub cull: Row<LANES>,
    /// The axes of the shears of the rays: see [`Shear::axes`].
    axes: [[u32; LANES]; 3],
    /// See [`Slab::negative`](crate::accel::bvh::ray::Slab::negative).
    negative: [[u32; LANES]; 3],
    /// Nearest hits: geometries, primitives, instances.
    pub ids: [[u32; LANES]; 3],
    /// Which packet it is, to the caller.
    pub packet: usize,
    /// Those that have not come to their ends.
    pub left: u32,
    /// Of occlusion, those that have hit something.
    pub found: u32,
}

impl Mates {
    /// No rays.
    pub fn none() -> Self {
        Self {
            prepared: Prepared::none(),
            cull: [0.0; LANES],
            axes: [[0; LANES]; 3],
            negative: [[0; LANES]; 3],
            ids: [[HitPacket::NONE; LANES]; 3],
            packet: 0,
            left: 0,
            found: 0,
        }
    }

    /// Takes the rays of a packet, of which there are none left yet.
    #[inline(always)]
    pub fn load<S: Lanes<LANES>>(&mut self, s: S, index: usize, packet: &RayPacket) {
        let rays = &mut self.prepared.rays;
        rays.origin[0] = packet.org_x;
        rays.origin[1] = packet.org_y;
        rays.origin[2] = packet.org_z;
        rays.direction[0] = packet.dir_x;
        rays.direction[1] = packet.dir_y;
        rays.direction[2] = packet.dir_z;
        (rays.tnear, rays.tfar, rays.time) = (packet.tnear, packet.tfar, packet.time);
        (rays.mask, rays.id) = (packet.mask, packet.id);
        self.prepared.prepare(s);
        let tfar = s.load(&packet.tfar);
        s.store(s.mul(tfar, s.splat(CULL_SLACK)), &mut self.cull);
        let [x_greatest, y_greatest, _] = self.prepared.greatest;
        for lane in 0..LANES as u32 {
            // 0, 1 or 2, the others in cyclic order after it.
            let z = 2 - 2 * (x_greatest >> lane & 1) - (y_greatest >> lane & 1);
            let x = if z == 2 { 0 } else { z + 1 };
            let y = if x == 2 { 0 } else { x + 1 };
            (0..3).for_each(|i| self.axes[i][lane as usize] = [x, y, z][i]);
        }
        for axis in 0..3 {
            for lane in 0..LANES {
                self.negative[axis][lane] = self.prepared.rays.direction[axis][lane].to_bits() >> 31;
            }
        }
        self.ids = [[HitPacket::NONE; LANES]; 3];
        (self.packet, self.left, self.found) = (index, 0, 0);
    }

    /// The state of one ray's query.
    #[inline(always)]
    pub fn query<'a>(&self, lane: usize, asked: Asked<'a>) -> Query<'a> {
        Query {
            ids: self.ids.map(|row| row[lane]),
            ..self.prepared.query(lane, asked)
        }
    }

    /// Keeps what a query has come to.
    #[inline(always)]
    pub fn take(&mut self, lane: usize, query: &Query) {
        self.prepared.rays.tfar[lane] = query.tfar * query.scale;
        self.cull[lane] = query.cull;
        (0..3).for_each(|i| self.ids[i][lane] = query.ids[i]);
    }

    /// [`Query::offer`] of one ray.
    #[inline(always)]
    pub fn offer(
        &mut self,
        lane: usize,
        candidate: &Candidate,
        asked: Asked,
        uv: impl FnOnce(Shear) -> [f32; 2],
    ) -> bool {
        if asked.is_filtered(candidate.geometry) {
            return self.offer_filtered(lane, candidate, asked, uv);
        }
        let precedes = candidate.precedes(self.prepared.rays.tfar[lane], || self.ids.map(|row| row[lane]));
        if precedes {
            self.prepared.rays.tfar[lane] = candidate.t;
            self.cull[lane] = candidate.t * CULL_SLACK;
            self.ids[0][lane] = candidate.geometry;
            self.ids[1][lane] = candidate.primitive;
            self.ids[2][lane] = candidate.instance;
        }
        precedes
    }

    #[cold]
    #[inline(never)]
    fn offer_filtered(
        &mut self,
        lane: usize,
        candidate: &Candidate,
        asked: Asked,
        uv: impl FnOnce(Shear) -> [f32; 2],
    ) -> bool {
        let mut query = self.query(lane, asked);
        let accepted = query.offer(candidate, || uv(self.prepared.shear(lane)));
        self.take(lane, &query);
        accepted
    }
}

/// One of them.
#[derive(Clone, Copy)]
pub struct Member<'a> {
    /// All.
    pub mates: &'a Mates,
    /// Which.
    pub lane: usize,
}

impl Slabs for Member<'_> {
    #[inline(always)]
    fn near(self, axis: usize) -> [f32; 2] {
        let (rays, lane) = (&self.mates.prepared, self.lane % LANES);
        [rays.near_scale[axis][lane], rays.near_shift[axis][lane]]
    }
    #[inline(always)]
    fn far(self, axis: usize) -> [f32; 2] {
        let (rays, lane) = (&self.mates.prepared, self.lane % LANES);
        [rays.far_scale[axis][lane], rays.far_shift[axis][lane]]
    }
    #[inline(always)]
    fn negative(self, axis: usize) -> usize {
        self.mates.negative[axis][self.lane % LANES] as usize
    }
}

impl Shears for Member<'_> {
    #[inline(always)]
    fn axis(self, i: usize) -> usize {
        self.mates.axes[i][self.lane % LANES] as usize
    }
    #[inline(always)]
    fn origin(self, i: usize) -> f32 {
        self.mates.prepared.rays.origin[i][self.lane % LANES]
    }
    #[inline(always)]
    fn direction(self, i: usize) -> f32 {
        self.mates.prepared.rays.direction[i][self.lane % LANES]
    }
    #[inline(always)]
    fn scale(self, i: usize) -> f32 {
        self.mates.prepared.scale[i][self.lane % LANES]
    }
    #[inline(always)]
    fn inverse(self, i: usize) -> f32 {
        self.mates.prepared.inverse[self.axis(i)][self.lane % LANES]
    }
    #[inline(always)]
    fn shear(self) -> Shear {
        self.mates.prepared.shear(self.lane)
    }
}
