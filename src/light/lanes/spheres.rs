//! Spheres seen from outside.

use super::Points;
use crate::light::emitter::{Cone, sphere_point};
use crate::math::{DVec3, LANES, Lanes, Vec2, Vec3Lanes, VectorLanes};
use crate::sampling::warp;

/// A sphere.
#[derive(Clone, Copy, Debug)]
pub(in crate::light) struct SphereLight {
    pub center: DVec3,
    pub radius: f64,
    /// Whether its normal points inwards.
    pub inward: bool,
}

/// One for each lane.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Spheres {
    center: [[f64; LANES]; 3],
    radius: [f64; LANES],
    inward: [bool; LANES],
}

impl Spheres {
    pub fn set(&mut self, lane: usize, sphere: &SphereLight) {
        let [x, y, z] = &mut self.center;
        [x[lane], y[lane], z[lane]] = sphere.center.to_array();
        (self.radius[lane], self.inward[lane]) = (sphere.radius, sphere.inward);
    }

    #[inline(always)]
    fn center(&self, lane: usize) -> DVec3 {
        let [x, y, z] = &self.center;
        DVec3::new(x[lane], y[lane], z[lane])
    }

    /// Which of the `wanted` lanes see their sphere from outside, from the points `from`.
    #[inline]
    pub fn fit(&self, mut wanted: [bool; LANES], from: &Vec3Lanes) -> [bool; LANES] {
        for (i, wanted) in wanted.iter_mut().enumerate() {
            *wanted = *wanted && Cone::is_outside(from.get(i), self.center(i), self.radius[i]);
        }
        wanted
    }

    /// [`Emitter::sample`](crate::light::emitter::Emitter::sample) from the points `from`, outside.
    #[inline(always)]
    pub fn points(&self, from: &Vec3Lanes, [ux, uy]: [&Lanes; 2]) -> Points {
        let mut points = Points::default();
        for i in 0..LANES {
            let (center, radius) = (self.center(i), self.radius[i]);
            let cone = Cone::of(from.get(i), center, radius);
            let local = warp::sample_uniform_cone(Vec2::new(ux[i], uy[i]), cone.one_minus_cos);
            let outward = cone.surface_direction(local, radius);
            let pdf = warp::uniform_cone_pdf(cone.one_minus_cos);
            let point = sphere_point(center, radius, self.inward[i], outward, pdf);
            points.p.set(i, point.p);
            points.error[i] = point.error;
            points.ng.set(i, point.ng);
            points.pdf[i] = point.pdf.0;
        }
        points
    }
}
