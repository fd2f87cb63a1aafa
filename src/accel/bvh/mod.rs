//! Our own BVH, pure Rust: binary trees by a binned SAH (`build`, `bins`), with spatial splits (`spatial`), collapsed to eight children a node
//! (`collapse`), or such nodes at once along a Morton curve (`linear`), over what `primitives` says; and one traversal (`traverse`) over a kernel of vector instructions that is
//! chosen at run time (`tracing`, `kernel`, `avx2`).
//!
//! Of few primitives (`few`) no tree is asked: packets of rays are tested against all of them.
//!
//! It is watertight: `triangle` says how two triangles leave no gap at their edge, `ray` why no box is passed over whose
//! triangle would be hit. All kernels, and all ways through a tree, give the same bits.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod bins;
mod build;
mod collapse;
mod few;
mod interleave;
mod item;
mod kernel;
mod lanes;
mod leaf;
mod linear;
mod node;
mod order;
mod packet;
mod pages;
mod prepare;
mod primitives;
pub(super) mod query;
pub(super) mod ray;
mod spatial;
mod stream;
#[cfg(test)]
mod tests;
mod topology;
mod tracing;
mod traverse;
mod tree;
pub(super) mod triangle;

use std::sync::Arc;

use rayon::prelude::*;

use self::few::Few;
use self::kernel::Kernel;
use self::query::{Asked, Query};
use self::ray::{LocalRay, direction_scale};
use self::tracing::Tracing;
use self::traverse::{Level, STACK};
use self::tree::{FixedTree, GroupTrees};
use super::{Accel, AccelInfo, Backend, BuildOptions, HitFilter, RayKind};
use crate::geometry::{GroupId, HitPacket, LANES, Opacity, RayPacket, World};

/// A world and the trees over it.
struct Scene {
    world: Arc<World>,
    /// The top level: geometries in world space, and instances.
    top: GroupTrees,
    /// See [`FixedTree::expected_nodes`]; of the top level.
    expected_nodes: f64,
    /// All that there is, if that is so little that no tree is asked.
    few: Option<Few>,
    /// By [`GroupId`].
    groups: Vec<GroupTrees>,
    /// Of each geometry, whether hits on it are filtered.
    filtered: Vec<bool>,
}

/// An 8-wide BVH over a world: one tree over what is in world space and over the instances, one for each group.
///
/// Hits are found in single precision by the watertight test (of spheres, in double precision), and where distances are equal
/// the hit of least (geometry, primitive, instance) is reported; an instance precedes "none". Hits count beyond `tnear`, up to and
/// with `tfar`: a ray that starts in the plane of a triangle does not meet it. The answer for a ray does not
/// depend on the other rays of a call, nor on the instructions of the processor.
pub struct Bvh {
    scene: Arc<Scene>,
    tracing: Tracing,
}

impl Bvh {
    /// Builds it, in the rayon pool of the caller. The tree does not depend on the number of threads.
    ///
    /// Of low quality it is built along a Morton curve, of medium quality by the surface area heuristic with 16 bins along each axis, of high
    /// quality with 32 bins and spatial splits. [`BuildOptions::robust`] and [`BuildOptions::compact`] make no difference.
    pub fn build(world: &Arc<World>, options: &BuildOptions) -> Self {
        let quality = options.quality;
        let groups = world.groups().par_iter();
        let groups: Vec<_> = groups
            .map(|members| GroupTrees::build(world, members, &[], quality))
            .collect();
        let boxes: Vec<_> = (0..world.groups().len())
            .into_par_iter()
            .map(|group| world.group_bounds(GroupId::from_index(group)))
            .collect();
        let instances: Vec<_> = world
            .instances()
            .par_iter()
            .map(|instance| instance.world_from_object.moving_bounds(&boxes[instance.group.index()]))
            .collect();
        let top = GroupTrees::build(world, world.root(), &instances, quality);
        Self {
            scene: Arc::new(Scene {
                expected_nodes: top.fixed.as_ref().map_or(0.0, FixedTree::expected_nodes),
                top,
                few: Few::new(world),
                groups,
                filtered: world
                    .geometries()
                    .iter()
                    .map(|g| g.opacity == Opacity::Filtered)
                    .collect(),
                world: Arc::clone(world),
            }),
            tracing: Tracing::detect(),
        }
    }

