//! Camera subpaths: they meet lights, and are connected to lights and to the vertices of light subpaths.

use super::light_path::LightVertex;
use super::mis::{Exponent, LightStart, Partial};
use super::{BdptIntegrator, Event, Origin, State, Strategies, SubpathStage};
use crate::geometry::{Ray, SurfaceInteraction};
use crate::integrator::fault::Fault;
use crate::integrator::shadow::{Contribution, shadow_ray};
use crate::integrator::stage::Vertex;
use crate::light::{EmissionDensity, Light, LightDensity, LightEnd, LightSample};
use crate::material::TransportMode;
use crate::math::Vec3;
use crate::scene::Scene;
use crate::spectrum::SampledSpectrum;

impl BdptIntegrator {
    /// A camera subpath meets a surface, or leaves the scene.
    pub(super) fn camera_vertex<'s>(&self, stage: &mut SubpathStage<'_, 's>, vertex: &Vertex<'_, State>) {
        let Vertex { lane, ray, .. } = *vertex;
        let Some(si) = vertex.surface else {
            self.add_environment(stage, vertex);
            return;
        };
        let cos = f64::from(si.ng.dot(ray.direction).abs());
        let partial = match lane.state.origin {
            Origin::Camera => {
                let arrival = stage.view.camera.pdf_we(si.p, ray.direction, ray.time);
                let arrival = arrival.map_or(0.0, |ray| f64::from(ray.arrival.0));
                self.exponent()
                    .camera_start(Self::light_paths(stage.view), arrival, cos)
            }
            Origin::Surface | Origin::Light(_) => {
                let distance_squared = f64::from(lane.state.p.distance_squared(si.p));
                self.exponent().arrive(lane.state.partial, distance_squared, cos)
            }
        };
        self.add_emission(stage, vertex, si, partial, cos);
        if self.strategies == Strategies::LightTracer || !self.allows(stage.depth + 1) {
            return;
        }
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
            self.connect_to_light(stage, &event);
            self.connect_to_light_path(stage, &event);
        }
        self.scatter(stage, &event);
    }

    /// s = 0, at a surface.
    fn add_emission(
        &self,
        stage: &mut SubpathStage<'_, '_>,
        vertex: &Vertex<'_, State>,
        si: &SurfaceInteraction,
        partial: Partial,
        cos: f64,
    ) {
        let (scene, lane) = (stage.scene, vertex.lane);
        let Some(id) = scene.light_of(si.hit.geometry, si.hit.primitive) else {
            return;
        };
        let light = scene.light(id);
        let slot = &mut stage.slots[lane.slot as usize];
        let le = light.le(si, si.wo, &slot.lambda);
        if le.is_black() {
            return;
        }
        let State { p, n, .. } = lane.state;
        let weight = if stage.depth == 0 {
            1.0
        } else {
            let pmf = f64::from(scene.light_sampler().pmf(p, n, id));
            let direct = pmf * f64::from(light.pdf_li(p, si).0) * cos / f64::from(p.distance_squared(si.p));
            let (position, direction) = light.pdf_le(si, si.wo);
            let chosen = f64::from(scene.emission_sampler().pmf(p, n, id));
            let emission = chosen * f64::from(position.0) * f64::from(direction.0);
            self.weight_of_met_light(partial, direct, emission)
        };
        let l = lane.beta * le * (weight as f32);
        slot.l += l;
        if let Some(record) = &mut stage.memory.record {
            record.add(lane.slot, [0, stage.depth + 2], l, weight as f32);
        }
    }

    /// s = 0, of what is infinitely far away: "densities by area" there are by solid angle.
    fn add_environment(&self, stage: &mut SubpathStage<'_, '_>, vertex: &Vertex<'_, State>) {
        let Vertex { lane, ray, .. } = *vertex;
        let (scene, depth) = (stage.scene, stage.depth);
        let State { p, n, partial, .. } = lane.state;
        let slot = &mut stage.slots[lane.slot as usize];
        for (id, light) in scene.environments() {
            let le = light.le(ray.origin, ray.direction, ray.time, &slot.lambda);
            if le.is_black() {
                continue;
            }
            let weight = if depth == 0 {
                1.0
            } else {
                let pmf = f64::from(scene.light_sampler().pmf(p, n, id));
                let direct = pmf * f64::from(light.pdf_li(p, ray.direction, ray.time).0);
                let (position, direction) = light.pdf_le(p, ray.direction, ray.time, &scene.bounds());
                let chosen = f64::from(scene.emission_sampler().pmf(p, n, id));
                let emission = chosen * f64::from(position.0) * f64::from(direction.0);
                self.weight_of_met_light(partial, direct, emission)
            };
            let l = lane.beta * le * (weight as f32);
            slot.l += l;
            if let Some(record) = &mut stage.memory.record {
                record.add(lane.slot, [0, depth + 2], l, weight as f32);
            }
        }
    }

    /// s = 1 has the density `direct` for the point of the light instead of that in `partial`, s > 1 has that of a whole ray.
    fn weight_of_met_light(&self, partial: Partial, direct: f64, emission: f64) -> f64 {
        if self.fault.is(Fault::StrategyLeftOut) {
            return 1.0;
        }
        let exponent = self.exponent();
        let w_camera = exponent.of(direct) * partial.vcm + exponent.of(emission) * partial.vc;
        Exponent::weight(0.0, w_camera)
    }

    /// s = 1.
    fn connect_to_light(&self, stage: &mut SubpathStage<'_, '_>, event: &Event<'_, '_>) -> Option<()> {
        let Event {
            lane,
            si,
            bsdf,
            numbers,
            ..
        } = event;
        let scene = stage.scene;
        let chosen = scene.light_sampler().sample(si.p, si.ns, numbers.which_light)?;
        let light = scene.light(chosen.light);
        let sample = light.sample_li(si.p, si.time, numbers.light, &stage.slot(lane).lambda)?;
        let value = bsdf.eval(si.wo, sample.wi, TransportMode::Radiance)?;
        if value.f.is_black() {
            return None;
        }
        let emission = light.emission_density(si.p, &sample, si.time, &scene.bounds());
        let chosen_to_emit = scene.emission_sampler().pmf(si.p, si.ns, chosen.light);
        let pmf = f64::from(chosen.pmf);
        let start = start_of(light, &sample, si, pmf, f64::from(chosen_to_emit), &emission);
        let exponent = self.exponent();
        let (w_light, pdf) = match sample.density {
            LightDensity::Continuous(pdf) => (exponent.of(f64::from(value.pdf.0) / (pmf * f64::from(pdf.0))), pdf.0),
            LightDensity::Delta => (0.0, 1.0),
        };
        let reverse = f64::from(bsdf.pdf(sample.wi, si.wo, TransportMode::Importance).0);
        let cos = f64::from(si.ng.dot(sample.wi).abs());
        // The light subpath that has this ray, against the light sample: see `LightStart::direct`.
        let w_camera = exponent.sum(event.partial, start.emission * cos / start.direct, reverse);
        let weight = Exponent::weight(w_light, w_camera) as f32;
        let factor = value.cos_theta * weight / (chosen.pmf * pdf);
        let value = lane.beta * value.f * sample.li * factor;
        if let Some(record) = &mut stage.memory.record {
            let ray = shadow_ray(si, sample.wi, sample.end);
            record.add_unless_occluded(stage.scene, &ray, lane.slot, [1, stage.depth + 2], value, weight);
        }
        stage.connect(lane, si, &sample, value);
        Some(())
    }

    /// s > 1, t > 1.
    fn connect_to_light_path(&self, stage: &mut SubpathStage<'_, '_>, event: &Event<'_, '_>) {
        let slot = event.lane.slot;
        let mut record = stage.memory.record.take();
        for light in stage.memory.of(slot) {
            if !self.allows(stage.depth + light.depth + 2) {
                continue;
            }
            if let Some((ray, value, weight)) = self.connection(event, light) {
                if let Some(record) = &mut record {
                    let strategy = [light.depth + 2, stage.depth + 2];
                    record.add_unless_occluded(stage.scene, &ray, slot, strategy, value, weight);
                }
                if ray.is_valid() {
                    stage.shadows.push(&ray, Contribution { slot, value });
                } else {
                    stage.slots[slot as usize].broken = true;
                }
            }
        }
        stage.memory.record = record;
    }

    /// The ray that must be free, what a vertex of a light subpath brings, weighted, and the weight.
    fn connection(&self, event: &Event<'_, '_>, light: &LightVertex<'_>) -> Option<(Ray, SampledSpectrum, f32)> {
        let Event { lane, si, bsdf, .. } = event;
        let to_light: Vec3 = light.si.p - si.p;
        let distance_squared = to_light.length_squared();
        let w = to_light / distance_squared.sqrt();
        if !w.is_finite() {
            return None;
        }
        let here = bsdf.eval(si.wo, w, TransportMode::Radiance)?;
        let there = light.bsdf.eval(light.si.wo, -w, TransportMode::Importance)?;
        let correction = self.adjoint_correction(&light.si, &light.bsdf, -w);
        let f = here.f * there.f * (here.cos_theta * there.cos_theta * correction / distance_squared);
        if f.is_black() {
            return None;
        }
        let d2 = f64::from(distance_squared);
        let (cos_here, cos_there) = (si.ng.dot(w).abs(), light.si.ng.dot(w).abs());
        let mut to_there = f64::from(here.pdf.0) * f64::from(cos_there) / d2;
        if self.fault.is(Fault::PdfInWrongMeasure) {
            to_there = f64::from(here.pdf.0);
        }
        let to_here = f64::from(there.pdf.0) * f64::from(cos_here) / d2;
        let exponent = self.exponent();
        let back = light.bsdf.pdf(-w, light.si.wo, TransportMode::Radiance);
        let w_light = exponent.sum(light.partial, to_there, f64::from(back.0));
        let back = bsdf.pdf(w, si.wo, TransportMode::Importance);
        let w_camera = exponent.sum(event.partial, to_here, f64::from(back.0));
        let weight = Exponent::weight(w_light, w_camera) as f32;
        let ray = si.spawn_ray_to(light.si.p, light.si.error, light.si.ng);
        Some((ray, lane.beta * light.beta * f * weight, weight))
    }
}

/// What a light subpath that had the ray of a light sample would have started with.
fn start_of(
    light: &Light,
    sample: &LightSample,
    si: &SurfaceInteraction,
    pmf: f64,
    chosen_to_emit: f64,
    emission: &EmissionDensity,
) -> LightStart {
    let cos_light = match (light, sample.end) {
        (Light::Area(_), LightEnd::Point { ng, .. }) => f64::from(ng.dot(sample.wi).abs()),
        _ => 1.0,
    };
    let density = match (emission.position, sample.density, sample.end) {
        (LightDensity::Delta, _, LightEnd::Point { p, .. }) => f64::from(p.distance_squared(si.p)),
        (_, LightDensity::Continuous(pdf), _) => f64::from(pdf.0) * cos_light,
        _ => 1.0,
    };
    LightStart {
        direct: pmf * density,
        emission: chosen_to_emit * emission.product(),
        cos_light,
        is_delta: light.is_delta(),
    }
}
