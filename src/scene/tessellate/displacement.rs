//! Meshes displaced by a texture, as in pbrt: triangles are halved at their longest edge until no edge is longer than a bound, and
//! then each vertex is moved along its normal.

use std::collections::HashMap;

use rayon::prelude::*;

use super::{MOST_TRIANGLES, too_many};
use crate::desc::MeshDesc;
use crate::math::{DAffine3, Vec2, Vec3, transform_point};
use crate::texture::{FloatTexture, TextureContext};

/// A mesh whose vertices are moved by `texture`, in object space, after its edges have become shorter than `edge_length` in the space
/// that `world_from_object` leads to. Its normals are those of the displaced surface.
///
/// # Errors
/// If the mesh has no texture coordinates, or would become too much.
pub(in crate::scene) fn displaced(
    mesh: &MeshDesc,
    texture: &FloatTexture,
    edge_length: f64,
    world_from_object: &DAffine3,
) -> Result<MeshDesc, String> {
    if mesh.uvs.is_empty() {
        return Err("the mesh has no texture coordinates, which its displacement needs".to_owned());
    }
    if mesh.positions_end.is_some() {
        return Err("a mesh that moves its vertices cannot be displaced".to_owned());
    }
    let mut fine = Refinement {
        positions: mesh.positions.clone(),
        normals: if mesh.normals.is_empty() {
            vertex_normals(&mesh.positions, &mesh.indices)
        } else {
            mesh.normals.iter().map(|n| n.normalize_or_zero()).collect()
        },
        uvs: mesh.uvs.clone(),
        indices: Vec::with_capacity(mesh.indices.len()),
        middles: HashMap::new(),
        square: edge_length * edge_length,
        world_from_object,
    };
    for &triangle in &mesh.indices {
        fine.refine(triangle)?;
    }
    let Refinement {
        positions,
        normals,
        uvs,
        indices,
        ..
    } = fine;
    let normal_matrix = world_from_object.matrix3.inverse().transpose();
    let moved = |((p, n), uv): ((Vec3, Vec3), Vec2)| {
        let world_normal = (normal_matrix * n.as_dvec3()).normalize_or_zero().as_vec3();
        let context = TextureContext::at_point(transform_point(world_from_object, p), world_normal, uv);
        p + n * texture.evaluate(&context)
    };
    let places = positions.into_par_iter().zip(normals).zip(uvs.par_iter().copied());
    let positions: Vec<Vec3> = places.map(moved).collect();
    Ok(MeshDesc {
        normals: vertex_normals(&positions, &indices),
        positions,
        uvs,
        indices,
        ..MeshDesc::default()
    })
}

/// A mesh that becomes finer.
struct Refinement<'a> {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
    indices: Vec<[u32; 3]>,
    /// By the ends of an edge, the lesser first: the vertex in its middle.
    middles: HashMap<(u32, u32), u32>,
    /// Of the longest edge that is left.
    square: f64,
    world_from_object: &'a DAffine3,
}

