//! Calls that the layer does not make as they are slower there, for measuring: single rays, packets of 4 and of 16, streams of nearest
//! hits. What goes with a call is copied from the layer's packets of 8 and back, which is part of their cost there.

use std::ffi::{c_int, c_uint};
use std::mem::MaybeUninit;

use embree_sys as ffi;

use super::query::{Query, STREAM_PACKETS, SingleRay, single_rays};
use crate::geometry::{HitPacket, LANES, RayPacket};

/// Lanes that are copied at a time: they divide every width.
const RUN: usize = 4;

/// Which of Embree's calls traces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Entry {
    /// `rtcIntersect1`, `rtcOccluded1`.
    Single,
    /// `rtcIntersect4`, `rtcOccluded4`.
    Packet4,
    /// `rtcIntersect8`, `rtcOccluded8`.
    Packet8,
    /// `rtcIntersect16`, `rtcOccluded16`.
    Packet16,
    /// `rtcIntersect1M`, `rtcOccluded1M`, of Embree 3.
    Stream,
}

impl Entry {
    /// Those that the library has.
    pub const AVAILABLE: &[Self] = if ffi::EMBREE_HAS_STREAMS == 1 {
        &[Self::Single, Self::Packet4, Self::Packet8, Self::Packet16, Self::Stream]
    } else {
        &[Self::Single, Self::Packet4, Self::Packet8, Self::Packet16]
    };
}

/// Where lane `first` of a row of packets of 8 is: packet and lane.
fn place(first: usize) -> (usize, usize) {
    (first / LANES, first % LANES)
}

/// Defines nearest hits and occlusion by packets of `$width` rays.
macro_rules! packets_of {
    ($width:literal, $align:literal, $rays:ident, $hits:ident, $intersect:ident by $trace:ident, $occluded:ident by $any:ident) => {
        impl Query<'_> {
            fn $intersect(&self, rays: &[RayPacket], hits: &mut [HitPacket]) {
                #[repr(align($align))]
                struct Valid([c_int; $width]);
                self.run(|query| {
                    // SAFETY: numbers only, for which zero is a value.
                    let mut packet: ffi::$hits = unsafe { MaybeUninit::zeroed().assume_init() };
                    for first in (0..rays.len() * LANES).step_by($width) {
                        let mut valid = Valid([0; $width]);
                        packet.hit.geomID = [ffi::EMBREE_INVALID_ID; $width];
                        packet.hit.instID[0] = [ffi::EMBREE_INVALID_ID; $width];
                        for run in (0..$width).step_by(RUN) {
                            let (index, lane) = place(first + run);
                            let Some(from) = rays.get(index) else { continue };
                            copy_in!(packet.ray, from, valid, run, lane);
                        }
                        // SAFETY: the scene is committed; mask, packet and query are live, aligned, and this thread's own.
                        unsafe { ffi::$trace(valid.0.as_ptr(), self.scene.raw(), query, &raw mut packet) };
                        for run in 0..$width {
                            let (index, lane) = place(first + run);
                            let Some(to) = hits.get_mut(index) else { break };
                            store(
                                to,
                                lane,
                                packet.hit.geomID[run],
                                packet.hit.primID[run],
                                packet.hit.instID[0][run],
                            );
                            to.t[lane] = packet.ray.tfar[run];
                        }
                    }
                });
            }

            fn $occluded(&self, rays: &mut [RayPacket]) {
                #[repr(align($align))]
                struct Valid([c_int; $width]);
                self.run(|query| {
                    // SAFETY: numbers only, for which zero is a value.
                    let mut packet: ffi::$rays = unsafe { MaybeUninit::zeroed().assume_init() };
                    for first in (0..rays.len() * LANES).step_by($width) {
                        let mut valid = Valid([0; $width]);
                        for run in (0..$width).step_by(RUN) {
                            let (index, lane) = place(first + run);
                            let Some(from) = rays.get(index) else { continue };
                            copy_in!(packet, from, valid, run, lane);
                        }
                        // SAFETY: as above.
                        unsafe { ffi::$any(valid.0.as_ptr(), self.scene.raw(), query, &raw mut packet) };
                        for run in (0..$width).step_by(RUN) {
                            let (index, lane) = place(first + run);
                            let Some(to) = rays.get_mut(index) else { break };
                            to.tfar[lane..lane + RUN].copy_from_slice(&packet.tfar[run..run + RUN]);
                        }
                    }
                });
            }
        }
    };
}

/// Copies a run of lanes of a packet of 8 into another packet, and says which of them take part.
macro_rules! copy_in {
    ($to:expr, $from:ident, $valid:ident, $run:ident, $lane:ident) => {{
        let (to, from) = ($run..$run + RUN, $lane..$lane + RUN);
        $to.org_x[to.clone()].copy_from_slice(&$from.org_x[from.clone()]);
        $to.org_y[to.clone()].copy_from_slice(&$from.org_y[from.clone()]);
        $to.org_z[to.clone()].copy_from_slice(&$from.org_z[from.clone()]);
        $to.tnear[to.clone()].copy_from_slice(&$from.tnear[from.clone()]);
        $to.dir_x[to.clone()].copy_from_slice(&$from.dir_x[from.clone()]);
        $to.dir_y[to.clone()].copy_from_slice(&$from.dir_y[from.clone()]);
        $to.dir_z[to.clone()].copy_from_slice(&$from.dir_z[from.clone()]);
        $to.time[to.clone()].copy_from_slice(&$from.time[from.clone()]);
        $to.tfar[to.clone()].copy_from_slice(&$from.tfar[from.clone()]);
        $to.mask[to.clone()].copy_from_slice(&$from.mask[from.clone()]);
        $to.id[to].copy_from_slice(&$from.id[from]);
        for i in 0..RUN {
            $valid.0[$run + i] = -c_int::from($from.is_active($lane + i));
        }
    }};
}

