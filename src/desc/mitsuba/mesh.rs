//! Mesh files: all that a scene names are read in parallel, before its shapes are translated.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

use glam::{Vec2, Vec3};
use rayon::prelude::*;

use super::graph::{Graph, Object};
use super::plugins::Class;
use super::props::Props;
use super::xml::XmlReader;
use crate::desc::ply::PlyFile;
use crate::desc::report::mesh_problem;
use crate::desc::{MeshDesc, obj, ply, serialized};
use crate::error::Error;

/// The meshes of a scene.
#[derive(Debug)]
pub(super) struct Meshes {
    read: HashMap<MeshFile, Result<ReadMesh, String>>,
}

/// A mesh file and how it is to be taken.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct MeshFile {
    pub path: PathBuf,
    format: Format,
    /// Which of the meshes of the file.
    shape_index: u32,
    /// Whether it has no shading normals.
    face_normals: bool,
    /// Whether v becomes 1 - v.
    invert_v: bool,
    /// Whether its attributes are wanted.
    with_attributes: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Format {
    Obj,
    Ply,
    Serialized,
}

/// A mesh as it is taken.
#[derive(Clone, Debug)]
pub(super) struct ReadMesh {
    pub mesh: Arc<MeshDesc>,
    /// Whether its normals are those of the file, not made from its faces.
    pub own_normals: bool,
    hash: blake3::Hash,
}

impl Meshes {
    /// Reads all mesh files that objects of a graph name.
    pub fn new(graph: &Graph, xml: &mut XmlReader) -> Self {
        let mut files = Vec::new();
        let mut read = HashMap::new();
        for object in graph.objects.iter().filter(|object| object.class == Class::Shape) {
            // What is wrong with the properties is said when the shape is translated.
            if let Some(file) = MeshFile::of(&mut Props::new(object), graph, xml)
                && read.insert(file.clone(), Err(String::new())).is_none()
            {
                files.push(file);
            }
        }
        let meshes: Vec<_> = files.par_iter().map(MeshFile::read).collect();
        for (file, mesh) in files.into_iter().zip(meshes) {
            if let Ok(mesh) = &mesh {
                xml.hasher.update(mesh.hash.as_bytes());
            }
            read.insert(file, mesh);
        }
        Self { read }
    }

    /// A mesh that has been read; or what is wrong with its file.
    pub fn get(&self, file: &MeshFile) -> Result<ReadMesh, String> {
        self.read.get(file).cloned().unwrap_or_else(|| Err(String::new()))
    }
}

impl MeshFile {
    /// The file that a shape is in; `None` if it is in none. Takes the properties that say so.
    pub fn of(props: &mut Props<'_>, graph: &Graph, xml: &XmlReader) -> Option<Self> {
        let object: &Object = props.object;
        let (format, flips) = match object.plugin.as_str() {
            "obj" => (Format::Obj, true),
            "ply" => (Format::Ply, false),
            "serialized" => (Format::Serialized, false),
            _ => return None,
        };
        let shape_index = if format == Format::Serialized {
            props.count("shape_index", 0, 0)
        } else {
            0
        };
        let face_normals = props.boolean("face_normals", false);
        let flips = props.boolean("flip_tex_coords", flips);
        let Some(name) = props.string("filename") else {
            if !props.has("filename") {
                let message = format!("this `{}` has no `<string name=\"filename\" .../>`", object.plugin);
                props.error(object.span, message);
            }
            return None;
        };
        Some(Self {
            path: xml.resolve(name),
            format,
            shape_index,
            face_normals,
            // Mitsuba's v is this program's the other way round.
            invert_v: !flips,
            with_attributes: format == Format::Ply && graph.has_attributes(),
        })
    }

    fn read(&self) -> Result<ReadMesh, String> {
        let of_ply = |file: PlyFile| (file.mesh, file.hash, false);
        let outcome = match self.format {
            Format::Obj => obj::load(&self.path).map(|file| (file.mesh, file.hash, false)),
            Format::Ply if self.with_attributes => ply::load_with_attributes(&self.path).map(of_ply),
            Format::Ply => ply::load(&self.path).map(of_ply),
            Format::Serialized => serialized::load(&self.path, self.shape_index)
                .map(|file| (file.mesh, file.hash, file.face_normals))
                .map_err(Error::Usage),
        };
        let (mut mesh, hash, flat) = outcome.map_err(|error| mesh_problem(&self.path, &error))?;
        if self.invert_v {
            mesh.uvs.iter_mut().for_each(|uv| *uv = Vec2::new(uv.x, 1.0 - uv.y));
        }
        let own_normals = !mesh.normals.is_empty();
        if self.face_normals || flat {
            mesh.normals = Vec::new();
        } else if !own_normals {
            mesh.normals = smooth_normals(&mesh);
        }
        Ok(ReadMesh {
            mesh: Arc::new(mesh),
            own_normals,
            hash,
        })
    }
}

/// The normals of the faces around each vertex, by their angles there (Thürmer and Wüthrich 1998); 0 where there are none.
fn smooth_normals(mesh: &MeshDesc) -> Vec<Vec3> {
    let mut sums = vec![Vec3::ZERO; mesh.positions.len()];
    for triangle in &mesh.indices {
        let p = triangle.map(|v| mesh.positions[v as usize]);
        let Some(normal) = (p[1] - p[0]).cross(p[2] - p[0]).try_normalize() else {
            continue;
        };
        for i in 0..3 {
            let [a, b] = [1, 2].map(|step| (p[(i + step) % 3] - p[i]).normalize_or_zero());
            sums[triangle[i] as usize] += normal * a.angle_between(b);
        }
    }
    sums.into_iter().map(Vec3::normalize_or_zero).collect()
}
