//! The surfaces that eight rays hit, computed together.

use super::mesh::{NO_NORMALS, PLAIN_UVS};
use super::triangle::{self, Corners, rounding_error};
use super::{Hit, HitPacket, Ray, RayPacket, Shape, SurfaceInteraction, TriangleMesh, World};
use crate::math::{Kernel, LANES, Lanes, Vec2, Vec2Lanes, Vec3, Vec3Lanes, VectorLanes, Vectorizer};

/// The surfaces that the lanes of a packet hit: the bits of [`World::interaction`], several times faster where they hit triangles in
/// world space. Made once and filled again and again.
#[derive(Clone, Debug, Default)]
pub struct SurfaceLanes {
    vectorizer: Vectorizer,
    triangles: Triangles,
    /// Whether the lane hit a triangle in world space.
    is_triangle: [bool; LANES],
    surfaces: Surfaces,
    /// Of lanes that hit something else.
    others: [Option<SurfaceInteraction>; LANES],
}

/// What [`triangle::point`] and [`Corners::at`] are given.
#[derive(Clone, Copy, Debug, Default)]
struct Triangles {
    /// Of each corner what the lanes have, one after the other: as meshes have it, in two copies and not in three.
    vertices: [[Vec3; LANES]; 3],
    normals: [[Vec3; LANES]; 3],
    uvs: [[Vec2; LANES]; 3],
    side: Lanes,
    /// Whether the lane's normals are those of a mesh without any, and so its texture coordinates.
    has_no_normals: [bool; LANES],
    has_no_uvs: [bool; LANES],
}

/// What they give: see [`SurfaceInteraction`].
#[derive(Clone, Copy, Debug, Default)]
pub struct Surfaces {
    /// See [`SurfaceInteraction::p`].
    pub p: Vec3Lanes,
    /// See [`SurfaceInteraction::error`].
    pub error: Lanes,
    /// See [`SurfaceInteraction::ng`].
    pub ng: Vec3Lanes,
    /// See [`SurfaceInteraction::ns`].
    pub ns: Vec3Lanes,
    /// From the origins of the rays.
    pub distance: Lanes,
    dpdu: Vec3Lanes,
    dpdv: Vec3Lanes,
    uv: Vec2Lanes,
    barycentrics: Vec2Lanes,
}

impl SurfaceLanes {
    /// Computes what the rays that take part hit; `other` says it, for a ray, its hit and the distance there, of what is not a triangle in
    /// world space.
    #[inline]
    pub fn fill(
        &mut self,
        world: &World,
        rays: &RayPacket,
        hits: &HitPacket,
        other: impl Fn(&Ray, Hit, f32) -> SurfaceInteraction,
    ) {
        let mut has_others = false;
        for lane in 0..LANES {
            let hit = hits.get(lane);
            let on_mesh = hit.and_then(|hit| world_mesh(world, hit));
            self.is_triangle[lane] = on_mesh.is_some();
            has_others |= hit.is_some() & on_mesh.is_none();
            if let Some((mesh, triangle)) = on_mesh {
                self.triangles.set(lane, mesh, triangle, rays.time[lane]);
            }
        }
        if self.is_triangle != [false; LANES] {
            let triangles = &self.triangles;
            let surfaces = &mut self.surfaces;
            self.vectorizer.run(Compute {
                rays,
                triangles,
                surfaces,
            });
        }
        if has_others {
            self.fill_others(rays, hits, other);
        }
    }

    fn fill_others(
        &mut self,
        rays: &RayPacket,
        hits: &HitPacket,
        other: impl Fn(&Ray, Hit, f32) -> SurfaceInteraction,
    ) {
        for lane in 0..LANES {
            let hit = hits.get(lane).filter(|_| !self.is_triangle[lane]);
            let surface = hit.map(|hit| other(&rays.get(lane), hit, hits.t[lane]));
            if let Some(surface) = &surface {
                self.surfaces.set(lane, surface, rays.origin(lane));
            }
            self.others[lane] = surface;
        }
    }

    /// Where rays hit something; in other lanes anything.
    #[inline]
    pub fn all(&self) -> &Surfaces {
        &self.surfaces
    }

