//! Triangles and parallelograms.

use super::Points;
use crate::light::emitter::{area_to_solid_angle, plane_point};
use crate::math::{LANES, Lanes, Vec2, Vec3, Vec3Lanes, VectorLanes};
use crate::sampling::AreaPdf;

/// A triangle or a parallelogram.
#[derive(Clone, Copy, Debug)]
pub(in crate::light) struct PlaneLight {
    /// Whether it is a triangle with these corners; if not, it has a corner here and two edges from there.
    pub is_triangle: bool,
    pub vectors: [Vec3; 3],
    /// Unit geometric normal.
    pub ng: Vec3,
    /// See [`LightEnd::Point`](crate::light::LightEnd::Point).
    pub error: f32,
    /// Of a point of it.
    pub pdf: AreaPdf,
}

/// One for each lane.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Planes {
    is_triangle: [bool; LANES],
    vectors: [Vec3Lanes; 3],
    ng: Vec3Lanes,
    error: Lanes,
    pdf: Lanes,
}

impl Planes {
    pub fn set(&mut self, lane: usize, plane: &PlaneLight) {
        self.is_triangle[lane] = plane.is_triangle;
        for i in 0..3 {
            self.vectors[i].set(lane, plane.vectors[i]);
        }
        self.ng.set(lane, plane.ng);
        (self.error[lane], self.pdf[lane]) = (plane.error, plane.pdf.0);
    }

    /// [`Emitter::sample`](crate::light::emitter::Emitter::sample) from the points `from`.
    #[inline(always)]
    pub fn points(&self, from: &Vec3Lanes, [ux, uy]: [&Lanes; 2]) -> Points {
        let mut points = Points::default();
        for i in 0..LANES {
            let vectors = [self.vectors[0].get(i), self.vectors[1].get(i), self.vectors[2].get(i)];
            let ng = self.ng.get(i);
            let (p, _) = plane_point(&vectors, self.is_triangle[i], Vec2::new(ux[i], uy[i]));
            points.p.set(i, p);
            points.error[i] = self.error[i];
            points.ng.set(i, ng);
            points.pdf[i] = area_to_solid_angle(AreaPdf(self.pdf[i]), from.get(i), p, ng).0;
        }
        points
    }
}
