//! From the ids of a hit to the surface there. Distance and position are recomputed from ray and primitive in double precision,
//! so that they do not depend on the backend or on its vector width.

use super::triangle::{
    self, Corners, LEAST_ERROR, Parametrization, TrianglePlane, TrianglePoint, facing_side, rounding_error,
    shading_normal,
};
use super::{GeometryId, HitPacket, InstanceId, PrimitiveId, Ray, Shape, Sphere, TriangleMesh, World};
use crate::math::{DAffine3, DVec3, Vec2, Vec3, gamma, offset_ray_origin};

/// What a ray hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hit {
    /// The geometry.
    pub geometry: GeometryId,
    /// The primitive of that geometry.
    pub primitive: PrimitiveId,
    /// The instance, unless the geometry is in world space.
    pub instance: Option<InstanceId>,
}

impl HitPacket {
    /// What `lane` hit; `None` for a miss.
    #[inline]
    pub fn get(&self, lane: usize) -> Option<Hit> {
        self.is_hit(lane).then(|| Hit {
            geometry: GeometryId(self.geometry[lane]),
            primitive: PrimitiveId(self.primitive[lane]),
            instance: (self.instance[lane] != Self::NONE).then_some(InstanceId(self.instance[lane])),
        })
    }
}

/// A point on a surface, with all that shading needs of the geometry there. World space.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceInteraction {
    /// The point.
    pub p: Vec3,
    /// How far the surface that a backend sees may be from `p`, along the normal.
    pub error: f32,
    /// Geometric normal, unit length, on the side that the shape's orientation says; never turned towards the ray.
    pub ng: Vec3,
    /// Shading normal, unit length, in the hemisphere of `ng`.
    pub ns: Vec3,
    /// Derivative of the position by the first texture coordinate, not normalised; may be zero.
    pub dpdu: Vec3,
    /// Derivative of the position by the second texture coordinate; zero where `dpdu` is.
    pub dpdv: Vec3,
    /// Texture coordinates.
    pub uv: Vec2,
    /// Of a triangle: the barycentric coordinates of its second and its third vertex; of other shapes zero.
    pub barycentrics: Vec2,
    /// Back along the ray, of the length of its direction.
    pub wo: Vec3,
    /// Width of the ray's [cone](super::RayCone) at the point: how much of the surface one sample stands for, across the ray. 0, as
    /// [`World::interaction`] leaves it, asks for the finest detail of textures.
    pub footprint: f32,
    /// Scene time of the ray.
    pub time: f32,
    /// What was hit.
    pub hit: Hit,
}

impl SurfaceInteraction {
    /// A ray from here in direction `w`.
    #[inline]
    pub fn spawn_ray(&self, w: Vec3) -> Ray {
        Ray::new(offset_ray_origin(self.p, self.error, self.ng, w), w, self.time)
    }

    /// A ray from here that ends just before `to`, at distance 1 (a point of a surface of normal `to_ng`, with the
    /// [error](SurfaceInteraction::error) `to_error`; both zero for a point in space).
    #[inline]
    pub fn spawn_ray_to(&self, to: Vec3, to_error: f32, to_ng: Vec3) -> Ray {
        let origin = offset_ray_origin(self.p, self.error, self.ng, to - self.p);
        Ray::between(origin, to, to_error, to_ng, self.time)
    }

    /// The rest of `ray`, which met this surface and goes on through it.
    #[inline]
    pub fn rest_of_ray(&self, ray: &Ray) -> Ray {
        let rest = self.spawn_ray(ray.direction);
        if ray.tfar == f32::INFINITY {
            return rest;
        }
        // To the same end, by a direction of which that is again one.
        let end = ray.origin + ray.direction;
        Ray {
            direction: end - rest.origin,
            tfar: ray.tfar,
            ..rest
        }
    }
}

