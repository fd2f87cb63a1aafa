//! Camera paths of photon mapping, up to where photons are asked: what lights send straight, and what is seen in mirrors and through
//! glass.

use super::carried::carried;
use crate::desc::{Heuristic, Strategy, Term, Terms};
use crate::geometry::{RayCone, SurfaceInteraction};
use crate::integrator::direct::{DirectLight, Origin};
use crate::integrator::fault::Fault;
use crate::integrator::lane::{Lane, LaneState};
use crate::integrator::numbers::EventNumbers;
use crate::integrator::path::survival;
use crate::integrator::stage::{Estimator, Stage, Vertex};
use crate::material::{Bsdf, BsdfSample, Density, TransportMode};
use crate::math::Each;

/// What a camera path of photon mapping knows of its way.
#[derive(Clone, Copy, Debug)]
pub(super) struct EyeState {
    pub origin: Origin,
    /// Which term the light belongs to that its ray meets.
    pub term: Term,
    pub phase: Phase,
    /// Whether its secondary wavelengths have ended.
    pub hero_only: bool,
}

impl LaneState for EyeState {
    type Lanes = Each<Self>;
}

/// What is next on a camera path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Phase {
    /// The first surface that is not specular.
    Eye,
    /// It has been; what is met now is gathered.
    Gather,
    /// As before, with specular surfaces since: light that is met now belongs to the caustic map.
    GatherBySpecular,
}

impl EyeState {
    /// Of a ray from the camera.
    pub fn new() -> Self {
        Self {
            origin: Origin::Delta,
            term: Term::Direct,
            phase: Phase::Eye,
            hero_only: false,
        }
    }
}

/// A surface that a camera path has met.
pub(super) struct Event<'a, 's> {
    pub si: &'a SurfaceInteraction,
    pub bsdf: Bsdf<'s>,
    pub cone: RayCone,
    /// Whether secondary wavelengths end here at the latest.
    pub hero_only: bool,
}

/// A path and its random numbers at an event.
pub(super) type Way<'a> = (&'a Lane<EyeState>, &'a EventNumbers);

/// What all camera paths of photon mapping do.
#[derive(Clone, Copy, Debug)]
pub(super) struct Eye {
    pub max_depth: Option<u32>,
    pub terms: Terms,
}

impl Eye {
    /// Adds the light that a ray meets, where it belongs to its term; then what is to happen at the surface, if paths may go on from it.
    pub fn arrive<'a, 's, E: Estimator<State = EyeState>>(
        &self,
        stage: &mut Stage<'_, 's, E>,
        vertex: &Vertex<'a, EyeState>,
    ) -> Option<Event<'a, 's>> {
        let Vertex { lane, ray, .. } = *vertex;
        let (scene, slot) = (stage.scene, &mut stage.slots[lane.slot as usize]);
        let met = match vertex.surface {
            None => Some(Self::direct_light(1).environment(scene, &lane.state.origin, ray, &slot.lambda)),
            Some(si) => Self::direct_light(1).emission(scene, &lane.state.origin, si, &slot.lambda),
        };
        if let Some(le) = met
            && lane.state.phase != Phase::GatherBySpecular
            && self.terms.has(lane.state.term)
        {
            slot.l += carried(lane.beta * le, lane.state.hero_only);
        }
        let si = vertex.surface?;
        if self.max_depth.is_some_and(|max_depth| stage.depth >= max_depth) {
            return None;
        }
        let mut lambda = slot.lambda;
        let bsdf = scene.material(si.hit.geometry).bsdf(si, &mut lambda);
        Some(Event {
            si,
            bsdf,
            cone: vertex.cone,
            hero_only: lane.state.hero_only || lambda.secondary_terminated(),
        })
    }

    /// Looks for light straight from a surface, where `directions` are drawn from its BSDF as well.
    pub fn sample_light<E: Estimator<State = EyeState>>(
        &self,
        stage: &mut Stage<'_, '_, E>,
        event: &Event<'_, '_>,
        (lane, numbers): Way<'_>,
        term: Term,
        directions: u32,
    ) {
        if !self.terms.has(term) {
            return;
        }
        let lambda = &stage.slots[lane.slot as usize].lambda;
        let direct = Self::direct_light(directions);
        let sample = direct.sample(stage.scene, event.si, &event.bsdf, numbers, lambda);
        if let Some((light, value)) = sample {
            let value = carried(lane.beta * value, event.hero_only);
            stage.connect(lane, event.si, &light, value);
        }
    }

