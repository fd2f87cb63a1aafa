//! Loop's subdivision surfaces (Loop 1987), as pbrt has them: the cage is refined, its vertices are moved onto the limit surface, and
//! normals come from the tangent masks over the limit positions around each vertex (Pharr, Jakob and Humphreys, third edition,
//! section 3.8).
//!
//! As in pbrt vertices on a boundary are moved by the weights 1/5, 3/5, 1/5, where those of the limit curve, a cubic B-spline, would be
//! 1/6, 2/3, 1/6; the more levels, the less it matters. As in pbrt, too, the normals are on the side from which the triangles of the cage go round clockwise.

use std::collections::HashMap;

use super::{MOST_TRIANGLES, too_many};
use crate::desc::MeshDesc;
use crate::math::{DVec3, Vec3};

/// No neighbour, no face.
const NONE: u32 = u32::MAX;

/// The limit surface of a cage, each triangle of which becomes 4^`levels`.
///
/// # Errors
/// What is wrong with the cage, or that it becomes too much.
pub(in crate::scene) fn subdivided(cage: &MeshDesc, levels: u32) -> Result<MeshDesc, String> {
    let growth = 4_u64.checked_pow(levels).unwrap_or(u64::MAX);
    if (cage.indices.len() as u64).saturating_mul(growth) > MOST_TRIANGLES {
        return Err(too_many());
    }
    let mut surface = Surface::new(cage)?;
    for _ in 0..levels {
        surface = surface.refined();
    }
    Ok(surface.limit())
}

/// A triangle and its neighbours.
#[derive(Clone, Copy)]
struct Face {
    /// Corners.
    v: [u32; 3],
    /// The face on the other side of the edge from corner k to corner k + 1.
    f: [u32; 3],
}

impl Face {
    const EMPTY: Self = Self {
        v: [NONE; 3],
        f: [NONE; 3],
    };

    /// Which of its corners a vertex is.
    fn place(&self, vertex: u32) -> usize {
        (0..2).find(|&k| self.v[k] == vertex).unwrap_or(2)
    }

    /// The corner that is neither of two.
    fn other(&self, a: u32, b: u32) -> u32 {
        self.v.into_iter().find(|&v| v != a && v != b).unwrap_or(a)
    }
}

#[derive(Clone, Copy)]
struct Vertex {
    p: DVec3,
    /// One of its faces; none if it has none.
    start: u32,
    boundary: bool,
    /// Of valence 6, or 4 at a boundary.
    regular: bool,
}

struct Surface {
    vertices: Vec<Vertex>,
    faces: Vec<Face>,
}

impl Surface {
    fn new(cage: &MeshDesc) -> Result<Self, String> {
        let mut vertices: Vec<Vertex> = cage
            .positions
            .iter()
            .map(|p| Vertex {
                p: p.as_dvec3(),
                start: NONE,
                boundary: false,
                regular: false,
            })
            .collect();
        let mut faces: Vec<Face> = cage.indices.iter().map(|&v| Face { v, ..Face::EMPTY }).collect();
        // Each edge by its corners in the order of its face; its neighbour has them the other way round.
        let mut edges = HashMap::with_capacity(3 * faces.len());
        for (index, face) in faces.iter().enumerate() {
            for k in 0..3 {
                let edge = (face.v[k], face.v[(k + 1) % 3]);
                vertices[edge.0 as usize].start = index as u32;
                if edge.0 == edge.1 {
                    return Err(format!("triangle {index} of the cage has the vertex {} twice", edge.0));
                }
                if edges.insert(edge, index as u32).is_some() {
                    let (a, b) = edge;
                    let message = "has more than two triangles, or two that go round the same way";
                    return Err(format!("the edge of the cage from vertex {a} to {b} {message}"));
                }
            }
        }
        for face in &mut faces {
            for k in 0..3 {
                face.f[k] = edges.get(&(face.v[(k + 1) % 3], face.v[k])).copied().unwrap_or(NONE);
            }
        }
        let mut surface = Self { vertices, faces };
        for v in 0..surface.vertices.len() as u32 {
            if surface.vertices[v as usize].start != NONE {
                surface.classify(v);
            }
        }
        Ok(surface)
    }