impl Ray {
    /// A ray from `origin` that ends just before `to`, at distance 1; see [`SurfaceInteraction::spawn_ray_to`].
    #[inline]
    pub fn between(origin: Vec3, to: Vec3, to_error: f32, to_ng: Vec3, time: f32) -> Self {
        // Seen from afar, the direction's rounding and the backend's add to the error there, in proportion to the distance.
        let from_afar = gamma(32) * to_ng.abs().dot((to - origin).abs());
        let end = offset_ray_origin(to, to_error + from_afar, to_ng, origin - to);
        Self {
            tfar: 1.0 - FAR_GAP,
            ..Self::new(origin, end - origin, time)
        }
    }
}

/// How much of a ray between two points is left out at its far end: some units in the last place. More would let light through
/// what stands close before a lamp: pbrt's 1e-4 made smallpt, whose lamp is cut off by the ceiling at a flat angle, 0.8 % too
/// bright.
const FAR_GAP: f32 = 1e-6;

impl World {
    /// The surface where `ray` meets the primitive that a backend says it hits.
    ///
    /// The point is on the primitive even where the ray just misses it by another rounding than the backend's.
    pub fn interaction(&self, ray: &Ray, hit: Hit) -> SurfaceInteraction {
        let shape = &self.geometry(hit.geometry).shape;
        let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let Some(id) = hit.instance else {
            return finish(&local_surface(shape, origin, direction, ray, hit), ray, hit);
        };
        let motion = &self.instance(id).world_from_object;
        let (world_from_object, object_from_world) = (motion.at(ray.time), motion.inverse_at(ray.time));
        let origin = object_from_world.transform_point3(origin);
        let direction = object_from_world.transform_vector3(direction);
        let local = local_surface(shape, origin, direction, ray, hit);
        finish(
            &to_world(&local, &world_from_object, &object_from_world, motion.is_static()),
            ray,
            hit,
        )
    }
}

/// What `hit` is of `shape`, for the line of `ray` in the space of its group.
#[inline]
fn local_surface(shape: &Shape, origin: DVec3, direction: DVec3, ray: &Ray, hit: Hit) -> LocalSurface {
    let (primitive, tnear) = (hit.primitive.index(), f64::from(ray.tnear));
    match shape {
        Shape::Mesh(mesh) => triangle_surface(mesh, primitive, origin, direction, ray.time),
        Shape::Spheres(spheres) => sphere_surface(&spheres[primitive], origin, direction, tnear),
        Shape::Quadrics(quadrics) => quadrics[primitive].surface(origin, direction, tnear),
        Shape::Curves(curves) => curves.surface(primitive, origin, direction, tnear),
        Shape::Tubes(tubes) => tubes.surface(primitive, origin, direction),
        Shape::Patches(mesh) => mesh.surface(primitive).at(origin, direction, tnear),
    }
}

/// A surface point in the space of its group.
pub(super) struct LocalSurface {
    pub p: DVec3,
    /// As [`SurfaceInteraction::error`], less the rounding of `p`.
    pub error: f64,
    /// Unit length.
    pub ng: DVec3,
    /// Unit length; 0 for that of `ng`.
    pub ns: Vec3,
    pub dpdu: Vec3,
    pub dpdv: Vec3,
    pub uv: Vec2,
    /// As [`SurfaceInteraction::barycentrics`].
    pub barycentrics: Vec2,
}

fn finish(local: &LocalSurface, ray: &Ray, hit: Hit) -> SurfaceInteraction {
    let ng = local.ng.as_vec3();
    SurfaceInteraction {
        p: local.p.as_vec3(),
        error: (local.error + rounding_error(local.p, ng)) as f32,
        ng,
        ns: if local.ns == Vec3::ZERO { ng } else { local.ns },
        dpdu: local.dpdu,
        dpdv: local.dpdv,
        uv: local.uv,
        barycentrics: local.barycentrics,
        wo: -ray.direction,
        footprint: 0.0,
        time: ray.time,
        hit,
    }
}

