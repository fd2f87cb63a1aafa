//! Alpha cut-outs: geometry that a ray may pass with the probability 1 - alpha.
//!
//! Whether a ray passes is decided by a hash of the ray itself (its origin, direction and time) and of what it hits: the same for
//! every backend and order of questions, and independent between rays, surfaces and the two sides of a sphere.

use super::Scene;
use crate::accel::{FilterHit, HitFilter, RayKind};
use crate::geometry::{Hit, HitPacket, LANES, Ray, RayPacket, Shape, SurfaceInteraction, SurfaceLanes, World};
use crate::sampling::hash::{hash_u32s, unit_f32};
use crate::texture::FloatTexture;

/// Asked by a backend about the rays of one call, whose ids are their places in it.
struct Cutouts<'a> {
    scene: &'a Scene,
    rays: &'a [RayPacket],
}

impl HitFilter for Cutouts<'_> {
    fn accept(&self, hit: &FilterHit) -> bool {
        let Some(alpha) = &self.scene.surfaces[hit.geometry.index()].alpha else {
            return true;
        };
        let ray = self.rays[hit.ray_id as usize / LANES].get(hit.ray_id as usize % LANES);
        let place = Hit {
            geometry: hit.geometry,
            primitive: hit.primitive,
            instance: hit.instance,
        };
        let (alpha, is_front) = match alpha {
            FloatTexture::Constant(alpha) if *alpha <= 0.0 => return false,
            texture => {
                let si = interaction_near(&self.scene.world, &ray, place, hit.t);
                (texture.at(&si), si.ng.dot(si.wo) > 0.0)
            }
        };
        alpha >= 1.0 || chance(&ray, &place, is_front) < alpha
    }
}

/// A number in [0, 1) that is a function of a ray and of the side of a primitive.
fn chance(ray: &Ray, hit: &Hit, is_front: bool) -> f32 {
    let [ox, oy, oz] = ray.origin.to_array().map(f32::to_bits);
    let [dx, dy, dz] = ray.direction.to_array().map(f32::to_bits);
    let hash = hash_u32s(&[
        ox,
        oy,
        oz,
        dx,
        dy,
        dz,
        ray.time.to_bits(),
        hit.geometry.0,
        hit.primitive.0,
        hit.instance.map_or(u32::MAX, |id| id.0),
        u32::from(is_front),
    ]);
    unit_f32((hash >> 32) as u32)
}

/// [`World::interaction`] where the hit is at about the distance `t`: of a sphere whose front a ray passed, the back.
fn interaction_near(world: &World, ray: &Ray, hit: Hit, t: f32) -> SurfaceInteraction {
    let si = world.interaction(ray, hit);
    if let Shape::Mesh(_) = &world.geometry(hit.geometry).shape {
        return si;
    }
    let first = (si.p - ray.origin).dot(ray.direction) / ray.direction.length_squared();
    if t <= first * (1.0 + 1e-4) {
        return si;
    }
    let behind = Ray {
        tnear: 0.5 * (first + t),
        ..*ray
    };
    world.interaction(&behind, hit)
}

impl Scene {
    /// Finds the nearest hit of each ray that takes part: [`Accel::intersect`](crate::accel::Accel::intersect), with the scene's cut-outs.
    pub fn intersect(&self, kind: RayKind, rays: &[RayPacket], hits: &mut [HitPacket]) {
        if !self.has_cutouts {
            return self.accel.intersect(kind, rays, hits, None);
        }
        let mut rays = rays.to_vec();
        number(&mut rays);
        let cutouts = Cutouts {
            scene: self,
            rays: &rays,
        };
        self.accel.intersect(kind, &rays, hits, Some(&cutouts));
    }

    /// Marks the rays that hit anything: [`Accel::occluded`](crate::accel::Accel::occluded), with the scene's cut-outs. Ray ids are not kept.
    pub fn occluded(&self, kind: RayKind, rays: &mut [RayPacket]) {
        if !self.has_cutouts {
            return self.accel.occluded(kind, rays, None);
        }
        number(rays);
        let asked = rays.to_vec();
        let cutouts = Cutouts {
            scene: self,
            rays: &asked,
        };
        self.accel.occluded(kind, rays, Some(&cutouts));
    }

    /// The surface that a hit of [`Scene::intersect`] at distance `t` means: [`World::interaction`], but where the ray may have passed the
    /// front of what it hit.
    #[inline]
    pub fn interaction(&self, ray: &Ray, hit: Hit, t: f32) -> SurfaceInteraction {
        if self.has_cutouts && self.surfaces[hit.geometry.index()].alpha.is_some() {
            interaction_near(&self.world, ray, hit, t)
        } else {
            self.world.interaction(ray, hit)
        }
    }

    /// [`Scene::interaction`] of the rays that hit something: of the first packets of `packets`, as many as there are of `surfaces`.
    #[inline]
    pub fn interactions<'p>(
        &self,
        surfaces: &mut [SurfaceLanes<'_>],
        packets: impl Iterator<Item = (&'p RayPacket, &'p HitPacket)> + Clone,
    ) {
        for (surfaces, (rays, hits)) in surfaces.iter_mut().zip(packets.clone()) {
            surfaces.gather(rays, hits);
        }
        for (surfaces, (rays, hits)) in surfaces.iter_mut().zip(packets) {
            surfaces.compute(rays, hits, |ray, hit, t| self.interaction(ray, hit, t));
        }
    }
}

/// Gives each ray its place as its id.
fn number(rays: &mut [RayPacket]) {
    for (packet, rays) in rays.iter_mut().enumerate() {
        for (lane, id) in rays.id.iter_mut().enumerate() {
            *id = (packet * LANES + lane) as u32;
        }
    }
}
