//! Meshes that are written out in the scene: of triangles, of bilinear patches, cages of subdivision surfaces.

use std::sync::Arc;

use glam::Vec2;

use super::arrays::{as_many, corners, indices, vectors, vectors3, vertices};
use super::attributes::attributes;
use crate::desc::pbrt::params::ParamType;
use crate::desc::pbrt::reader::ParamReader;
use crate::desc::{MeshDesc, PatchMeshDesc, ShapeKind};

pub(super) fn triangle_mesh(reader: &mut ParamReader<'_>) -> Option<ShapeKind> {
    reader.inert(&[("faceIndices", "it matters to Ptex textures only")]);
    let positions = vertices(reader, "trianglemesh");
    let end = vectors3(reader, "P1", ParamType::Point3);
    let normals = vectors3(reader, "N", ParamType::Normal);
    let tangents = vectors3(reader, "S", ParamType::Vector3);
    let uvs = vectors(reader, "uv", ParamType::Point2, |[x, y]: [f32; 2]| Vec2::new(x, y));
    let count = positions.as_ref().map(Vec::len);
    let indices = indices(reader, "trianglemesh", count, "triangle");
    let attributes = attributes(reader, count, indices.as_ref().map(Vec::len));
    let (positions, count, indices) = (positions?, count?, indices?);
    Some(ShapeKind::TriangleMesh(Arc::new(MeshDesc {
        positions,
        positions_end: as_many(reader, "P1", end, count),
        normals: as_many(reader, "N", normals, count).unwrap_or_default(),
        tangents: as_many(reader, "S", tangents, count).unwrap_or_default(),
        uvs: as_many(reader, "uv", uvs, count).unwrap_or_default(),
        indices,
        attributes,
    })))
}

pub(super) fn bilinear_mesh(reader: &mut ParamReader<'_>) -> Option<ShapeKind> {
    reader.inert(&[
        ("faceIndices", "it matters to Ptex textures only"),
        (
            "emissionfilename",
            "it only says where to look for light; what shines is the image of the `AreaLightSource`",
        ),
    ]);
    let positions = vertices(reader, "bilinearmesh");
    let normals = vectors3(reader, "N", ParamType::Normal);
    let uvs = vectors(reader, "uv", ParamType::Point2, |[x, y]: [f32; 2]| Vec2::new(x, y));
    let count = positions.as_ref().map(Vec::len);
    let indices = indices(reader, "bilinearmesh", count, "patch");
    let (positions, count, indices) = (positions?, count?, indices?);
    Some(ShapeKind::BilinearMesh(Arc::new(PatchMeshDesc {
        positions,
        normals: as_many(reader, "N", normals, count).unwrap_or_default(),
        uvs: as_many(reader, "uv", uvs, count).unwrap_or_default(),
        indices,
    })))
}

pub(super) fn loop_subdivision(reader: &mut ParamReader<'_>) -> Option<ShapeKind> {
    reader.inert(&[("scheme", "there is only Loop's")]);
    let levels = reader.integer_in(
        "levels",
        3,
        |levels| (0..=MOST_LEVELS).contains(&levels),
        "from 0 to 20",
    );
    let positions = vertices(reader, "loopsubdiv");
    let param = reader.take("indices", &[ParamType::Integer]);
    let positions = positions?;
    let Some(param) = param else {
        if !reader.has("indices") {
            let span = reader.span;
            let message = "this `loopsubdiv` has no `\"integer indices\"`";
            reader.report().error(span, message);
        }
        return None;
    };
    let indices = corners(reader, &param, positions.len(), "triangle")?;
    let cage = MeshDesc {
        positions,
        indices,
        ..MeshDesc::default()
    };
    Some(ShapeKind::LoopSubdivision {
        cage: Arc::new(cage),
        levels: levels.unsigned_abs(),
    })
}

/// Beyond this even one triangle becomes more than memory holds.
const MOST_LEVELS: i32 = 20;
