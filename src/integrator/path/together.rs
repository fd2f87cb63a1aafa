//! The commonest scattering events, of eight paths at once: by Lambertian surfaces and by conductors.
//! The bits are those of [`PathIntegrator::scatter`], which takes the other paths.

mod lobes;

use std::marker::PhantomData;

use super::{PathIntegrator, PathStage, survival};
use crate::desc::{Heuristic, Strategy};
use crate::geometry::{Hit, Ray, RayPacket, Surfaces};
use crate::integrator::direct::{DirectLight, Origin};
use crate::integrator::fault::Fault;
use crate::integrator::lane::{Lane, NO_SLOT, Slot};
use crate::integrator::numbers::EventLanes;
use crate::integrator::shadow::{Contribution, NO_NOTE};
use crate::integrator::stage::PacketVertices;
use crate::light::{ChosenLight, LightLanes, LightSampleLanes};
use crate::material::{LaneSample, LaneValue};
use crate::math::{Frame, Kernel, LANES, Lanes, Vec2, Vec3, Vec3Lanes, VectorLanes, Vectorizer, offset_ray_origin};
use crate::sampling::{SolidAnglePdf, balance_heuristic, power_heuristic};
use crate::scene::Scene;
use crate::spectrum::SpectrumLanes;
use lobes::{Kind, KindLanes, Lambertian, Lobes, Mirror, RoughConductor};

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
    kinds: KindLanes,
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
    /// Whether by delta lobes.
    is_delta: bool,
    /// Of the direction, by solid angle, if not.
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
        if !is_usual {
            return [false; LANES];
        }
        if self.max_depth == Some(stage.depth) {
            return at_dark_ends(stage.scene, packet);
        }
        let Together { lights, paths, .. } = &mut *stage.memory;
        let (kinds, chosen) = paths.gather(&self.direct_light(), stage.scene, stage.slots, packet);
        if kinds == [None; LANES] {
            return [false; LANES];
        }
        let surfaces = packet.surfaces.all();
        let lights = &lights.sample(&chosen, &surfaces.p, &packet.rays.time, packet.numbers.light());
        let of = |kind| kinds.map(|of_lane| of_lane == Some(kind));
        self.send::<Lambertian>(stage, packet, lights, of(Kind::Lambertian));
        self.send::<RoughConductor<false>>(stage, packet, lights, of(Kind::Ggx));
        self.send::<RoughConductor<true>>(stage, packet, lights, of(Kind::Beckmann));
        self.send::<Mirror>(stage, packet, lights, of(Kind::Mirror));
        kinds.map(|kind| kind.is_some())
    }

    /// Sends the chosen lanes, which are at surfaces with such lobes, on their ways.
    #[inline]
    fn send<L: Lobes>(
        &self,
        stage: &mut PathStage<'_, '_>,
        packet: &PacketVertices<'_, Origin>,
        lights: &LightSampleLanes,
        chosen: [bool; LANES],
    ) {
        if chosen == [false; LANES] {
            return;
        }
        let Together { vectorizer, paths, .. } = &*stage.memory;
        let scattered = vectorizer.run(Scatter::<L> {
            rays: packet.rays,
            surfaces: packet.surfaces.all(),
            numbers: packet.numbers,
            paths,
            lights,
            is_power: self.heuristic == Heuristic::Power,
            depth: stage.depth,
            is_unlimited: self.max_depth.is_none(),
            lobes: PhantomData,
        });
        for (i, lane) in packet.lanes.iter().enumerate() {
            if chosen[i] {
                scattered.send(stage, packet, i, lane);
            }
        }
    }
}

/// Which paths have nothing more to bring after their last scattering event, as nothing emits where they are.
fn at_dark_ends(scene: &Scene, packet: &PacketVertices<'_, Origin>) -> [bool; LANES] {
    let mut ends = [false; LANES];
    for (i, lane) in packet.lanes.iter().enumerate() {
        let is_dark = |hit: Hit| scene.light_of(hit.geometry, hit.primitive).is_none();
        ends[i] = lane.slot != NO_SLOT && packet.hits.get(i).is_some_and(is_dark);
    }
    ends
}