    /// A specular surface: light straight from it, unless it is perfectly smooth, and on by one direction.
    pub fn pass_specular<E: Estimator<State = EyeState>>(
        &self,
        stage: &mut Stage<'_, '_, E>,
        event: &Event<'_, '_>,
        way: Way<'_>,
    ) {
        let (lane, numbers) = way;
        if !event.bsdf.is_delta() && lane.state.phase == Phase::Eye {
            self.sample_light(stage, event, way, specular(lane.state.term), 1);
        }
        let mode = TransportMode::Radiance;
        if let Some(sample) = event.bsdf.sample_f(event.si.wo, numbers.lobe, numbers.bsdf, mode) {
            self.follow_specular(stage, event, way, &sample, 1);
        }
    }

    /// Goes on by a direction that counts as specular, one of `directions`.
    pub fn follow_specular<E: Estimator<State = EyeState>>(
        &self,
        stage: &mut Stage<'_, '_, E>,
        event: &Event<'_, '_>,
        (lane, numbers): Way<'_>,
        sample: &BsdfSample,
        directions: u32,
    ) {
        let left = sample.weight().max_value() * sample.eta * sample.eta;
        let survival = survival(stage.depth, left, self.max_depth.is_none());
        if numbers.roulette >= survival {
            return;
        }
        let state = EyeState {
            origin: origin_of(event, sample, 1),
            term: specular(lane.state.term),
            phase: match lane.state.phase {
                // In a corner it belongs to a gather ray, and light that is met now to the caustics of where that came from.
                Phase::Eye if lane.state.term == Term::Indirect => Phase::GatherBySpecular,
                Phase::Eye => Phase::Eye,
                Phase::Gather | Phase::GatherBySpecular => Phase::GatherBySpecular,
            },
            hero_only: event.hero_only,
        };
        go_on(stage, event, lane, sample, state, 1.0 / (survival * directions as f32));
    }

    /// Goes on by one of `directions` drawn at a surface that is not specular.
    pub fn gather<E: Estimator<State = EyeState>>(
        &self,
        stage: &mut Stage<'_, '_, E>,
        event: &Event<'_, '_>,
        lane: &Lane<EyeState>,
        sample: &BsdfSample,
        directions: u32,
    ) {
        let state = EyeState {
            origin: origin_of(event, sample, directions),
            term: lane.state.term,
            phase: Phase::Gather,
            hero_only: event.hero_only,
        };
        go_on(stage, event, lane, sample, state, 1.0 / directions as f32);
    }

    fn direct_light(directions: u32) -> DirectLight {
        DirectLight {
            strategy: Strategy::Mis,
            heuristic: Heuristic::Power,
            bsdf_samples: directions as f32,
            fault: Fault::None,
        }
    }
}

/// Sends a path on, with a part of what the sample weighs.
fn go_on<E: Estimator<State = EyeState>>(
    stage: &mut Stage<'_, '_, E>,
    event: &Event<'_, '_>,
    lane: &Lane<EyeState>,
    sample: &BsdfSample,
    state: EyeState,
    part: f32,
) {
    let next = Lane {
        beta: lane.beta * sample.weight() * part,
        cone: event.cone,
        state,
        ..*lane
    };
    stage.go_on(&next, &event.si.spawn_ray(sample.wi));
}

/// The term of what is seen by way of a specular surface.
fn specular(term: Term) -> Term {
    match term {
        Term::Direct => Term::Specular,
        Term::Specular | Term::Caustic | Term::Indirect => term,
    }
}

fn origin_of(event: &Event<'_, '_>, sample: &BsdfSample, directions: u32) -> Origin {
    match sample.density {
        Density::Delta(_) => Origin::Delta,
        Density::Continuous(mut pdf) => {
            pdf.0 *= directions as f32;
            Origin::Sampled {
                p: event.si.p,
                n: event.si.ns,
                pdf,
            }
        }
    }
}
