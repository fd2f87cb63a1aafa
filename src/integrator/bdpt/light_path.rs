//! Light subpaths: they start at lights, keep their vertices, and are connected to the lens.

use super::mis::{Exponent, LightStart, Partial};
use super::pyramid::Record;
use super::{BdptIntegrator, Event, Origin, State, Strategies, SubpathStage};
use crate::geometry::{Ray, SurfaceInteraction};
use crate::integrator::lane::Lane;
use crate::integrator::numbers::EmissionNumbers;
use crate::integrator::shadow::SplatContribution;
use crate::integrator::stage::Vertex;
use crate::light::{EmissionOrigin, Light, LightDensity, LightId};
use crate::material::{Bsdf, TransportMode};
use crate::math::Vec3;
use crate::sampling::SampleStream;
use crate::scene::Scene;
use crate::spectrum::{SampledSpectrum, Wavelengths};

/// The first ray of a light subpath.
#[derive(Clone, Copy, Debug)]
pub(super) struct LightRay {
    light: LightId,
    origin: EmissionOrigin,
    cos_theta: f32,
    /// See [`LightStart::emission`].
    emission: f64,
    has_delta_position: bool,
    is_delta: bool,
}

/// A vertex that camera subpaths may be connected to.
#[derive(Debug)]
pub(super) struct LightVertex<'s> {
    pub si: SurfaceInteraction,
    pub bsdf: Bsdf<'s>,
    /// Power over the density of the subpath, before it is scattered here.
    pub beta: SampledSpectrum,
    pub partial: Partial,
    /// Scattering events before this one.
    pub depth: u32,
    /// The vertex of the same subpath that was made before.
    previous: u32,
}

/// The vertices of the light subpaths of a wave.
#[derive(Debug, Default)]
pub(in crate::integrator) struct LightVertices<'s> {
    vertices: Vec<LightVertex<'s>>,
    /// By slot: the last one.
    last: Vec<u32>,
    /// What each strategy finds, if that is wanted.
    pub(super) record: Option<Box<Record>>,
}

const NONE: u32 = u32::MAX;

impl<'s> LightVertices<'s> {
    /// None, and where to note what each strategy finds.
    pub(super) fn recording(record: Option<Box<Record>>) -> Self {
        Self {
            record,
            ..Self::default()
        }
    }

    /// Forgets all, for a wave of so many slots.
    pub fn restart(&mut self, slots: usize) {
        self.vertices.clear();
        self.last.clear();
        self.last.resize(slots, NONE);
        if let Some(record) = &mut self.record {
            record.restart(slots);
        }
    }

    fn push(&mut self, slot: u32, mut vertex: LightVertex<'s>) {
        let last = &mut self.last[slot as usize];
        vertex.previous = std::mem::replace(last, self.vertices.len() as u32);
        self.vertices.push(vertex);
    }

    /// Those of a slot, the last one first.
    pub(super) fn of(&self, slot: u32) -> impl Iterator<Item = &LightVertex<'s>> {
        let get = |index: u32| self.vertices.get(index as usize);
        std::iter::successors(get(self.last[slot as usize]), move |vertex| get(vertex.previous))
    }
}

impl BdptIntegrator {
    /// Draws a light by its power, and a ray from it.
    pub(super) fn start_light_path(&self, stage: &mut SubpathStage<'_, '_>, slot: u32, stream: SampleStream) {
        let numbers = EmissionNumbers::draw(&stream);
        let scene = stage.scene;
        let Some(chosen) = scene
            .emission_sampler()
            .sample(Vec3::ZERO, Vec3::ZERO, numbers.which_light)
        else {
            return;
        };
        let (light, of_slot) = (scene.light(chosen.light), &stage.slots[slot as usize]);
        let bounds = scene.bounds();
        let sample = light.sample_le(
            of_slot.time,
            numbers.position,
            numbers.direction,
            &of_slot.lambda,
            &bounds,
        );
        let Some(sample) = sample else { return };
        let emission = f64::from(chosen.pmf) * sample.density.product();
        let has_delta_position = sample.density.position == LightDensity::Delta;
        let ray = sample.ray(of_slot.time);
        let lane = Lane {
            slot,
            split: false,
            stream,
            beta: sample.le * ((f64::from(sample.cos_theta) / emission) as f32),
            eta_scale: 1.0,
            cone: Default::default(),
            state: State {
                origin: Origin::Light(LightRay {
                    light: chosen.light,
                    origin: sample.origin,
                    cos_theta: sample.cos_theta,
                    emission,
                    has_delta_position,
                    is_delta: has_delta_position || sample.density.direction == LightDensity::Delta,
                }),
                p: ray.origin,
                n: Vec3::ZERO,
                partial: Partial { vcm: 0.0, vc: 0.0 },
                throughput: 1.0,
            },
        };
        stage.go_on(&lane, &ray);
    }

