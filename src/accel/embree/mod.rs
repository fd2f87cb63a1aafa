//! Debian's Embree, version 3 or 4.
//!
//! A [`World`] becomes one Embree scene for each group and one for the root, which holds the geometries in world space and the
//! instances. Meshes share the world's arrays; flat and cylindrical curves are Embree's flat Bézier curves, in scenes of their own
//! (`curves.rs`); all else is user geometry, intersected in double precision by
//! [`Shape::line_hits`](crate::geometry::Shape::line_hits); only filtered geometry has a filter function.
//!
//! # Which call serves which kind of ray
//!
//! Measured in robust mode on one thread (AVX2; a room with a displaced sphere of 160k triangles, and one with 7000 boxes), Mrays/s
//! with Embree 3.13.5, repacking included:
//!
//! | | sphere | boxes |
//! |---|---|---|
//! | camera: **`intersect8` coherent** | 21.5 | 8.6 |
//! | `intersect8` incoherent | 8.6 | 3.1 |
//! | `intersect1` | 6.3 | 2.9 |
//! | bounce: **`intersect8` incoherent** | 6.7 | 2.1 |
//! | `intersect8` coherent | 4.8 | 1.4 |
//! | `intersect1` | 5.7 | 2.0 |
//! | shadow: **`occluded1M`** | 16.2 | 5.0 |
//! | `occluded8` incoherent | 14.6 | 3.9 |
//! | `occluded1` | 9.2 | 3.4 |
//!
//! Embree 4 has no streams; shadow rays take `occluded8` there.
//!
//! # Limits
//!
//! Debian 12's library checks its assertions: a ray that takes part and is not valid, or has a coordinate of origin or direction
//! beyond 1.844e18 (where products of three overflow), ends the process. Triangles beyond that are left out by Embree, and those
//! whose edges are so short that products of three underflow (some 1e-13) are not met.

#![allow(
    unsafe_code,
    reason = "the only calls of C in this crate; each block says why it is sound"
)]

mod callbacks;
#[cfg(test)]
mod curve_tests;
mod curves;
mod device;
#[cfg(test)]
mod filter_tests;
mod motion;
mod query;
mod scene;
#[cfg(test)]
mod shuffle_tests;
#[cfg(test)]
mod tests;
mod widths;

use std::sync::Arc;

use embree_sys as ffi;

pub use self::widths::Entry;

use self::curves::CurveLayer;
use self::device::Device;
use self::query::{Query, STREAM_PACKETS};
use self::scene::{Layer, Scenes};
use super::{Accel, AccelInfo, Backend, BuildOptions, HitFilter, RayKind};
use crate::error::Result;
use crate::geometry::{Geometry, GeometryId, HitPacket, InstanceId, LANES, RayPacket, Shape, World};

/// A world in Embree's trees.
pub struct EmbreeScene {
    built: Arc<Built>,
    /// `None` to choose by the kind of ray.
    calls: Option<Calls>,
}

/// What one build makes, for any way to trace through it.
struct Built {
    scenes: Scenes,
    world: Arc<World>,
    /// Whether each geometry at the root has its id for its place there.
    root_is_in_order: bool,
    device: Arc<Device>,
}

/// How to trace, whatever the rays are for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Calls {
    /// By which call.
    pub entry: Entry,
    /// Whether Embree is told that rays that are traced together are neighbours, on which only speed depends.
    pub coherent: bool,
}

impl Calls {
    /// Whether they come back from `world`, built by `options`, for every ray. With AVX-512, Embree 3.13.5 traces coherent occlusion of
    /// 16 rays, streams among them, octant by octant, and keeps the octants in a register that it does not save while it calls back or
    /// goes into an instance: after that it may look for them for ever. Seen with instances of meshes, of curves and of quadrics, and in
    /// compact scenes with meshes alone.
    pub fn return_from(self, world: &World, options: &BuildOptions) -> bool {
        let is_analytic = |geometry: &Geometry| !matches!(geometry.shape, Shape::Mesh(_));
        let has_16_lanes = matches!(self.entry, Entry::Packet16 | Entry::Stream);
        let calls_back = !world.instances().is_empty() || world.geometries().iter().any(is_analytic);
        !(self.coherent && has_16_lanes && (calls_back || options.compact))
    }
}

impl EmbreeScene {
    /// Builds the trees of `world`, on `options.threads` threads.
    ///
    /// # Errors
    /// [`Error::Backend`](crate::Error::Backend) with the first error that Embree reports.
    pub fn build(world: &Arc<World>, options: &BuildOptions) -> Result<Self> {
        let device = Device::new(options.threads)?;
        let scenes = scene::build(world, &device, options)?;
        device.check()?;
        let in_order = |(place, id): (usize, &GeometryId)| place == id.index();
        Ok(Self {
            built: Arc::new(Built {
                scenes,
                world: Arc::clone(world),
                root_is_in_order: world.root().iter().enumerate().all(in_order),
                device,
            }),
            calls: None,
        })
    }

    /// The same trees, traced by these calls whatever rays are for. For measuring.
    #[must_use]
    pub fn calling(&self, calls: Calls) -> Self {
        Self {
            built: Arc::clone(&self.built),
            calls: Some(calls),
        }
    }

    /// The committed scene of all but curves, for benchmarks that call Embree directly. It lives as long as `self`.
    pub fn raw_scene(&self) -> ffi::RTCScene {
        self.built.scenes.main.root.raw()
    }