    /// What `ray`, which was in `lane`, `hit`.
    #[inline]
    pub fn get(&self, lane: usize, ray: &Ray, hit: Hit) -> SurfaceInteraction {
        if let (false, Some(surface)) = (self.is_triangle[lane], &self.others[lane]) {
            return *surface;
        }
        let surfaces = &self.surfaces;
        SurfaceInteraction {
            p: surfaces.p.get(lane),
            error: surfaces.error[lane],
            ng: surfaces.ng.get(lane),
            ns: surfaces.ns.get(lane),
            dpdu: surfaces.dpdu.get(lane),
            dpdv: surfaces.dpdv.get(lane),
            uv: surfaces.uv.get(lane),
            barycentrics: surfaces.barycentrics.get(lane),
            wo: -ray.direction,
            footprint: 0.0,
            time: ray.time,
            hit,
        }
    }
}

/// The mesh and the triangle that were hit, if the mesh is in world space.
#[inline]
fn world_mesh(world: &World, hit: Hit) -> Option<(&TriangleMesh, usize)> {
    match &world.geometry(hit.geometry).shape {
        Shape::Mesh(mesh) if hit.instance.is_none() => Some((mesh, hit.primitive.index())),
        _ => None,
    }
}

impl Surfaces {
    fn set(&mut self, lane: usize, surface: &SurfaceInteraction, origin: Vec3) {
        self.p.set(lane, surface.p);
        self.error[lane] = surface.error;
        self.ng.set(lane, surface.ng);
        self.ns.set(lane, surface.ns);
        self.distance[lane] = surface.p.distance(origin);
    }
}

impl Triangles {
    #[inline]
    fn set(&mut self, lane: usize, mesh: &TriangleMesh, triangle: usize, time: f32) {
        let corners = mesh.indices()[triangle];
        if mesh.is_moving() {
            set_all(&mut self.vertices, lane, [0, 1, 2], &mesh.triangle(triangle, time));
        } else {
            set_all(&mut self.vertices, lane, corners, mesh.padded_positions(0));
        }
        // What a mesh does not have is mostly in its lane already.
        match mesh.normals() {
            Some(normals) => set_all(&mut self.normals, lane, corners, normals),
            None if self.has_no_normals[lane] => {}
            None => set_all(&mut self.normals, lane, [0, 1, 2], &NO_NORMALS),
        }
        self.has_no_normals[lane] = mesh.normals().is_none();
        match mesh.uvs() {
            Some(uvs) => set_all(&mut self.uvs, lane, corners, uvs),
            None if self.has_no_uvs[lane] => {}
            None => set_all(&mut self.uvs, lane, [0, 1, 2], &PLAIN_UVS),
        }
        self.has_no_uvs[lane] = mesh.uvs().is_none();
        self.side[lane] = mesh.side();
    }
}

/// Puts what three corners have of `values` into a lane. One by one: an array of them would go by way of memory.
#[inline(always)]
fn set_all<T: Copy>(lanes: &mut [[T; LANES]; 3], lane: usize, corners: [u32; 3], values: &[T]) {
    for i in 0..3 {
        lanes[i][lane] = values[corners[i] as usize];
    }
}

/// See [`SurfaceLanes::fill`].
struct Compute<'a> {
    rays: &'a RayPacket,
    triangles: &'a Triangles,
    /// Written at the end, all at once: the compiler cannot know that it is apart from the others.
    surfaces: &'a mut Surfaces,
}

