//! Unidirectional path tracing: next-event estimation and BSDF sampling at every vertex, combined by multiple importance sampling
//! (Veach 1997, section 9.2), and Russian roulette on the throughput.
//!
//! With `splitting` N a path becomes N at its first scattering event that is not specular: N light samples and N BSDF samples, each
//! with a weight of 1/N. As both techniques take the same number, the weights between them stay.

mod together;

use super::direct::{DirectLight, Origin};
use super::fault::Fault;
use super::lane::Lane;
use super::numbers::EventNumbers;
use super::stage::{Estimator, PacketVertices, Stage, Vertex};
use crate::desc::{Heuristic, Strategy};
use crate::geometry::{Ray, RayCone, SurfaceInteraction};
use crate::material::{Bsdf, Density, TransportMode};
use crate::math::LaneSet;
use crate::scene::View;
use together::Together;

/// The path tracer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PathIntegrator {
    /// The greatest number of scattering events, as in pbrt; `None` for any number.
    pub max_depth: Option<u32>,
    /// How light is looked for.
    pub strategy: Strategy,
    /// How the two ways of finding it are weighed.
    pub heuristic: Heuristic,
    /// Paths that go on from the first scattering event that is not specular, at least 1.
    pub splitting: u32,
    #[doc(hidden)]
    pub fault: Fault,
}

/// As in pbrt: the paths that bring most of the light are not thinned.
const FIRST_ROULETTE_DEPTH: u32 = 2;

/// From this depth on a path without limit survives with at most [`LAST_SURVIVAL`], or one between perfect mirrors would not end.
pub(super) const LAST_SURVIVAL_DEPTH: u32 = 64;
pub(super) const LAST_SURVIVAL: f32 = 0.95;

type PathLane = Lane<Origin>;
type PathStage<'a, 's> = Stage<'a, 's, PathIntegrator>;

/// A scattering event.
struct Event<'a> {
    /// The path; of a split one, with its part of the throughput.
    lane: &'a PathLane,
    si: &'a SurfaceInteraction,
    bsdf: &'a Bsdf<'a>,
    numbers: &'a EventNumbers,
    /// The cone of the ray from here on.
    cone: RayCone,
}

impl Estimator for PathIntegrator {
    type State = Origin;
    type Memory<'s> = Together;

    #[inline]
    fn camera_state(&self, _view: &View, _ray: &Ray) -> Origin {
        Origin::Delta
    }

    #[inline]
    fn shade_together<'s>(&self, stage: &mut PathStage<'_, 's>, packet: &PacketVertices<'_, Origin>) -> LaneSet {
        self.scatter_together(stage, packet)
    }

    #[inline]
    fn shade<'s>(&self, stage: &mut PathStage<'_, 's>, vertex: Vertex<'_, Origin>) {
        let Vertex { lane, ray, cone, .. } = vertex;
        let (scene, slot) = (stage.scene, &mut stage.slots[lane.slot as usize]);
        let Some(si) = vertex.surface else {
            slot.l += lane.beta * self.direct_light().environment(scene, &lane.state, ray, &slot.lambda);
            return;
        };
        if let Some(le) = self.direct_light().emission(scene, &lane.state, si, &slot.lambda) {
            slot.l += lane.beta * le;
        }
        if self.max_depth == Some(stage.depth) {
            return;
        }
        let bsdf = scene.material(si.hit.geometry).bsdf(si, &mut slot.lambda);
        let event = Event {
            lane,
            si,
            bsdf: &bsdf,
            numbers: &vertex.numbers(),
            cone,
        };
        if self.splitting == 1 || lane.split || bsdf.is_delta() {
            self.scatter(stage, &event);
            return;
        }
        for branch in 0..self.splitting {
            let stream = lane.stream.branch(branch);
            let lane = &Lane {
                split: true,
                stream,
                beta: lane.beta * (1.0 / self.splitting as f32),
                ..*lane
            };
            let numbers = &EventNumbers::draw(&stream, stage.depth);
            self.scatter(stage, &Event { lane, numbers, ..event });
        }
    }
}

impl PathIntegrator {
    /// Looks for light from a scattering event, and goes on from it.
    #[inline]
    fn scatter(&self, stage: &mut PathStage<'_, '_>, event: &Event<'_>) {
        let Event { lane, si, numbers, .. } = event;
        if self.strategy != Strategy::Bsdf && !event.bsdf.is_delta() {
            let lambda = &stage.slots[lane.slot as usize].lambda;
            let sample = self.direct_light().sample(stage.scene, si, event.bsdf, numbers, lambda);
            if let Some((light, value)) = sample {
                stage.connect(lane, si, &light, lane.beta * value);
            }
        }
        let sample = event
            .bsdf
            .sample_f(si.wo, numbers.lobe, numbers.bsdf, TransportMode::Radiance);
        let Some(sample) = sample else { return };
        let mut next = Lane {
            beta: lane.beta * sample.weight(),
            eta_scale: lane.eta_scale * sample.eta * sample.eta,
            state: match sample.density {
                Density::Delta(_) => Origin::Delta,
                Density::Continuous(pdf) => Origin::Sampled { p: si.p, n: si.ns, pdf },
            },
            cone: event.cone,
            ..**lane
        };
        if self.fault.is(Fault::EtaForgotten) {
            next.beta *= sample.eta * sample.eta;
        }
        if self.survives(&mut next, stage.depth, numbers) {
            stage.go_on(&next, &si.spawn_ray(sample.wi));
        }
    }

    /// Whether a path goes on after the scattering event `depth`, which makes up for those that do not.
    #[inline]
    pub(super) fn survives<S>(&self, next: &mut Lane<S>, depth: u32, numbers: &EventNumbers) -> bool {
        // A path that was split is as worthy of going on as the whole.
        let whole = if next.split { self.splitting as f32 } else { 1.0 };
        let throughput = next.beta.max_value() * next.eta_scale * whole;
        let survival = survival(depth, throughput, self.max_depth.is_none());
        if survival < 1.0 {
            if numbers.roulette >= survival {
                return false;
            }
            next.beta *= 1.0 / survival;
        }
        true
    }

    pub(super) fn direct_light(&self) -> DirectLight {
        DirectLight {
            strategy: self.strategy,
            heuristic: self.heuristic,
            bsdf_samples: 1.0,
            fault: self.fault,
        }
    }
}

/// The probability with which a path of this throughput goes on after the scattering event `depth`: its square root, which on the
/// Cornell box needs a sixth fewer rays than the throughput itself for the same error.
#[inline(always)]
pub(super) fn survival(depth: u32, throughput: f32, is_unlimited: bool) -> f32 {
    if depth < FIRST_ROULETTE_DEPTH {
        return 1.0;
    }
    let limit = if is_unlimited && depth >= LAST_SURVIVAL_DEPTH {
        LAST_SURVIVAL
    } else {
        1.0
    };
    throughput.sqrt().min(limit)
}
