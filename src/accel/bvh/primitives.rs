//! What trees are built over.

use rayon::prelude::*;

use super::item::is_within_reach;
use super::node::{Child, ChildRef};
use crate::geometry::{GeometryId, PrimitiveId, Shape, TriangleMesh, World};
use crate::math::{Bounds3, Vec3};

/// How many there are of what: triangles are named first, then other primitives, then instances.
#[derive(Clone, Copy, Debug)]
pub struct Census {
    /// Triangles, as many of which as a block holds may share a leaf; all else has a leaf to itself.
    pub triangles: u32,
    /// Primitives that are no triangles.
    pub analytic: u32,
    /// Instances.
    pub instances: u32,
}

impl Census {
    /// All.
    pub fn count(&self) -> usize {
        self.triangles as usize + self.analytic as usize + self.instances as usize
    }

    /// The leaf of what is no triangle.
    pub fn child(&self, index: u32) -> ChildRef {
        let index = (index - self.triangles) as usize;
        ChildRef::new(match index.checked_sub(self.analytic as usize) {
            None => Child::Analytic(index),
            Some(instance) => Child::Instance(instance),
        })
    }
}

/// What a tree is built over, by number.
pub trait Primitives: Sync {
    /// Whether any [may be split](Self::corners).
    const SPLITS: bool;

    /// How many there are of what.
    fn census(&self) -> Census;

    /// A box around one.
    fn bounds(&self, index: u32) -> Bounds3;

    /// A box around all; it may be larger.
    fn bounds_of_all(&self) -> Bounds3;

    /// The corners of a triangle that may be split.
    fn corners(&self, index: u32) -> Option<[Vec3; 3]>;
}

/// Triangles of meshes, in the order of their geometries, then as primitives of these.
pub struct Triangles<'a> {
    meshes: Vec<(GeometryId, &'a TriangleMesh)>,
    /// Of each mesh, the number of its first triangle.
    first: Vec<u32>,
    count: u32,
}

impl<'a> Triangles<'a> {
    /// Those of some meshes of a world.
    pub fn new(world: &'a World, members: &[GeometryId], is_wanted: impl Fn(&TriangleMesh) -> bool) -> Self {
        let mut meshes: Vec<_> = members
            .iter()
            .filter_map(|&id| Some((id, mesh(world, id)?)))
            .filter(|(_, mesh)| is_wanted(mesh))
            .collect();
        meshes.sort_unstable_by_key(|(id, _)| *id);
        let mut count = 0;
        let first = meshes.iter().map(|(_, mesh)| {
            let first = number(count);
            count += mesh.triangle_count();
            first
        });
        Self {
            first: first.collect(),
            count: number(count),
            meshes,
        }
    }

    /// A box around all.
    fn bounds(&self) -> Bounds3 {
        let meshes = self.meshes.par_iter().map(|(_, mesh)| mesh.bounds());
        meshes.reduce(|| Bounds3::EMPTY, Bounds3::union)
    }

    /// How many.
    pub fn count(&self) -> u32 {
        self.count
    }

    /// The mesh that a triangle is of, and which of its triangles it is.
    #[inline(always)]
    pub fn find(&self, index: u32) -> (GeometryId, &'a TriangleMesh, usize) {
        let place = match self.first.len() {
            1 => 0,
            _ => self.first.partition_point(|&first| first <= index) - 1,
        };
        let (id, mesh) = self.meshes[place];
        (id, mesh, (index - self.first[place]) as usize)
    }
}

/// A number of things as they are counted here.
///
/// # Panics
/// If there are 2^32 - 1 or more: such a tree is larger than any memory.
fn number(count: usize) -> u32 {
    PrimitiveId::from_index(count).0
}

/// The mesh of a geometry that is one.
pub fn mesh(world: &World, id: GeometryId) -> Option<&TriangleMesh> {
    match &world.geometry(id).shape {
        Shape::Mesh(mesh) => Some(mesh),
        _ => None,
    }
}

/// What does not move: triangles, other primitives, and instances by the box of all that they sweep.
pub struct Fixed<'a> {
    /// The triangles.
    pub triangles: Triangles<'a>,
    /// The other primitives.
    pub analytic: Vec<(GeometryId, PrimitiveId)>,
    /// Boxes around those, which take longer to find than to keep.
    analytic_bounds: Vec<Bounds3>,
    instances: &'a [Bounds3],
}

