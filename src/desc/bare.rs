//! Meshes without a scene, on a stage: a camera that sees all of the mesh, a floor, a large lamp and a pale sky, or an image all
//! around.
//!
//! The stage is written as a scene in pbrt's format and read as such, with a sphere in the place of each mesh, which then takes its
//! place.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::Vec3;

use super::obj::mtl::{self, MtlMaterial};
use super::{MeshDesc, ParseOptions, SceneDesc, ShapeKind, obj, pbrt, ply};
use crate::error::{Diagnostic, Result};

/// Whether a file is a mesh, by its extension.
pub fn is_mesh(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    [".ply", ".ply.gz", ".obj", ".obj.gz"]
        .iter()
        .any(|end| name.ends_with(end))
}

/// Reads a mesh and puts it on a stage: upright along y, lit by `environment`, an image of all directions, if one is given.
///
/// # Errors
///
/// As [`super::load`].
pub fn load(path: &Path, environment: Option<&Path>, options: &ParseOptions) -> Result<SceneDesc> {
    let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    let subject = if name.contains(".obj") {
        read_obj(path)?
    } else {
        read_ply(path)?
    };
    let mut stage = Stage::default();
    stage.surroundings(&bounds(&subject.parts), environment);
    stage.subject(&subject);
    let mut scene = pbrt::parse_str(stage.text.as_bytes(), path, options)?;
    let first = scene.shapes.len() - subject.parts.len();
    for (shape, part) in scene.shapes[first..].iter_mut().zip(subject.parts) {
        shape.kind = ShapeKind::TriangleMesh(Arc::new(part.mesh));
    }
    scene.warnings.extend(subject.warnings);
    let mut hasher = blake3::Hasher::new();
    hasher.update(scene.hash.as_bytes());
    hasher.update(subject.hash.as_bytes());
    scene.hash = hasher.finalize().to_hex().to_string();
    Ok(scene)
}

/// What stands on the stage.
struct Subject {
    parts: Vec<Part>,
    warnings: Vec<Diagnostic>,
    hash: blake3::Hash,
}

struct Part {
    mesh: MeshDesc,
    material: Option<MtlMaterial>,
}

fn read_ply(path: &Path) -> Result<Subject> {
    let file = ply::load(path)?;
    Ok(Subject {
        parts: vec![Part {
            mesh: file.mesh,
            material: None,
        }],
        warnings: Vec::new(),
        hash: file.hash,
    })
}

fn read_obj(path: &Path) -> Result<Subject> {
    let mut file = obj::load(path)?;
    let mut warnings = std::mem::take(&mut file.warnings);
    let mut known: Vec<MtlMaterial> = Vec::new();
    for library in &file.libraries {
        let files = library_files(path, &library.name);
        if files.is_empty() {
            let message = format!("there is no file {}: its materials are a neutral grey", library.name);
            warnings.push(Diagnostic {
                message,
                ..library.place.clone()
            });
        }
        for file in files {
            let read = mtl::load(&file)?;
            known.extend(read.materials);
            warnings.extend(read.warnings);
        }
    }
    for name in &file.materials {
        if !known.iter().any(|material| material.name == name.name) && !file.libraries.is_empty() {
            warnings.push(Diagnostic {
                message: "no library has this material: it is a neutral grey".to_owned(),
                ..name.place.clone()
            });
        }
    }
    let names = file.materials.clone();
    let hash = file.hash;
    let part = |(material, mesh): (Option<usize>, MeshDesc)| {
        let name = material.map(|index| names[index].name.as_str());
        let material = known.iter().rev().find(|known| Some(known.name.as_str()) == name);
        Part {
            mesh,
            material: material.cloned(),
        }
    };
    Ok(Subject {
        parts: file.into_meshes().into_iter().map(part).collect(),
        warnings,
        hash,
    })
}

/// What `mtllib` names, beside the mesh: one file whose name may have spaces, or several files.
fn library_files(mesh: &Path, names: &str) -> Vec<PathBuf> {
    let directory = mesh.parent().unwrap_or(Path::new(""));
    let whole = directory.join(names);
    if whole.is_file() {
        return vec![whole];
    }
    let each = names.split_whitespace().map(|name| directory.join(name));
    each.filter(|file| file.is_file()).collect()
}

/// The least and the greatest corner of a box around all parts.
fn bounds(parts: &[Part]) -> [Vec3; 2] {
    let points = parts.iter().flat_map(|part| &part.mesh.positions);
    let none = [Vec3::INFINITY, Vec3::NEG_INFINITY];
    points.fold(none, |[min, max], p| [min.min(*p), max.max(*p)])
}

/// The text of a scene.
#[derive(Default)]
struct Stage {
    text: String,
}

impl Stage {
    /// A line of the text.
    fn line(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }

