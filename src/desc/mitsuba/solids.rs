//! The shapes that Mitsuba has formulas for: flat ones are meshes here.

use glam::{Vec2, Vec3};

use crate::desc::{MeshDesc, QuadricDesc, ShapeKind};

/// From (-1, -1) to (1, 1) in the plane z = 0, facing +z.
pub(super) fn rectangle() -> MeshDesc {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    MeshDesc {
        positions: corners.iter().map(|&[x, y]| Vec3::new(x, y, 0.0)).collect(),
        uvs: corners
            .iter()
            .map(|&[x, y]| uv(0.5 * (x + 1.0), 0.5 * (y + 1.0)))
            .collect(),
        indices: vec![[0, 1, 2], [0, 2, 3]],
        ..MeshDesc::default()
    }
}

/// From (-1, -1, -1) to (1, 1, 1), facing outwards.
pub(super) fn cube() -> MeshDesc {
    let mut mesh = MeshDesc::default();
    // The normal of each face, and the directions of its u and v.
    let faces = [
        (Vec3::NEG_Y, Vec3::Z, Vec3::X),
        (Vec3::Y, Vec3::NEG_X, Vec3::NEG_Z),
        (Vec3::X, Vec3::Y, Vec3::NEG_Z),
        (Vec3::Z, Vec3::Y, Vec3::X),
        (Vec3::NEG_X, Vec3::Y, Vec3::Z),
        (Vec3::NEG_Z, Vec3::NEG_Y, Vec3::X),
    ];
    for (normal, along_u, along_v) in faces {
        let first = mesh.positions.len() as u32;
        for (u, v) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
            mesh.positions
                .push(normal + along_u * (2.0 * u - 1.0) + along_v * (2.0 * v - 1.0));
            mesh.normals.push(normal);
            mesh.uvs.push(uv(u, v));
        }
        mesh.indices
            .extend([[0, 2, 1], [0, 3, 2]].map(|triangle| triangle.map(|v| first + v)));
    }
    mesh
}

/// Of radius 1 around the origin in the plane z = 0, facing +z; u is the distance from the middle, v the angle.
pub(super) const DISK: ShapeKind = ShapeKind::Quadric {
    surface: QuadricDesc::Disk {
        height: 0.0,
        radius: 1.0,
        inner_radius: 0.0,
        radial_uv: true,
    },
    phi_max: 360.0,
};

/// Of radius 1 around the z axis from z = 0 to 1, without ends, facing outwards; u is the angle, and of v this program's is 1 - z.
pub(super) const CYLINDER: ShapeKind = ShapeKind::Quadric {
    surface: QuadricDesc::Cylinder {
        radius: 1.0,
        z: [0.0, 1.0],
    },
    phi_max: 360.0,
};

/// Mitsuba's texture coordinates as this program's.
fn uv(u: f32, v: f32) -> Vec2 {
    Vec2::new(u, 1.0 - v)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Twice the volume between a surface and the origin, by the divergence theorem times 3; area by the way.
    fn volume_and_area(mesh: &MeshDesc) -> (f32, f32) {
        let corners = |t: &[u32; 3]| t.map(|v| mesh.positions[v as usize]);
        let sum = |f: &dyn Fn([Vec3; 3]) -> f32| mesh.indices.iter().map(|t| f(corners(t))).sum::<f32>();
        let volume = sum(&|[a, b, c]| a.dot(b.cross(c)) / 6.0);
        (volume, sum(&|[a, b, c]| 0.5 * (b - a).cross(c - a).length()))
    }

    #[test]
    fn solids_face_outwards_and_have_their_size() {
        let (volume, area) = volume_and_area(&cube());
        assert!((volume - 8.0).abs() < 1e-5 && (area - 24.0).abs() < 1e-5);
        let mesh = rectangle();
        let [a, b, c] = mesh.indices[0].map(|v| mesh.positions[v as usize]);
        assert!((b - a).cross(c - a).z > 0.0);
    }
}
