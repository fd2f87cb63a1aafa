//! Rays and what belongs to them, side by side in packets.

use crate::geometry::{LANES, Ray, RayLanes, RayPacket, RayQueue};
use crate::math::{Append, Columns, Each, LaneSet, Packing, Shuffle, Vectorizer};

/// What eight lanes hold, to be looked at lane by lane.
pub(super) trait Packet: Columns + Copy {
    /// What one of them holds.
    type Lane: Copy;

    /// The same in all lanes.
    fn all(value: Self::Lane) -> Self;

    /// What a lane holds.
    fn get(&self, lane: usize) -> Self::Lane;

    /// Puts `value` into a lane.
    fn set(&mut self, lane: usize, value: Self::Lane);
}

impl<T: Copy> Packet for Each<T> {
    type Lane = T;

    #[inline(always)]
    fn all(value: T) -> Self {
        Self([value; _])
    }

    #[inline(always)]
    fn get(&self, lane: usize) -> T {
        self.0[lane]
    }

    #[inline(always)]
    fn set(&mut self, lane: usize, value: T) {
        self.0[lane] = value;
    }
}

/// Rays in packets, and to each packet of them one of what belongs to them: ray i is lane i % 8 of packet i / 8.
#[derive(Clone, Debug)]
pub(super) struct Queue<P> {
    rays: RayQueue,
    /// Those from the last in use on are left over from a longer queue.
    packets: Vec<P>,
}

impl<P> Default for Queue<P> {
    fn default() -> Self {
        Self {
            rays: RayQueue::default(),
            packets: Vec::new(),
        }
    }
}

impl<P: Packet> Queue<P> {
    /// Adds a valid ray, and what belongs to it.
    #[inline(always)]
    pub fn push(&mut self, ray: &Ray, value: P::Lane) {
        let (packet, lane) = (self.rays.len() / LANES, self.rays.len() % LANES);
        if packet == self.packets.len() {
            self.packets.push(P::all(value));
        } else {
            self.packets[packet].set(lane, value);
        }
        self.rays.push(ray);
    }

    /// Adds a packet of rays, of which some may take no part, and one of what belongs to them, for the caller to write: they are what happens
    /// to be there, or `any`. All lanes that are held so far are whole packets.
    #[inline]
    pub fn push_any_packet(&mut self, any: impl FnOnce() -> P) -> (&mut RayPacket, &mut P) {
        let packet = self.rays.len() / LANES;
        if packet == self.packets.len() {
            self.packets.push(any());
        }
        (self.rays.push_any_packet(), &mut self.packets[packet])
    }

    /// Adds `chosen` lanes of `rays`, which must be valid, and of `values`. The queue grows by `any` packet.
    #[inline(always)]
    pub fn append(
        &mut self,
        vectorizer: Vectorizer,
        chosen: LaneSet,
        rays: &RayLanes,
        values: &impl Columns<P>,
        any: &P,
    ) {
        let (len, queue) = (self.rays.len(), self);
        vectorizer.append(
            chosen,
            len,
            AppendLanes {
                queue,
                rays,
                values,
                any,
            },
        );
    }

    /// Number of rays.
    #[inline]
    pub fn len(&self) -> usize {
        self.rays.len()
    }

    /// Whether there are none.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.rays.is_empty()
    }

    /// Forgets all.
    pub fn clear(&mut self) {
        self.rays.clear();
    }

    /// The rays.
    #[inline]
    pub fn rays(&self) -> &[RayPacket] {
        self.rays.packets()
    }

    /// The rays, for a backend to write to.
    #[inline]
    pub fn rays_mut(&mut self) -> &mut [RayPacket] {
        self.rays.packets_mut()
    }

    /// The rays, and what belongs to them; of lanes of the last packet without a ray this is of no meaning.
    #[inline]
    pub fn packets(&self) -> impl Iterator<Item = (&RayPacket, &P)> {
        self.rays.packets().iter().zip(&self.packets)
    }
}

/// See [`Queue::append`].
struct AppendLanes<'a, P, C> {
    queue: &'a mut Queue<P>,
    rays: &'a RayLanes,
    values: &'a C,
    any: &'a P,
}

impl<P: Packet, C: Columns<P>> Append for AppendLanes<'_, P, C> {
    #[inline(always)]
    fn append<S: Shuffle>(self, packing: &Packing<S>) {
        packing.append(&mut self.queue.packets, self.values, self.any);
        self.queue.rays.append(packing, self.rays);
    }
}
