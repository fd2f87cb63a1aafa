//! The surfaces that eight rays hit, computed together.

use std::cell::OnceCell;
use std::sync::Arc;

use super::mesh::{NO_NORMALS, PLAIN_UVS};
use super::triangle::{self, Facing, Parametrization, rounding_error};
use super::{Hit, HitPacket, Ray, RayPacket, Shape, SurfaceInteraction, TriangleMesh, World};
use crate::math::{Kernel, LANES, LaneSet, Lanes, Vec2, Vec2Lanes, Vec3, Vec3Lanes, VectorLanes, Vectorizer};

/// The surfaces that the lanes of a packet hit: the bits of [`World::interaction`], several times faster where they hit triangles in
/// world space. Made once for a world and filled again and again.
#[derive(Clone, Debug, Default)]
pub struct SurfaceLanes<'a> {
    vectorizer: Vectorizer,
    /// By geometry; of those that are no meshes, or that move, nothing.
    meshes: Arc<[Mesh<'a>]>,
    triangles: Triangles,
    /// Whether the lane hit a triangle in world space.
    is_triangle: [bool; LANES],
    surfaces: Surfaces,
    /// Of triangles, once it is asked for.
    parametrizations: OnceCell<Parametrizations>,
    /// Of lanes that hit something else.
    others: [Option<SurfaceInteraction>; LANES],
}

/// What a mesh has, at hand.
#[derive(Clone, Copy, Debug, Default)]
struct Mesh<'a> {
    indices: &'a [[u32; 3]],
    /// As many as there are normals, if there are any.
    positions: &'a [Vec3],
    /// Empty if it has none.
    normals: &'a [Vec3],
    /// Empty if it has none.
    uvs: &'a [Vec2],
    /// See [`Corners::side`](triangle::Corners::side).
    side: f32,
    /// It, if it moves.
    moving: Option<&'a TriangleMesh>,
}

impl<'a> Mesh<'a> {
    /// Of a geometry's shape; without triangles if it is none.
    fn of(shape: &'a Shape) -> Self {
        let Shape::Mesh(mesh) = shape else {
            return Self::default();
        };
        Self {
            indices: mesh.indices(),
            positions: mesh.positions(0),
            normals: mesh.normals().unwrap_or_default(),
            uvs: mesh.uvs().unwrap_or_default(),
            side: mesh.side(),
            moving: Some(mesh).filter(|mesh| mesh.is_moving()),
        }
    }
}

/// What [`triangle::point`] and [`Facing::at`] are given.
#[derive(Clone, Copy, Debug, Default)]
struct Triangles {
    /// Of each corner what the lanes have, one after the other: as meshes have it, in two copies and not in three.
    vertices: [[Vec3; LANES]; 3],
    normals: [[Vec3; LANES]; 3],
    side: Lanes,
    /// Whether the lane's normals are those of a mesh without any.
    has_no_normals: [bool; LANES],
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
    barycentrics: Vec2Lanes,
}

/// See [`Parametrization`].
#[derive(Clone, Copy, Debug, Default)]
struct Parametrizations {
    dpdu: Vec3Lanes,
    dpdv: Vec3Lanes,
    uv: Vec2Lanes,
}

impl<'a> SurfaceLanes<'a> {
    /// Two of what rays hit in `world`.
    pub fn two(world: &'a World) -> [Self; 2] {
        let meshes = world.geometries().iter().map(|geometry| Mesh::of(&geometry.shape));
        let one = Self {
            meshes: meshes.collect(),
            ..Self::default()
        };
        [one.clone(), one]
    }

    /// Collects what there is to know of the triangles that rays hit, for [`Self::compute`]: better some time before, as what is stored
    /// lane by lane is waited for if it is read at once.
    #[inline]
    pub fn gather(&mut self, rays: &RayPacket, hits: &HitPacket) {
        self.parametrizations.take();
        for lane in 0..LANES {
            let triangle = triangle_hit(&self.meshes, hits, lane);
            self.is_triangle[lane] = triangle.is_some();
            if let Some((mesh, corners)) = triangle {
                self.triangles.set(lane, mesh, corners);
                if let Some(moving) = mesh.moving {
                    let vertices = moving.triangle(hits.primitive[lane] as usize, rays.time[lane]);
                    set_all(&mut self.triangles.vertices, lane, [0, 1, 2], &vertices);
                }
            }
        }
    }

