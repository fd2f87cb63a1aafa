//! Connections of a vertex of a camera subpath: to a point of a light (s = 1), and to the vertices of the light subpath (s > 1).
//!
//! Most of what they could bring is little, and the shadow rays are the greater part of what they cost. So all are evaluated first,
//! and Russian roulette says which are made (Veach 1997, section 10.3.4): one that brings C, weighted, if nothing is in its way, is
//! made with the probability q = min(1, C / δ), and then brings C / q. δ is a part of what all connections of this camera subpath
//! could bring so far, including those of this vertex: where it is large that adds little to the variance. The probabilities share one
//! random number: connection i is made if an integer lies between u + q_1 + ... + q_{i-1} and u + q_1 + ... + q_i.

use super::light_path::LightVertex;
use super::mis::{Exponent, LightStart};
use super::{BdptIntegrator, Event, SubpathStage};
use crate::geometry::SurfaceInteraction;
use crate::integrator::adjoint::bend;
use crate::integrator::fault::Fault;
use crate::integrator::shadow::{Contribution, NO_NOTE, shadow_ray};
use crate::light::{EmissionDensity, Light, LightDensity, LightEnd, LightSample};
use crate::material::TransportMode;
use crate::math::Vec3;
use crate::spectrum::SampledSpectrum;

/// δ, as a part of what the connections of a camera subpath could bring. On the Cornell box it spares a fifth of all rays for 1 % more
/// error; twice as much would spare a quarter for 4 %.
const DELTA: f32 = 0.1;

/// A connection that could be made.
#[derive(Clone, Copy, Debug)]
pub(super) struct Connection {
    /// Vertices of the light subpath.
    s: u32,
    wi: Vec3,
    end: LightEnd,
    /// What it brings, weighted, if nothing is in the way.
    value: SampledSpectrum,
    weight: f32,
}

impl BdptIntegrator {
    /// Connects a vertex, to all that the light subpath has. Returns what its subpath could have got from connections so far.
    pub(super) fn connect(&self, stage: &mut SubpathStage<'_, '_>, event: &Event<'_, '_>) -> f32 {
        let slot = event.lane.slot;
        stage.memory.arrange();
        let mut connections = std::mem::take(&mut stage.memory.connections);
        connections.clear();
        if let Some(connection) = self.light_connection(stage, event) {
            connections.push(connection);
        }
        for (seat, vertex) in stage.memory.of(slot) {
            if self.allows(stage.depth + seat.depth + 2)
                && seat.may_see(event.si.p)
                && let Some(connection) = self.vertex_connection(event, vertex, seat.depth + 2)
            {
                connections.push(connection);
            }
        }
        let found: f32 = connections.iter().map(|connection| connection.value.max_value()).sum();
        let found = event.lane.state.found + found;
        self.make(stage, event, &connections, found * DELTA);
        stage.memory.connections = connections;
        found
    }

    /// Sends the shadow rays of those connections that Russian roulette chooses.
    fn make(&self, stage: &mut SubpathStage<'_, '_>, event: &Event<'_, '_>, connections: &[Connection], delta: f32) {
        let Event { lane, si, numbers, .. } = event;
        let (slot, t) = (lane.slot, stage.depth + 2);
        let mut between = numbers.connections;
        for connection in connections {
            let probability = connection.value.max_value() / delta;
            // One that is not a number is made, to be dropped and counted.
            let (mut value, mut is_made) = (connection.value, true);
            if probability < 1.0 {
                between += probability;
                is_made = between >= 1.0;
                if is_made {
                    between -= 1.0;
                    value *= 1.0 / probability;
                } else {
                    value = SampledSpectrum::ZERO;
                }
            }
            let note = match &mut stage.memory.record {
                Some(record) => record.note(slot, [connection.s, t], value, connection.in_full()),
                None if is_made => NO_NOTE,
                None => continue,
            };
            let ray = shadow_ray(si, connection.wi, connection.end);
            if is_made || ray.is_valid() {
                stage.add_unless_occluded(&ray, Contribution { slot, note, value });
            }
        }
    }

    /// s = 1.
    fn light_connection(&self, stage: &mut SubpathStage<'_, '_>, event: &Event<'_, '_>) -> Option<Connection> {
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
        let (value, reverse) = bsdf.eval_both_ways(si.wo, sample.wi, TransportMode::Radiance)?;
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
        let cos = f64::from(si.ng.dot(sample.wi).abs());
        // The light subpath that has this ray, against the light sample: see `LightStart::direct`.
        let w_camera = exponent.sum(event.partial, start.emission * cos / start.direct, f64::from(reverse.0));
        let weight = Exponent::weight(w_light, w_camera) as f32;
        let factor = value.cos_theta * weight / (chosen.pmf * pdf);
        Some(Connection {
            s: 1,
            wi: sample.wi,
            end: sample.end,
            value: lane.beta * value.f * sample.li * factor,
            weight,
        })
    }

    /// s > 1.
    fn vertex_connection(&self, event: &Event<'_, '_>, light: &LightVertex<'_>, s: u32) -> Option<Connection> {
        let Event { lane, si, bsdf, .. } = event;
        let to_light: Vec3 = light.p - si.p;
        let distance_squared = to_light.length_squared();
        let w = to_light / distance_squared.sqrt();
        if !w.is_finite() {
            return None;
        }
        let (here, reverse_here) = bsdf.eval_both_ways(si.wo, w, TransportMode::Radiance)?;
        let (there, reverse_there) = light.bsdf.eval_both_ways(light.wo, -w, TransportMode::Importance)?;
        let mut correction = bend(light.ng, &light.bsdf, w) / light.bend;
        if self.fault.is(Fault::AdjointForgotten) {
            correction = 1.0;
        }
        let f = here.f * there.f * (here.cos_theta * there.cos_theta * correction / distance_squared);
        if f.is_black() || !correction.is_finite() {
            return None;
        }
        let d2 = f64::from(distance_squared);
        let (cos_here, cos_there) = (si.ng.dot(w).abs(), light.ng.dot(w).abs());
        let mut to_there = f64::from(here.pdf.0) * f64::from(cos_there) / d2;
        if self.fault.is(Fault::PdfInWrongMeasure) {
            to_there = f64::from(here.pdf.0);
        }
        let to_here = f64::from(there.pdf.0) * f64::from(cos_here) / d2;
        let exponent = self.exponent();
        let w_light = exponent.sum(light.partial, to_there, f64::from(reverse_there.0));
        let w_camera = exponent.sum(event.partial, to_here, f64::from(reverse_here.0));
        let weight = Exponent::weight(w_light, w_camera) as f32;
        Some(Connection {
            s,
            wi: w,
            end: LightEnd::Point {
                p: light.p,
                error: light.error,
                ng: light.ng,
            },
            value: lane.beta * light.beta * f * weight,
            weight,
        })
    }
}

impl Connection {
    /// What it brings without its weight. A weight that vanishes takes the value with it.
    fn in_full(&self) -> SampledSpectrum {
        if self.weight >= f32::MIN_POSITIVE {
            self.value * (1.0 / self.weight)
        } else {
            SampledSpectrum::ZERO
        }
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
