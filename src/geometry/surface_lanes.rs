//! The surfaces that eight rays hit, computed together.

use std::cell::OnceCell;
use std::sync::Arc;

use super::mesh::PLAIN_UVS;
use super::triangle::{self, Parametrization, TrianglePoint, rounding_error, shading_normal};
use super::triangle_lanes::{GatheredTriangles, Mesh, TriangleLanes, set_corners, triangle_hit};
use super::triangle_records::{RecordLanes, TriangleRecord, TriangleRecords};
use super::{Hit, HitPacket, Ray, RayPacket, SurfaceInteraction, World};
use crate::math::{Kernel, LANES, LaneSet, Lanes, Vec2, Vec2Lanes, Vec3, Vec3Lanes, VectorLanes, Vectorizer};

/// The surfaces that the lanes of a packet hit: the bits of [`World::interaction`], several times faster where they hit triangles in
/// world space. Made once for a world and filled again and again.
#[derive(Clone, Debug, Default)]
pub struct SurfaceLanes<'a> {
    vectorizer: Vectorizer,
    /// By geometry; of those that are no meshes, or that move, nothing.
    meshes: Arc<[Mesh<'a>]>,
    /// What is known of the world's triangles, if anything.
    known: Option<&'a TriangleRecords>,
    /// Whether all triangles that the lanes hit have records, and are in `records`, or are gathered.
    are_recorded: bool,
    records: RecordLanes,
    gathered: GatheredTriangles,
    /// Whether the lane hit a triangle in world space.
    is_triangle: [bool; LANES],
    surfaces: Surfaces,
    /// Of triangles, once it is asked for.
    parametrizations: OnceCell<Parametrizations>,
    /// Of lanes that hit something else.
    others: [Option<SurfaceInteraction>; LANES],
}

/// Points of triangles: see [`SurfaceInteraction`].
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
            known: Some(world.triangle_records()).filter(|known| !known.is_empty()),
            ..Self::default()
        };
        [one.clone(), one]
    }

    /// Collects what there is to know of the triangles that rays hit, for [`Self::compute`]: better some time before, as what is stored
    /// lane by lane is waited for if it is read at once.
    #[inline]
    pub fn gather(&mut self, rays: &RayPacket, hits: &HitPacket) {
        self.parametrizations.take();
        self.are_recorded = self.known.is_some_and(|known| self.gather_records(known, hits));
        if self.are_recorded {
            return;
        }
        for lane in 0..LANES {
            let triangle = triangle_hit(&self.meshes, hits, lane);
            self.is_triangle[lane] = triangle.is_some();
            if let Some((mesh, corners)) = triangle {
                self.gathered.set(lane, mesh, corners);
                if let Some(moving) = mesh.moving {
                    let vertices = moving.triangle(hits.primitive[lane] as usize, rays.time[lane]);
                    set_corners(&mut self.gathered.vertices, lane, [0, 1, 2], &vertices);
                }
            }
        }
    }

    /// Collects records, if all triangles that were hit have them.
    #[inline(always)]
    fn gather_records(&mut self, known: &TriangleRecords, hits: &HitPacket) -> bool {
        static NONE: TriangleRecord = TriangleRecord::NONE;
        let records: [_; LANES] = std::array::from_fn(|lane| {
            let record = known.get(hits.geometry[lane], hits.primitive[lane]);
            record.filter(|_| hits.instance[lane] == HitPacket::NONE)
        });
        self.is_triangle = records.map(|record| record.is_some());
        let have_all = hits.hit_lanes().without(self.is_triangle.into()).is_empty();
        if have_all {
            let records = records.map(|record| record.unwrap_or(&NONE));
            self.records.set(self.vectorizer, records);
        }
        have_all
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
            let (vectorizer, surfaces) = (self.vectorizer, &mut self.surfaces);
            if self.are_recorded {
                let triangles = &self.records;
                vectorizer.run(Compute {
                    rays,
                    triangles,
                    surfaces,
                });
            } else {
                let triangles = &self.gathered;
                vectorizer.run(Compute {
                    rays,
                    triangles,
                    surfaces,
                });
            }
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
                Some((mesh, corners)) if !mesh.uvs.is_empty() => set_corners(&mut uvs, lane, corners, mesh.uvs),
                _ => set_corners(&mut uvs, lane, [0, 1, 2], &PLAIN_UVS),
            }
        }
        let (uvs, barycentrics) = (&uvs, &self.surfaces.barycentrics);
        if self.are_recorded {
            let triangles = &self.records;
            self.vectorizer.run(Parametrize {
                uvs,
                triangles,
                barycentrics,
            })
        } else {
            let triangles = &self.gathered;
            self.vectorizer.run(Parametrize {
                uvs,
                triangles,
                barycentrics,
            })
        }
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

