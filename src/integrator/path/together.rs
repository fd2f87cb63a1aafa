//! The commonest scattering event, of eight paths at once: by Lambertian surfaces that do not emit. Paths that leave a scene without
//! an environment end here too.
//! The bits are those of [`PathIntegrator::scatter`], which takes the other paths.

use std::f32::consts::FRAC_1_PI;

use super::{FIRST_ROULETTE_DEPTH, PathIntegrator, PathStage, survival};
use crate::desc::{Heuristic, Strategy};
use crate::geometry::{Ray, RayLanes, RayPacket, Surfaces};
use crate::integrator::direct::Origin;
use crate::integrator::fault::Fault;
use crate::integrator::lane::{LanePacket, Slot};
use crate::integrator::numbers::LambertianLanes;
use crate::integrator::shadow::{ContributionLanes, NO_NOTE};
use crate::integrator::stage::PacketVertices;
use crate::light::{ChosenLight, LightLanes, LightSampleLanes, SampledLight};
use crate::math::{
    Columns, Frame, Kernel, LANES, LaneSet, Lanes, Packing, Shuffle, Vec2, Vec3, VectorLanes, Vectorizer,
    offset_ray_origin,
};
use crate::sampling::{balance_heuristic, power_heuristic, warp};
use crate::scene::Scene;
use crate::spectrum::{SampledSpectrum, SpectrumLanes, Wavelengths};

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
    /// Of the light that each samples; 1 without.
    pmf: Lanes,
}

/// Where they go from there. Shadow rays and paths are sent from the columns in which they are computed.
#[derive(Debug, Default)]
struct Scattered {
    /// Whether light was found that arrives if nothing is between, by which ray, and what it brings.
    connects: [bool; LANES],
    shadow_is_valid: [bool; LANES],
    shadow_rays: RayLanes,
    value: SpectrumLanes,
    /// Whether the path goes on, and by which ray.
    goes_on: [bool; LANES],
    next_is_valid: [bool; LANES],
    next_rays: RayLanes,
    beta: SpectrumLanes,
    /// Of the direction, by solid angle.
    pdf: Lanes,
    cone_width: Lanes,
}

impl PathIntegrator {
    /// Takes the paths of `packet` to their next events that are such as above, or into the dark, and says which those are.
    #[inline]
    pub(super) fn scatter_together(
        &self,
        stage: &mut PathStage<'_, '_>,
        packet: &PacketVertices<'_, Origin>,
    ) -> LaneSet {
        // Of a path that has been split the order of what it brings would depend on the packets that its parts are in.
        let is_usual = self.strategy == Strategy::Mis && self.splitting == 1 && self.fault == Fault::None;
        if !is_usual || self.max_depth == Some(stage.depth) {
            return LaneSet::NONE;
        }
        let (scene, slots) = (stage.scene, &*stage.slots);
        let hit = packet.hits.hit_lanes();
        let ended = if scene.has_environment() {
            LaneSet::NONE
        } else {
            packet.active.without(hit)
        };
        let Together {
            vectorizer,
            lights,
            paths,
        } = &mut *stage.memory;
        let taken = paths.gather(scene, slots, packet);
        if taken.is_empty() {
            return ended;
        }
        let (surfaces, only_light) = (packet.surfaces.all(), scene.light_sampler().only());
        let may_end = stage.depth >= FIRST_ROULETTE_DEPTH;
        let has_others = !packet.active.and(hit).without(taken).is_empty();
        let numbers = &packet.numbers.lambertian(only_light.is_none(), may_end, has_others);
        match only_light {
            Some(SampledLight { light, pmf })
                if lights.sample_one(light, scene.light(light), &surfaces.p, numbers.light()) =>
            {
                paths.pmf = [pmf; LANES];
            }
            _ => {
                let chosen = paths.choose_lights(scene, slots, packet, taken, numbers.which_light());
                lights.sample(&chosen, &surfaces.p, &packet.rays.time, numbers.light());
            }
        }
        let scattered = vectorizer.run(Scatter {
            rays: packet.rays,
            lanes: packet.lanes,
            surfaces,
            numbers,
            paths,
            lights: lights.samples(),
            is_power: self.heuristic == Heuristic::Power,
            depth: stage.depth,
            is_unlimited: self.max_depth.is_none(),
        });
        scattered.send(stage, packet, taken);
        taken.or(ended)
    }
}

impl Scattered {
    /// Sends the paths that were taken on their way, and shadow rays.
    #[inline(always)]
    fn send(&self, stage: &mut PathStage<'_, '_>, packet: &PacketVertices<'_, Origin>, taken: LaneSet) {
        let (lanes, surfaces, scattered) = (packet.lanes, packet.surfaces.all(), self);
        let (connects, goes_on) = (taken.and(self.connects.into()), taken.and(self.goes_on.into()));
        let (shadow_is_valid, next_is_valid) = (self.shadow_is_valid.into(), self.next_is_valid.into());
        stage.note_broken(connects.without(shadow_is_valid), lanes);
        stage.note_broken(goes_on.without(next_is_valid), lanes);
        let connected = Connected { lanes, scattered };
        stage.add_unless_occluded_together(connects.and(shadow_is_valid), &self.shadow_rays, &connected);
        let next = Next {
            lanes,
            surfaces,
            scattered,
        };
        stage.go_on_together(goes_on.and(next_is_valid), &self.next_rays, &next, lanes);
    }
}

/// What lights bring to paths.
struct Connected<'a> {
    lanes: &'a LanePacket<Origin>,
    scattered: &'a Scattered,
}