    /// Computes what the rays that take part hit; `other` says it, for a ray, its hit and the distance there, of what is not a triangle in
    /// world space.
    #[inline]
    pub fn compute(
        &mut self,
        rays: &RayPacket,
        hits: &HitPacket,
        other: impl Fn(&Ray, Hit, f32) -> SurfaceInteraction,
    ) {
        let on_triangles = LaneSet::from(self.is_triangle);
        if !on_triangles.is_empty() {
            let triangles = &self.triangles;
            let surfaces = &mut self.surfaces;
            self.vectorizer.run(Compute {
                rays,
                triangles,
                surfaces,
            });
        }
        if !hits.hit_lanes().without(on_triangles).is_empty() {
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

    /// Where the ray in `lane` has this `hit`, one of the `hits` of `rays` that this was filled with.
    #[inline]
    pub fn get(&self, lane: usize, hit: Hit, rays: &RayPacket, hits: &HitPacket) -> SurfaceInteraction {
        if let (false, Some(surface)) = (self.is_triangle[lane], &self.others[lane]) {
            return *surface;
        }
        let surfaces = &self.surfaces;
        let Parametrizations { dpdu, dpdv, uv } = self.parametrizations.get_or_init(|| self.parametrize(hits));
        SurfaceInteraction {
            p: surfaces.p.get(lane),
            error: surfaces.error[lane],
            ng: surfaces.ng.get(lane),
            ns: surfaces.ns.get(lane),
            dpdu: dpdu.get(lane),
            dpdv: dpdv.get(lane),
            uv: uv.get(lane),
            barycentrics: surfaces.barycentrics.get(lane),
            wo: -rays.direction(lane),
            footprint: 0.0,
            time: rays.time[lane],
            hit,
        }
    }

    fn parametrize(&self, hits: &HitPacket) -> Parametrizations {
        let mut uvs = [[Vec2::ZERO; LANES]; 3];
        for lane in 0..LANES {
            match triangle_hit(&self.meshes, hits, lane) {
                Some((mesh, corners)) if !mesh.uvs.is_empty() => set_all(&mut uvs, lane, corners, mesh.uvs),
                _ => set_all(&mut uvs, lane, [0, 1, 2], &PLAIN_UVS),
            }
        }
        self.vectorizer.run(Parametrize {
            uvs: &uvs,
            vertices: &self.triangles.vertices,
            barycentrics: &self.surfaces.barycentrics,
        })
    }
}

/// The mesh in world space, if it is one, that a lane hit, and the corners of the triangle.
#[inline]
fn triangle_hit<'a, 'm>(meshes: &'m [Mesh<'a>], hits: &HitPacket, lane: usize) -> Option<(&'m Mesh<'a>, [u32; 3])> {
    // What is not hit is beyond all geometries.
    let mesh = meshes.get(hits.geometry[lane] as usize)?;
    let corners = mesh.indices.get(hits.primitive[lane] as usize)?;
    (hits.instance[lane] == HitPacket::NONE).then_some((mesh, *corners))
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
    #[inline(always)]
    fn set(&mut self, lane: usize, mesh: &Mesh<'_>, corners: [u32; 3]) {
        self.side[lane] = mesh.side;
        self.has_no_normals[lane] = if mesh.normals.is_empty() {
            set_all(&mut self.vertices, lane, corners, mesh.positions);
            // They are mostly in their lane already.
            if !self.has_no_normals[lane] {
                set_all(&mut self.normals, lane, [0, 1, 2], &NO_NORMALS);
            }
            true
        } else {
            // Corners that have positions then have normals, as the compiler sees.
            set_all(&mut self.vertices, lane, corners, &mesh.positions[..mesh.normals.len()]);
            set_all(&mut self.normals, lane, corners, mesh.normals);
            false
        };
    }
}

/// Puts what three corners have of `values` into a lane. One by one: an array of them would go by way of memory.
#[inline(always)]
fn set_all<T: Copy>(lanes: &mut [[T; LANES]; 3], lane: usize, corners: [u32; 3], values: &[T]) {
    for i in 0..3 {
        lanes[i][lane] = values[corners[i] as usize];
    }
}

/// See [`SurfaceLanes::compute`].
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
        let Triangles { vertices, normals, .. } = triangles;
        let mut surfaces = Surfaces::default();
        for i in 0..LANES {
            let vertices = [vertices[0][i], vertices[1][i], vertices[2][i]];
            let normals = [normals[0][i], normals[1][i], normals[2][i]];
            let point = triangle::point(&vertices, rays.origin(i).as_dvec3(), rays.direction(i).as_dvec3());
            let (barycentrics, ng) = point.in_single_precision();
            let Facing { side, ns: given } = Facing::at(&normals, triangles.side[i], ng, barycentrics);
            let ng = ng * side;
            let has_ns = (given.x != 0.0) | (given.y != 0.0) | (given.z != 0.0);
            let p = point.p.as_vec3();
            surfaces.p.set(i, p);
            surfaces.distance[i] = p.distance(rays.origin(i));
            surfaces.error[i] = (point.error + rounding_error(point.p, ng)) as f32;
            surfaces.ng.set(i, ng);
            let ns = |given: f32, ng: f32| if has_ns { given } else { ng };
            surfaces
                .ns
                .set(i, Vec3::new(ns(given.x, ng.x), ns(given.y, ng.y), ns(given.z, ng.z)));
            surfaces.barycentrics.set(i, barycentrics.into());
        }
        *self.surfaces = surfaces;
    }
}

/// See [`SurfaceLanes::parametrize`].
struct Parametrize<'a> {
    uvs: &'a [[Vec2; LANES]; 3],
    vertices: &'a [[Vec3; LANES]; 3],
    barycentrics: &'a Vec2Lanes,
}

impl Kernel for Parametrize<'_> {
    type Output = Parametrizations;

    #[inline(always)]
    fn call(self) -> Parametrizations {
        let Self { uvs, vertices, .. } = self;
        let mut lanes = Parametrizations::default();
        for i in 0..LANES {
            let vertices = [vertices[0][i], vertices[1][i], vertices[2][i]];
            let uvs = [uvs[0][i], uvs[1][i], uvs[2][i]];
            let Parametrization { dpdu, dpdv, uv } =
                Parametrization::at(&uvs, &vertices, self.barycentrics.get(i).into());
            lanes.dpdu.set(i, dpdu);
            lanes.dpdv.set(i, dpdv);
            lanes.uv.set(i, uv);
        }
        lanes
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
        let [mut lanes, _] = SurfaceLanes::two(&world);
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
            lanes.gather(&rays, &hits);
            lanes.compute(&rays, &hits, |ray, hit, _| world.interaction(ray, hit));
            for lane in 0..LANES - 1 {
                let (ray, hit) = (rays.get(lane), hits.get(lane).unwrap());
                let (together, alone) = (lanes.get(lane, hit, &rays, &hits), world.interaction(&ray, hit));
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
