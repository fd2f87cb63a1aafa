//! Shapes of a description to geometries of a world.

use super::tessellate::{displaced, subdivided};
use super::textures::TextureCompiler;
use super::tubes::tubes;
use crate::desc::{CurveDesc, CurveKindDesc, MeshDesc, MotionDesc, PatchMeshDesc, QuadricDesc, ShapeDesc, ShapeKind};
use crate::geometry::{
    CurveKind, CurveSegment, CurveSet, Geometry, PatchMesh, Quadric, QuadricKind, Shape, Sphere, TriangleMesh,
};
use crate::math::{AnimatedTransform, DAffine3, DVec3, Vec2, Vec3, transform_point};

/// A shape as a geometry, and how the geometry then moves.
pub(super) struct PlacedShape {
    pub geometry: Geometry,
    /// `None` if the geometry is in the space that the shape was placed in.
    pub motion: Option<AnimatedTransform>,
}

/// Makes the geometry of a shape: in the space it is placed in if that is the same at all times, in its own if it moves.
/// The error is a message for the shape's place in the file.
pub(super) fn place(shape: &ShapeDesc, textures: &mut TextureCompiler) -> Result<PlacedShape, String> {
    let (transform, motion) = if shape.world_from_object.is_static() {
        (shape.world_from_object.start, None)
    } else {
        (DAffine3::IDENTITY, Some(animated(&shape.world_from_object)?))
    };
    Ok(PlacedShape {
        geometry: Geometry::opaque(geometry(shape, &transform, textures)?),
        motion,
    })
}

fn geometry(shape: &ShapeDesc, transform: &DAffine3, textures: &mut TextureCompiler) -> Result<Shape, String> {
    let reverse = shape.reverse_orientation;
    let in_space = |mesh: &MeshDesc| mesh_in_space(mesh, transform, reverse).map(Shape::Mesh);
    match &shape.kind {
        ShapeKind::TriangleMesh(mesh) => in_space(mesh),
        ShapeKind::LoopSubdivision { cage, levels } => in_space(&subdivided(cage, *levels)?),
        ShapeKind::DisplacedMesh { mesh, displacement } => {
            let texture = textures.float(&displacement.texture);
            let world_from_object = &shape.world_from_object.start;
            in_space(&displaced(mesh, &texture, displacement.edge_length, world_from_object)?)
        }
        ShapeKind::Curve(curve) => {
            let curves = curve_in_space(curve, transform).ok_or("the curve is too large")?;
            Ok(Shape::Curves(curves.with_flipped_normal(reverse)))
        }
        ShapeKind::Tubes(curves) => {
            let tubes = tubes(curves, transform).ok_or("the curves are too large")?;
            Ok(Shape::Tubes(tubes.with_flipped_normal(reverse)))
        }
        ShapeKind::BilinearMesh(mesh) => patches_in_space(mesh, transform, reverse),
        ShapeKind::Sphere { radius } => {
            let sphere = Sphere::new(*radius, *transform).ok_or("the sphere has no extent")?;
            Ok(Shape::Spheres(vec![sphere.with_flipped_normal(reverse)]))
        }
        ShapeKind::Quadric { surface, phi_max } => {
            let quadric = Quadric::new(kind_of(surface), phi_max.to_radians(), *transform);
            let quadric = quadric.ok_or("the shape has no extent")?;
            let radial = matches!(surface, QuadricDesc::Disk { radial_uv: true, .. });
            Ok(Shape::Quadrics(vec![
                quadric.with_flipped_normal(reverse).with_radial_uv(radial),
            ]))
        }
    }
}

fn curve_in_space(curve: &CurveDesc, transform: &DAffine3) -> Option<CurveSet> {
    let kind = match curve.kind {
        CurveKindDesc::Flat => CurveKind::Flat,
        CurveKindDesc::Cylinder => CurveKind::Cylinder,
        CurveKindDesc::Ribbon => CurveKind::Ribbon,
    };
    let [start, end] = curve.widths;
    let width = |i: usize| (start + (end - start) * i as f64 / curve.segments.len() as f64) as f32;
    let normal = |i: usize| curve.normals.get(i).map_or(Vec3::Z, |n| n.normalize_or_zero());
    let segments = curve.segments.iter().enumerate().map(|(i, points)| CurveSegment {
        points: *points,
        widths: [width(i), width(i + 1)],
        normals: [normal(i), normal(i + 1)],
    });
    CurveSet::new(segments.collect(), kind, curve.split_depth, *transform)
}

