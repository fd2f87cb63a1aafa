//! Shapes of a description to geometries of a world.

use crate::desc::{MeshDesc, MotionDesc, ShapeDesc, ShapeKind};
use crate::geometry::{Geometry, Shape, Sphere, TriangleMesh};
use crate::math::{AnimatedTransform, DAffine3, Vec3, transform_point};

/// A shape as a geometry, and how the geometry then moves.
pub(super) struct PlacedShape {
    pub geometry: Geometry,
    /// `None` if the geometry is in the space that the shape was placed in.
    pub motion: Option<AnimatedTransform>,
}

/// Makes the geometry of a shape: in the space it is placed in if that is the same at all times, in its own if it moves.
/// The error is a message for the shape's place in the file.
pub(super) fn place(shape: &ShapeDesc) -> Result<PlacedShape, String> {
    let (transform, motion) = if shape.world_from_object.is_static() {
        (shape.world_from_object.start, None)
    } else {
        (DAffine3::IDENTITY, Some(animated(&shape.world_from_object)?))
    };
    let shape = match &shape.kind {
        ShapeKind::TriangleMesh(mesh) => {
            Shape::Mesh(mesh_in_space(mesh, &transform, shape.reverse_orientation).map_err(|e| e.to_string())?)
        }
        ShapeKind::Sphere { radius } => {
            let sphere = Sphere::new(*radius, transform).ok_or("the sphere has no extent")?;
            Shape::Spheres(vec![sphere.with_flipped_normal(shape.reverse_orientation)])
        }
    };
    Ok(PlacedShape {
        geometry: Geometry::opaque(shape),
        motion,
    })
}

/// The motion that a description means.
pub(super) fn animated(motion: &MotionDesc) -> Result<AnimatedTransform, String> {
    AnimatedTransform::new(motion.start, motion.end).ok_or_else(|| {
        "this transform cannot be animated: it is singular at one end, or mirrors at one end only".to_owned()
    })
}

fn mesh_in_space(
    mesh: &MeshDesc,
    transform: &DAffine3,
    reverse_orientation: bool,
) -> Result<TriangleMesh, crate::geometry::MeshError> {
    let place = |positions: &[Vec3]| positions.iter().map(|&p| transform_point(transform, p)).collect();
    let mut steps = vec![place(&mesh.positions)];
    steps.extend(mesh.positions_end.as_deref().map(place));
    // The cross product of transformed edges changes sides where the transform mirrors; a normal does not.
    let mirrors = transform.matrix3.determinant() < 0.0;
    let mut result = TriangleMesh::new(steps, mesh.indices.clone())?.with_flipped_normal(reverse_orientation ^ mirrors);
    if !mesh.normals.is_empty() {
        let normal_matrix = transform.matrix3.inverse().transpose();
        let sign = if reverse_orientation { -1.0 } else { 1.0 };
        let normals = mesh.normals.iter().map(|n| {
            (normal_matrix * n.as_dvec3())
                .try_normalize()
                .map_or(Vec3::ZERO, |n| (sign * n).as_vec3())
        });
        result = result.with_normals(normals.collect())?;
    }
    if !mesh.uvs.is_empty() {
        result = result.with_uvs(mesh.uvs.clone())?;
    }
    Ok(result)
}
