//! `Shape`.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

use glam::{Vec2, Vec3};

use super::params::{Param, ParamType, Values, value_span};
use super::reader::{ParamReader, unknown_type};
use crate::desc::{MeshDesc, Textured};
use crate::error::Span;

const KNOWN: [&str; 3] = ["trianglemesh", "plymesh", "sphere"];
const LATER: [&str; 5] = ["bilinearmesh", "curve", "cylinder", "disk", "loopsubdiv"];

/// A shape whose mesh may yet have to be read.
#[derive(Debug)]
pub(super) enum RawKind {
    Mesh(Arc<MeshDesc>),
    Sphere {
        radius: f64,
    },
    /// An index into [`PendingMeshes::files`].
    Pending(usize),
}

/// The mesh files that shapes name. A file that is named several times is read once.
#[derive(Debug, Default)]
pub(super) struct PendingMeshes {
    /// The files, and where each was first named.
    pub files: Vec<(PathBuf, Span)>,
    indices: HashMap<PathBuf, usize>,
}

impl PendingMeshes {
    fn add(&mut self, path: PathBuf, span: Span) -> usize {
        *self.indices.entry(path).or_insert_with_key(|path| {
            self.files.push((path.clone(), span));
            self.files.len() - 1
        })
    }
}

/// Reads a shape and its alpha; none if there is no such shape to be read or something essential is wrong with it.
pub(super) fn read(
    mut reader: ParamReader<'_>,
    kind: &str,
    meshes: &mut PendingMeshes,
) -> Option<(RawKind, Textured<f32>)> {
    let shape = match kind {
        "trianglemesh" => triangle_mesh(&mut reader).map(|mesh| RawKind::Mesh(Arc::new(mesh))),
        "plymesh" => ply_mesh(&mut reader, meshes),
        "sphere" => Some(sphere(&mut reader)),
        _ => {
            let classes = (&KNOWN[..], &LATER[..]);
            let span = reader.span;
            unknown_type(reader.report(), "shape", kind, span, classes, "it is left out");
            return None;
        }
    };
    let alpha = alpha(&mut reader);
    reader.finish();
    Some((shape?, alpha))
}

/// How much there is of a shape; 1 by default.
fn alpha(reader: &mut ParamReader<'_>) -> Textured<f32> {
    match reader.float_textured("alpha") {
        Some(Textured::Value(value)) if !(0.0..=1.0).contains(&value) => {
            reader.out_of_range("alpha", &value.to_string(), "between 0 and 1");
            Textured::Value(1.0)
        }
        Some(alpha) => alpha,
        None => Textured::Value(1.0),
    }
}

fn sphere(reader: &mut ParamReader<'_>) -> RawKind {
    let radius = reader.positive("radius", 1.0);
    let z_min = reader.float("zmin").unwrap_or(-radius);
    let z_max = reader.float("zmax").unwrap_or(radius);
    let phi_max = reader.float("phimax").unwrap_or(360.0);
    for (name, partial) in [
        ("zmin", z_min > -radius),
        ("zmax", z_max < radius),
        ("phimax", phi_max < 360.0),
    ] {
        if partial {
            let span = reader.span_of(name);
            let message = format!("parts of spheres, by `{name}`, are not supported yet");
            reader.report().unsupported(span, message, "the sphere is whole");
        }
    }
    RawKind::Sphere { radius }
}

fn ply_mesh(reader: &mut ParamReader<'_>, meshes: &mut PendingMeshes) -> Option<RawKind> {
    reader.unsupported(&["displacement"]);
    reader.inert(&[("edgelength", "it matters to displacement only")]);
    let Some((name, span)) = reader.string("filename") else {
        if !reader.has("filename") {
            let span = reader.span;
            reader
                .report()
                .error(span, "this `plymesh` has no `\"string filename\"`");
        }
        return None;
    };
    let path = reader.context.resolve(&name, span);
    Some(RawKind::Pending(meshes.add(path, span)))
}