impl Kernel for Compute<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { rays, triangles, .. } = self;
        let Triangles {
            vertices, normals, uvs, ..
        } = triangles;
        let mut surfaces = Surfaces::default();
        for i in 0..LANES {
            let vertices = [vertices[0][i], vertices[1][i], vertices[2][i]];
            let corners = Corners {
                normals: [normals[0][i], normals[1][i], normals[2][i]],
                uvs: [uvs[0][i], uvs[1][i], uvs[2][i]],
                side: triangles.side[i],
            };
            let point = triangle::point(&vertices, rays.origin(i).as_dvec3(), rays.direction(i).as_dvec3());
            let (barycentrics, ng) = point.in_single_precision();
            let attributes = corners.at(&vertices, ng, barycentrics);
            let ng = ng * attributes.side;
            let has_ns = (attributes.ns.x != 0.0) | (attributes.ns.y != 0.0) | (attributes.ns.z != 0.0);
            let p = point.p.as_vec3();
            surfaces.p.set(i, p);
            surfaces.distance[i] = p.distance(rays.origin(i));
            surfaces.error[i] = (point.error + rounding_error(point.p, ng)) as f32;
            surfaces.ng.set(i, ng);
            surfaces.dpdu.set(i, attributes.dpdu);
            surfaces.dpdv.set(i, attributes.dpdv);
            let ns = |given: f32, ng: f32| if has_ns { given } else { ng };
            let given = attributes.ns;
            surfaces
                .ns
                .set(i, Vec3::new(ns(given.x, ng.x), ns(given.y, ng.y), ns(given.z, ng.z)));
            surfaces.uv.set(i, attributes.uv);
            surfaces.barycentrics.set(i, barycentrics.into());
        }
        *self.surfaces = surfaces;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Geometry, GeometryId, Group, Instance, PrimitiveId, Sphere, WorldBuilder};
    use crate::math::{AnimatedTransform, DAffine3, DVec3};

    /// Meshes bare, with normals (one of which faces away), with texture coordinates, moving; a sphere; an instance.
    fn world() -> World {
        let at = |z: f32| {
            vec![
                Vec3::new(-1.0, -0.9, z),
                Vec3::new(1.2, -1.0, z + 0.3),
                Vec3::new(0.1, 1.3, z - 0.2),
            ]
        };
        let mesh = |steps| TriangleMesh::new(steps, vec![[0, 1, 2]]).unwrap();
        let uvs = vec![Vec2::new(0.1, 0.2), Vec2::new(0.9, 0.1), Vec2::new(0.4, 0.7)];
        let normals = |z| {
            vec![
                Vec3::new(0.2, 0.1, z),
                Vec3::new(-0.3, 0.0, 2.0 * z),
                Vec3::new(0.0, 0.4, z),
            ]
        };
        let shapes = [
            Shape::Mesh(mesh(vec![at(1.0)])),
            Shape::Mesh(mesh(vec![at(2.0)]).with_normals(normals(1.0)).unwrap()),
            Shape::Mesh(
                mesh(vec![at(3.0)])
                    .with_normals(normals(-1.0))
                    .unwrap()
                    .with_uvs(uvs.clone())
                    .unwrap(),
            ),
            Shape::Mesh(
                mesh(vec![at(4.0), at(5.0)])
                    .with_uvs(vec![uvs[0]; 3])
                    .unwrap()
                    .with_flipped_normal(true),
            ),
            Shape::Spheres(vec![Sphere::at(DVec3::new(0.1, 0.0, 6.0), 0.5).unwrap()]),
        ];
        let mut builder = WorldBuilder::default();
        let ids = shapes.map(|shape| builder.add_geometry(Geometry::opaque(shape)));
        builder.root.geometries = ids.to_vec();
        let group = builder.add_group(Group {
            geometries: vec![ids[1]],
            instances: Vec::new(),
        });
        builder.root.instances.push(Instance {
            group,
            world_from_object: AnimatedTransform::fixed(DAffine3::from_translation(DVec3::Z)).unwrap(),
            mask: u32::MAX,
        });
        builder.build().unwrap()
    }

    #[test]
    fn lanes_are_the_surfaces_of_single_rays() {
        let world = world();
        let mut lanes = SurfaceLanes::default();
        for round in 0..20 {
            let (mut rays, mut hits) = (RayPacket::EMPTY, HitPacket::EMPTY);
            for lane in 0..LANES - 1 {
                let turn = (round * LANES + lane) as f32;
                let toward = Vec3::new(0.2 * turn.sin(), 0.2 * turn.cos(), 1.0);
                rays.set(
                    lane,
                    &Ray::new(Vec3::new(0.05, -0.1, -2.0), toward, 0.05 * round as f32),
                );
                hits.geometry[lane] = ((lane + round) % 6 % 5) as u32;
                hits.primitive[lane] = 0;
                if (lane + round) % 6 == 5 {
                    (hits.geometry[lane], hits.instance[lane]) = (1, 0);
                }
            }
            lanes.fill(&world, &rays, &hits, |ray, hit, _| world.interaction(ray, hit));
            for lane in 0..LANES - 1 {
                let (ray, hit) = (rays.get(lane), hits.get(lane).unwrap());
                let (together, alone) = (lanes.get(lane, &ray, hit), world.interaction(&ray, hit));
                assert_eq!(format!("{together:?}"), format!("{alone:?}"));
                assert_eq!(
                    together.hit,
                    Hit {
                        geometry: GeometryId(hits.geometry[lane]),
                        primitive: PrimitiveId(0),
                        ..hit
                    }
                );
            }
        }
    }
}