impl Refinement<'_> {
    /// Adds a triangle, in parts if need be.
    fn refine(&mut self, triangle: [u32; 3]) -> Result<(), String> {
        let mut rest = vec![triangle];
        while let Some(v) = rest.pop() {
            let lengths = [0, 1, 2].map(|k| self.square_length(v[k], v[(k + 1) % 3]));
            let longest = if lengths[0] > lengths[1] && lengths[0] > lengths[2] {
                0
            } else if lengths[1] > lengths[2] {
                1
            } else {
                2
            };
            // An edge of which single precision has no middle ends as it is.
            let [a, b, c] = [0, 1, 2].map(|k| v[(longest + k) % 3]);
            if lengths[longest] < self.square || !self.has_middle(a, b) {
                self.indices.push(v);
                continue;
            }
            if self.indices.len() as u64 + rest.len() as u64 >= MOST_TRIANGLES {
                return Err(too_many());
            }
            let middle = self.middle(a, b);
            rest.push([middle, b, c]);
            rest.push([a, middle, c]);
        }
        Ok(())
    }

    fn square_length(&self, a: u32, b: u32) -> f64 {
        let edge = (self.positions[b as usize] - self.positions[a as usize]).as_dvec3();
        self.world_from_object.transform_vector3(edge).length_squared()
    }

    fn has_middle(&self, a: u32, b: u32) -> bool {
        let [a, b] = [a, b].map(|v| self.positions[v as usize]);
        let middle = (a + b) * 0.5;
        middle != a && middle != b
    }

    fn middle(&mut self, a: u32, b: u32) -> u32 {
        let next = self.positions.len() as u32;
        let middle = *self.middles.entry((a.min(b), a.max(b))).or_insert(next);
        if middle == next {
            let [a, b] = [a as usize, b as usize];
            self.positions.push((self.positions[a] + self.positions[b]) * 0.5);
            self.normals
                .push((self.normals[a] + self.normals[b]).normalize_or_zero());
            self.uvs.push((self.uvs[a] + self.uvs[b]) * 0.5);
        }
        middle
    }
}

/// The mean of the unit normals of each vertex's triangles, as in pbrt; zero for a vertex without.
fn vertex_normals(positions: &[Vec3], indices: &[[u32; 3]]) -> Vec<Vec3> {
    let mut normals = vec![Vec3::ZERO; positions.len()];
    for triangle in indices {
        let [a, b, c] = triangle.map(|v| positions[v as usize]);
        let normal = (b - a).cross(c - b).normalize_or_zero();
        for v in triangle {
            normals[*v as usize] += normal;
        }
    }
    normals.iter().map(|n| n.normalize_or_zero()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> MeshDesc {
        MeshDesc {
            positions: vec![Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y],
            uvs: vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y],
            indices: vec![[0, 1, 2], [0, 2, 3]],
            ..MeshDesc::default()
        }
    }

    #[test]
    fn edges_become_short_enough_and_the_surface_has_no_gaps() {
        let scale = DAffine3::from_scale(crate::math::DVec3::splat(2.0));
        let mesh = displaced(&square(), &FloatTexture::Constant(0.25), 0.1, &scale).unwrap();
        let mut sides: HashMap<(u32, u32), i32> = HashMap::new();
        let mut area = 0.0;
        for triangle in &mesh.indices {
            let [a, b, c] = triangle.map(|v| mesh.positions[v as usize]);
            for (p, q) in [(a, b), (b, c), (c, a)] {
                assert!(2.0 * (p - q).length() < 0.1);
            }
            assert!([a, b, c].iter().all(|p| p.z == 0.25));
            area += (b - a).cross(c - a).z / 2.0;
            for k in 0..3 {
                *sides.entry((triangle[k], triangle[(k + 1) % 3])).or_default() += 1;
            }
        }
        assert!((area - 1.0).abs() < 1e-5, "{area}");
        assert!(sides.values().all(|&count| count == 1));
        // Only edges of the rim have no other side.
        for (a, b) in sides.keys().filter(|(a, b)| !sides.contains_key(&(*b, *a))) {
            let [p, q] = [a, b].map(|v| mesh.positions[*v as usize]);
            assert!((0..2).any(|i| p[i] == q[i] && (p[i] == 0.0 || p[i] == 1.0)), "{p} {q}");
        }
        assert!(mesh.normals.iter().all(|n| *n == Vec3::Z));
        assert_eq!(mesh.uvs.len(), mesh.positions.len());
    }

    #[test]
    fn what_cannot_be_displaced_is_refused() {
        let identity = DAffine3::IDENTITY;
        let texture = FloatTexture::Constant(1.0);
        let bare = MeshDesc {
            uvs: Vec::new(),
            ..square()
        };
        assert!(
            displaced(&bare, &texture, 1.0, &identity)
                .unwrap_err()
                .contains("texture coordinates")
        );
    }
}