    /// The camera, the light and the floor.
    fn surroundings(&mut self, [min, max]: &[Vec3; 2], environment: Option<&Path>) {
        // Half of each, so that no difference overflows.
        let (center, half) = (*min * 0.5 + *max * 0.5, *max * 0.5 - *min * 0.5);
        let radius = half.length().max(1e-30);
        const HALF_ANGLE: f32 = 17.0;
        let distance = 1.02 * radius / HALF_ANGLE.to_radians().sin();
        let eye = center + Vec3::new(0.45, 0.35, 0.82).normalize() * distance;
        let Vec3 { x, y, z } = center;
        // pbrt's camera space is left-handed: without this, letters on the mesh would be back to front.
        self.line("Scale -1 1 1");
        self.line(&format!("LookAt {} {} {}  {x} {y} {z}  0 1 0", eye.x, eye.y, eye.z));
        self.line(&format!("Camera \"perspective\" \"float fov\" {}", 2.0 * HALF_ANGLE));
        self.line("Film \"rgb\" \"integer xresolution\" 1024 \"integer yresolution\" 1024");
        self.line("Sampler \"zsobol\" \"integer pixelsamples\" 128");
        self.line("Integrator \"path\" \"integer maxdepth\" 16");
        self.line("WorldBegin");
        if let Some(file) = environment {
            // The pole of an environment is +z, that of the stage +y.
            self.line("AttributeBegin Rotate -90 1 0 0");
            let file = std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
            self.line(&format!(
                "LightSource \"infinite\" \"string filename\" {}",
                quoted(&file.to_string_lossy())
            ));
            self.line("AttributeEnd");
            return;
        }
        self.line("LightSource \"infinite\" \"rgb L\" [0.45 0.48 0.52]");
        let floor = 40.0 * radius;
        self.line("AttributeBegin Material \"diffuse\" \"rgb reflectance\" [0.4 0.4 0.4]");
        self.line(&format!(
            "Translate {x} {} {z} Rotate -90 1 0 0 Shape \"disk\" \"float radius\" {floor}",
            min.y
        ));
        self.line("AttributeEnd");
        // A lamp to the left above, as large as the mesh.
        let lamp = center + Vec3::new(-0.9, 1.9, 1.2) * radius;
        self.line("AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [9 8.6 8]");
        self.line("Material \"diffuse\" \"rgb reflectance\" [0 0 0]");
        self.line(&format!("Translate {} {} {}", lamp.x, lamp.y, lamp.z));
        // Its normal is +z: towards the mesh.
        let towards = center - lamp;
        let turn = Vec3::Z.cross(towards.normalize());
        let angle = Vec3::Z.angle_between(towards).to_degrees();
        self.line(&format!("Rotate {angle} {} {} {}", turn.x, turn.y, turn.z));
        self.line(&format!("Shape \"disk\" \"float radius\" {}", 0.6 * radius));
        self.line("AttributeEnd");
    }

    /// A sphere for each part, with its material.
    fn subject(&mut self, subject: &Subject) {
        for (index, part) in subject.parts.iter().enumerate() {
            self.line("AttributeBegin");
            match &part.material {
                None => self.line("Material \"diffuse\" \"rgb reflectance\" [0.6 0.6 0.6]"),
                Some(material) => self.material(index, material),
            }
            let alpha = part.material.as_ref().map_or(1.0, opacity);
            self.line(&format!("Shape \"sphere\" \"float alpha\" {alpha}"));
            self.line("AttributeEnd");
        }
    }

    fn material(&mut self, index: usize, material: &MtlMaterial) {
        let MtlMaterial {
            diffuse: [dr, dg, db],
            specular: [sr, sg, sb],
            emission: [er, eg, eb],
            ..
        } = *material;
        if er + eg + eb > 0.0 {
            self.line(&format!("AreaLightSource \"diffuse\" \"rgb L\" [{er} {eg} {eb}]"));
        }
        let mut reflectance = format!("\"rgb reflectance\" [{dr} {dg} {db}]");
        if let Some(file) = &material.diffuse_map {
            let file = std::path::absolute(file).unwrap_or_else(|_| file.clone());
            // Many libraries leave black what an image covers.
            let factor = match (dr + dg + db) / 3.0 {
                0.0 => 1.0,
                mean => mean,
            };
            let name = format!("map {index}");
            let file = quoted(&file.to_string_lossy());
            self.line(&format!(
                "Texture \"{name}\" \"spectrum\" \"imagemap\" \"string filename\" {file} \"float scale\" {factor}"
            ));
            reflectance = format!("\"texture reflectance\" \"{name}\"");
        }
        // The width of Phong's lobe as a roughness (Walter et al. 2007).
        let roughness = (2.0 / (material.exponent + 2.0)).sqrt();
        let mut line = String::new();
        let has_diffuse = dr + dg + db > 0.0 || material.diffuse_map.is_some();
        let written = match material.model {
            4 | 6 | 7 | 9 => write!(line, "Material \"dielectric\" \"float eta\" {}", material.index),
            3 | 5 | 8 => write!(line, "Material \"conductor\" \"rgb reflectance\" [{sr} {sg} {sb}]"),
            2 if sr + sg + sb > 0.0 && !has_diffuse => write!(
                line,
                "Material \"conductor\" \"rgb reflectance\" [{sr} {sg} {sb}] \"float roughness\" {roughness} \
                 \"bool remaproughness\" false"
            ),
            2 if sr + sg + sb > 0.0 => write!(
                line,
                "Material \"coateddiffuse\" {reflectance} \"float roughness\" {roughness} \"bool remaproughness\" false"
            ),
            _ => write!(line, "Material \"diffuse\" {reflectance}"),
        };
        // Writing to a string does not fail.
        if written.is_ok() {
            self.line(&line);
        }
    }
}

/// What of the rays stops at the surface: glass is there wholly, whatever its opacity.
fn opacity(material: &MtlMaterial) -> f32 {
    match material.model {
        4 | 6 | 7 | 9 => 1.0,
        _ => material.opacity,
    }
}

/// A string of a scene file.
fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}
