//! The commonest scattering event, of eight paths at once: by Lambertian surfaces that do not emit.
//! The bits are those of [`PathIntegrator::scatter`], which takes the other paths.

use std::f32::consts::FRAC_1_PI;

use super::{PathIntegrator, PathStage, survival};
use crate::desc::{Heuristic, Strategy};
use crate::geometry::{Ray, RayPacket, Surfaces};
use crate::integrator::direct::Origin;
use crate::integrator::fault::Fault;
use crate::integrator::lane::{Lane, NO_SLOT, Slot};
use crate::integrator::numbers::EventLanes;
use crate::integrator::shadow::{Contribution, NO_NOTE};
use crate::integrator::stage::PacketVertices;
use crate::light::{ChosenLight, LightLanes, LightSampleLanes};
use crate::math::{Frame, Kernel, LANES, Lanes, Vec2, Vec3, Vec3Lanes, VectorLanes, Vectorizer, offset_ray_origin};
use crate::sampling::{SolidAnglePdf, balance_heuristic, power_heuristic, warp};
use crate::scene::Scene;
use crate::spectrum::{SampledSpectrum, SpectrumLanes};

/// What eight paths are computed with. Made once and used again and again.
#[derive(Debug, Default)]
pub(in crate::integrator) struct Together {
    vectorizer: Vectorizer,
    lights: LightLanes,
    paths: Paths,
}

/// The paths, at the surfaces that they have come to.
#[derive(Debug, Default)]
struct Paths {
    albedo: SpectrumLanes,
    beta: SpectrumLanes,
    eta_scale: Lanes,
    /// Of the light that each samples; 1 without.
    pmf: Lanes,
}

/// Where they go from there.
#[derive(Debug, Default)]
struct Scattered {
    /// Whether light was found that arrives if nothing is between.
    connects: [bool; LANES],
    shadow_is_valid: [bool; LANES],
    shadow_origin: Vec3Lanes,
    shadow_direction: Vec3Lanes,
    shadow_tfar: Lanes,
    /// What it brings.
    value: SpectrumLanes,
    goes_on: [bool; LANES],
    next_is_valid: [bool; LANES],
    origin: Vec3Lanes,
    direction: Vec3Lanes,
    beta: SpectrumLanes,
    /// Of the direction, by solid angle.
    pdf: Lanes,
}

impl PathIntegrator {
    /// Takes the paths of `packet` to their next events that are such as above, and says which those are.
    #[inline]
    pub(super) fn scatter_together(
        &self,
        stage: &mut PathStage<'_, '_>,
        packet: &PacketVertices<'_, Origin>,
    ) -> [bool; LANES] {
        // Of a path that has been split the order of what it brings would depend on the packets that its parts are in.
        let is_usual = self.strategy == Strategy::Mis && self.splitting == 1 && self.fault == Fault::None;
        if !is_usual || self.max_depth == Some(stage.depth) {
            return [false; LANES];
        }
        let Together {
            vectorizer,
            lights,
            paths,
        } = &mut *stage.memory;
        let (taken, chosen) = paths.gather(stage.scene, stage.slots, packet);
        if taken == [false; LANES] {
            return taken;
        }
        let surfaces = packet.surfaces.all();
        let lights = &lights.sample(&chosen, &surfaces.p, &packet.rays.time, packet.numbers.light());
        let scattered = vectorizer.run(Scatter {
            rays: packet.rays,
            surfaces,
            numbers: packet.numbers,
            paths,
            lights,
            is_power: self.heuristic == Heuristic::Power,
            depth: stage.depth,
            is_unlimited: self.max_depth.is_none(),
        });
        for (i, lane) in packet.lanes.iter().enumerate() {
            if taken[i] {
                scattered.send(stage, packet, i, lane);
            }
        }
        taken
    }
}

impl Paths {
    /// Takes up the paths of `packet` that are at Lambertian surfaces; says which those are, and the light that each is to sample.
    #[inline]
    fn gather<'a>(
        &mut self,
        scene: &'a Scene,
        slots: &'a [Slot],
        packet: &PacketVertices<'_, Origin>,
    ) -> ([bool; LANES], [Option<ChosenLight<'a>>; LANES]) {
        let surfaces = packet.surfaces.all();
        let (mut taken, mut chosen) = ([false; LANES], [None; LANES]);
        for (i, lane) in packet.lanes.iter().enumerate() {
            if lane.slot == NO_SLOT || !packet.rays.is_active(i) {
                continue;
            }
            let Some(hit) = packet.hits.get(i) else { continue };
            let Some(reflectance) = scene.lambertian(hit) else {
                continue;
            };
            let lambda = &slots[lane.slot as usize].lambda;
            let albedo = match reflectance.constant() {
                Some(spectrum) => spectrum.sample(lambda),
                None => reflectance.reflectance_at(&packet.surface(i, hit), lambda),
            };
            taken[i] = true;
            self.albedo.set(i, albedo);
            self.beta.set(i, lane.beta);
            self.eta_scale[i] = lane.eta_scale;
            let (p, n) = (surfaces.p.get(i), surfaces.ns.get(i));
            let light = scene.light_sampler().sample(p, n, packet.numbers.which_light()[i]);
            self.pmf[i] = light.map_or(1.0, |light| light.pmf);
            chosen[i] = light.map(|light| (light.light, scene.light(light.light), lambda));
        }
        (taken, chosen)
    }
}

