//! Meshes in the PLY format (Turk 1994): text or binary of either byte order, all of them possibly compressed with gzip.
//!
//! Read are the vertices' `x y z`, `nx ny nz` and texture coordinates (`u v`, `s t`, `texture_u texture_v`, `texture_s
//! texture_t`), and the faces' `vertex_indices` or `vertex_index`; further numbers if they are asked for (see
//! [`load_with_attributes`]); everything else is skipped. Polygons become fans of triangles
//! around their first vertex. For a planar quadrilateral that is pbrt-v4's surface too; of others pbrt makes bilinear patches.
//!
//! Counts in a file are checked against its length before anything is allocated by them.

mod attributes;
mod cursor;
mod header;
#[cfg(unix)]
mod large;
mod rows;

use std::ops::Range;
use std::path::Path;

use glam::{Vec2, Vec3};
use rayon::prelude::*;

use super::{AttributeDomain, MeshAttributeDesc, MeshDesc, bytes};
use crate::error::{Diagnostic, Error, Result, Severity};
use attributes::AttributeColumns;
use cursor::Cursor;
use header::{Element, Encoding, Scalar};

/// A mesh file.
#[derive(Debug)]
pub struct PlyFile {
    /// What it describes.
    pub mesh: MeshDesc,
    /// BLAKE3 of its content, decompressed.
    pub hash: blake3::Hash,
}

/// The longest file that is read, decompressed.
const LONGEST: u64 = 1 << 36;

/// What is wrong, and with which bytes of the file.
type Problem = (Range<usize>, String);

/// Reads a file.
///
/// # Errors
///
/// [`Error::Scene`] with the first problem, [`Error::Io`] if it cannot be read.
pub fn load(path: &Path) -> Result<PlyFile> {
    read(path, false)
}

/// Reads a file with what else its vertices and faces have, under the names that Mitsuba 3 gives them: of `r g b` or `red green blue`
/// it makes `vertex_color` or `face_color`, of `name_x name_y name_z` (or other endings) `vertex_name`. Colours of 8 or 16 bits are
/// divided by the largest number (in Mitsuba they are not, which warns of that). Alpha and attributes of other than one or three
/// numbers are left out.
///
/// # Errors
///
/// [`Error::Scene`] with the first problem, [`Error::Io`] if it cannot be read.
pub fn load_with_attributes(path: &Path) -> Result<PlyFile> {
    read(path, true)
}

/// Files of so many bytes or more are not read as a whole, if they can be read otherwise.
#[cfg(unix)]
const LARGE: u64 = 1 << 24;

fn read(path: &Path, with_attributes: bool) -> Result<PlyFile> {
    #[cfg(unix)]
    if !with_attributes && let Some(file) = large::load(path, LARGE) {
        return Ok(file);
    }
    let content = bytes::read(path, LONGEST).map_err(|e| Error::io("read", path, e))?;
    Ok(PlyFile {
        mesh: located(parse_mesh(&content, with_attributes), &content, path)?,
        hash: blake3::hash(&content),
    })
}

/// Reads a mesh from the content of a file, not compressed; problems are reported under the name `path`.
///
/// # Errors
///
/// [`Error::Scene`] with the first problem.
pub fn parse(content: &[u8], path: &Path) -> Result<MeshDesc> {
    located(parse_mesh(content, false), content, path)
}

/// [`load_with_attributes`] from the content of a file, not compressed; problems are reported under the name `path`.
///
/// # Errors
///
/// [`Error::Scene`] with the first problem.
pub fn parse_with_attributes(content: &[u8], path: &Path) -> Result<MeshDesc> {
    located(parse_mesh(content, true), content, path)
}

fn located(mesh: Result<MeshDesc, Problem>, content: &[u8], path: &Path) -> Result<MeshDesc> {
    mesh.map_err(|(place, message)| {
        let diagnostic = Diagnostic::new(Severity::Error, path, content, place, message);
        Error::Scene(vec![diagnostic])
    })
}

