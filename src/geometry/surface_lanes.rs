//! The surfaces that eight rays hit, computed together.

use super::triangle::{self, Corners, rounding_error};
use super::{Hit, HitPacket, LANES, Ray, RayPacket, Shape, SurfaceInteraction, TriangleMesh, World};
use crate::math::{Kernel, Vec2, Vec3, Vectorizer};

/// A number for each lane.
type Lanes = [f32; LANES];

/// [`World::interaction`] of the lanes of a packet: the same bits, several times faster where they hit triangles in world space. Made
/// once and filled again and again.
#[derive(Clone, Debug, Default)]
pub struct SurfaceLanes {
    vectorizer: Vectorizer,
    triangles: Triangles,
    /// Whether the lane hit a triangle in world space: only then its surface is below.
    is_triangle: [bool; LANES],
    surfaces: Surfaces,
}

/// What [`triangle::point`] and [`Corners::at`] are given.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(32))]
struct Triangles {
    /// By vertex and axis.
    vertices: [[Lanes; 3]; 3],
    /// By vertex and axis.
    normals: [[Lanes; 3]; 3],
    /// By vertex and coordinate.
    uvs: [[Lanes; 2]; 3],
    side: Lanes,
}

/// What they give: see [`SurfaceInteraction`].
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(32))]
struct Surfaces {
    p: [Lanes; 3],
    error: Lanes,
    ng: [Lanes; 3],
    ns: [Lanes; 3],
    dpdu: [Lanes; 3],
    dpdv: [Lanes; 3],
    uv: [Lanes; 2],
    barycentrics: [Lanes; 2],
}

impl SurfaceLanes {
    /// Computes what the rays that take part hit.
    #[inline]
    pub fn fill(&mut self, world: &World, rays: &RayPacket, hits: &HitPacket) {
        let triangles = &mut self.triangles;
        for lane in 0..LANES {
            let hit = hits.get(lane).and_then(|hit| world_mesh(world, hit));
            self.is_triangle[lane] = hit.is_some();
            let Some((mesh, triangle)) = hit else { continue };
            let corners = mesh.corners(triangle);
            for (i, vertex) in mesh.triangle(triangle, rays.time[lane]).into_iter().enumerate() {
                put(&mut triangles.vertices[i], lane, vertex);
                put(&mut triangles.normals[i], lane, corners.normals[i]);
                [triangles.uvs[i][0][lane], triangles.uvs[i][1][lane]] = corners.uvs[i].to_array();
            }
            triangles.side[lane] = corners.side;
        }
        self.surfaces = self.vectorizer.run(Compute { rays, triangles });
    }

    /// What `ray`, which was in `lane`, `hit`.
    #[inline]
    pub fn get(&self, world: &World, lane: usize, ray: &Ray, hit: Hit) -> SurfaceInteraction {
        if !self.is_triangle[lane] {
            return world.interaction(ray, hit);
        }
        let surfaces = &self.surfaces;
        SurfaceInteraction {
            p: of(&surfaces.p, lane),
            error: surfaces.error[lane],
            ng: of(&surfaces.ng, lane),
            ns: of(&surfaces.ns, lane),
            dpdu: of(&surfaces.dpdu, lane),
            dpdv: of(&surfaces.dpdv, lane),
            uv: Vec2::new(surfaces.uv[0][lane], surfaces.uv[1][lane]),
            barycentrics: Vec2::new(surfaces.barycentrics[0][lane], surfaces.barycentrics[1][lane]),
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

#[inline(always)]
fn of(axes: &[Lanes; 3], lane: usize) -> Vec3 {
    Vec3::new(axes[0][lane], axes[1][lane], axes[2][lane])
}

#[inline(always)]
fn put(axes: &mut [Lanes; 3], lane: usize, v: Vec3) {
    [axes[0][lane], axes[1][lane], axes[2][lane]] = v.to_array();
}

/// See [`SurfaceLanes::fill`].
struct Compute<'a> {
    rays: &'a RayPacket,
    triangles: &'a Triangles,
}

impl Kernel for Compute<'_> {
    type Output = Surfaces;

    #[inline(always)]
    fn call(self) -> Surfaces {
        let Self { rays, triangles } = self;
        let ([a, b, c], [na, nb, nc]) = (&triangles.vertices, &triangles.normals);
        let [[ua, va], [ub, vb], [uc, vc]] = &triangles.uvs;
        let mut surfaces = Surfaces::default();
        for i in 0..LANES {
            let vertices = [of(a, i), of(b, i), of(c, i)];
            let corners = Corners {
                normals: [of(na, i), of(nb, i), of(nc, i)],
                uvs: [
                    Vec2::new(ua[i], va[i]),
                    Vec2::new(ub[i], vb[i]),
                    Vec2::new(uc[i], vc[i]),
                ],
                side: triangles.side[i],
            };
            let origin = Vec3::new(rays.org_x[i], rays.org_y[i], rays.org_z[i]).as_dvec3();
            let direction = Vec3::new(rays.dir_x[i], rays.dir_y[i], rays.dir_z[i]).as_dvec3();
            let point = triangle::point(&vertices, origin, direction);
            let (barycentrics, ng) = point.in_single_precision();
            let attributes = corners.at(&vertices, ng, barycentrics);
            let ng = ng * attributes.side;
            let has_ns = (attributes.ns.x != 0.0) | (attributes.ns.y != 0.0) | (attributes.ns.z != 0.0);
            put(&mut surfaces.p, i, point.p.as_vec3());
            surfaces.error[i] = (point.error + rounding_error(point.p, ng)) as f32;
            put(&mut surfaces.ng, i, ng);
            put(&mut surfaces.dpdu, i, attributes.dpdu);
            put(&mut surfaces.dpdv, i, attributes.dpdv);
            for (ns, (given, ng)) in surfaces.ns.iter_mut().zip([
                (attributes.ns.x, ng.x),
                (attributes.ns.y, ng.y),
                (attributes.ns.z, ng.z),
            ]) {
                ns[i] = if has_ns { given } else { ng };
            }
            [surfaces.uv[0][i], surfaces.uv[1][i]] = attributes.uv.to_array();
            [surfaces.barycentrics[0][i], surfaces.barycentrics[1][i]] = barycentrics;
        }
        surfaces
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
            lanes.fill(&world, &rays, &hits);
            for lane in 0..LANES - 1 {
                let (ray, hit) = (rays.get(lane), hits.get(lane).unwrap());
                let (together, alone) = (lanes.get(&world, lane, &ray, hit), world.interaction(&ray, hit));
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
