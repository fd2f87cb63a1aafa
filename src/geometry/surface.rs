//! From the ids of a hit to the surface there. Distance and position are recomputed from ray and primitive in double precision,
//! so that they do not depend on the backend or on its vector width.

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
    /// Distance along the ray, in units of its direction.
    pub t: f32,
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
    /// Back along the ray, of the length of its direction.
    pub wo: Vec3,
    /// Width of the ray's [cone](RayCone) at the point: how much of the surface one sample stands for, across the ray. 0, as
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
        // Seen from afar, the direction's rounding and the backend's add to the error there, in proportion to the distance.
        let from_afar = gamma(32) * to_ng.abs().dot((to - self.p).abs());
        let origin = offset_ray_origin(self.p, self.error, self.ng, to - self.p);
        let end = offset_ray_origin(to, to_error + from_afar, to_ng, origin - to);
        Ray {
            tfar: 1.0 - FAR_GAP,
            ..Ray::new(origin, end - origin, self.time)
        }
    }
}

/// How much of a ray between two points is left out at its far end: some units in the last place. More would let light through
/// what stands close before a lamp: pbrt's 1e-4 made smallpt, whose lamp is cut off by the ceiling at a flat angle, 0.8 % too
/// bright.
const FAR_GAP: f32 = 1e-6;

/// How wide a path's ray is taken to be, for the filtering of textures: a cone around it (Akenine-Möller et al. 2019, "Texture
/// Level of Detail Strategies for Real-Time Ray Tracing"). Scattering does not change how it widens, so that its width is that of
/// a pixel seen over the whole length of the path.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RayCone {
    /// At the ray's origin, in scene units.
    pub width: f32,
    /// Growth over a unit of distance.
    pub spread: f32,
}

impl RayCone {
    /// The cone from the point at distance `t` on.
    #[inline]
    #[must_use]
    pub fn after(self, t: f32) -> Self {
        Self {
            width: self.width + self.spread * t,
            ..self
        }
    }
}

/// A surface point in the space of its group.
struct LocalSurface {
    p: DVec3,
    /// As [`SurfaceInteraction::error`], less the rounding of `p`.
    error: f64,
    t: f64,
    /// Unit length.
    ng: DVec3,
    /// Of any length but 0.
    ns: Vec3,
    dpdu: Vec3,
    dpdv: Vec3,
    uv: Vec2,
}

impl World {
    /// The surface where `ray` meets the primitive that a backend says it hits.
    ///
    /// The point is on the primitive even where the ray just misses it by another rounding than the backend's.
    pub fn interaction(&self, ray: &Ray, hit: Hit) -> SurfaceInteraction {
        let shape = &self.geometry(hit.geometry).shape;
        let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let Some(id) = hit.instance else {
            return finish(&local_surface(shape, hit.primitive, origin, direction, ray), ray, hit);
        };
        let motion = &self.instance(id).world_from_object;
        let (world_from_object, object_from_world) = (motion.at(ray.time), motion.inverse_at(ray.time));
        let origin = object_from_world.transform_point3(origin);
        let direction = object_from_world.transform_vector3(direction);
        let local = local_surface(shape, hit.primitive, origin, direction, ray);
        finish(
            &to_world(&local, &world_from_object, &object_from_world, motion.is_static()),
            ray,
            hit,
        )
    }
}

fn local_surface(shape: &Shape, primitive: PrimitiveId, origin: DVec3, direction: DVec3, ray: &Ray) -> LocalSurface {
    match shape {
        Shape::Mesh(mesh) => triangle_surface(mesh, primitive.index(), origin, direction, ray.time),
        Shape::Spheres(spheres) => sphere_surface(&spheres[primitive.index()], origin, direction, ray.tnear),
    }
}

fn finish(local: &LocalSurface, ray: &Ray, hit: Hit) -> SurfaceInteraction {
    let ng = local.ng.as_vec3();
    SurfaceInteraction {
        p: local.p.as_vec3(),
        error: (local.error + rounding_error(local.p, ng)) as f32,
        t: local.t as f32,
        ng,
        ns: local.ns.try_normalize().unwrap_or(ng),
        dpdu: local.dpdu,
        dpdv: local.dpdv,
        uv: local.uv,
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
        ..*local
    }
}

/// How far rounding to single precision can move `p`, and then the origin of a ray beside it, along the unit normal `n`.
fn rounding_error(p: DVec3, n: Vec3) -> f64 {
    n.abs().as_dvec3().dot(p.abs()) * f64::from(gamma(3))
}

/// The least error, relative to the size of a primitive: where a plane through the origin is exact a ray must start off it all
/// the same, and by more than the smallest numbers there are.
pub const LEAST_ERROR: f64 = 1.0 / (1_u64 << 36) as f64;

/// How far from its plane a backend may see a triangle, for a ray that starts on it.
///
/// A backend computes T = ng . (v - o), a distance times |ng|, from corners relative to the origin, in single precision. With
/// extents E of the triangle, an element of ng = e x e' is off by some 14 u E E (u the unit roundoff: edges are off by 3 u E, and
/// two products and their difference round), the corner by u E, the sum by 3 u; together 22 u E E E for each of three terms. Half
/// of this worst case is never exceeded in tests. Where the triangle is perpendicular to an axis only [`LEAST_ERROR`]
/// is left, as the sum then has one term and the rest is exact.
pub fn triangle_error(vertices: &[DVec3; 3]) -> f64 {
    let [a, b, c] = *vertices;
    plane_error(vertices, (b - a).cross(c - a).length())
}

