//! Rays and hits in struct-of-arrays packets.

use crate::math::{Columns, LANES, LaneSet, Lanes, Packing, Shuffle, Vec3, Vec3Lanes, VectorLanes};

/// One ray, as it is put into a packet.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Origin, world space.
    pub origin: Vec3,
    /// Direction, world space, of any length but 0; distances are in its units.
    pub direction: Vec3,
    /// Hits nearer than this do not count.
    pub tnear: f32,
    /// Nor those farther than this; may be infinite.
    pub tfar: f32,
    /// Scene time, in [0, 1].
    pub time: f32,
    /// Only geometries and instances that share a bit with this are seen.
    pub mask: u32,
    /// Handed to a hit filter, so that what it decides can be a function of the ray.
    pub id: u32,
}

impl Ray {
    /// The largest magnitude of an element of origin or direction: squares must stay finite, and Embree, as Debian 12 builds it,
    /// ends the process above 1.844e18.
    pub const LARGEST: f32 = 1.8e18;

    /// A ray that takes no part.
    pub const INACTIVE: Self = Self {
        origin: Vec3::ZERO,
        direction: Vec3::Z,
        tnear: 0.0,
        tfar: f32::NEG_INFINITY,
        time: 0.0,
        mask: 0,
        id: 0,
    };

    /// A ray that sees everything, at any distance.
    pub fn new(origin: Vec3, direction: Vec3, time: f32) -> Self {
        Self {
            origin,
            direction,
            tnear: 0.0,
            tfar: f32::INFINITY,
            time,
            mask: u32::MAX,
            id: 0,
        }
    }

    /// Whether a backend may be given it: nothing NaN, no element of origin and direction beyond [`Ray::LARGEST`], the direction
    /// not zero, time in [0, 1].
    #[inline]
    pub fn is_valid(&self) -> bool {
        // Comparisons are false of NaN. One branch in all: nearly every ray is valid.
        let origin = self.origin.abs().to_array().map(|x| x <= Self::LARGEST);
        let direction = self.direction.abs().to_array().map(|x| x <= Self::LARGEST);
        (origin[0] & origin[1] & origin[2])
            & (direction[0] & direction[1] & direction[2])
            & (self.direction != Vec3::ZERO)
            & (self.tnear >= 0.0)
            & !self.tfar.is_nan()
            & (self.time >= 0.0)
            & (self.time <= 1.0)
    }
}

/// Eight rays. A lane takes part if `tnear <= tfar`; every lane that does must be [valid](Ray::is_valid).
///
/// The layout is that of Embree's `RTCRay8`.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub struct RayPacket {
    /// Origin, x.
    pub org_x: [f32; LANES],
    /// Origin, y.
    pub org_y: [f32; LANES],
    /// Origin, z.
    pub org_z: [f32; LANES],
    /// Start of the segment.
    pub tnear: [f32; LANES],
    /// Direction, x.
    pub dir_x: [f32; LANES],
    /// Direction, y.
    pub dir_y: [f32; LANES],
    /// Direction, z.
    pub dir_z: [f32; LANES],
    /// Scene time, in [0, 1].
    pub time: [f32; LANES],
    /// End of the segment.
    pub tfar: [f32; LANES],
    /// See [`Ray::mask`].
    pub mask: [u32; LANES],
    /// See [`Ray::id`].
    pub id: [u32; LANES],
    /// Room that Embree's layout has; 0.
    pub flags: [u32; LANES],
}

impl RayPacket {
    /// A packet none of whose lanes takes part.
    pub const EMPTY: Self = Self {
        org_x: [0.0; LANES],
        org_y: [0.0; LANES],
        org_z: [0.0; LANES],
        tnear: [0.0; LANES],
        dir_x: [0.0; LANES],
        dir_y: [0.0; LANES],
        dir_z: [1.0; LANES],
        time: [0.0; LANES],
        tfar: [f32::NEG_INFINITY; LANES],
        mask: [0; LANES],
        id: [0; LANES],
        flags: [0; LANES],
    };

