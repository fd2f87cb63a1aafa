//! Eight paths at surfaces of one kind: the kernel.

use std::marker::PhantomData;

use super::Paths;
use super::lobes::Lobes;
use crate::geometry::{Ray, RayLanes, RayPacket, Surfaces};
use crate::integrator::direct::Origin;
use crate::integrator::lane::LanePacket;
use crate::integrator::numbers::OneLobeLanes;
use crate::integrator::path::survival;
use crate::light::LightSampleLanes;
use crate::material::{LaneSample, LaneValue};
use crate::math::{Frame, Kernel, LANES, Lanes, Vec2, Vec3, Vec3Lanes, VectorLanes, offset_ray_origin};
use crate::sampling::{balance_heuristic, power_heuristic};
use crate::spectrum::SpectrumLanes;

/// Where they go from there. Shadow rays and paths are sent from the columns in which they are computed.
#[derive(Debug, Default)]
pub struct Scattered {
    /// Whether light was found that arrives if nothing is between, by which ray, and what it brings.
    pub connects: [bool; LANES],
    pub shadow_is_valid: [bool; LANES],
    pub shadow_rays: RayLanes,
    pub value: SpectrumLanes,
    /// Whether the path goes on, and by which ray.
    pub goes_on: [bool; LANES],
    pub next_is_valid: [bool; LANES],
    pub next_rays: RayLanes,
    pub beta: SpectrumLanes,
    /// Of the direction, by solid angle; negative if it is one of a delta lobe.
    pub pdf: Lanes,
    pub cone_width: Lanes,
}

/// Where paths go from surfaces with lobes of a kind.
pub struct Scatter<'a, L> {
    pub rays: &'a RayPacket,
    pub lanes: &'a LanePacket<Origin>,
    pub surfaces: &'a Surfaces,
    pub numbers: &'a OneLobeLanes<'a>,
    pub paths: &'a Paths,
    /// The points of lights that they have found.
    pub lights: &'a LightSampleLanes,
    /// Whether these are weighed by the power heuristic, or by the balance heuristic.
    pub is_power: bool,
    /// Scattering events before.
    pub depth: u32,
    /// Whether there can be any number.
    pub is_unlimited: bool,
    pub lobes: PhantomData<L>,
}

impl<L: Lobes> Kernel for Scatter<'_, L> {
    type Output = Scattered;

    #[inline(always)]
    fn call(self) -> Scattered {
        let mut scattered = Scattered::default();
        let places = Places::of(&self);
        if !L::IS_DELTA {
            for i in 0..LANES {
                self.connect(&mut scattered, i, &places);
            }
        }
        for i in 0..LANES {
            self.go_on(&mut scattered, i, &places);
        }
        scattered
    }
}

/// The frames of lobes, and the directions in them that paths came from.
struct Places {
    s: Vec3Lanes,
    t: Vec3Lanes,
    n: Vec3Lanes,
    wo: Vec3Lanes,
}

impl Places {
    #[inline(always)]
    fn of<L: Lobes>(scatter: &Scatter<'_, L>) -> Self {
        let n = scatter.surfaces.ns;
        let (mut s, mut t, mut wo) = (Vec3Lanes::default(), Vec3Lanes::default(), Vec3Lanes::default());
        for i in 0..LANES {
            let frame = L::frame(&scatter.paths.kinds, i, n.get(i));
            s.set(i, frame.s);
            t.set(i, frame.t);
            wo.set(i, frame.to_local(-scatter.rays.direction(i)));
        }
        Self { s, t, n, wo }
    }

    #[inline(always)]
    fn frame(&self, lane: usize) -> Frame {
        Frame {
            s: self.s.get(lane),
            t: self.t.get(lane),
            n: self.n.get(lane),
        }
    }
}