/// [`triangle_error`] of a triangle, given the length of the cross product of two edges.
#[inline]
fn plane_error(vertices: &[DVec3; 3], area: f64) -> f64 {
    let [a, b, c] = *vertices;
    let extent = a.max(b).max(c) - a.min(b).min(c);
    let size = extent.max_element();
    let volume = extent.x * extent.y * extent.z;
    let plane = if volume == 0.0 {
        0.0
    } else {
        f64::from(gamma(32)) * volume / area
    };
    // The plane of a sliver means nothing; a thousandth of its size is as far as a ray may be moved.
    plane.clamp(LEAST_ERROR * size, 1e-3 * size)
}

fn triangle_surface(mesh: &TriangleMesh, triangle: usize, origin: DVec3, direction: DVec3, time: f32) -> LocalSurface {
    let vertices = mesh.triangle(triangle, time).map(Vec3::as_dvec3);
    let (e1, e2) = (vertices[1] - vertices[0], vertices[2] - vertices[0]);
    let cross = e1.cross(e2);
    let area = cross.length();
    // Moeller and Trumbore (1997); barycentrics are kept inside, where a backend rounded otherwise.
    let from_corner = origin - vertices[0];
    let moment = from_corner.cross(direction);
    let inverse = -1.0 / direction.dot(cross);
    let (v, w) = match (e2.dot(moment) * inverse, -e1.dot(moment) * inverse) {
        (v, w) if v.is_finite() && w.is_finite() => clamp_barycentrics(v, w),
        _ => (1.0 / 3.0, 1.0 / 3.0),
    };
    let p = vertices[0] + e1 * v + e2 * w;
    let weights = [(1.0 - v - w) as f32, v as f32, w as f32];
    let corners = mesh.indices()[triangle].map(|v| v as usize);

    let mut ng = cross / area;
    if mesh.has_flipped_normal() {
        ng = -ng;
    }
    let mut ns = Vec3::ZERO;
    if let Some(normals) = mesh.normals() {
        let normals = corners.map(|v| normals[v]);
        // With normals given they say which side is out, as in pbrt.
        if ng.dot((normals[0] + normals[1] + normals[2]).as_dvec3()) < 0.0 {
            ng = -ng;
        }
        ns = normals[0] * weights[0] + normals[1] * weights[1] + normals[2] * weights[2];
    }
    if ns == Vec3::ZERO {
        ns = ng.as_vec3();
    }
    let (uv, [dpdu, dpdv]) = match mesh.uvs() {
        // Without coordinates: (0, 0), (1, 0), (1, 1).
        None => (
            Vec2::new(weights[1] + weights[2], weights[2]),
            [e1.as_vec3(), (e2 - e1).as_vec3()],
        ),
        Some(uvs) => {
            let uvs = corners.map(|v| uvs[v]);
            let uv = uvs[0] * weights[0] + uvs[1] * weights[1] + uvs[2] * weights[2];
            (uv, triangle_derivatives(e1.as_vec3(), e2.as_vec3(), &uvs))
        }
    };
    let t = (p - origin).dot(direction) / direction.length_squared();
    LocalSurface {
        p,
        error: plane_error(&vertices, area),
        t,
        ng,
        ns,
        dpdu,
        dpdv,
        uv,
    }
}

/// The nearest barycentrics of the second and third corner inside the triangle, nearly.
#[inline]
fn clamp_barycentrics(v: f64, w: f64) -> (f64, f64) {
    let (v, w) = (v.max(0.0), w.max(0.0));
    let sum = v + w;
    if sum > 1.0 { (v / sum, w / sum) } else { (v, w) }
}

/// Solves dp = dpdu du + dpdv dv along two edges for dpdu and dpdv; zero where the texture coordinates are degenerate.
fn triangle_derivatives(e1: Vec3, e2: Vec3, uv: &[Vec2; 3]) -> [Vec3; 2] {
    let (d1, d2) = (uv[1] - uv[0], uv[2] - uv[0]);
    let determinant = d1.perp_dot(d2);
    if determinant == 0.0 {
        [Vec3::ZERO; 2]
    } else {
        let inverse = 1.0 / determinant;
        [(e1 * d2.y - e2 * d1.y) * inverse, (e2 * d1.x - e1 * d2.x) * inverse]
    }
}

fn sphere_surface(sphere: &Sphere, origin: DVec3, direction: DVec3, tnear: f32) -> LocalSurface {
    let object = sphere.object_from_world();
    let (o, d) = (object.transform_point3(origin), object.transform_vector3(direction));
    let t = match sphere.intersect(origin, direction) {
        Some(hits) if hits.enter >= f64::from(tnear) => hits.enter,
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
        t,
        ng,
        ns: ng.as_vec3(),
        dpdu: dpdu.as_vec3(),
        dpdv: dpdv.as_vec3(),
        uv,
    }
}