    /// Puts `ray` into `lane`.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, ray: &Ray) {
        [self.org_x[lane], self.org_y[lane], self.org_z[lane]] = ray.origin.to_array();
        [self.dir_x[lane], self.dir_y[lane], self.dir_z[lane]] = ray.direction.to_array();
        self.tnear[lane] = ray.tnear;
        self.tfar[lane] = ray.tfar;
        self.time[lane] = ray.time;
        self.mask[lane] = ray.mask;
        self.id[lane] = ray.id;
    }

    /// The ray in `lane`.
    #[inline]
    pub fn get(&self, lane: usize) -> Ray {
        Ray {
            origin: self.origin(lane),
            direction: self.direction(lane),
            tnear: self.tnear[lane],
            tfar: self.tfar[lane],
            time: self.time[lane],
            mask: self.mask[lane],
            id: self.id[lane],
        }
    }

    /// The direction of the ray in `lane`.
    #[inline(always)]
    pub fn direction(&self, lane: usize) -> Vec3 {
        Vec3::new(self.dir_x[lane], self.dir_y[lane], self.dir_z[lane])
    }

    /// The origin of the ray in `lane`.
    #[inline(always)]
    pub fn origin(&self, lane: usize) -> Vec3 {
        Vec3::new(self.org_x[lane], self.org_y[lane], self.org_z[lane])
    }

    /// Whether `lane` takes part.
    #[inline]
    pub fn is_active(&self, lane: usize) -> bool {
        self.tnear[lane] <= self.tfar[lane]
    }

    /// Whether an occlusion query found something in the way of `lane`: it then has set its `tfar` to negative infinity.
    #[inline]
    pub fn is_occluded(&self, lane: usize) -> bool {
        self.tfar[lane] == f32::NEG_INFINITY
    }
}

/// Rays of eight lanes that see everything, from 0 on: [`Ray::new`].
#[derive(Clone, Copy, Debug, Default)]
pub struct RayLanes {
    /// See [`Ray::origin`].
    pub origin: Vec3Lanes,
    /// See [`Ray::direction`].
    pub direction: Vec3Lanes,
    /// See [`Ray::tfar`].
    pub tfar: Lanes,
    /// See [`Ray::time`].
    pub time: Lanes,
}

impl RayLanes {
    /// Puts a ray into `lane`.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, origin: Vec3, direction: Vec3, tfar: f32, time: f32) {
        self.origin.set(lane, origin);
        self.direction.set(lane, direction);
        (self.tfar[lane], self.time[lane]) = (tfar, time);
    }
}

impl Columns<RayPacket> for RayLanes {
    #[inline(always)]
    fn pack<S: Shuffle>(&self, packing: &Packing<S>, last: &mut RayPacket, next: &mut RayPacket) {
        let [x, y, z] = self.origin.columns();
        x.pack(packing, &mut last.org_x, &mut next.org_x);
        y.pack(packing, &mut last.org_y, &mut next.org_y);
        z.pack(packing, &mut last.org_z, &mut next.org_z);
        let [x, y, z] = self.direction.columns();
        x.pack(packing, &mut last.dir_x, &mut next.dir_x);
        y.pack(packing, &mut last.dir_y, &mut next.dir_y);
        z.pack(packing, &mut last.dir_z, &mut next.dir_z);
        self.tfar.pack(packing, &mut last.tfar, &mut next.tfar);
        self.time.pack(packing, &mut last.time, &mut next.time);
        [0.0; LANES].pack(packing, &mut last.tnear, &mut next.tnear);
        packing.fill(u32::MAX, &mut last.mask, &mut next.mask);
        packing.fill(0, &mut last.id, &mut next.id);
    }
}