fn parse_mesh(content: &[u8], with_attributes: bool) -> Result<MeshDesc, Problem> {
    let header = header::parse(content)?;
    let mut cursor = Cursor::new(content, &header);
    let mut mesh = MeshDesc::default();
    for element in &header.elements {
        cursor.begin(element);
        let least = element.least_row(header.encoding);
        // The last number of a text needs no space after it.
        if element.count.saturating_mul(least) > cursor.left() as u64 + 1 {
            return Err(element.problem(&format!(
                "the file is too short for {} rows of `{}`",
                element.count, element.name
            )));
        }
        let attributes = if with_attributes {
            attributes::of(element)
        } else {
            Vec::new()
        };
        match element.name.as_str() {
            "vertex" if mesh.positions.is_empty() => {
                read_vertices(&mut cursor, element, header.encoding, attributes, &mut mesh)?;
            }
            "face" if mesh.indices.is_empty() => {
                read_faces(&mut cursor, element, header.encoding, &attributes, &mut mesh)?;
            }
            _ => skip(&mut cursor, element, header.encoding)?,
        }
    }
    check(&mesh).map_err(|(element, message)| (header.place_of(element), message))?;
    Ok(mesh)
}

/// What must hold of a mesh that has been read; else what is wrong, and with which element.
fn check(mesh: &MeshDesc) -> Result<(), (&'static str, String)> {
    let count = mesh.positions.len();
    if count == 0 || mesh.indices.is_empty() {
        let element = if count == 0 { "vertex" } else { "face" };
        return Err((element, "there are no vertices or no faces".to_owned()));
    }
    let faces = || mesh.indices.par_iter().with_min_len(1 << 14);
    let last = faces().map(|&[a, b, c]| a.max(b).max(c)).reduce(|| 0, u32::max);
    if last as usize >= count {
        let is_beyond = |&&i: &&u32| i as usize >= count;
        let bad = faces()
            .filter_map(|face| face.iter().find(is_beyond))
            .find_first(|_| true);
        let bad = bad.unwrap_or(&last);
        let message = format!("a face has the vertex {bad}, but there are {count}, counted from 0");
        return Err(("face", message));
    }
    let finite = |values: &[Vec3]| {
        values
            .par_iter()
            .with_min_len(1 << 14)
            .position_first(|v| !v.is_finite())
    };
    let uv = mesh.uvs.iter().position(|v| !v.is_finite());
    let is_finite = |attribute: &&MeshAttributeDesc| attribute.values.iter().all(|v| v.is_finite());
    if let Some(bad) = mesh.attributes.iter().find(|attribute| !is_finite(attribute)) {
        let element = match bad.domain {
            AttributeDomain::Vertices => "vertex",
            AttributeDomain::Triangles => "face",
        };
        let message = format!("a value of `{}` is not finite in 32-bit floating point", bad.name);
        return Err((element, message));
    }
    for (bad, what) in [
        (finite(&mesh.positions), "position"),
        (finite(&mesh.normals), "normal"),
        (uv, "texture coordinate"),
    ] {
        if let Some(index) = bad {
            let message = format!("the {what} of vertex {index} is not finite in 32-bit floating point");
            return Err(("vertex", message));
        }
    }
    Ok(())
}

/// Where the properties that matter are in a row.
struct Columns {
    position: [usize; 3],
    normal: Option<[usize; 3]>,
    uv: Option<[usize; 2]>,
    attributes: Vec<AttributeColumns>,
}

impl Columns {
    fn of(element: &Element, attributes: Vec<AttributeColumns>) -> Result<Self, Problem> {
        let find = |name: &str| {
            let mut properties = element.properties.iter();
            properties.position(|p| p.name == name && p.length.is_none())
        };
        let find3 = |x, y, z| Some([find(x)?, find(y)?, find(z)?]);
        let uv_names = [
            ("u", "v"),
            ("s", "t"),
            ("texture_u", "texture_v"),
            ("texture_s", "texture_t"),
        ];
        Ok(Self {
            position: find3("x", "y", "z")
                .ok_or_else(|| element.problem("the vertices have no properties `x`, `y` and `z`"))?,
            normal: find3("nx", "ny", "nz"),
            uv: uv_names.iter().find_map(|(u, v)| Some([find(u)?, find(v)?])),
            attributes,
        })
    }
}

fn read_vertices(
    cursor: &mut Cursor,
    element: &Element,
    encoding: Encoding,
    attributes: Vec<AttributeColumns>,
    mesh: &mut MeshDesc,
) -> Result<(), Problem> {
    let first = mesh.attributes.len();
    let named = attributes
        .iter()
        .map(|columns| columns.named("vertex", AttributeDomain::Vertices));
    mesh.attributes.extend(named);
    let columns = Columns::of(element, attributes)?;
    if u32::try_from(element.count).is_err() {
        return Err(element.problem("there are more vertices than 32 bits can count"));
    }
    let count = element.count as usize;
    match element.fixed_row().filter(|_| encoding != Encoding::Ascii) {
        Some(row) => {
            let content = cursor.bytes(count.saturating_mul(row))?;
            rows::vertices(content, row, element, &columns, encoding, mesh, first);
        }
        None => {
            mesh.positions.reserve_exact(count);
            let mut row = vec![0.0; element.properties.len()];
            for _ in 0..count {
                for (property, value) in element.properties.iter().zip(&mut row) {
                    match property.length {
                        None => *value = cursor.number(property.value)? as f32,
                        Some(length) => skip_list(cursor, length, property.value)?,
                    }
                }
                push_vertex(mesh, &columns, |i| row[i]);
                attributes::push(&mut mesh.attributes[first..], &columns.attributes, |i| row[i]);
            }
        }
    }
    Ok(())
}