    /// A light subpath meets a surface.
    pub(super) fn light_vertex<'s>(&self, stage: &mut SubpathStage<'_, 's>, vertex: &Vertex<'_, State>) {
        let Vertex { lane, ray, .. } = *vertex;
        let Some(si) = vertex.surface else { return };
        if !self.allows(stage.depth + 1) {
            return;
        }
        let cos = f64::from(si.ng.dot(ray.direction).abs());
        let partial = match &lane.state.origin {
            Origin::Light(start) => {
                let lambda = &stage.slots[lane.slot as usize].lambda;
                let Some(start) = light_start(stage.scene, start, si, ray, lambda) else {
                    return;
                };
                self.exponent().light_start(&start, cos)
            }
            Origin::Surface | Origin::Camera => {
                let distance_squared = f64::from(lane.state.p.distance_squared(si.p));
                self.exponent().arrive(lane.state.partial, distance_squared, cos)
            }
        };
        let scene: &'s Scene = stage.scene;
        let lambda = &mut stage.slots[lane.slot as usize].lambda;
        let event = Event {
            lane,
            si,
            bsdf: scene.material(si.hit.geometry).bsdf(si, lambda),
            partial,
            numbers: vertex.numbers,
            cone: vertex.cone,
        };
        if !event.bsdf.is_delta() {
            self.connect_to_lens(stage, &event);
            if self.strategies == Strategies::All && self.allows(stage.depth + 2) {
                stage.memory.push(
                    lane.slot,
                    LightVertex {
                        si: *si,
                        bsdf: event.bsdf,
                        beta: lane.beta,
                        partial,
                        depth: stage.depth,
                        previous: NONE,
                    },
                );
            }
        }
        if self.allows(stage.depth + 2) {
            self.scatter(stage, &event);
        }
    }

    /// t = 1.
    fn connect_to_lens(&self, stage: &mut SubpathStage<'_, '_>, event: &Event<'_, '_>) {
        let Event { lane, si, bsdf, .. } = event;
        let (view, slot) = (stage.view, lane.slot);
        let domain = view.domain();
        let Some(lens) = view.camera.sample_wi(si.p, si.time, event.numbers.light, &domain) else {
            return;
        };
        let Some(value) = bsdf.eval(si.wo, lens.wi, TransportMode::Importance) else {
            return;
        };
        let f = value.f * (value.cos_theta * self.adjoint_correction(si, bsdf, lens.wi) * lens.weight());
        if f.is_black() {
            return;
        }
        let weight = match self.strategies {
            Strategies::LightTracer => 1.0,
            Strategies::All => {
                let reverse = bsdf.pdf(lens.wi, si.wo, TransportMode::Radiance);
                let arrival = f64::from(lens.ray.arrival.0) * f64::from(si.ng.dot(lens.wi).abs());
                let density = arrival / Self::light_paths(view);
                Exponent::weight(self.exponent().sum(event.partial, density, f64::from(reverse.0)), 0.0)
            }
        };
        let splat = SplatContribution {
            slot,
            film: lens.ray.film,
            value: lane.beta * f * (weight as f32),
        };
        let ray = si.spawn_ray_to(lens.end, 0.0, Vec3::ZERO);
        if let Some(record) = &mut stage.memory.record {
            record.splat_unless_occluded(stage.scene, &ray, stage.depth + 2, &splat, weight as f32);
        }
        stage.splat_unless_occluded(&ray, splat);
    }
}

/// How the first vertex of a light subpath came about, where light samples choose lights by the light sampler of `path`. `None` if the
/// light does not shine there: what comes through a portal does not light what is in front of it.
fn light_start(
    scene: &Scene,
    start: &LightRay,
    si: &SurfaceInteraction,
    ray: &Ray,
    lambda: &Wavelengths,
) -> Option<LightStart> {
    let pmf = scene.light_sampler().pmf(si.p, si.ns, start.light);
    let density = match (scene.light(start.light), start.origin) {
        _ if start.has_delta_position => f64::from(si.p.distance_squared(ray.origin)),
        (Light::Area(light), EmissionOrigin::Surface { p, ng, .. }) => {
            f64::from(light.pdf_li(si.p, p, ng, ray.time).0) * f64::from(start.cos_theta)
        }
        (Light::Environment(light), _) => {
            if light.le(si.p, -ray.direction, ray.time, lambda).is_black() {
                return None;
            }
            f64::from(light.pdf_li(si.p, -ray.direction, ray.time).0)
        }
        _ => 1.0,
    };
    Some(LightStart {
        direct: f64::from(pmf) * density,
        emission: start.emission,
        cos_light: f64::from(start.cos_theta),
        is_delta: start.is_delta,
    })
}