/// Positions, normals and error bounds through an instance's transform. A backend moves the ray to object space in single
/// precision; the bound covers what that loses.
fn to_world(
    local: &LocalSurface,
    world_from_object: &DAffine3,
    object_from_world: &DAffine3,
    is_static: bool,
) -> LocalSurface {
    let p = world_from_object.transform_point3(local.p);
    let normal = |n: DVec3| object_from_world.matrix3.transpose() * n;
    let ng = normal(local.ng);
    // A distance from a plane shrinks as its normal, transformed, grows.
    let shrink = ng.length().recip();
    let (forward, backward) = (world_from_object.matrix3.abs(), object_from_world.matrix3.abs());
    // Embree interpolates rotations nearly: its matrices, and again their inverses, are off by up to 2.1e-6 (35 u) at half a turn.
    let g = f64::from(gamma(if is_static { 4 } else { 72 }));
    let object_error = g * (backward * p.abs() + object_from_world.translation.abs());
    let world_error = g * (forward * local.p.abs() + world_from_object.translation.abs());
    LocalSurface {
        p,
        error: (local.error + local.ng.abs().dot(object_error)) * shrink + (ng * shrink).abs().dot(world_error),
        ng: ng * shrink,
        ns: normal(local.ns.as_dvec3()).normalize_or_zero().as_vec3(),
        dpdu: world_from_object.transform_vector3(local.dpdu.as_dvec3()).as_vec3(),
        dpdv: world_from_object.transform_vector3(local.dpdv.as_dvec3()).as_vec3(),
        uv: local.uv,
        barycentrics: local.barycentrics,
    }
}

fn triangle_surface(mesh: &TriangleMesh, triangle: usize, origin: DVec3, direction: DVec3, time: f32) -> LocalSurface {
    let vertices = mesh.triangle(triangle, time);
    let TrianglePlane { error, ng } = TrianglePlane::of(&vertices);
    let TrianglePoint { p, barycentrics } = triangle::point(&vertices, origin, direction);
    let Corners { normals, uvs, side } = mesh.corners(triangle);
    let side = facing_side(&normals, side, ng.as_vec3());
    let Parametrization { dpdu, dpdv, uv } = Parametrization::at(&uvs, &vertices, barycentrics);
    LocalSurface {
        p,
        error,
        ng: ng * f64::from(side),
        ns: shading_normal(&normals, barycentrics),
        dpdu,
        dpdv,
        uv,
        barycentrics: barycentrics.into(),
    }
}

fn sphere_surface(sphere: &Sphere, origin: DVec3, direction: DVec3, tnear: f64) -> LocalSurface {
    let object = sphere.object_from_world();
    let (o, d) = (object.transform_point3(origin), object.transform_vector3(direction));
    let t = match sphere.intersect(origin, direction) {
        Some(hits) if hits.enter >= tnear => hits.enter,
        Some(hits) => hits.leave,
        // A graze that the backend saw through an instance's rounded transform: the point of closest approach.
        None => -o.dot(d) / d.length_squared(),
    };
    // Back onto the sphere, whatever t lost.
    let unit = (o + d * t).normalize();
    let world = sphere.world_from_object();
    let p = world.transform_point3(unit * sphere.radius());
    let outward = (object.matrix3.transpose() * unit).normalize();
    let ng = if sphere.has_flipped_normal() { -outward } else { outward };
    let phi = unit.y.atan2(unit.x);
    let phi = if phi < 0.0 { phi + std::f64::consts::TAU } else { phi };
    let uv = Vec2::new(
        (phi / std::f64::consts::TAU) as f32,
        ((std::f64::consts::PI - unit.z.clamp(-1.0, 1.0).acos()) / std::f64::consts::PI) as f32,
    );
    let dpdu = world.transform_vector3(DVec3::new(-unit.y, unit.x, 0.0) * sphere.radius() * std::f64::consts::TAU);
    // v goes from the south pole to the north pole.
    let from_axis = unit.truncate().length();
    let azimuth = unit.truncate() / from_axis.max(f64::MIN_POSITIVE);
    let along = (azimuth * -unit.z).extend(from_axis);
    let dpdv = world.transform_vector3(along * sphere.radius() * std::f64::consts::PI);
    LocalSurface {
        p,
        // The test that a backend makes is in double precision.
        error: LEAST_ERROR * (p - sphere.center()).length(),
        ng,
        ns: ng.as_vec3(),
        dpdu: dpdu.as_vec3(),
        dpdv: dpdv.as_vec3(),
        uv,
        barycentrics: Vec2::ZERO,
    }
}
