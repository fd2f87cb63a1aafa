//! Meshes in Wavefront's OBJ format, as text or compressed with gzip.
//!
//! Read are vertices (`v`), texture coordinates (`vt`) and normals (`vn`), faces (`f`, whose indices may count backwards), and
//! which material the faces have (`mtllib`, `usemtl`). Polygons become fans of triangles around their first vertex. Corners that
//! have vertex, texture coordinate and normal in common are one vertex of the mesh.
//!
//! Groups, objects, smoothing groups, lines, points and colours of vertices are passed over; free-form curves and surfaces are
//! errors. Texture coordinates are as pbrt's, (0, 0) being the lower left corner of an image.

pub mod mtl;
mod reader;
mod words;

use std::ops::Range;
use std::path::Path;

use super::{MeshDesc, bytes};
use crate::error::{Diagnostic, Error, Result};

/// A mesh file.
#[derive(Debug)]
pub struct ObjFile {
    /// All faces, in file order. It has normals if any face has, those of corners without being zero, which asks for the
    /// geometric normal; likewise texture coordinates, zero for corners without.
    pub mesh: MeshDesc,
    /// Runs of triangles of one material; they cover all triangles, in order.
    pub parts: Vec<ObjPart>,
    /// The materials that faces name, each once, in the order of their first use.
    pub materials: Vec<ObjName>,
    /// What `mtllib` says, each line once: a file's name, or several with spaces between.
    pub libraries: Vec<ObjName>,
    /// What is passed over and may have mattered, in file order.
    pub warnings: Vec<Diagnostic>,
    /// BLAKE3 of its content, decompressed.
    pub hash: blake3::Hash,
}

/// Triangles that have their material in common.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ObjPart {
    /// Index into [`ObjFile::materials`]; `None` before any `usemtl`.
    pub material: Option<usize>,
    /// Of [`MeshDesc::indices`].
    pub triangles: Range<usize>,
}

/// A name, and the place where it is first used.
#[derive(Clone, Debug)]
pub struct ObjName {
    /// As in the file.
    pub name: String,
    /// A warning at its place, with an empty message: for whoever finds that the name means nothing.
    pub place: Diagnostic,
}

/// The longest file that is read, decompressed.
const LONGEST: u64 = 1 << 36;

/// Reads a file.
///
/// # Errors
///
/// [`Error::Scene`] with every problem found (at most some 50), [`Error::Io`] if it cannot be read.
pub fn load(path: &Path) -> Result<ObjFile> {
    let content = bytes::read(path, LONGEST).map_err(|e| Error::io("read", path, e))?;
    parse(&content, path)
}

/// Reads a mesh from the content of a file, not compressed; problems are reported under the name `path`.
///
/// # Errors
///
/// [`Error::Scene`] with every problem found (at most some 50).
pub fn parse(content: &[u8], path: &Path) -> Result<ObjFile> {
    reader::read(content, path)
}

impl ObjFile {
    /// A mesh of its own for each material, and for the faces without; each with the vertices that it uses.
    pub fn into_meshes(self) -> Vec<(Option<usize>, MeshDesc)> {
        let mut order: Vec<Option<usize>> = Vec::new();
        for part in &self.parts {
            if !order.contains(&part.material) {
                order.push(part.material);
            }
        }
        if let [only] = order[..] {
            return vec![(only, self.mesh)];
        }
        let mut place_of = vec![u32::MAX; self.mesh.positions.len()];
        let of_material = |material: Option<usize>| {
            let parts = self.parts.iter().filter(|part| part.material == material);
            let mesh = submesh(&self.mesh, parts.map(|part| part.triangles.clone()), &mut place_of);
            (material, mesh)
        };
        order.into_iter().map(of_material).collect()
    }
}

/// Some triangles of a mesh, with the vertices that they use. `place_of` has a number for each vertex of the mesh, all of them
/// `u32::MAX` before and after.
fn submesh(mesh: &MeshDesc, parts: impl Iterator<Item = Range<usize>>, place_of: &mut [u32]) -> MeshDesc {
    let mut used = Vec::new();
    let mut indices = Vec::new();
    for triangle in parts.flat_map(|triangles| &mesh.indices[triangles]) {
        indices.push(triangle.map(|vertex| {
            let place = &mut place_of[vertex as usize];
            if *place == u32::MAX {
                *place = used.len() as u32;
                used.push(vertex as usize);
            }
            *place
        }));
    }
    for &vertex in &used {
        place_of[vertex] = u32::MAX;
    }
    fn pick<T: Copy>(values: &[T], used: &[usize]) -> Vec<T> {
        if values.is_empty() {
            return Vec::new();
        }
        used.iter().map(|&vertex| values[vertex]).collect()
    }
    MeshDesc {
        positions: pick(&mesh.positions, &used),
        normals: pick(&mesh.normals, &used),
        uvs: pick(&mesh.uvs, &used),
        indices,
        ..MeshDesc::default()
    }
}