    fn classify(&mut self, v: u32) {
        let start = self.vertices[v as usize].start;
        let mut face = self.next(start, v);
        while face != NONE && face != start {
            face = self.next(face, v);
        }
        let boundary = face == NONE;
        self.vertices[v as usize].boundary = boundary;
        let mut ring = Vec::new();
        self.ring(v, &mut ring);
        self.vertices[v as usize].regular = ring.len() == if boundary { 4 } else { 6 };
    }

    /// The next face around a vertex, over the edge that leads away from it.
    fn next(&self, face: u32, v: u32) -> u32 {
        let face = &self.faces[face as usize];
        face.f[face.place(v)]
    }

    /// The face before, over the edge that leads to the vertex.
    fn previous(&self, face: u32, v: u32) -> u32 {
        let face = &self.faces[face as usize];
        face.f[(face.place(v) + 2) % 3]
    }

    fn point(&self, v: u32) -> DVec3 {
        self.vertices[v as usize].p
    }

    /// The positions around a vertex that has a face, in order; from one boundary to the other if it is on one.
    fn ring(&self, v: u32, ring: &mut Vec<DVec3>) {
        ring.clear();
        let vertex = &self.vertices[v as usize];
        let ahead = |face: u32| {
            let face = &self.faces[face as usize];
            self.point(face.v[(face.place(v) + 1) % 3])
        };
        let mut face = vertex.start;
        if !vertex.boundary {
            loop {
                ring.push(ahead(face));
                face = self.next(face, v);
                if face == vertex.start {
                    return;
                }
            }
        }
        while self.next(face, v) != NONE {
            face = self.next(face, v);
        }
        ring.push(ahead(face));
        while face != NONE {
            let behind = &self.faces[face as usize];
            ring.push(self.point(behind.v[(behind.place(v) + 2) % 3]));
            face = self.previous(face, v);
        }
    }

    /// Each triangle in four: of face i, the child 4 i + k at corner k, and 4 i + 3 in the middle.
    fn refined(&self) -> Self {
        let mut ring = Vec::new();
        let mut vertices: Vec<Vertex> = (0..self.vertices.len() as u32)
            .map(|v| self.even_vertex(v, &mut ring))
            .collect();
        let mut faces = vec![Face::EMPTY; 4 * self.faces.len()];
        // By face and edge, the vertex in the middle of the edge: made by the first of the two faces.
        let mut odd: Vec<[u32; 3]> = Vec::with_capacity(self.faces.len());
        for (index, face) in self.faces.iter().enumerate() {
            odd.push([0, 1, 2].map(|k| {
                let (a, b) = (face.v[k], face.v[(k + 1) % 3]);
                let neighbour = face.f[k];
                if neighbour != NONE && (neighbour as usize) < index {
                    return odd[neighbour as usize][self.faces[neighbour as usize].place(b)];
                }
                vertices.push(self.odd_vertex(index, [a, b], neighbour));
                vertices.len() as u32 - 1
            }));
        }
        for (index, face) in self.faces.iter().enumerate() {
            let child = |k: usize| 4 * index + k;
            for k in 0..3 {
                let (next, previous) = ((k + 1) % 3, (k + 2) % 3);
                // The neighbours' children at the same vertex.
                let across = |f: u32| match f {
                    NONE => NONE,
                    f => 4 * f + self.faces[f as usize].place(face.v[k]) as u32,
                };
                faces[child(3)].f[k] = child(next) as u32;
                faces[child(3)].v[k] = odd[index][k];
                let corner = &mut faces[child(k)];
                corner.v[k] = face.v[k];
                corner.v[next] = odd[index][k];
                corner.v[previous] = odd[index][previous];
                corner.f[next] = child(3) as u32;
                corner.f[k] = across(face.f[k]);
                corner.f[previous] = across(face.f[previous]);
            }
        }
        Self { vertices, faces }
    }

    /// An old vertex on the next level.
    fn even_vertex(&self, v: u32, ring: &mut Vec<DVec3>) -> Vertex {
        let vertex = self.vertices[v as usize];
        if vertex.start == NONE {
            return vertex;
        }
        self.ring(v, ring);
        let p = if vertex.boundary {
            along_boundary(vertex.p, ring, 1.0 / 8.0)
        } else {
            around(vertex.p, ring, beta(ring.len()))
        };
        let place = self.faces[vertex.start as usize].place(v);
        Vertex {
            p,
            start: 4 * vertex.start + place as u32,
            ..vertex
        }
    }

