//! Worlds of so few primitives that packets of rays are done sooner with all of them than with any tree: rays need neither go the same
//! way nor be sorted.

use super::leaf::Triangle;
use super::triangle::Plane;
use crate::geometry::{Opacity, Shape, Sphere, World};

/// What testing a ray against all primitives costs at most for it to be worth it, as measured, in tests of triangles: deep bounces cross
/// over at some 200, first ones at 100.
pub const MOST_TESTS: usize = 128;

/// Tests of triangles that the test of a sphere takes as long as, about.
const TESTS_OF_SPHERE: usize = 4;

/// Coordinates are at most this, in size, so that products of two differences of them are finite.
pub const FAR: f32 = 1e15;

/// A triangle.
pub struct Facet {
    /// The places of its edges in [`Few::edges`], each opposite to a corner.
    pub edges: [u16; 3],
    /// All bits, if the triangle has the second or the third of them the other way round but not the first, or the reverse.
    pub turned: [u32; 2],
    /// Its box: by axis, the places of its lower and its upper end in [`Few::ends`].
    pub bounds: [[u16; 2]; 3],
    /// Its plane.
    pub plane: Plane,
    /// Geometry and primitive.
    pub ids: [u32; 2],
}

/// A sphere.
pub struct Ball {
    /// The sphere.
    pub sphere: Sphere,
    /// Geometry and primitive.
    pub ids: [u32; 2],
}

/// All primitives of a world. What triangles have in common is there once.
pub struct Few {
    /// The mask that all have.
    pub mask: u32,
    /// Corners of triangles.
    pub corners: Vec<[f32; 3]>,
    /// Edges of triangles, from corner to corner.
    pub edges: Vec<[u16; 2]>,
    /// By axis, where boxes of triangles begin and end.
    pub ends: [Vec<f32>; 3],
    /// Triangles, those with area.
    pub facets: Vec<Facet>,
    /// Spheres.
    pub balls: Vec<Ball>,
}

impl Few {
    /// The primitives of a world; `None` if they are too many, have several masks, reach too [far](FAR), or there is anything else than
    /// triangles and spheres at rest that no filter is asked about.
    pub fn new(world: &World) -> Option<Self> {
        if !world.instances().is_empty() {
            return None;
        }
        let mask = world.root().first().map_or(0, |&id| world.geometry(id).mask);
        let mut few = Self {
            mask,
            corners: Vec::new(),
            edges: Vec::new(),
            ends: [const { Vec::new() }; 3],
            facets: Vec::new(),
            balls: Vec::new(),
        };
        for &id in world.root() {
            let geometry = world.geometry(id);
            if geometry.opacity == Opacity::Filtered
                || geometry.mask != mask
                || few.tests() + geometry.primitive_count() > MOST_TESTS
            {
                return None;
            }
            match &geometry.shape {
                Shape::Mesh(mesh) if !mesh.is_moving() => {
                    for triangle in 0..mesh.triangle_count() {
                        few.add((id, mesh, triangle));
                    }
                }
                Shape::Spheres(spheres) => {
                    few.balls.extend((0..).zip(spheres).map(|(i, sphere)| Ball {
                        sphere: sphere.clone(),
                        ids: [id.0, i],
                    }));
                }
                _ => return None,
            }
        }
        let is_far = |corner: &[f32; 3]| corner.iter().any(|x| x.abs() > FAR);
        (few.tests() <= MOST_TESTS && !few.corners.iter().any(is_far)).then_some(few)
    }

    /// What testing a ray against all of them costs, in tests of triangles of closed surfaces, which share their edges and corners.
    pub fn tests(&self) -> usize {
        let of_triangles = (self.corners.len() + self.edges.len() + self.facets.len()) / 3;
        of_triangles + TESTS_OF_SPHERE * self.balls.len()
    }

    /// Bytes.
    pub fn memory(&self) -> usize {
        size_of_val(self.corners.as_slice())
            + size_of_val(self.edges.as_slice())
            + self.ends.iter().map(|ends| size_of_val(ends.as_slice())).sum::<usize>()
            + size_of_val(self.facets.as_slice())
            + size_of_val(self.balls.as_slice())
    }

    /// Adds a triangle, if it has area.
    fn add(&mut self, (geometry, mesh, triangle): Triangle<'_>) {
        let positions = mesh.positions(0);
        let corners = mesh.indices()[triangle].map(|vertex| positions[vertex as usize].to_array());
        let plane = Plane::new(&corners);
        if !plane.has_area() {
            return;
        }
        let bounds = [0, 1, 2].map(|axis| {
            let [a, b, c] = corners.map(|corner| corner[axis]);
            let ends = [a.min(b).min(c), a.max(b).max(c)];
            ends.map(|end| place_of(&mut self.ends[axis], end, f32::to_bits))
        });
        let [a, b, c] = corners.map(|corner| place_of(&mut self.corners, corner, |it| it.map(f32::to_bits)));
        let edges = [self.edge(b, c), self.edge(c, a), self.edge(a, b)];
        let is_reversed = [b > c, c > a, a > b];
        self.facets.push(Facet {
            edges,
            turned: [is_reversed[1], is_reversed[2]].map(|it| if it == is_reversed[0] { 0 } else { u32::MAX }),
            bounds,
            plane,
            ids: [geometry.0, triangle as u32],
        });
    }

    /// The place of the edge between two corners.
    fn edge(&mut self, a: u16, b: u16) -> u16 {
        place_of(&mut self.edges, [a.min(b), a.max(b)], |edge| edge)
    }
}

/// The place of a thing among others, to which it is added if it is not there.
fn place_of<T: Copy, K: PartialEq>(all: &mut Vec<T>, thing: T, key: impl Fn(T) -> K) -> u16 {
    let place = all.iter().position(|&other| key(other) == key(thing));
    let place = place.unwrap_or_else(|| {
        all.push(thing);
        all.len() - 1
    });
    place as u16
}