/// See [`SurfaceLanes::compute`].
struct Compute<'a, T> {
    rays: &'a RayPacket,
    triangles: &'a T,
    /// Written at the end, all at once: the compiler cannot know that it is apart from the others.
    surfaces: &'a mut Surfaces,
}

impl<T: TriangleLanes> Kernel for Compute<'_, T> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { rays, triangles, .. } = self;
        let mut surfaces = Surfaces::default();
        for i in 0..LANES {
            let (origin, direction) = (rays.origin(i).as_dvec3(), rays.direction(i).as_dvec3());
            let point = triangle::point(&triangles.vertices(i), origin, direction);
            let TrianglePoint { p: exact, barycentrics } = point;
            let (error, ng) = triangles.plane(i);
            let given = shading_normal(&triangles.normals(i), barycentrics);
            let has_ns = (given.x != 0.0) | (given.y != 0.0) | (given.z != 0.0);
            let p = exact.as_vec3();
            surfaces.p.set(i, p);
            surfaces.distance[i] = p.distance(rays.origin(i));
            surfaces.error[i] = (error + rounding_error(exact, ng)) as f32;
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
struct Parametrize<'a, T> {
    uvs: &'a [[Vec2; LANES]; 3],
    triangles: &'a T,
    barycentrics: &'a Vec2Lanes,
}

impl<T: TriangleLanes> Kernel for Parametrize<'_, T> {
    type Output = Parametrizations;

    #[inline(always)]
    fn call(self) -> Parametrizations {
        let Self { uvs, triangles, .. } = self;
        let mut lanes = Parametrizations::default();
        for i in 0..LANES {
            let uvs = [uvs[0][i], uvs[1][i], uvs[2][i]];
            let Parametrization { dpdu, dpdv, uv } =
                Parametrization::at(&uvs, &triangles.vertices(i), self.barycentrics.get(i).into());
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
    use crate::geometry::{
        Geometry, GeometryId, Group, Instance, PrimitiveId, Shape, Sphere, TriangleMesh, WorldBuilder,
    };
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
        // Of three kinds, all triangles have records; of six they do not.
        for (round, kinds) in (0..40).map(|turn| (turn / 2, [3, 6][turn % 2])) {
            let (mut rays, mut hits) = (RayPacket::EMPTY, HitPacket::EMPTY);
            for lane in 0..LANES - 1 {
                let turn = (round * LANES + lane) as f32;
                let toward = Vec3::new(0.2 * turn.sin(), 0.2 * turn.cos(), 1.0);
                rays.set(
                    lane,
                    &Ray::new(Vec3::new(0.05, -0.1, -2.0), toward, 0.05 * round as f32),
                );
                hits.geometry[lane] = ((lane + round) % kinds % 5) as u32;
                hits.primitive[lane] = 0;
                if (lane + round) % kinds == 5 {
                    (hits.geometry[lane], hits.instance[lane]) = (1, 0);
                }
            }
            lanes.gather(&rays, &hits);
            assert_eq!(lanes.are_recorded, kinds == 3);
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
