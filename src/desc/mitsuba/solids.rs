//! The shapes that Mitsuba has formulas for and that are meshes here.

use std::f32::consts::TAU;

use glam::{Vec2, Vec3};

use crate::desc::MeshDesc;

/// How many sides a circle has. The polygon inscribed has 1e-4 less area.
const SIDES: u32 = 256;

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
pub(super) fn disk() -> MeshDesc {
    let mut mesh = MeshDesc::default();
    for side in 0..SIDES {
        let first = mesh.positions.len() as u32;
        let middle = (side as f32 + 0.5) / SIDES as f32;
        mesh.positions.push(Vec3::ZERO);
        mesh.uvs.push(uv(0.0, middle));
        for step in [0, 1] {
            let (turn, at) = on_circle(side + step);
            mesh.positions.push(at.extend(0.0));
            mesh.uvs.push(uv(1.0, turn));
        }
        mesh.indices.push([first, first + 1, first + 2]);
    }
    mesh
}

/// Of radius 1 around the z axis from z = 0 to 1, without ends, facing outwards; u is the angle, v is z.
pub(super) fn cylinder() -> MeshDesc {
    let mut mesh = MeshDesc::default();
    for side in 0..=SIDES {
        let (turn, at) = on_circle(side);
        for z in [0.0, 1.0] {
            mesh.positions.push(at.extend(z));
            mesh.normals.push(at.extend(0.0));
            mesh.uvs.push(uv(turn, z));
        }
    }
    mesh.indices = (0..SIDES)
        .flat_map(|side| [[0, 2, 3], [0, 3, 1]].map(|t| t.map(|v| 2 * side + v)))
        .collect();
    mesh
}

/// A corner of the polygon: what part of a turn it is at, and where.
fn on_circle(side: u32) -> (f32, Vec2) {
    let turn = side as f32 / SIDES as f32;
    let angle = if side == SIDES { 0.0 } else { TAU * turn };
    (turn, Vec2::from_angle(angle))
}

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
        let (volume, area) = volume_and_area(&cylinder());
        // Without its lower end in the origin's plane; the upper end's cone of volume pi / 3 is missing.
        assert!(
            (volume - TAU / 3.0).abs() < 1e-3 && (area - TAU).abs() < 1e-3,
            "{volume} {area}"
        );
        let (_, area) = volume_and_area(&disk());
        assert!((area - 0.5 * TAU).abs() < 1e-3);
        for mesh in [rectangle(), disk()] {
            let [a, b, c] = mesh.indices[0].map(|v| mesh.positions[v as usize]);
            assert!((b - a).cross(c - a).z > 0.0);
        }
    }
}
