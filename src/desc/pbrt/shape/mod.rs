//! `Shape`.

mod arrays;
mod attributes;
mod curve;
mod mesh;
mod quadric;
mod tubes;

use std::collections::HashMap;
use std::path::PathBuf;

use super::reader::{ParamReader, unknown_type};
use crate::desc::{DisplacementDesc, ShapeKind, Textured};
use crate::error::Span;

const KNOWN: [&str; 9] = [
    "trianglemesh",
    "plymesh",
    "bilinearmesh",
    "loopsubdiv",
    "sphere",
    "cylinder",
    "disk",
    "curve",
    "tubes",
];

/// A shape whose mesh may yet have to be read.
#[derive(Debug)]
pub(super) enum RawKind {
    /// It is all there.
    Whole(ShapeKind),
    /// Its mesh is in a file.
    File {
        /// An index into [`PendingMeshes::files`].
        file: usize,
        displacement: Option<DisplacementDesc>,
    },
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
        "trianglemesh" => mesh::triangle_mesh(&mut reader).map(RawKind::Whole),
        "plymesh" => ply_mesh(&mut reader, meshes),
        "bilinearmesh" => mesh::bilinear_mesh(&mut reader).map(RawKind::Whole),
        "loopsubdiv" => mesh::loop_subdivision(&mut reader).map(RawKind::Whole),
        "sphere" => quadric::sphere(&mut reader).map(RawKind::Whole),
        "cylinder" => quadric::cylinder(&mut reader).map(RawKind::Whole),
        "disk" => quadric::disk(&mut reader).map(RawKind::Whole),
        "curve" => curve::curve(&mut reader).map(RawKind::Whole),
        "tubes" => tubes::tubes(&mut reader).map(RawKind::Whole),
        _ => {
            let classes = (&KNOWN[..], &[][..]);
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

fn ply_mesh(reader: &mut ParamReader<'_>, meshes: &mut PendingMeshes) -> Option<RawKind> {
    let displacement = reader.float_textured("displacement");
    let edge_length = ["displacement.edgelength", "edgelength"].map(|name| {
        let given = reader.has(name);
        let length = reader.positive(name, 1.0);
        given.then_some(length)
    });
    let [edge_length, older_name] = edge_length;
    let displacement = displacement.map(|texture| DisplacementDesc {
        texture,
        edge_length: edge_length.or(older_name).unwrap_or(1.0),
    });
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
    let file = meshes.add(path, span);
    Some(RawKind::File { file, displacement })
}