#[inline]
fn push_vertex(mesh: &mut MeshDesc, columns: &Columns, at: impl Fn(usize) -> f32) {
    mesh.positions.push(Vec3::from_array(columns.position.map(&at)));
    if let Some(normal) = columns.normal {
        mesh.normals.push(Vec3::from_array(normal.map(&at)));
    }
    if let Some(uv) = columns.uv {
        mesh.uvs.push(Vec2::from_array(uv.map(&at)));
    }
}

/// The faces as triangles, each with the values of its face. Faces with fewer than three vertices are left out, as pbrt leaves them.
fn read_faces(
    cursor: &mut Cursor,
    element: &Element,
    encoding: Encoding,
    attributes: &[AttributeColumns],
    mesh: &mut MeshDesc,
) -> Result<(), Problem> {
    let is_corners = |name: &str| name == "vertex_indices" || name == "vertex_index";
    let mut properties = element.properties.iter();
    let corners = properties
        .position(|p| is_corners(&p.name) && p.length.is_some() && p.value.is_integer())
        .ok_or_else(|| element.problem("the faces have no list of integers `vertex_indices`"))?;
    if let Some(row) = rows::triangle_row(element).filter(|_| encoding != Encoding::Ascii)
        && let Some(content) = cursor.peek((element.count as usize).saturating_mul(row))
        && let Some(triangles) = rows::triangles(content, row, encoding)
    {
        cursor.bytes(content.len())?;
        mesh.indices = triangles;
        return Ok(());
    }
    let first = mesh.attributes.len();
    let named = attributes
        .iter()
        .map(|columns| columns.named("face", AttributeDomain::Triangles));
    mesh.attributes.extend(named);
    mesh.indices.reserve_exact(element.count as usize);
    let mut row = vec![0.0; element.properties.len()];
    for _ in 0..element.count {
        let before = mesh.indices.len();
        for (i, property) in element.properties.iter().enumerate() {
            match property.length {
                Some(length) if i == corners => {
                    let count = cursor.index(length)?;
                    read_fan(cursor, count, property.value, &mut mesh.indices)?;
                }
                Some(length) => skip_list(cursor, length, property.value)?,
                None if attributes.is_empty() => cursor.skip(1, property.value)?,
                None => row[i] = cursor.number(property.value)? as f32,
            }
        }
        for _ in before..mesh.indices.len() {
            attributes::push(&mut mesh.attributes[first..], attributes, |i| row[i]);
        }
    }
    Ok(())
}

fn read_fan(cursor: &mut Cursor, count: usize, kind: Scalar, triangles: &mut Vec<[u32; 3]>) -> Result<(), Problem> {
    let (mut first, mut previous) = (0, 0);
    for i in 0..count {
        let corner = cursor.index(kind)? as u32;
        match i {
            0 => first = corner,
            1 => {}
            _ => triangles.push([first, previous, corner]),
        }
        previous = corner;
    }
    Ok(())
}

fn skip_list(cursor: &mut Cursor, length: Scalar, value: Scalar) -> Result<(), Problem> {
    let count = cursor.index(length)?;
    cursor.skip(count, value)
}

/// Skips an element that does not matter.
fn skip(cursor: &mut Cursor, element: &Element, encoding: Encoding) -> Result<(), Problem> {
    if element.properties.is_empty() {
        return Ok(());
    }
    let count = usize::try_from(element.count).unwrap_or(usize::MAX);
    if let Some(row) = element.fixed_row().filter(|_| encoding != Encoding::Ascii) {
        cursor.bytes(count.saturating_mul(row))?;
        return Ok(());
    }
    for _ in 0..count {
        for property in &element.properties {
            match property.length {
                Some(length) => skip_list(cursor, length, property.value)?,
                None => cursor.skip(1, property.value)?,
            }
        }
    }
    Ok(())
}
