//! The triangles that the lanes of a packet hit.

use super::mesh::NO_NORMALS;
use super::triangle::{TrianglePlane, facing_side};
use super::triangle_records::RecordLanes;
use super::{HitPacket, Shape, TriangleMesh};
use crate::math::{LANES, Lanes, Vec2, Vec3};

/// What kernels need to know of a triangle in each lane.
pub(super) trait TriangleLanes {
    fn vertices(&self, lane: usize) -> [Vec3; 3];

    /// See [`Corners::normals`](super::triangle::Corners::normals).
    fn normals(&self, lane: usize) -> [Vec3; 3];

    /// See [`TrianglePlane::error`], and the unit normal on the side where the surface faces.
    fn plane(&self, lane: usize) -> (f64, Vec3);
}

/// What a mesh has, at hand.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Mesh<'a> {
    pub indices: &'a [[u32; 3]],
    /// As many as there are normals, if there are any.
    pub positions: &'a [Vec3],
    /// Empty if it has none.
    pub normals: &'a [Vec3],
    /// Empty if it has none.
    pub uvs: &'a [Vec2],
    /// See [`Corners::side`](super::triangle::Corners::side).
    pub side: f32,
    /// It, if it moves.
    pub moving: Option<&'a TriangleMesh>,
}

impl<'a> Mesh<'a> {
    /// Of a geometry's shape; without triangles if it is none.
    pub fn of(shape: &'a Shape) -> Self {
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

/// The mesh in world space, if it is one, that a lane hit, and the corners of the triangle.
#[inline]
pub(super) fn triangle_hit<'a, 'm>(
    meshes: &'m [Mesh<'a>],
    hits: &HitPacket,
    lane: usize,
) -> Option<(&'m Mesh<'a>, [u32; 3])> {
    // What is not hit is beyond all geometries.
    let mesh = meshes.get(hits.geometry[lane] as usize)?;
    let corners = mesh.indices.get(hits.primitive[lane] as usize)?;
    (hits.instance[lane] == HitPacket::NONE).then_some((mesh, *corners))
}

/// Triangles as meshes have them.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct GatheredTriangles {
    /// Of each corner what the lanes have, one after the other: as meshes have it, in two copies and not in three.
    pub vertices: [[Vec3; LANES]; 3],
    normals: [[Vec3; LANES]; 3],
    /// See [`Corners::side`](super::triangle::Corners::side).
    side: Lanes,
    /// Whether the lane's normals are those of a mesh without any.
    has_no_normals: [bool; LANES],
}

impl GatheredTriangles {
    /// Puts a triangle of a mesh into a lane.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, mesh: &Mesh<'_>, corners: [u32; 3]) {
        self.side[lane] = mesh.side;
        self.has_no_normals[lane] = if mesh.normals.is_empty() {
            set_corners(&mut self.vertices, lane, corners, mesh.positions);
            // They are mostly in their lane already.
            if !self.has_no_normals[lane] {
                set_corners(&mut self.normals, lane, [0, 1, 2], &NO_NORMALS);
            }
            true
        } else {
            // Corners that have positions then have normals, as the compiler sees.
            set_corners(&mut self.vertices, lane, corners, &mesh.positions[..mesh.normals.len()]);
            set_corners(&mut self.normals, lane, corners, mesh.normals);
            false
        };
    }
}

/// Puts what three corners have of `values` into a lane. One by one: an array of them would go by way of memory.
#[inline(always)]
pub(super) fn set_corners<T: Copy>(lanes: &mut [[T; LANES]; 3], lane: usize, corners: [u32; 3], values: &[T]) {
    for i in 0..3 {
        lanes[i][lane] = values[corners[i] as usize];
    }
}

impl TriangleLanes for GatheredTriangles {
    #[inline(always)]
    fn vertices(&self, lane: usize) -> [Vec3; 3] {
        let [a, b, c] = &self.vertices;
        [a[lane], b[lane], c[lane]]
    }

    #[inline(always)]
    fn normals(&self, lane: usize) -> [Vec3; 3] {
        let [a, b, c] = &self.normals;
        [a[lane], b[lane], c[lane]]
    }

    #[inline(always)]
    fn plane(&self, lane: usize) -> (f64, Vec3) {
        let TrianglePlane { error, ng } = TrianglePlane::of(&self.vertices(lane));
        let ng = ng.as_vec3();
        (error, ng * facing_side(&self.normals(lane), self.side[lane], ng))
    }
}

impl TriangleLanes for RecordLanes {
    #[inline(always)]
    fn vertices(&self, lane: usize) -> [Vec3; 3] {
        self.vertices(lane)
    }

    #[inline(always)]
    fn normals(&self, lane: usize) -> [Vec3; 3] {
        self.normals(lane)
    }

    #[inline(always)]
    fn plane(&self, lane: usize) -> (f64, Vec3) {
        (self.error(lane), self.ng(lane))
    }
}
