//! What is the same wherever a triangle is hit, computed once for those of scenes with few.

use super::triangle::{Corners, TrianglePlane, facing_side};
use super::{Geometry, GeometryId, Shape, TriangleMesh};
use crate::math::{Column, LANES, Vec3, Vectorizer};

/// The most triangles that have records, in 384 KiB.
const MAX_TRIANGLES: usize = 4096;

/// Numbers of 32 bits, in blocks as long as a packet: vertices, normals, the normal of the plane, the two halves of its error.
const BLOCKS: usize = 3;
const VERTICES: usize = 0;
const NORMALS: usize = 9;
const NG: usize = 18;
const ERROR: usize = 21;

/// A triangle that does not move, in world space.
#[derive(Clone, Debug)]
#[repr(align(32))]
pub struct TriangleRecord([Column; BLOCKS]);

impl TriangleRecord {
    /// Of no triangle.
    pub const NONE: Self = Self([[0; LANES]; BLOCKS]);

    fn new(mesh: &TriangleMesh, triangle: usize) -> Self {
        let vertices = mesh.triangle(triangle, 0.0);
        let Corners { normals, side, .. } = mesh.corners(triangle);
        let TrianglePlane { error, ng } = TrianglePlane::of(&vertices);
        let ng = ng.as_vec3();
        let mut record = Self::NONE;
        for i in 0..3 {
            record.set(VERTICES + 3 * i, vertices[i]);
            record.set(NORMALS + 3 * i, normals[i]);
        }
        record.set(NG, ng * facing_side(&normals, side, ng));
        let numbers = record.0.as_flattened_mut();
        let error = error.to_bits();
        (numbers[ERROR], numbers[ERROR + 1]) = (error as u32, (error >> 32) as u32);
        record
    }

    fn set(&mut self, at: usize, v: Vec3) {
        self.0.as_flattened_mut()[at..at + 3].copy_from_slice(&v.to_array().map(f32::to_bits));
    }
}

/// The records of a world's triangles.
#[derive(Clone, Debug, Default)]
pub struct TriangleRecords {
    records: Vec<TriangleRecord>,
    /// The place of the first one of each geometry, or [`NO_RECORDS`]; empty if there are none.
    first: Vec<u32>,
}

/// Beyond all records.
const NO_RECORDS: u32 = u32::MAX;

impl TriangleRecords {
    /// Of the meshes among `geometries` that are placed in world space, by `root`, and do not move; of none if they have too many triangles.
    pub fn of(geometries: &[Geometry], root: &[GeometryId]) -> Self {
        let mesh = |id: &GeometryId| match &geometries[id.index()].shape {
            Shape::Mesh(mesh) if !mesh.is_moving() => Some((id.index(), mesh)),
            _ => None,
        };
        let meshes: Vec<_> = root.iter().filter_map(mesh).collect();
        let count: usize = meshes.iter().map(|(_, mesh)| mesh.triangle_count()).sum();
        if count == 0 || count > MAX_TRIANGLES {
            return Self::default();
        }
        let mut records = Vec::with_capacity(count);
        let mut first = vec![NO_RECORDS; geometries.len()];
        for (geometry, mesh) in meshes {
            first[geometry] = records.len() as u32;
            records.extend((0..mesh.triangle_count()).map(|triangle| TriangleRecord::new(mesh, triangle)));
        }
        Self { records, first }
    }

    /// That of a triangle of a geometry; none if there are no such things.
    #[inline(always)]
    pub fn get(&self, geometry: u32, triangle: u32) -> Option<&TriangleRecord> {
        let first = *self.first.get(geometry as usize)?;
        self.records.get(first.saturating_add(triangle) as usize)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.records.is_empty()
    }

    /// Bytes of its arrays.
    pub fn memory(&self) -> usize {
        size_of_val(self.records.as_slice()) + size_of_val(self.first.as_slice())
    }
}

/// The records of the triangles that the lanes of a packet hit.
#[derive(Clone, Copy, Debug, Default)]
pub struct RecordLanes([[Column; LANES]; BLOCKS]);

impl RecordLanes {
    /// Puts a record into each lane.
    #[inline(always)]
    pub fn set(&mut self, vectorizer: Vectorizer, records: [&TriangleRecord; LANES]) {
        vectorizer.transpose(records.map(|record| &record.0), &mut self.0);
    }

    #[inline(always)]
    fn number(&self, at: usize, lane: usize) -> u32 {
        self.0[at / LANES][at % LANES][lane]
    }

    #[inline(always)]
    fn vector(&self, at: usize, lane: usize) -> Vec3 {
        Vec3::new(
            f32::from_bits(self.number(at, lane)),
            f32::from_bits(self.number(at + 1, lane)),
            f32::from_bits(self.number(at + 2, lane)),
        )
    }

    #[inline(always)]
    pub fn vertices(&self, lane: usize) -> [Vec3; 3] {
        [
            self.vector(VERTICES, lane),
            self.vector(VERTICES + 3, lane),
            self.vector(VERTICES + 6, lane),
        ]
    }

    #[inline(always)]
    pub fn normals(&self, lane: usize) -> [Vec3; 3] {
        [
            self.vector(NORMALS, lane),
            self.vector(NORMALS + 3, lane),
            self.vector(NORMALS + 6, lane),
        ]
    }

    /// The unit normal of the plane, on the side where the surface faces.
    #[inline(always)]
    pub fn ng(&self, lane: usize) -> Vec3 {
        self.vector(NG, lane)
    }

    /// See [`TrianglePlane::error`].
    #[inline(always)]
    pub fn error(&self, lane: usize) -> f64 {
        let (low, high) = (self.number(ERROR, lane), self.number(ERROR + 1, lane));
        f64::from_bits(u64::from(high) << 32 | u64::from(low))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A fan of as many triangles, at as many times.
    fn fan(triangles: u32, steps: usize) -> Geometry {
        let at = |i: u32| Vec3::new(i as f32, (i * i) as f32, 1.0);
        let vertices = (0..triangles + 2).map(at).collect();
        let mesh = TriangleMesh::new(
            vec![vertices; steps],
            (0..triangles).map(|i| [0, i + 1, i + 2]).collect(),
        );
        Geometry::opaque(Shape::Mesh(mesh.unwrap()))
    }

    #[test]
    fn few_triangles_at_rest_in_world_space_have_records() {
        let geometries = [fan(2, 1), fan(3, 2), fan(4, 1), fan(5, 1)];
        let known = TriangleRecords::of(&geometries, &[GeometryId(3), GeometryId(1), GeometryId(0)]);
        for (geometry, count) in [(0, 2), (1, 0), (2, 0), (3, 5)] {
            for triangle in 0..count {
                let Shape::Mesh(mesh) = &geometries[geometry].shape else {
                    unreachable!()
                };
                let expected = TriangleRecord::new(mesh, triangle);
                assert_eq!(known.get(geometry as u32, triangle as u32).unwrap().0, expected.0);
            }
            assert!(count > 0 || known.get(geometry as u32, 0).is_none());
        }
        assert!(known.get(4, 0).is_none() && known.get(u32::MAX, u32::MAX).is_none());
        assert_eq!(known.memory(), 7 * 96 + 4 * 4);
    }

    #[test]
    fn many_triangles_have_none() {
        let records = |triangles| TriangleRecords::of(&[fan(triangles, 1)], &[GeometryId(0)]);
        assert_eq!(records(MAX_TRIANGLES as u32).memory(), MAX_TRIANGLES * 96 + 4);
        let none = records(MAX_TRIANGLES as u32 + 1);
        assert!(none.is_empty() && none.memory() == 0);
    }
}
