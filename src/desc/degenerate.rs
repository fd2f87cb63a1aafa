//! Triangles that nothing can hit.

use std::collections::HashSet;
use std::sync::Arc;

use rayon::prelude::*;

use super::{MeshDesc, SceneDesc, ShapeKind};
use crate::error::Severity;

/// So many meshes have a warning of their own.
const MOST_WARNINGS: usize = 10;

/// Says of which meshes some triangles have no area, whose corners are in one line: they are kept, but no ray meets them and no light
/// comes from them.
pub(super) fn warn(scene: &mut SceneDesc) {
    let mut seen = HashSet::new();
    let mut warnings = Vec::new();
    let shapes = scene.shapes.iter().chain(scene.objects.iter().flat_map(|o| &o.shapes));
    for shape in shapes {
        let (ShapeKind::TriangleMesh(mesh) | ShapeKind::DisplacedMesh { mesh, .. }) = &shape.kind else {
            continue;
        };
        if !seen.insert(Arc::as_ptr(mesh)) {
            continue;
        }
        let count = without_area(mesh);
        if count > 0 {
            let all = mesh.indices.len();
            let message = format!("{count} of the {all} triangles of this mesh have no area: nothing meets them");
            warnings.push(scene.sources.diagnostic(Severity::Warning, shape.span, message));
        }
    }
    if let Some(more) = warnings.len().checked_sub(MOST_WARNINGS).filter(|&more| more > 0) {
        warnings.truncate(MOST_WARNINGS);
        let last = &mut warnings[MOST_WARNINGS - 1];
        last.help = Some(format!("{more} more meshes have such triangles"));
    }
    scene.warnings.append(&mut warnings);
}

/// How many triangles of a mesh have no area, where they are and, of those that move, where they go.
fn without_area(mesh: &MeshDesc) -> usize {
    let is_flat = |face: &[u32; 3], positions: &[glam::Vec3]| {
        let [a, b, c] = face.map(|v| positions[v as usize].as_dvec3());
        (b - a).cross(c - a) == glam::DVec3::ZERO
    };
    let end = mesh.positions_end.as_deref();
    let faces = mesh.indices.par_iter().with_min_len(1 << 14);
    faces
        .filter(|face| is_flat(face, &mesh.positions) && end.is_none_or(|end| is_flat(face, end)))
        .count()
}
