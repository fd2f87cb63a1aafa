//! Blocks of four triangles in struct-of-arrays form.

use super::ray::LocalRay;
use super::triangle::{greatest, least};
use crate::geometry::{GeometryId, HitPacket, TriangleMesh, World};
use crate::math::Bounds3;

/// Triangles in a block.
pub const LANES: usize = 4;

/// A triangle of a mesh.
pub type Triangle<'a> = (GeometryId, &'a TriangleMesh, usize);

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

    #[inline(always)]
    fn set(&mut self, lane: usize, mesh: &TriangleMesh, triangle: usize, step: usize) {
        let positions = mesh.positions(step);
        for (corner, &vertex) in self.0.iter_mut().zip(&mesh.indices()[triangle]) {
            let position = positions[vertex as usize];
            corner[0][lane] = position.x;
            corner[1][lane] = position.y;
            corner[2][lane] = position.z;
        }
    }

    /// The corners of one triangle.
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> [[f32; 3]; 3] {
        self.0.map(|corner| corner.map(|axis| axis[lane]))
    }

    /// A box around the triangles of all lanes.
    #[inline(always)]
    fn bounds(&self) -> Bounds3 {
        let mut bounds = Bounds3::EMPTY;
        for axis in 0..3 {
            let [a, b, c] = [&self.0[0][axis], &self.0[1][axis], &self.0[2][axis]];
            let (mut low, mut high) = ([0.0; LANES], [0.0; LANES]);
            for lane in 0..LANES {
                low[lane] = least(least(a[lane], b[lane]), c[lane]);
                high[lane] = greatest(greatest(a[lane], b[lane]), c[lane]);
            }
            bounds.min[axis] = least(least(low[0], low[1]), least(low[2], low[3]));
            bounds.max[axis] = greatest(greatest(high[0], high[1]), greatest(high[2], high[3]));
        }
        bounds
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
    #[inline(always)]
    fn new(world: &World, triangles: &[Triangle<'_>]) -> Self {
        let mut ids = Self {
            mask: [0; LANES],
            geometry: [HitPacket::NONE; LANES],
            primitive: [HitPacket::NONE; LANES],
        };
        for (lane, &(geometry, _, triangle)) in triangles.iter().enumerate() {
            ids.mask[lane] = world.geometry(geometry).mask;
            ids.geometry[lane] = geometry.0;
            ids.primitive[lane] = triangle as u32;
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
    /// As of a node that it is below.
    type Bounds: Copy + Send + Sync;

    /// A box around nothing.
    const NOTHING: Self::Bounds;

    /// Of at most four triangles of meshes, from time step `step` on.
    fn new(world: &World, triangles: &[Triangle<'_>], step: usize) -> Self;

    /// A box around its triangles.
    fn bounds(&self) -> Self::Bounds;

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
    type Bounds = Bounds3;

    const NOTHING: Bounds3 = Bounds3::EMPTY;

    #[inline(always)]
    fn new(world: &World, triangles: &[Triangle<'_>], step: usize) -> Self {
        Self {
            corners: gather(triangles, step),
            ids: BlockIds::new(world, triangles),
        }
    }

    #[inline(always)]
    fn bounds(&self) -> Bounds3 {
        self.corners.bounds()
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
    /// At the start and at the end of the segment.
    type Bounds = [Bounds3; 2];

    const NOTHING: [Bounds3; 2] = [Bounds3::EMPTY; 2];

    #[inline(always)]
    fn new(world: &World, triangles: &[Triangle<'_>], step: usize) -> Self {
        Self {
            start: gather(triangles, step),
            end: gather(triangles, step + 1),
            ids: BlockIds::new(world, triangles),
        }
    }

    fn bounds(&self) -> [Bounds3; 2] {
        [self.start.bounds(), self.end.bounds()]
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

/// The corners of triangles; lanes without one have those of the first.
#[inline(always)]
fn gather(triangles: &[Triangle<'_>], step: usize) -> Corners {
    let mut corners = Corners::scratch();
    for lane in 0..LANES {
        let (_, mesh, triangle) = triangles[if lane < triangles.len() { lane } else { 0 }];
        corners.set(lane, mesh, triangle, step);
    }
    corners
}