fn triangle_mesh(reader: &mut ParamReader<'_>) -> Option<MeshDesc> {
    reader.inert(&[("faceIndices", "it matters to Ptex textures only")]);
    let positions = vectors3(reader, "P", ParamType::Point3);
    let end = vectors3(reader, "P1", ParamType::Point3);
    let normals = vectors3(reader, "N", ParamType::Normal);
    let tangents = vectors3(reader, "S", ParamType::Vector3);
    let uvs = vectors(reader, "uv", ParamType::Point2, |[x, y]: [f32; 2]| Vec2::new(x, y));
    let indices = reader.take("indices", &[ParamType::Integer]);
    let Some((positions, _)) = positions else {
        if !reader.has("P") {
            let span = reader.span;
            reader
                .report()
                .error(span, "this `trianglemesh` has no vertices `\"point3 P\"`");
        }
        return None;
    };
    let indices = match indices {
        Some(param) => triangles(reader, &param, positions.len())?,
        None if positions.len() == 3 && !reader.has("indices") => vec![[0, 1, 2]],
        None => {
            if !reader.has("indices") {
                let span = reader.span;
                let message = "this `trianglemesh` has no `\"integer indices\"`; only one of 3 vertices needs none";
                reader.report().error(span, message);
            }
            return None;
        }
    };
    let count = positions.len();
    Some(MeshDesc {
        positions,
        positions_end: as_many(reader, "P1", end, count),
        normals: as_many(reader, "N", normals, count).unwrap_or_default(),
        tangents: as_many(reader, "S", tangents, count).unwrap_or_default(),
        uvs: as_many(reader, "uv", uvs, count).unwrap_or_default(),
        indices,
    })
}

/// The values of a vertex attribute, if there are as many as there are vertices; else a complaint.
fn as_many<T>(
    reader: &mut ParamReader<'_>,
    name: &str,
    values: Option<(Vec<T>, Span)>,
    count: usize,
) -> Option<Vec<T>> {
    let (values, span) = values?;
    if values.len() == count {
        return Some(values);
    }
    let message = format!("`{name}` is given for {} vertices, but there are {count}", values.len());
    reader.report().error(span, message);
    None
}

fn vectors3(reader: &mut ParamReader<'_>, name: &'static str, kind: ParamType) -> Option<(Vec<Vec3>, Span)> {
    vectors(reader, name, kind, |[x, y, z]: [f32; 3]| Vec3::new(x, y, z))
}

/// The numbers of a parameter by groups of `N`, and their place.
fn vectors<T, const N: usize>(
    reader: &mut ParamReader<'_>,
    name: &'static str,
    kind: ParamType,
    make: impl Fn([f32; N]) -> T,
) -> Option<(Vec<T>, Span)> {
    let param = reader.take(name, &[kind])?;
    let Values::Numbers(numbers) = &param.values else {
        return None;
    };
    let (groups, rest) = numbers.as_chunks::<N>();
    if !rest.is_empty() || groups.is_empty() {
        let message = format!("`{name}` takes {N} numbers a vertex, found {} in all", numbers.len());
        reader.report().error(param.values_span, message);
        return None;
    }
    let mut values = Vec::with_capacity(groups.len());
    for (i, group) in groups.iter().enumerate() {
        let group = group.map(|v| v as f32);
        if let Some(j) = group.iter().position(|v| !v.is_finite()) {
            let span = value_span(reader.report(), &param, i * N + j);
            let message = format!("this number of `{name}` does not fit into 32-bit floating point");
            reader.report().error(span, message);
            return None;
        }
        values.push(make(group));
    }
    Some((values, param.values_span))
}

/// Triples of vertex indices, all below `count`.
fn triangles(reader: &mut ParamReader<'_>, param: &Param, count: usize) -> Option<Vec<[u32; 3]>> {
    let Values::Integers(indices) = &param.values else {
        return None;
    };
    let (triples, rest) = indices.as_chunks::<3>();
    if !rest.is_empty() || triples.is_empty() {
        let message = format!("`indices` takes 3 integers a triangle, found {} in all", indices.len());
        reader.report().error(param.values_span, message);
        return None;
    }
    let valid = |i: &i32| usize::try_from(*i).is_ok_and(|i| i < count);
    if let Some(bad) = indices.iter().position(|i| !valid(i)) {
        let span = value_span(reader.report(), param, bad);
        let message = format!("there is no vertex {}: `P` has {count}, counted from 0", indices[bad]);
        reader.report().error(span, message);
        return None;
    }
    Some(triples.iter().map(|t| t.map(i32::cast_unsigned)).collect())
}
