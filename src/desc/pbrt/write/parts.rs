//! The files beside a scene's: meshes and images that it needs.

use std::collections::HashMap;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{Vec2, Vec3};

use crate::desc::{AttributeDomain, ImageDesc, LensSurface, MeshAttributeDesc, MeshDesc, RealisticDesc};
use crate::error::{Error, Result};
use crate::image_io::{Image, PendingOutput};

/// A folder beside a scene's file, and what has been written into it. Files are named as the scene is to name them.
pub(super) struct Parts {
    /// Where the scene's file is.
    base: PathBuf,
    folder: String,
    /// By the place in memory of what they hold, which lives as long as the description.
    written: HashMap<usize, String>,
}

impl Parts {
    /// Nothing yet, for the scene in the file `scene`.
    pub fn beside(scene: &Path) -> Self {
        let stem = scene.file_stem().unwrap_or_default().to_string_lossy();
        Self {
            base: scene.parent().unwrap_or(Path::new("")).to_owned(),
            folder: format!("{stem}-parts"),
            written: HashMap::new(),
        }
    }

    /// A file that exists.
    pub fn file(&self, path: &Path) -> Result<String> {
        let absolute = |path: &Path| {
            let path = if path.as_os_str().is_empty() {
                Path::new(".")
            } else {
                path
            };
            fs::canonicalize(path).map_err(|e| Error::io("find", path, e))
        };
        let (file, base) = (absolute(path)?, absolute(&self.base)?);
        // Beside or below, so that the whole can be moved; else from the root.
        let named = file.strip_prefix(&base).unwrap_or(&file);
        Ok(named.to_string_lossy().into_owned())
    }

    /// An image that has been read from a file.
    pub fn image_file(&self, image: &ImageDesc) -> Result<String> {
        self.file(&image.path)
    }

    /// An image of linear values, as an EXR file.
    pub fn image(&mut self, image: &Arc<Image>) -> Result<String> {
        self.once(Arc::as_ptr(image) as usize, "image", "exr", |path| {
            let output = PendingOutput::create(path)?;
            output.commit(image, None, 0.0).map(|_| ())
        })
    }

    /// A mesh without tangents and motion, as a binary PLY file.
    pub fn mesh(&mut self, mesh: &Arc<MeshDesc>) -> Result<String> {
        self.once(Arc::as_ptr(mesh) as usize, "mesh", "ply", |path| {
            let write = || -> std::io::Result<()> {
                let mut file = BufWriter::new(File::create(path)?);
                write_ply(&mut file, mesh)?;
                file.flush()
            };
            write().map_err(|e| Error::io("write", path, e))
        })
    }

    /// The responses of a sensor: wavelength, red, green, blue.
    pub fn responses(&mut self, rows: &[[f32; 4]]) -> Result<String> {
        self.once(rows.as_ptr() as usize, "sensor", "txt", |path| {
            let lines: Vec<_> = rows.iter().map(|[l, r, g, b]| format!("{l} {r} {g} {b}\n")).collect();
            fs::write(path, lines.concat()).map_err(|e| Error::io("write", path, e))
        })
    }

    /// The table of a camera's lenses.
    pub fn lenses(&mut self, lenses: &Arc<RealisticDesc>) -> Result<String> {
        self.once(Arc::as_ptr(lenses) as usize, "lenses", "txt", |path| {
            let line = |s: &LensSurface| format!("{} {} {} {}\n", s.radius, s.thickness, s.eta, s.diameter);
            let lines: String = lenses.surfaces.iter().map(line).collect();
            fs::write(path, lines).map_err(|e| Error::io("write", path, e))
        })
    }

    /// Writes a file unless what is at `place` has one.
    fn once(
        &mut self,
        place: usize,
        what: &str,
        extension: &str,
        write: impl FnOnce(&Path) -> Result<()>,
    ) -> Result<String> {
        if let Some(name) = self.written.get(&place) {
            return Ok(name.clone());
        }
        let name = format!("{}/{what}-{}.{extension}", self.folder, self.written.len() + 1);
        let folder = self.base.join(&self.folder);
        fs::create_dir_all(&folder).map_err(|e| Error::io("make", &folder, e))?;
        write(&self.base.join(&name))?;
        self.written.insert(place, name.clone());
        Ok(name)
    }
}

fn write_ply(file: &mut impl Write, mesh: &MeshDesc) -> std::io::Result<()> {
    let has_normals = !mesh.normals.is_empty();
    let has_uvs = !mesh.uvs.is_empty();
    let properties =
        |names: &[&str]| -> String { names.iter().map(|name| format!("property float {name}\n")).collect() };
    write!(
        file,
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\n{}{}{}{}element face {}\n\
         property list uchar uint vertex_indices\n{}end_header\n",
        mesh.positions.len(),
        properties(&["x", "y", "z"]),
        if has_normals {
            properties(&["nx", "ny", "nz"])
        } else {
            String::new()
        },
        if has_uvs {
            properties(&["u", "v"])
        } else {
            String::new()
        },
        attribute_properties(mesh, AttributeDomain::Vertices),
        mesh.indices.len(),
        attribute_properties(mesh, AttributeDomain::Triangles),
    )?;
    for (i, position) in mesh.positions.iter().enumerate() {
        let normal = mesh.normals.get(i).map(Vec3::to_array);
        let uv = mesh.uvs.get(i).map(Vec2::to_array);
        let numbers = position.to_array().into_iter();
        for number in numbers
            .chain(normal.into_iter().flatten())
            .chain(uv.into_iter().flatten())
            .chain(attribute_row(mesh, AttributeDomain::Vertices, i))
        {
            file.write_all(&number.to_le_bytes())?;
        }
    }
    for (i, triangle) in mesh.indices.iter().enumerate() {
        file.write_all(&[3])?;
        for index in triangle {
            file.write_all(&index.to_le_bytes())?;
        }
        for number in attribute_row(mesh, AttributeDomain::Triangles, i) {
            file.write_all(&number.to_le_bytes())?;
        }
    }
    Ok(())
}

fn attributes_of(mesh: &MeshDesc, domain: AttributeDomain) -> impl Iterator<Item = &MeshAttributeDesc> {
    mesh.attributes
        .iter()
        .filter(move |attribute| attribute.domain == domain)
}

/// `name_0`, `name_1`, ...: of these the reader makes one attribute, whatever the name.
fn attribute_properties(mesh: &MeshDesc, domain: AttributeDomain) -> String {
    let mut lines = String::new();
    for attribute in attributes_of(mesh, domain) {
        let name = attribute.name.strip_prefix(domain.prefix()).unwrap_or(&attribute.name);
        lines.extend((0..attribute.channels).map(|i| format!("property float {name}_{i}\n")));
    }
    lines
}

/// The numbers of a vertex or a triangle.
fn attribute_row(mesh: &MeshDesc, domain: AttributeDomain, i: usize) -> impl Iterator<Item = f32> {
    attributes_of(mesh, domain)
        .flat_map(move |attribute| &attribute.values[i * attribute.channels..(i + 1) * attribute.channels])
        .copied()
}