    /// The calls for rays of a kind.
    fn calls(&self, kind: RayKind, any: bool) -> Calls {
        let streams = any && kind != RayKind::Camera && ffi::EMBREE_HAS_STREAMS == 1;
        self.calls.unwrap_or(Calls {
            entry: if streams { Entry::Stream } else { Entry::Packet8 },
            coherent: kind == RayKind::Camera,
        })
    }

    fn query<'a>(&'a self, layer: &'a Layer, calls: Calls, filter: Option<&'a dyn HitFilter>) -> Query<'a> {
        Query {
            scene: &layer.root,
            filter,
            first_instance: self.built.scenes.first_instance,
            coherent: calls.coherent,
        }
    }

    /// What curves are met in front of the hits that there are.
    fn intersect_curves(&self, curves: &CurveLayer, calls: Calls, rays: &[RayPacket], hits: &mut [HitPacket]) {
        let query = self.query(&curves.layer, calls, None);
        let mut found = [HitPacket::EMPTY; STREAM_PACKETS];
        for (rays, hits) in rays.chunks(STREAM_PACKETS).zip(hits.chunks_mut(STREAM_PACKETS)) {
            let (moved, by) = moved_back(curves, rays, |packet| &hits[packet].t);
            let found = &mut found[..rays.len()];
            query.intersect_by(calls.entry, &moved[..rays.len()], found, |hits| {
                self.built.resolve(hits);
            });
            for ((hits, found), by) in hits.iter_mut().zip(found).zip(by) {
                curves::merge(hits, found, &by);
            }
        }
    }

    /// Marks the rays that meet curves.
    fn occlude_curves(&self, curves: &CurveLayer, calls: Calls, rays: &mut [RayPacket]) {
        let query = self.query(&curves.layer, calls, None);
        for rays in rays.chunks_mut(STREAM_PACKETS) {
            let (mut moved, _) = moved_back(curves, rays, |packet| &rays[packet].tfar);
            query.occluded_by(calls.entry, &mut moved[..rays.len()]);
            for (rays, moved) in rays.iter_mut().zip(&moved) {
                for lane in 0..LANES {
                    if moved.tfar[lane] == f32::NEG_INFINITY {
                        rays.tfar[lane] = f32::NEG_INFINITY;
                    }
                }
            }
        }
    }
}

/// Some packets of rays, as far back as curves need, that end at `ends`; and by how much.
fn moved_back<'a>(
    curves: &CurveLayer,
    rays: &[RayPacket],
    ends: impl Fn(usize) -> &'a [f32; LANES],
) -> ([RayPacket; STREAM_PACKETS], [[f32; LANES]; STREAM_PACKETS]) {
    let mut moved = [RayPacket::EMPTY; STREAM_PACKETS];
    let mut by = [[0.0; LANES]; STREAM_PACKETS];
    for (packet, rays) in rays.iter().enumerate() {
        (moved[packet], by[packet]) = curves.moved_back(rays, ends(packet));
    }
    (moved, by)
}

impl Built {
    /// Makes Embree's ids of geometries and instances those of the world: a geometry is known by its place among the members of
    /// its group, instances are numbered after the geometries at the root.
    #[inline]
    fn resolve(&self, hits: &mut HitPacket) {
        let has_instances = hits.instance != [HitPacket::NONE; LANES];
        if !has_instances && self.root_is_in_order {
            return;
        }
        for lane in 0..LANES {
            if !hits.is_hit(lane) {
                continue;
            }
            let members = if hits.instance[lane] == HitPacket::NONE {
                self.world.root()
            } else {
                hits.instance[lane] -= self.scenes.first_instance;
                let group = self.world.instance(InstanceId(hits.instance[lane])).group;
                self.world.groups()[group.index()].as_slice()
            };
            hits.geometry[lane] = members[hits.geometry[lane] as usize].0;
        }
    }
}

impl Accel for EmbreeScene {
    fn intersect(&self, kind: RayKind, rays: &[RayPacket], hits: &mut [HitPacket], filter: Option<&dyn HitFilter>) {
        assert_eq!(rays.len(), hits.len(), "a packet of hits for each packet of rays");
        let calls = self.calls(kind, false);
        self.query(&self.built.scenes.main, calls, filter)
            .intersect_by(calls.entry, rays, hits, |hits| self.built.resolve(hits));
        if let Some(curves) = &self.built.scenes.curves {
            self.intersect_curves(curves, calls, rays, hits);
        }
    }

    fn occluded(&self, kind: RayKind, rays: &mut [RayPacket], filter: Option<&dyn HitFilter>) {
        let calls = self.calls(kind, true);
        self.query(&self.built.scenes.main, calls, filter)
            .occluded_by(calls.entry, rays);
        if let Some(curves) = &self.built.scenes.curves {
            self.occlude_curves(curves, calls, rays);
        }
    }

    /// Coherent packets share one traversal: seen are some ten answers in a thousand that change with the mates, of rays aimed at
    /// vertices and edges. Incoherent packets and streams answer each ray by itself: none seen in 10^5.
    fn is_mate_independent(&self, kind: RayKind) -> bool {
        !self.calls(kind, kind == RayKind::Shadow).coherent
    }

    fn info(&self) -> AccelInfo {
        AccelInfo {
            backend: Backend::Embree,
            version: self.built.device.version(),
            memory: self.built.device.memory(),
        }
    }
}