    /// A new vertex on the edge between two others.
    fn odd_vertex(&self, face: usize, [a, b]: [u32; 2], neighbour: u32) -> Vertex {
        let ends = self.point(a) + self.point(b);
        let boundary = neighbour == NONE;
        let p = if boundary {
            ends * 0.5
        } else {
            let opposite = |face: &Face| self.point(face.other(a, b));
            let both = opposite(&self.faces[face]) + opposite(&self.faces[neighbour as usize]);
            ends * (3.0 / 8.0) + both * (1.0 / 8.0)
        };
        Vertex {
            p,
            start: (4 * face + 3) as u32,
            boundary,
            regular: true,
        }
    }

    /// The vertices moved onto the limit surface, with normals.
    fn limit(mut self) -> MeshDesc {
        let mut ring = Vec::new();
        let limit = |v: u32| {
            let vertex = &self.vertices[v as usize];
            if vertex.start == NONE {
                return vertex.p;
            }
            self.ring(v, &mut ring);
            if vertex.boundary {
                along_boundary(vertex.p, &ring, 1.0 / 5.0)
            } else {
                let n = ring.len() as f64;
                around(vertex.p, &ring, 1.0 / (n + 3.0 / (8.0 * beta(ring.len()))))
            }
        };
        let points: Vec<DVec3> = (0..self.vertices.len() as u32).map(limit).collect();
        for (vertex, p) in self.vertices.iter_mut().zip(points) {
            vertex.p = p;
        }
        let mut ring = Vec::new();
        let normals = (0..self.vertices.len() as u32)
            .map(|v| self.normal(v, &mut ring))
            .collect();
        MeshDesc {
            positions: self.vertices.iter().map(|v| v.p.as_vec3()).collect(),
            normals,
            indices: self.faces.iter().map(|face| face.v).collect(),
            ..MeshDesc::default()
        }
    }

    /// The cross product of two tangents, at unit length; zero where there is none.
    fn normal(&self, v: u32, ring: &mut Vec<DVec3>) -> Vec3 {
        let vertex = &self.vertices[v as usize];
        if vertex.start == NONE {
            return Vec3::ZERO;
        }
        self.ring(v, ring);
        let [s, t] = if vertex.boundary {
            boundary_tangents(vertex.p, ring)
        } else {
            interior_tangents(ring)
        };
        s.cross(t).normalize_or_zero().as_vec3()
    }
}

/// Loop's weight of each neighbour, simplified by Warren.
fn beta(valence: usize) -> f64 {
    if valence == 3 {
        3.0 / 16.0
    } else {
        3.0 / (8.0 * valence as f64)
    }
}

fn around(p: DVec3, ring: &[DVec3], weight: f64) -> DVec3 {
    p * (1.0 - ring.len() as f64 * weight) + ring.iter().sum::<DVec3>() * weight
}

/// Only the neighbours along the boundary count: the first and the last.
fn along_boundary(p: DVec3, ring: &[DVec3], weight: f64) -> DVec3 {
    p * (1.0 - 2.0 * weight) + (ring[0] + ring[ring.len() - 1]) * weight
}

fn interior_tangents(ring: &[DVec3]) -> [DVec3; 2] {
    let mut tangents = [DVec3::ZERO; 2];
    for (j, p) in ring.iter().enumerate() {
        let (sin, cos) = (std::f64::consts::TAU * j as f64 / ring.len() as f64).sin_cos();
        tangents[0] += *p * cos;
        tangents[1] += *p * sin;
    }
    tangents
}

fn boundary_tangents(p: DVec3, ring: &[DVec3]) -> [DVec3; 2] {
    let last = ring.len() - 1;
    let along = ring[last] - ring[0];
    let across = match ring {
        [a, b] => *a + *b - 2.0 * p,
        [_, b, _] => *b - p,
        [a, b, c, d] => 2.0 * (*b + *c) - *a - *d - 2.0 * p,
        _ => {
            let theta = std::f64::consts::PI / last as f64;
            let inner = |k: usize| ring[k] * ((2.0 * theta.cos() - 2.0) * (k as f64 * theta).sin());
            -((ring[0] + ring[last]) * theta.sin() + (1..last).map(inner).sum::<DVec3>())
        }
    };
    [along, across]
}

#[cfg(test)]
mod tests;