    /// Whether there are spheres in a world, among so few primitives that rays are tested against all of them.
    pub fn has_spheres_among_few(world: &World) -> bool {
        Few::new(world).is_some_and(|few| !few.balls.is_empty()) && Tracing::detect().is_exhaustive()
    }

    /// The same trees, traced in each way that this processor has, by name: instructions, then how rays go through the trees. All give
    /// the same answers; for tests and measurements.
    pub fn variants(&self) -> Vec<(String, Self)> {
        let variant = |(name, tracing)| {
            let scene = Arc::clone(&self.scene);
            (name, Self { scene, tracing })
        };
        let is_there = |(_, tracing): &(String, Tracing)| self.scene.few.is_some() || !tracing.is_for_few();
        Tracing::all().into_iter().filter(is_there).map(variant).collect()
    }

    /// The names of [`Bvh::variants`] of worlds of few primitives, which have all of them.
    pub fn variant_names() -> Vec<String> {
        Tracing::all().into_iter().map(|(name, _)| name).collect()
    }
}

impl Scene {
    /// Traces one lane of a packet; `None` if it takes no part.
    #[inline(always)]
    fn trace<'a, K: Kernel, const ANY: bool>(
        &'a self,
        kernel: K,
        packet: &RayPacket,
        lane: usize,
        filter: Option<&'a dyn HitFilter>,
        stack: &mut [u64; STACK],
    ) -> Option<Query<'a>> {
        if !packet.is_active(lane) {
            return None;
        }
        let ray = packet.get(lane);
        let scale = direction_scale(ray.direction);
        let asked = Asked {
            filter,
            filtered: &self.filtered,
        };
        let mut query = Query::new(&ray, scale, asked);
        let local = LocalRay::new(ray.origin, ray.direction * scale);
        let level = Level {
            trees: &self.top,
            instance: HitPacket::NONE,
        };
        kernel.group::<ANY>(self, &level, &local, &mut query, stack);
        Some(query)
    }

    fn intersect<K: Kernel>(
        &self,
        kernel: K,
        rays: &[RayPacket],
        hits: &mut [HitPacket],
        filter: Option<&dyn HitFilter>,
    ) {
        let mut stack = [0; STACK];
        for (packet, hits) in rays.iter().zip(hits) {
            *hits = HitPacket {
                t: packet.tfar,
                ..HitPacket::EMPTY
            };
            for lane in 0..LANES {
                if let Some(query) = self.trace::<K, false>(kernel, packet, lane, filter, &mut stack) {
                    query.store(hits, lane);
                }
            }
        }
    }

    fn occluded<K: Kernel>(&self, kernel: K, rays: &mut [RayPacket], filter: Option<&dyn HitFilter>) {
        let mut stack = [0; STACK];
        for packet in rays {
            for lane in 0..LANES {
                if let Some(query) = self.trace::<K, true>(kernel, packet, lane, filter, &mut stack)
                    && query.is_hit()
                {
                    packet.tfar[lane] = f32::NEG_INFINITY;
                }
            }
        }
    }
}

impl Accel for Bvh {
    fn intersect(&self, kind: RayKind, rays: &[RayPacket], hits: &mut [HitPacket], filter: Option<&dyn HitFilter>) {
        assert_eq!(rays.len(), hits.len(), "a hit packet for each ray packet");
        self.tracing.intersect(&self.scene, kind, rays, hits, filter);
    }

    fn occluded(&self, _kind: RayKind, rays: &mut [RayPacket], filter: Option<&dyn HitFilter>) {
        self.tracing.occluded(&self.scene, rays, filter);
    }

    fn is_mate_independent(&self, _kind: RayKind) -> bool {
        true
    }

    fn info(&self) -> AccelInfo {
        let groups = self.scene.groups.iter().map(GroupTrees::memory).sum::<usize>();
        AccelInfo {
            backend: Backend::Bvh,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            memory: self.scene.top.memory() + groups + self.scene.few.as_ref().map_or(0, Few::memory),
        }
    }
}
