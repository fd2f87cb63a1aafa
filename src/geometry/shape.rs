//! What a geometry is made of, and what all kinds of shapes can say about their primitives.

use super::{CurveSet, PatchMesh, Quadric, Sphere, TriangleMesh, TubeSet};
use crate::math::{Bounds3, DVec3};

/// What a geometry is made of.
#[derive(Clone, Debug)]
pub enum Shape {
    /// A triangle mesh; primitive ids are triangle indices.
    Mesh(TriangleMesh),
    /// Spheres; primitive ids are their indices.
    Spheres(Vec<Sphere>),
    /// Parts of spheres, cylinders and disks; primitive ids are their indices.
    Quadrics(Vec<Quadric>),
    /// Bilinear patches; primitive ids are their indices.
    Patches(PatchMesh),
    /// Curves; primitive ids are those of parts of their segments.
    Curves(CurveSet),
    /// Round curves; primitive ids are those of their pieces.
    Tubes(TubeSet),
}

/// Where the line of a ray meets a primitive, in units of the ray's direction: at most two places, the nearer first. Of a curve only
/// what is in front of the ray's origin counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineHits {
    /// NaN for none.
    distances: [f64; 2],
}

impl LineHits {
    /// No place.
    pub const NONE: Self = Self {
        distances: [f64::NAN; 2],
    };

    /// Those of two distances that there are.
    pub fn new(a: Option<f64>, b: Option<f64>) -> Self {
        let [a, b] = [a, b].map(|t| t.unwrap_or(f64::NAN));
        Self {
            distances: if b < a { [b, a] } else { [a, b] },
        }
    }

    /// The distances in order.
    #[inline]
    pub fn iter(self) -> impl Iterator<Item = f64> {
        self.distances.into_iter().filter(|t| !t.is_nan())
    }

    /// The first one that is not before `tnear`, else the last.
    #[inline]
    pub fn from(self, tnear: f64) -> Option<f64> {
        self.iter().find(|t| *t >= tnear).or_else(|| self.iter().last())
    }
}

impl Shape {
    /// Number of primitives.
    pub fn primitive_count(&self) -> usize {
        match self {
            Self::Mesh(mesh) => mesh.triangle_count(),
            Self::Spheres(spheres) => spheres.len(),
            Self::Quadrics(quadrics) => quadrics.len(),
            Self::Patches(mesh) => mesh.patch_count(),
            Self::Curves(curves) => curves.primitive_count(),
            Self::Tubes(tubes) => tubes.pieces().len(),
        }
    }

    /// A box around it over all times, in the space of its group.
    pub fn bounds(&self) -> Bounds3 {
        match self {
            Self::Mesh(mesh) => mesh.bounds(),
            _ => (0..self.primitive_count())
                .map(|primitive| self.primitive_bounds(primitive))
                .fold(Bounds3::EMPTY, Bounds3::union),
        }
    }

    /// A box around one primitive, of a mesh at scene time 0. Empty if there is no such primitive.
    pub fn primitive_bounds(&self, primitive: usize) -> Bounds3 {
        if primitive >= self.primitive_count() {
            return Bounds3::EMPTY;
        }
        match self {
            Self::Mesh(mesh) => mesh.triangle_bounds(primitive, 0),
            Self::Spheres(spheres) => spheres[primitive].bounds(),
            Self::Quadrics(quadrics) => quadrics[primitive].bounds(),
            Self::Patches(mesh) => mesh.patch(primitive).bounds(),
            Self::Curves(curves) => curves.primitive_bounds(primitive),
            Self::Tubes(tubes) => tubes.piece_bounds(primitive),
        }
    }

    /// Whether every backend tests its primitives one by one, in double precision, by [`Shape::line_hits`].
    #[inline]
    pub fn is_analytic(&self) -> bool {
        !matches!(self, Self::Mesh(_))
    }

    /// Where a line meets a primitive of an [analytic](Shape::is_analytic) shape; of any other, or of a primitive that there is not,
    /// nowhere.
    #[inline]
    pub fn line_hits(&self, primitive: usize, origin: DVec3, direction: DVec3) -> LineHits {
        match self {
            Self::Mesh(_) => LineHits::NONE,
            Self::Spheres(spheres) => spheres
                .get(primitive)
                .and_then(|sphere| sphere.intersect(origin, direction))
                .map_or(LineHits::NONE, |hits| LineHits::new(Some(hits.enter), Some(hits.leave))),
            Self::Quadrics(quadrics) => quadrics
                .get(primitive)
                .map_or(LineHits::NONE, |quadric| quadric.intersect(origin, direction)),
            Self::Patches(mesh) if primitive < mesh.patch_count() => {
                let [a, b] = mesh.patch(primitive).intersect(origin, direction);
                LineHits::new(a.map(|hit| hit.t), b.map(|hit| hit.t))
            }
            Self::Curves(curves) if primitive < curves.primitive_count() => {
                curves.intersect(primitive, origin, direction)
            }
            Self::Tubes(tubes) if primitive < tubes.pieces().len() => tubes.intersect(primitive, origin, direction),
            Self::Patches(_) | Self::Curves(_) | Self::Tubes(_) => LineHits::NONE,
        }
    }

    /// Bytes of its arrays.
    pub fn memory(&self) -> usize {
        match self {
            Self::Mesh(mesh) => mesh.memory(),
            Self::Spheres(spheres) => size_of_val(spheres.as_slice()),
            Self::Quadrics(quadrics) => size_of_val(quadrics.as_slice()),
            Self::Patches(mesh) => mesh.memory(),
            Self::Curves(curves) => curves.memory(),
            Self::Tubes(tubes) => tubes.memory(),
        }
    }
}