packets_of!(4, 16, RTCRay4, RTCRayHit4, intersect4 by embree_intersect4, occluded4 by embree_occluded4);
packets_of!(16, 64, RTCRay16, RTCRayHit16, intersect16 by embree_intersect16, occluded16 by embree_occluded16);

impl Query<'_> {
    /// Nearest hits by a call; `resolve` as for [`Query::intersect8`].
    pub fn intersect_by(
        &self,
        entry: Entry,
        rays: &[RayPacket],
        hits: &mut [HitPacket],
        resolve: impl Fn(&mut HitPacket),
    ) {
        match entry {
            Entry::Packet8 => return self.intersect8(rays, hits, resolve),
            Entry::Packet4 => self.intersect4(rays, hits),
            Entry::Packet16 => self.intersect16(rays, hits),
            Entry::Single => self.intersect_single(rays, hits),
            Entry::Stream => self.intersect_stream(rays, hits),
        }
        hits.iter_mut().for_each(resolve);
    }

    /// Occlusion by a call.
    pub fn occluded_by(&self, entry: Entry, rays: &mut [RayPacket]) {
        match entry {
            Entry::Packet8 => self.occluded8(rays),
            Entry::Packet4 => self.occluded4(rays),
            Entry::Packet16 => self.occluded16(rays),
            Entry::Single => self.occluded_single(rays),
            Entry::Stream => self.occluded_stream(rays),
        }
    }

    fn intersect_single(&self, rays: &[RayPacket], hits: &mut [HitPacket]) {
        self.run(|query| {
            for (rays, hits) in rays.iter().zip(hits) {
                *hits = missed(rays);
                let mut singles = single_rays(rays).map(|ray| ray_hit(&ray));
                for (lane, single) in singles.iter_mut().enumerate() {
                    if rays.is_active(lane) {
                        // SAFETY: the scene is committed; ray and query are live, aligned, and this thread's own.
                        unsafe { ffi::embree_intersect1(self.scene.raw(), query, single) };
                        store_single(hits, lane, single);
                    }
                }
            }
        });
    }

    fn intersect_stream(&self, rays: &[RayPacket], hits: &mut [HitPacket]) {
        self.run(|query| {
            let nothing = ray_hit(&SingleRay::default());
            let mut stream = [[nothing; LANES]; STREAM_PACKETS];
            for (rays, hits) in rays.chunks(STREAM_PACKETS).zip(hits.chunks_mut(STREAM_PACKETS)) {
                for (singles, packet) in stream.iter_mut().zip(rays) {
                    *singles = single_rays(packet).map(|ray| ray_hit(&ray));
                }
                let count = (rays.len() * LANES) as c_uint;
                let first = stream.as_mut_ptr().cast::<ffi::RTCRayHit>();
                // SAFETY: as above; the stream has at least `count` rays. Those that take no part have tnear > tfar.
                let traced = unsafe { ffi::embree_intersect1_stream(self.scene.raw(), query, first, count) };
                debug_assert!(traced, "streams are asked for only where they exist");
                for ((singles, rays), hits) in stream.iter().zip(rays).zip(hits) {
                    *hits = missed(rays);
                    for (lane, single) in singles.iter().enumerate() {
                        store_single(hits, lane, single);
                    }
                }
            }
        });
    }

    fn occluded_single(&self, rays: &mut [RayPacket]) {
        self.run(|query| {
            for packet in rays {
                let mut singles = single_rays(packet);
                for (lane, single) in singles.iter_mut().enumerate() {
                    if packet.is_active(lane) {
                        let ray = (&raw mut *single).cast::<ffi::RTCRay>();
                        // SAFETY: as above; `SingleRay` has the layout of an `RTCRay`, as `query` asserts.
                        unsafe { ffi::embree_occluded1(self.scene.raw(), query, ray) };
                        packet.tfar[lane] = single.0[2].x;
                    }
                }
            }
        });
    }
}

/// A ray that has hit nothing.
#[inline]
fn ray_hit(ray: &SingleRay) -> ffi::RTCRayHit {
    // SAFETY: numbers only, for which zero is a value.
    let mut single: ffi::RTCRayHit = unsafe { MaybeUninit::zeroed().assume_init() };
    // SAFETY: `SingleRay` has the layout of an `RTCRay`, as `query` asserts, and both are plain numbers.
    single.ray = unsafe { *(&raw const *ray).cast::<ffi::RTCRay>() };
    single.hit.geomID = ffi::EMBREE_INVALID_ID;
    single.hit.instID[0] = ffi::EMBREE_INVALID_ID;
    single
}

fn missed(rays: &RayPacket) -> HitPacket {
    HitPacket {
        t: rays.tfar,
        ..HitPacket::EMPTY
    }
}

#[inline]
fn store_single(hits: &mut HitPacket, lane: usize, single: &ffi::RTCRayHit) {
    let hit = &single.hit;
    store(hits, lane, hit.geomID, hit.primID, hit.instID[0]);
    hits.t[lane] = single.ray.tfar;
}

/// Embree leaves the primitive of a miss as it was.
#[inline]
fn store(hits: &mut HitPacket, lane: usize, geometry: u32, primitive: u32, instance: u32) {
    hits.geometry[lane] = geometry;
    hits.primitive[lane] = if geometry == ffi::EMBREE_INVALID_ID {
        HitPacket::NONE
    } else {
        primitive
    };
    hits.instance[lane] = instance;
}