/// Rays, packed as they come: ray i is lane i % 8 of packet i / 8. Lanes of the last packet that hold no ray take no part.
#[derive(Clone, Debug, Default)]
pub struct RayQueue {
    /// Those from the last in use on are left over from a longer queue.
    packets: Vec<RayPacket>,
    len: usize,
}

impl RayQueue {
    /// Adds a ray.
    #[inline(always)]
    pub fn push(&mut self, ray: &Ray) {
        let (packet, lane) = (self.len / LANES, self.len % LANES);
        if lane == 0 {
            if packet == self.packets.len() {
                self.packets.push(RayPacket::EMPTY);
            }
            self.packets[packet].tfar = RayPacket::EMPTY.tfar;
        }
        self.packets[packet].set(lane, ray);
        self.len += 1;
    }

    /// Adds eight rays, of which some may take no part, to others that are whole packets: they are what happens to be there, for the caller
    /// to write.
    #[inline]
    pub fn push_any_packet(&mut self) -> &mut RayPacket {
        debug_assert!(self.len.is_multiple_of(LANES));
        let packet = self.len / LANES;
        if packet == self.packets.len() {
            self.packets.push(RayPacket::EMPTY);
        }
        self.len += LANES;
        &mut self.packets[packet]
    }

    /// Adds the chosen lanes of `rays`, `packing` being for as many as there are.
    #[inline(always)]
    pub fn append<S: Shuffle>(&mut self, packing: &Packing<S>, rays: &impl Columns<RayPacket>) {
        packing.append(&mut self.packets, rays, &RayPacket::EMPTY);
        if let Some([last, next]) = self.packets[self.len / LANES..].first_chunk_mut() {
            packing.end_with(f32::NEG_INFINITY, &mut last.tfar, &mut next.tfar);
        }
        self.len += packing.added();
    }

    /// Number of rays.
    #[inline]
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Forgets all rays.
    pub fn clear(&mut self) {
        self.len = 0;
    }

    /// Their packets.
    #[inline]
    pub fn packets(&self) -> &[RayPacket] {
        &self.packets[..self.len.div_ceil(LANES)]
    }

    /// Their packets, for a backend to write to.
    #[inline]
    pub fn packets_mut(&mut self) -> &mut [RayPacket] {
        &mut self.packets[..self.len.div_ceil(LANES)]
    }
}

impl FromIterator<Ray> for RayQueue {
    fn from_iter<I: IntoIterator<Item = Ray>>(rays: I) -> Self {
        let mut queue = Self::default();
        rays.into_iter().for_each(|ray| queue.push(&ray));
        queue
    }
}

/// What eight rays hit: ids only, and the backend's distance. Barycentrics and an exact distance are recomputed from the ray
/// and the primitive by [`World::interaction`](super::World::interaction), so that backends and vector widths agree.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub struct HitPacket {
    /// The geometry, or [`HitPacket::NONE`] for a miss or a lane that took no part.
    pub geometry: [u32; LANES],
    /// The primitive of that geometry.
    pub primitive: [u32; LANES],
    /// The instance it was seen through, or [`HitPacket::NONE`] for geometry of the top level.
    pub instance: [u32; LANES],
    /// Distance as the backend has it; `tfar` of the ray for a miss.
    pub t: [f32; LANES],
}

impl HitPacket {
    /// "Nothing" in each of the id arrays.
    pub const NONE: u32 = u32::MAX;

    /// Eight misses.
    pub const EMPTY: Self = Self {
        geometry: [Self::NONE; LANES],
        primitive: [Self::NONE; LANES],
        instance: [Self::NONE; LANES],
        t: [f32::INFINITY; LANES],
    };

    /// The lanes that hit something.
    #[inline]
    pub fn hit_lanes(&self) -> LaneSet {
        self.geometry.map(|geometry| geometry != Self::NONE).into()
    }

    /// Whether `lane` hit something.
    #[inline]
    pub fn is_hit(&self, lane: usize) -> bool {
        self.geometry[lane] != Self::NONE
    }
}