fn kind_of(surface: &QuadricDesc) -> QuadricKind {
    match *surface {
        QuadricDesc::Sphere { radius, z } => QuadricKind::Sphere { radius, z },
        QuadricDesc::Cylinder { radius, z } => QuadricKind::Cylinder { radius, z },
        QuadricDesc::Disk {
            height,
            radius,
            inner_radius,
            radial_uv: _,
        } => QuadricKind::Disk {
            height,
            radius,
            inner_radius,
        },
    }
}

/// The motion that a description means.
pub(super) fn animated(motion: &MotionDesc) -> Result<AnimatedTransform, String> {
    AnimatedTransform::new(motion.start, motion.end).ok_or_else(|| {
        "this transform cannot be animated: it is singular at one end, or mirrors at one end only".to_owned()
    })
}

fn mesh_in_space(mesh: &MeshDesc, transform: &DAffine3, reverse_orientation: bool) -> Result<TriangleMesh, String> {
    let place = |positions: &[Vec3]| positions.iter().map(|&p| transform_point(transform, p)).collect();
    let mut steps = vec![place(&mesh.positions)];
    steps.extend(mesh.positions_end.as_deref().map(place));
    let flip = reverse_orientation ^ mirrors(transform);
    let normals = normals_in_space(&mesh.normals, transform, reverse_orientation);
    let result = TriangleMesh::new(steps, mesh.indices.clone())
        .and_then(|bare| bare.with_normals(normals)?.with_uvs(mesh.uvs.clone()));
    Ok(result.map_err(|e| e.to_string())?.with_flipped_normal(flip))
}

/// Bilinear patches; as triangles, which are traced faster, if all are parallelograms and nothing but their points is given: then two
/// triangles are the same surface with the same texture coordinates.
fn patches_in_space(mesh: &PatchMeshDesc, transform: &DAffine3, reverse_orientation: bool) -> Result<Shape, String> {
    let positions = mesh.positions.iter().map(|&p| transform_point(transform, p)).collect();
    let flip = reverse_orientation ^ mirrors(transform);
    let normals = normals_in_space(&mesh.normals, transform, reverse_orientation);
    let result = PatchMesh::new(positions, mesh.indices.clone())
        .and_then(|bare| bare.with_normals(normals)?.with_uvs(mesh.uvs.clone()));
    let result = result.map_err(|e| e.to_string())?.with_flipped_normal(flip);
    let is_plain = mesh.normals.is_empty() && mesh.uvs.is_empty();
    if is_plain && (0..result.patch_count()).all(|i| result.patch(i).is_parallelogram()) {
        return parallelograms(&result, flip).map(Shape::Mesh);
    }
    Ok(Shape::Patches(result))
}

fn parallelograms(patches: &PatchMesh, flip: bool) -> Result<TriangleMesh, String> {
    let mut positions = Vec::with_capacity(4 * patches.patch_count());
    let mut uvs = Vec::with_capacity(positions.capacity());
    let mut indices = Vec::with_capacity(2 * patches.patch_count());
    for i in 0..patches.patch_count() {
        let first = positions.len() as u32;
        let [p00, p10, p01, p11] = patches.patch(i).corners.map(DVec3::as_vec3);
        positions.extend([p00, p10, p11, p01]);
        uvs.extend([Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y]);
        indices.extend([[0, 1, 2], [0, 2, 3]].map(|triangle: [u32; 3]| triangle.map(|v| first + v)));
    }
    let mesh = TriangleMesh::new(vec![positions], indices).and_then(|mesh| mesh.with_uvs(uvs));
    Ok(mesh.map_err(|e| e.to_string())?.with_flipped_normal(flip))
}

/// The cross product of transformed edges changes sides where the transform mirrors; a normal does not.
fn mirrors(transform: &DAffine3) -> bool {
    transform.matrix3.determinant() < 0.0
}

fn normals_in_space(normals: &[Vec3], transform: &DAffine3, reverse_orientation: bool) -> Vec<Vec3> {
    let normal_matrix = transform.matrix3.inverse().transpose();
    let sign = if reverse_orientation { -1.0 } else { 1.0 };
    let placed = |n: &Vec3| {
        (normal_matrix * n.as_dvec3())
            .try_normalize()
            .map_or(Vec3::ZERO, |n| (sign * n).as_vec3())
    };
    normals.iter().map(placed).collect()
}
