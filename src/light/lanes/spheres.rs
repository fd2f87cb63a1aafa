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

    /// Sine and cosine of the turns `u`, which no vector has, in some lanes.
    #[inline]
    pub fn turns(&self, lanes: [bool; LANES], u: &Lanes) -> [Lanes; 2] {
        let (mut sin, mut cos) = ([0.0; LANES], [0.0; LANES]);
        for i in 0..LANES {
            if lanes[i] {
                (sin[i], cos[i]) = warp::sin_cos_of_turn(u[i]);
            }
        }
        [sin, cos]
    }

    /// [`Emitter::sample`](crate::light::emitter::Emitter::sample) from the points `from`, outside, for the numbers `u` and [`Self::turns`].
    #[inline(always)]
    pub fn points(&self, from: &Vec3Lanes, u: &Lanes, [sin, cos]: &[Lanes; 2]) -> Points {
        let mut points = Points::default();
        for i in 0..LANES {
            let (center, radius) = (self.center(i), self.radius[i]);
            let cone = Cone::of(from.get(i), center, radius);
            let local = warp::direction_of_cone(u[i], Vec2::new(sin[i], cos[i]), cone.one_minus_cos);
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
