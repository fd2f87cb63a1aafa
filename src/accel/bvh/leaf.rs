//! Blocks of four triangles in struct-of-arrays form.

use super::ray::LocalRay;
use crate::geometry::{GeometryId, HitPacket, PrimitiveId, Shape, TriangleMesh, World};

/// Triangles in a block.
pub const LANES: usize = 4;

/// The corners of four triangles, by corner, axis and lane.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
pub struct Corners(pub [[[f32; LANES]; 3]; 3]);

impl Corners {
    /// Zeros, to be written over.
    #[inline(always)]
    pub fn scratch() -> Self {
        Self([[[0.0; LANES]; 3]; 3])
    }

    fn set(&mut self, lane: usize, mesh: &TriangleMesh, triangle: usize, step: usize) {
        for (corner, &vertex) in mesh.indices()[triangle].iter().enumerate() {
            for (axis, x) in mesh.positions(step)[vertex as usize].to_array().into_iter().enumerate() {
                self.0[corner][axis][lane] = x;
            }
        }
    }

    /// The corners of one triangle.
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> [[f32; 3]; 3] {
        self.0.map(|corner| corner.map(|axis| axis[lane]))
    }

    /// Linear between two; the operations are those of [`TriangleMesh::triangle`].
    #[inline(always)]
    fn set_between(&mut self, start: &Self, end: &Self, fraction: f32) {
        for corner in 0..3 {
            for axis in 0..3 {
                for lane in 0..LANES {
                    self.0[corner][axis][lane] =
                        start.0[corner][axis][lane] * (1.0 - fraction) + end.0[corner][axis][lane] * fraction;
                }
            }
        }
    }

    /// Barycentric coordinates, for a filter, of the place where `ray` hits the triangle of a lane.
    #[cold]
    pub fn barycentrics(&self, lane: usize, ray: &LocalRay) -> [f32; 2] {
        ray.shear.barycentrics(&self.lane(lane))
    }
}

/// Which triangles a block holds.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(16))]
pub struct BlockIds {
    /// Masks of their geometries; 0 for a lane without a triangle.
    pub mask: [u32; LANES],
    /// Geometries.
    pub geometry: [u32; LANES],
    /// Primitives.
    pub primitive: [u32; LANES],
}

impl BlockIds {
    fn new(world: &World, triangles: &[(GeometryId, PrimitiveId)]) -> Self {
        let mut ids = Self {
            mask: [0; LANES],
            geometry: [HitPacket::NONE; LANES],
            primitive: [HitPacket::NONE; LANES],
        };
        for (lane, &(geometry, primitive)) in triangles.iter().enumerate() {
            ids.mask[lane] = world.geometry(geometry).mask;
            ids.geometry[lane] = geometry.0;
            ids.primitive[lane] = primitive.0;
        }
        ids
    }
}

/// Four triangles that do not move.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct FixedBlock {
    corners: Corners,
    ids: BlockIds,
}

/// Four triangles over a time segment.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct MovingBlock {
    start: Corners,
    end: Corners,
    ids: BlockIds,
}

/// What building and traversal ask of a block.
pub trait Block: Send + Sync {
    /// Of at most four triangles of meshes, from time step `step` on.
    fn new(world: &World, triangles: &[(GeometryId, PrimitiveId)], step: usize) -> Self;

    /// The corners at a fraction of the time segment, which may be put into `scratch`.
    fn corners<'a>(&'a self, fraction: f32, scratch: &'a mut Corners) -> &'a Corners;

    /// Which triangles they are.
    fn ids(&self) -> &BlockIds;
}

impl FixedBlock {
    /// The corners.
    #[inline(always)]
    pub fn fixed_corners(&self) -> &Corners {
        &self.corners
    }
}

impl Block for FixedBlock {
    fn new(world: &World, triangles: &[(GeometryId, PrimitiveId)], step: usize) -> Self {
        Self {
            corners: gather(world, triangles, step),
            ids: BlockIds::new(world, triangles),
        }
    }

    #[inline(always)]
    fn corners<'a>(&'a self, _fraction: f32, _scratch: &'a mut Corners) -> &'a Corners {
        &self.corners
    }

    #[inline(always)]
    fn ids(&self) -> &BlockIds {
        &self.ids
    }
}

impl Block for MovingBlock {
    fn new(world: &World, triangles: &[(GeometryId, PrimitiveId)], step: usize) -> Self {
        Self {
            start: gather(world, triangles, step),
            end: gather(world, triangles, step + 1),
            ids: BlockIds::new(world, triangles),
        }
    }

    #[inline(always)]
    fn corners<'a>(&'a self, fraction: f32, scratch: &'a mut Corners) -> &'a Corners {
        scratch.set_between(&self.start, &self.end, fraction);
        scratch
    }

    #[inline(always)]
    fn ids(&self) -> &BlockIds {
        &self.ids
    }
}

fn gather(world: &World, triangles: &[(GeometryId, PrimitiveId)], step: usize) -> Corners {
    let mut corners = Corners::scratch();
    for (lane, &(geometry, primitive)) in triangles.iter().enumerate() {
        if let Shape::Mesh(mesh) = &world.geometry(geometry).shape {
            corners.set(lane, mesh, primitive.index(), step);
        }
    }
    corners
}
