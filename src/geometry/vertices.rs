//! What meshes have in common, whatever their faces are: faces name vertices, and vertices have more than a place.

use crate::math::{Vec2, Vec3};

/// Why arrays do not make a mesh.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MeshError {
    /// No time step, or none with the same number of vertices as the first.
    #[error("every time step must have as many vertices as the first, and there must be one")]
    TimeSteps,
    /// An index beyond the vertices.
    #[error("face {face} names vertex {vertex}, but there are only {vertices}")]
    IndexOutOfRange {
        /// The triangle or patch.
        face: usize,
        /// The vertex it names.
        vertex: u32,
        /// How many there are.
        vertices: usize,
    },
    /// A vertex is NaN or infinite.
    #[error("vertex {0} is not finite")]
    NotFinite(usize),
    /// Normals or texture coordinates do not match the vertices.
    #[error("there are {count} {what} for {vertices} vertices")]
    AttributeCount {
        /// `normals` or `texture coordinates`.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// How many there should be.
        vertices: usize,
    },
}

/// What vertices have beside a place.
#[derive(Clone, Debug, Default)]
pub(super) struct Attributes {
    pub normals: Option<Vec<Vec3>>,
    pub uvs: Option<Vec<Vec2>>,
}

impl Attributes {
    /// Takes shading normals, one for each of so many vertices, or none at all.
    pub fn set_normals(&mut self, normals: Vec<Vec3>, vertices: usize) -> Result<(), MeshError> {
        check_count("normals", normals.len(), vertices)?;
        self.normals = Some(normals).filter(|normals| !normals.is_empty());
        Ok(())
    }

    /// Takes texture coordinates, one for each of so many vertices, or none at all.
    pub fn set_uvs(&mut self, uvs: Vec<Vec2>, vertices: usize) -> Result<(), MeshError> {
        check_count("texture coordinates", uvs.len(), vertices)?;
        self.uvs = Some(uvs).filter(|uvs| !uvs.is_empty());
        Ok(())
    }

    /// Bytes of its arrays.
    pub fn memory(&self) -> usize {
        self.normals.as_ref().map_or(0, |n| size_of_val(n.as_slice()))
            + self.uvs.as_ref().map_or(0, |u| size_of_val(u.as_slice()))
    }
}

fn check_count(what: &'static str, count: usize, vertices: usize) -> Result<(), MeshError> {
    if count == 0 || count == vertices {
        Ok(())
    } else {
        Err(MeshError::AttributeCount { what, count, vertices })
    }
}

/// Refuses positions that are not finite.
pub(super) fn check_positions(positions: &[Vec3]) -> Result<(), MeshError> {
    let bad = positions.iter().position(|p| !p.is_finite());
    bad.map_or(Ok(()), |bad| Err(MeshError::NotFinite(bad)))
}

/// Refuses faces that name other than the first `vertices` vertices.
pub(super) fn check_faces<const CORNERS: usize>(faces: &[[u32; CORNERS]], vertices: usize) -> Result<(), MeshError> {
    for (face, corners) in faces.iter().enumerate() {
        if let Some(&vertex) = corners.iter().find(|&&v| v as usize >= vertices) {
            return Err(MeshError::IndexOutOfRange { face, vertex, vertices });
        }
    }
    Ok(())
}