impl Columns<ContributionLanes> for Connected<'_> {
    #[inline(always)]
    fn pack<S: Shuffle>(&self, packing: &Packing<S>, last: &mut ContributionLanes, next: &mut ContributionLanes) {
        self.lanes.slot.pack(packing, &mut last.slot, &mut next.slot);
        packing.fill(NO_NOTE, &mut last.note, &mut next.note);
        self.scattered.value.pack(packing, &mut last.value, &mut next.value);
    }
}

/// Paths after their events.
struct Next<'a> {
    lanes: &'a LanePacket<Origin>,
    surfaces: &'a Surfaces,
    scattered: &'a Scattered,
}

impl Columns<LanePacket<Origin>> for Next<'_> {
    #[inline(always)]
    fn pack<S: Shuffle>(&self, packing: &Packing<S>, last: &mut LanePacket<Origin>, next: &mut LanePacket<Origin>) {
        let Self {
            lanes,
            surfaces,
            scattered,
        } = self;
        lanes.slot.pack(packing, &mut last.slot, &mut next.slot);
        lanes.split.pack(packing, &mut last.split, &mut next.split);
        lanes.streams.pack(packing, &mut last.streams, &mut next.streams);
        lanes.eta_scale.pack(packing, &mut last.eta_scale, &mut next.eta_scale);
        lanes
            .cone_spread
            .pack(packing, &mut last.cone_spread, &mut next.cone_spread);
        scattered.beta.pack(packing, &mut last.beta, &mut next.beta);
        scattered
            .cone_width
            .pack(packing, &mut last.cone_width, &mut next.cone_width);
        surfaces.p.pack(packing, &mut last.states.p, &mut next.states.p);
        surfaces.ns.pack(packing, &mut last.states.n, &mut next.states.n);
        scattered.pdf.pack(packing, &mut last.states.pdf, &mut next.states.pdf);
    }
}

impl Paths {
    /// Takes up the paths of `packet` that are at Lambertian surfaces; says which those are.
    #[inline]
    fn gather(&mut self, scene: &Scene, slots: &[Slot], packet: &PacketVertices<'_, Origin>) -> LaneSet {
        let mut taken = [false; LANES];
        for i in packet.active.lanes() {
            let known = scene.known_albedo(packet.hits.geometry[i]);
            let albedo = known.or_else(|| {
                let lambda = &slots[packet.lanes.slot[i] as usize].lambda;
                albedo_of_hit(scene, packet, i, lambda)
            });
            if let Some(albedo) = albedo {
                self.albedo.set(i, albedo);
                taken[i] = true;
            }
        }
        taken.into()
    }

    /// The light that each path is to sample.
    #[inline]
    fn choose_lights<'a>(
        &mut self,
        scene: &'a Scene,
        slots: &'a [Slot],
        packet: &PacketVertices<'_, Origin>,
        taken: LaneSet,
        which_light: &Lanes,
    ) -> [Option<ChosenLight<'a>>; LANES] {
        let surfaces = packet.surfaces.all();
        let mut chosen = [None; LANES];
        for i in taken.lanes() {
            let (p, n) = (surfaces.p.get(i), surfaces.ns.get(i));
            let light = scene.light_sampler().sample(p, n, which_light[i]);
            self.pmf[i] = light.map_or(1.0, |light| light.pmf);
            let lambda = &slots[packet.lanes.slot[i] as usize].lambda;
            chosen[i] = light.map(|light| (light.light, scene.light(light.light), lambda));
        }
        chosen
    }
}

/// The reflectance of what a lane hit, if it is Lambertian and no light.
#[inline]
fn albedo_of_hit(
    scene: &Scene,
    packet: &PacketVertices<'_, Origin>,
    lane: usize,
    lambda: &Wavelengths,
) -> Option<SampledSpectrum> {
    let hit = packet.hits.get(lane)?;
    let reflectance = scene.lambertian(hit)?;
    Some(match reflectance.constant() {
        Some(spectrum) => spectrum.sample(lambda),
        None => reflectance.reflectance_at(&packet.surface(lane, hit), lambda),
    })
}

/// See [`PathIntegrator::scatter_together`].
struct Scatter<'a> {
    rays: &'a RayPacket,
    lanes: &'a LanePacket<Origin>,
    surfaces: &'a Surfaces,
    numbers: &'a LambertianLanes,
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
    fn go_on(&self, scattered: &mut Scattered, i: usize, cos_o: f32, f: SampledSpectrum) {
        let (surfaces, lanes) = (self.surfaces, self.lanes);
        let [u, v] = self.numbers.bsdf();
        let mut local = warp::sample_cosine_hemisphere(Vec2::new(u[i], v[i]));
        local.z = if cos_o < 0.0 { -local.z } else { local.z };
        let cos = local.z.abs();
        let pdf = cos * FRAC_1_PI;
        let beta = lanes.beta.get(i) * (f * (cos / pdf));
        let direction = Frame::from_normal(surfaces.ns.get(i)).to_world(local).normalize();
        let throughput = beta.max_value() * lanes.eta_scale[i];
        let survival = survival(self.depth, throughput, self.is_unlimited);
        let survives = (survival >= 1.0) | (self.numbers.roulette()[i] < survival);
        let thinned = if survival < 1.0 { 1.0 / survival } else { 1.0 };
        scattered.goes_on[i] = (cos_o != 0.0) & (local.z != 0.0) & !f.is_black() & survives;
        scattered.beta.set(i, beta * thinned);
        scattered.pdf[i] = pdf;
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