impl<L: Lobes> Scatter<'_, L> {
    /// What the light that a lane has found brings by way of the surface, and the ray there.
    #[inline(always)]
    fn connect(&self, scattered: &mut Scattered, i: usize, places: &Places) {
        let Self {
            surfaces,
            lights,
            paths,
            ..
        } = self;
        let (pdf, pmf) = (lights.pdf[i], paths.pmf[i]);
        let wi = lights.wi.get(i);
        let (wo, wi_local) = (places.wo.get(i), places.frame(i).to_local(wi));
        let LaneValue { value: bsdf, exists } = L::eval(&paths.kinds, i, wo, wi_local);
        scattered.connects[i] = (pdf > 0.0) & exists & !bsdf.f.is_black();
        let pdf_light = pmf * pdf;
        let weight = if self.is_power {
            power_heuristic(pdf_light, bsdf.pdf)
        } else {
            balance_heuristic(pdf_light, bsdf.pdf)
        };
        let weight = if lights.is_delta[i] { 1.0 } else { weight };
        let value = bsdf.f * wi_local.z.abs() * lights.li.get(i) * (1.0 / pmf / pdf);
        scattered.value.set(i, self.lanes.beta.get(i) * (value * weight));

        let (p, error, ng) = (surfaces.p.get(i), surfaces.error[i], surfaces.ng.get(i));
        let (to, time) = (lights.p.get(i), self.rays.time[i]);
        let is_infinite = lights.is_infinite[i];
        let origin = offset_ray_origin(p, error, ng, select(is_infinite, wi, to - p));
        let between = Ray::between(origin, to, lights.error[i], lights.ng.get(i), time);
        let direction = select(is_infinite, wi, between.direction);
        let tfar = if is_infinite { f32::INFINITY } else { between.tfar };
        let ray = Ray {
            tfar,
            ..Ray::new(origin, direction, time)
        };
        scattered.shadow_is_valid[i] = ray.is_valid();
        scattered.shadow_rays.set(i, origin, direction, tfar, time);
    }

    /// The direction that a path goes on in, and whether it survives.
    #[inline(always)]
    fn go_on(&self, scattered: &mut Scattered, i: usize, places: &Places) {
        let Self {
            lanes,
            surfaces,
            paths,
            numbers,
            ..
        } = self;
        let [u, v] = numbers.bsdf;
        let wo = places.wo.get(i);
        let LaneSample {
            wi,
            value: bsdf,
            exists,
        } = L::sample(&paths.kinds, i, wo, Vec2::new(u[i], v[i]));
        let weight = if L::IS_DELTA {
            bsdf.f
        } else {
            bsdf.f * (wi.z.abs() / bsdf.pdf)
        };
        let beta = lanes.beta.get(i) * weight;
        let direction = places.frame(i).to_world(wi).normalize();
        let throughput = beta.max_value() * lanes.eta_scale[i];
        let survival = survival(self.depth, throughput, self.is_unlimited);
        let survives = (survival >= 1.0) | (numbers.roulette[i] < survival);
        let thinned = if survival < 1.0 { 1.0 / survival } else { 1.0 };
        scattered.goes_on[i] = exists & (wo.z != 0.0) & (wi.z != 0.0) & !bsdf.f.is_black() & survives;
        scattered.beta.set(i, beta * thinned);
        scattered.pdf[i] = if L::IS_DELTA { -1.0 } else { bsdf.pdf };
        scattered.cone_width[i] = lanes.cone(i).after(surfaces.distance[i]).width;

        let (origin, time) = (
            offset_ray_origin(surfaces.p.get(i), surfaces.error[i], surfaces.ng.get(i), direction),
            self.rays.time[i],
        );
        scattered.next_is_valid[i] = Ray::new(origin, direction, time).is_valid();
        scattered.next_rays.set(i, origin, direction, f32::INFINITY, time);
    }
}

#[inline(always)]
fn select(condition: bool, a: Vec3, b: Vec3) -> Vec3 {
    let select = |a, b| if condition { a } else { b };
    Vec3::new(select(a.x, b.x), select(a.y, b.y), select(a.z, b.z))
}