impl<'a> Fixed<'a> {
    /// Those of some geometries of a world, and instances in their boxes.
    pub fn new(world: &'a World, members: &[GeometryId], instances: &'a [Bounds3]) -> Self {
        let of_shape = |&id: &GeometryId| {
            let shape = &world.geometry(id).shape;
            let count = if shape.is_analytic() {
                shape.primitive_count()
            } else {
                0
            };
            (0..count).map(move |primitive| (id, PrimitiveId::from_index(primitive)))
        };
        let analytic: Vec<_> = members.iter().flat_map(of_shape).collect();
        let bounds = |&(id, primitive): &(GeometryId, PrimitiveId)| {
            let shape = &world.geometry(id).shape;
            shape.primitive_bounds(primitive.index())
        };
        Self {
            triangles: Triangles::new(world, members, |mesh| !mesh.is_moving()),
            analytic_bounds: analytic.par_iter().map(bounds).collect(),
            analytic,
            instances,
        }
    }

    /// A box around what a leaf refers to that holds no triangles.
    pub fn leaf_bounds(&self, child: Child) -> Bounds3 {
        match child {
            Child::Analytic(index) => self.analytic_bounds[index],
            Child::Instance(index) => self.instances[index],
            Child::Node(_) | Child::Block(_) => Bounds3::EMPTY,
        }
    }
}

impl Primitives for Fixed<'_> {
    const SPLITS: bool = true;

    fn census(&self) -> Census {
        Census {
            triangles: self.triangles.count(),
            analytic: number(self.analytic.len()),
            instances: number(self.instances.len()),
        }
    }

    #[inline(always)]
    fn bounds(&self, index: u32) -> Bounds3 {
        if index < self.triangles.count() {
            let (_, mesh, triangle) = self.triangles.find(index);
            mesh.triangle_bounds(triangle, 0)
        } else {
            self.leaf_bounds(self.census().child(index).get())
        }
    }

    fn bounds_of_all(&self) -> Bounds3 {
        let others = self.triangles.count()..self.census().count() as u32;
        let bounds = others.into_par_iter().map(|index| self.bounds(index));
        let others = bounds.reduce(|| Bounds3::EMPTY, Bounds3::union);
        self.triangles.bounds().union(others)
    }

    #[inline(always)]
    fn corners(&self, index: u32) -> Option<[Vec3; 3]> {
        if index >= self.triangles.count() {
            return None;
        }
        let (_, mesh, triangle) = self.triangles.find(index);
        let positions = mesh.positions(0);
        let corners = mesh.indices()[triangle].map(|vertex| positions[vertex as usize]);
        is_within_reach(corners).then_some(corners)
    }
}

/// Triangles over a segment of time, each by the middle of its boxes at both ends.
pub struct Moving<'a> {
    /// The triangles.
    pub triangles: &'a Triangles<'a>,
    /// The segment.
    pub segment: usize,
}

/// The middle between two boxes.
pub fn between(start: Bounds3, end: Bounds3) -> Bounds3 {
    Bounds3 {
        min: start.min * 0.5 + end.min * 0.5,
        max: start.max * 0.5 + end.max * 0.5,
    }
}

impl Primitives for Moving<'_> {
    const SPLITS: bool = false;

    fn census(&self) -> Census {
        Census {
            triangles: self.triangles.count(),
            analytic: 0,
            instances: 0,
        }
    }

    #[inline(always)]
    fn bounds(&self, index: u32) -> Bounds3 {
        let (_, mesh, triangle) = self.triangles.find(index);
        let [start, end] = [0, 1].map(|end| mesh.triangle_bounds(triangle, self.segment + end));
        between(start, end)
    }

    fn bounds_of_all(&self) -> Bounds3 {
        self.triangles.bounds()
    }

    fn corners(&self, _index: u32) -> Option<[Vec3; 3]> {
        None
    }
}

#[cfg(test)]
pub mod tests {
    use super::*;

    /// Boxes as if they were around triangles.
    pub struct Boxes(Vec<Bounds3>);

    impl Boxes {
        pub fn new(boxes: impl IntoIterator<Item = [Vec3; 2]>) -> Self {
            Self(boxes.into_iter().map(|[min, max]| Bounds3 { min, max }).collect())
        }
    }

    impl Primitives for Boxes {
        const SPLITS: bool = false;

        fn census(&self) -> Census {
            Census {
                triangles: number(self.0.len()),
                analytic: 0,
                instances: 0,
            }
        }

        fn bounds(&self, index: u32) -> Bounds3 {
            self.0[index as usize]
        }

        fn bounds_of_all(&self) -> Bounds3 {
            self.0.iter().copied().fold(Bounds3::EMPTY, Bounds3::union)
        }

        fn corners(&self, _index: u32) -> Option<[Vec3; 3]> {
            None
        }
    }
}
