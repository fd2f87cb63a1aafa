//! Brute force, the reference: every primitive, one after the other, by the one lane version of the BVH's own tests.

use std::sync::Arc;

use super::bvh::query::{Asked, Candidate, Query};
use super::bvh::ray::{LocalRay, direction_scale};
use super::{Accel, AccelInfo, Backend, HitFilter, RayKind};
use crate::geometry::{GeometryId, HitPacket, InstanceId, LANES, Opacity, RayPacket, Shape, World};

/// Tests each ray against each primitive. It has no boxes and no tree to go wrong, and reports the hit of least (t, geometry,
/// primitive, instance). For tests: a query takes time in proportion to the primitives.
pub struct Brute {
    world: Arc<World>,
    filtered: Vec<bool>,
}

impl Brute {
    /// Over `world`; nothing is built.
    pub fn new(world: &Arc<World>) -> Self {
        Self {
            filtered: world
                .geometries()
                .iter()
                .map(|g| g.opacity == Opacity::Filtered)
                .collect(),
            world: Arc::clone(world),
        }
    }

    fn trace<'a>(&'a self, packet: &RayPacket, lane: usize, filter: Option<&'a dyn HitFilter>) -> Query<'a> {
        let ray = packet.get(lane);
        let scale = direction_scale(ray.direction);
        let asked = Asked {
            filter,
            filtered: &self.filtered,
        };
        let mut query = Query::new(&ray, scale, asked);
        let local = LocalRay::new(ray.origin, ray.direction * scale);
        for &geometry in self.world.root() {
            self.geometry(geometry, HitPacket::NONE, &local, &mut query);
        }
        for (index, instance) in self.world.instances().iter().enumerate() {
            if instance.mask & ray.mask == 0 {
                continue;
            }
            let object_from_world = instance.world_from_object.inverse_at(ray.time);
            let origin = object_from_world.transform_point3(local.origin.as_dvec3());
            let direction = object_from_world.transform_vector3(local.direction.as_dvec3());
            let local = LocalRay::new(origin.as_vec3(), direction.as_vec3());
            for &geometry in &self.world.groups()[instance.group.index()] {
                self.geometry(geometry, InstanceId::from_index(index).0, &local, &mut query);
            }
        }
        query
    }

    fn geometry(&self, id: GeometryId, instance: u32, ray: &LocalRay, query: &mut Query) {
        let geometry = self.world.geometry(id);
        if geometry.mask & query.mask == 0 {
            return;
        }
        for primitive in 0..geometry.primitive_count() {
            let candidate = |t| Candidate {
                t,
                geometry: id.0,
                primitive: primitive as u32,
                instance,
            };
            match &geometry.shape {
                Shape::Mesh(mesh) => {
                    let corners = mesh.triangle(primitive, query.time).map(|p| p.to_array());
                    if let Some(t) = ray.shear.distance(&corners)
                        && query.contains(t)
                    {
                        query.offer(&candidate(t), || ray.shear.barycentrics(&corners));
                    }
                }
                shape => {
                    query.offer_analytic(shape, primitive, ray.line(), candidate);
                }
            }
        }
    }
}

impl Accel for Brute {
    fn intersect(&self, _kind: RayKind, rays: &[RayPacket], hits: &mut [HitPacket], filter: Option<&dyn HitFilter>) {
        assert_eq!(rays.len(), hits.len(), "a hit packet for each ray packet");
        for (packet, hits) in rays.iter().zip(hits) {
            *hits = HitPacket {
                t: packet.tfar,
                ..HitPacket::EMPTY
            };
            for lane in (0..LANES).filter(|&lane| packet.is_active(lane)) {
                self.trace(packet, lane, filter).store(hits, lane);
            }
        }
    }

    fn occluded(&self, _kind: RayKind, rays: &mut [RayPacket], filter: Option<&dyn HitFilter>) {
        for packet in rays {
            for lane in 0..LANES {
                if packet.is_active(lane) && self.trace(packet, lane, filter).is_hit() {
                    packet.tfar[lane] = f32::NEG_INFINITY;
                }
            }
        }
    }

    fn is_mate_independent(&self, _kind: RayKind) -> bool {
        true
    }

    /// It is no backend that can be chosen; it says [`Backend::Bvh`], whose tests it does.
    fn info(&self) -> AccelInfo {
        AccelInfo {
            backend: Backend::Bvh,
            version: "brute force".into(),
            memory: 0,
        }
    }
}
