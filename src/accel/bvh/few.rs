//! Worlds of so few primitives that packets of rays are done sooner with all of them than with any tree: rays need neither go the same
//! way nor be sorted.

use super::leaf::Triangle;
use super::triangle::Plane;
use crate::geometry::{Opacity, Shape, Sphere, World};

/// What testing a ray against all primitives costs at most for it to be worth it, as measured, in tests of triangles: deep bounces cross
/// over at some 100, first ones at 60.
pub const MOST_TESTS: usize = 64;

/// Tests of triangles that the test of a sphere takes as long as, about.
const TESTS_OF_SPHERE: usize = 2;

/// A row that lanes pick a coordinate from: x, y, z.
pub type Choices = [f32; 8];

/// A triangle.
#[repr(C, align(32))]
pub struct Facet {
    /// Corners.
    pub corners: [Choices; 3],
    /// Its plane.
    pub plane: Plane,
    /// Mask.
    pub mask: u32,
    /// Geometry and primitive.
    pub ids: [u32; 2],
}

/// A sphere.
pub struct Ball {
    /// The sphere.
    pub sphere: Sphere,
    /// Mask.
    pub mask: u32,
    /// Geometry and primitive.
    pub ids: [u32; 2],
}

/// All primitives of a world.
pub struct Few {
    /// Triangles, those with area.
    pub facets: Vec<Facet>,
    /// Spheres.
    pub balls: Vec<Ball>,
}

impl Few {
    /// The primitives of a world; `None` if they are too many, or there is anything else than triangles and spheres at rest that no filter is
    /// asked about.
    pub fn new(world: &World) -> Option<Self> {
        if !world.instances().is_empty() {
            return None;
        }
        let mut few = Self {
            facets: Vec::new(),
            balls: Vec::new(),
        };
        for &id in world.root() {
            let geometry = world.geometry(id);
            if geometry.opacity == Opacity::Filtered || few.tests() + geometry.primitive_count() > MOST_TESTS {
                return None;
            }
            match &geometry.shape {
                Shape::Mesh(mesh) if !mesh.is_moving() => {
                    let triangles = (0..mesh.triangle_count()).map(|triangle| (id, mesh, triangle));
                    few.facets
                        .extend(triangles.filter_map(|triangle| Facet::new(triangle, geometry.mask)));
                }
                Shape::Spheres(spheres) => {
                    few.balls.extend((0..).zip(spheres).map(|(i, sphere)| Ball {
                        sphere: sphere.clone(),
                        mask: geometry.mask,
                        ids: [id.0, i],
                    }));
                }
                _ => return None,
            }
        }
        (few.tests() <= MOST_TESTS).then_some(few)
    }

    /// What testing a ray against all of them costs, in tests of triangles.
    pub fn tests(&self) -> usize {
        self.facets.len() + TESTS_OF_SPHERE * self.balls.len()
    }

    /// Bytes.
    pub fn memory(&self) -> usize {
        size_of_val(self.facets.as_slice()) + size_of_val(self.balls.as_slice())
    }
}

impl Facet {
    /// `None` without area.
    fn new((geometry, mesh, triangle): Triangle<'_>, mask: u32) -> Option<Self> {
        let positions = mesh.positions(0);
        let corners = mesh.indices()[triangle].map(|vertex| positions[vertex as usize].to_array());
        let plane = Plane::new(&corners);
        plane.has_area().then(|| Self {
            corners: corners.map(|[x, y, z]| [x, y, z, 0.0, 0.0, 0.0, 0.0, 0.0]),
            plane,
            mask,
            ids: [geometry.0, triangle as u32],
        })
    }

    /// The corners.
    pub fn points(&self) -> [[f32; 3]; 3] {
        self.corners.map(|[x, y, z, ..]| [x, y, z])
    }
}