impl Scattered {
    /// Sends a path on its way, and a shadow ray.
    #[inline]
    fn send(&self, stage: &mut PathStage<'_, '_>, packet: &PacketVertices<'_, Origin>, i: usize, lane: &Lane<Origin>) {
        let time = packet.rays.time[i];
        if self.connects[i] {
            let ray = Ray {
                tfar: self.shadow_tfar[i],
                ..Ray::new(self.shadow_origin.get(i), self.shadow_direction.get(i), time)
            };
            let (slot, note) = (lane.slot, NO_NOTE);
            let value = self.value.get(i);
            stage.add_unless_occluded_if(self.shadow_is_valid[i], &ray, Contribution { slot, note, value });
        }
        if !self.goes_on[i] {
            return;
        }
        let surfaces = packet.surfaces.all();
        let next = Lane {
            beta: self.beta.get(i),
            cone: packet.cone(i),
            state: Origin::Sampled {
                p: surfaces.p.get(i),
                n: surfaces.ns.get(i),
                pdf: SolidAnglePdf(self.pdf[i]),
            },
            ..*lane
        };
        let ray = Ray::new(self.origin.get(i), self.direction.get(i), time);
        stage.go_on_if(self.next_is_valid[i], &next, &ray);
    }
}

/// See [`PathIntegrator::scatter_together`].
struct Scatter<'a> {
    rays: &'a RayPacket,
    surfaces: &'a Surfaces,
    numbers: &'a EventLanes,
    paths: &'a Paths,
    lights: &'a LightSampleLanes,
    is_power: bool,
    depth: u32,
    is_unlimited: bool,
}

impl Kernel for Scatter<'_> {
    type Output = Scattered;

    #[inline(always)]
    fn call(self) -> Scattered {
        let mut scattered = Scattered::default();
        for i in 0..LANES {
            let n = self.surfaces.ns.get(i);
            let wo = -self.rays.direction(i);
            let cos_o = wo.dot(n);
            let f = self.paths.albedo.get(i) * FRAC_1_PI;
            self.connect(&mut scattered, i, cos_o, f);
            self.go_on(&mut scattered, i, cos_o, f);
        }
        scattered
    }
}

impl Scatter<'_> {
    /// What the light that a lane has found brings by way of the surface, and the ray there.
    #[inline(always)]
    fn connect(&self, scattered: &mut Scattered, i: usize, cos_o: f32, f: SampledSpectrum) {
        let (surfaces, lights, pmf) = (self.surfaces, self.lights, self.paths.pmf[i]);
        let wi = lights.wi.get(i);
        let cos_i = wi.dot(surfaces.ns.get(i));
        let pdf = lights.pdf[i];
        scattered.connects[i] = (pdf > 0.0) & (cos_o * cos_i > 0.0) & !f.is_black();
        let cos = cos_i.abs();
        let (pdf_light, pdf_scatter) = (pmf * pdf, cos * FRAC_1_PI);
        let weight = if self.is_power {
            power_heuristic(pdf_light, pdf_scatter)
        } else {
            balance_heuristic(pdf_light, pdf_scatter)
        };
        let weight = if lights.is_delta[i] { 1.0 } else { weight };
        let value = f * cos * lights.li.get(i) * (1.0 / pmf / pdf);
        scattered.value.set(i, self.paths.beta.get(i) * (value * weight));

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
        scattered.shadow_origin.set(i, origin);
        scattered.shadow_direction.set(i, direction);
        scattered.shadow_tfar[i] = tfar;
    }

    /// The direction that a path goes on in, and whether it survives.
    #[inline(always)]
    fn go_on(&self, scattered: &mut Scattered, i: usize, cos_o: f32, f: SampledSpectrum) {
        let surfaces = self.surfaces;
        let [u, v] = self.numbers.bsdf();
        let mut local = warp::sample_cosine_hemisphere(Vec2::new(u[i], v[i]));
        local.z = if cos_o < 0.0 { -local.z } else { local.z };
        let cos = local.z.abs();
        let pdf = cos * FRAC_1_PI;
        let beta = self.paths.beta.get(i) * (f * (cos / pdf));
        let direction = Frame::from_normal(surfaces.ns.get(i)).to_world(local).normalize();
        let throughput = beta.max_value() * self.paths.eta_scale[i];
        let survival = survival(self.depth, throughput, self.is_unlimited);
        let survives = (survival >= 1.0) | (self.numbers.roulette()[i] < survival);
        let thinned = if survival < 1.0 { 1.0 / survival } else { 1.0 };
        scattered.goes_on[i] = (cos_o != 0.0) & (local.z != 0.0) & !f.is_black() & survives;
        scattered.beta.set(i, beta * thinned);
        scattered.pdf[i] = pdf;

        let origin = offset_ray_origin(surfaces.p.get(i), surfaces.error[i], surfaces.ng.get(i), direction);
        scattered.next_is_valid[i] = Ray::new(origin, direction, self.rays.time[i]).is_valid();
        scattered.origin.set(i, origin);
        scattered.direction.set(i, direction);
    }
}

#[inline(always)]
fn select(condition: bool, a: Vec3, b: Vec3) -> Vec3 {
    let select = |a, b| if condition { a } else { b };
    Vec3::new(select(a.x, b.x), select(a.y, b.y), select(a.z, b.z))
}