impl Paths {
    /// Takes up the paths of `packet` that are at surfaces of some kind, and adds what these emit; says which kind, and the light that
    /// each is to sample.
    #[inline]
    fn gather<'a>(
        &mut self,
        direct_light: &DirectLight,
        scene: &'a Scene,
        slots: &'a mut [Slot],
        packet: &PacketVertices<'_, Origin>,
    ) -> ([Option<Kind>; LANES], [Option<ChosenLight<'a>>; LANES]) {
        let (mut kinds, mut chosen) = ([None; LANES], [None; LANES]);
        for (i, lane) in packet.lanes.iter().enumerate() {
            if lane.slot == NO_SLOT || !packet.rays.is_active(i) {
                continue;
            }
            let Some(hit) = packet.hits.get(i) else { continue };
            let slot = &mut slots[lane.slot as usize];
            let surface = || packet.surface(i, hit);
            kinds[i] = self.kinds.set(i, scene.material(hit.geometry), surface, &slot.lambda);
            if kinds[i].is_none() {
                continue;
            }
            self.beta.set(i, lane.beta);
            self.eta_scale[i] = lane.eta_scale;
            if scene.light_of(hit.geometry, hit.primitive).is_some()
                && let Some(le) = direct_light.emission(scene, &lane.state, &surface(), &slot.lambda)
            {
                slot.l += lane.beta * le;
            }
        }
        let (slots, surfaces): (&'a [Slot], _) = (slots, packet.surfaces.all());
        for (i, lane) in packet.lanes.iter().enumerate() {
            if kinds[i].is_none_or(Kind::is_delta) {
                continue;
            }
            let (p, n) = (surfaces.p.get(i), surfaces.ns.get(i));
            let light = scene.light_sampler().sample(p, n, packet.numbers.which_light()[i]);
            self.pmf[i] = light.map_or(1.0, |light| light.pmf);
            chosen[i] = light.map(|light| {
                let lambda = &slots[lane.slot as usize].lambda;
                (light.light, scene.light(light.light), lambda)
            });
        }
        (kinds, chosen)
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
            state: if self.is_delta {
                Origin::Delta
            } else {
                Origin::Sampled {
                    p: surfaces.p.get(i),
                    n: surfaces.ns.get(i),
                    pdf: SolidAnglePdf(self.pdf[i]),
                }
            },
            ..*lane
        };
        let ray = Ray::new(self.origin.get(i), self.direction.get(i), time);
        stage.go_on_if(self.next_is_valid[i], &next, &ray);
    }
}

/// See [`PathIntegrator::send`].
struct Scatter<'a, L> {
    rays: &'a RayPacket,
    surfaces: &'a Surfaces,
    numbers: &'a EventLanes,
    paths: &'a Paths,
    lights: &'a LightSampleLanes,
    is_power: bool,
    depth: u32,
    is_unlimited: bool,
    lobes: PhantomData<L>,
}

impl<L: Lobes> Kernel for Scatter<'_, L> {
    type Output = Scattered;

    #[inline(always)]
    fn call(self) -> Scattered {
        let mut scattered = Scattered {
            is_delta: L::IS_DELTA,
            ..Scattered::default()
        };
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
        scattered.value.set(i, paths.beta.get(i) * (value * weight));

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
    fn go_on(&self, scattered: &mut Scattered, i: usize, places: &Places) {
        let Self {
            surfaces,
            paths,
            numbers,
            ..
        } = self;
        let [u, v] = numbers.bsdf();
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
        let beta = paths.beta.get(i) * weight;
        let direction = places.frame(i).to_world(wi).normalize();
        let throughput = beta.max_value() * paths.eta_scale[i];
        let survival = survival(self.depth, throughput, self.is_unlimited);
        let survives = (survival >= 1.0) | (numbers.roulette()[i] < survival);
        let thinned = if survival < 1.0 { 1.0 / survival } else { 1.0 };
        scattered.goes_on[i] = exists & (wo.z != 0.0) & (wi.z != 0.0) & !bsdf.f.is_black() & survives;
        scattered.beta.set(i, beta * thinned);
        scattered.pdf[i] = bsdf.pdf;

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
