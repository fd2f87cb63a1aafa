//! Photons on their way from lights through the scene.

use super::guide::EmissionGuide;
use super::stored::Photon;
use crate::geometry::{Ray, RayCone, SurfaceInteraction};
use crate::integrator::adjoint::adjoint_correction;
use crate::integrator::emission::sample_emission;
use crate::integrator::lane::{Lane, LaneState};
use crate::integrator::numbers::EmissionNumbers;
use crate::integrator::path::{LAST_SURVIVAL, LAST_SURVIVAL_DEPTH};
use crate::integrator::stage::{Estimator, Stage, Vertex};
use crate::material::{Density, TransportMode};
use crate::math::Each;
use crate::sampling::SampleStream;
use crate::scene::View;
use crate::spectrum::SampledSpectrum;

/// Which photons are kept. In the notation of Heckbert (1990), L is a light, S a specular and D any other scattering event; all are
/// kept at surfaces that are not specular ([`Bsdf::is_specular`](crate::material::Bsdf::is_specular)).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Keep {
    /// L S+: the caustic map.
    Caustic,
    /// L (S|D)*: the global map, which final gathering looks into.
    All,
    /// L (S|D)* D (S|D)*: what is neither straight from a light nor a caustic.
    Indirect,
}

/// The estimator that follows photons.
#[derive(Clone, Copy, Debug)]
pub(super) struct PhotonTracer<'a> {
    pub keep: Keep,
    /// The greatest number of scattering events of a whole path: the last one belongs to the camera's side.
    pub max_depth: Option<u32>,
    /// Where emission is aimed, if it is.
    pub guide: Option<&'a EmissionGuide>,
}

/// What a photon has met.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Met {
    Nothing,
    Specular,
    Diffuse,
}

/// What a photon knows of its way.
#[derive(Clone, Copy, Debug)]
pub(super) struct State {
    met: Met,
    /// Whether its secondary wavelengths have ended.
    hero_only: bool,
}

impl LaneState for State {
    type Lanes = Each<Self>;
}

/// A photon and the path (of its wave) that brought it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Landed {
    pub path: u32,
    pub photon: Photon,
}

impl Estimator for PhotonTracer<'_> {
    type State = State;
    type Memory<'s> = Vec<Landed>;

    fn camera_state(&self, _view: &View, _ray: &Ray) -> State {
        State {
            met: Met::Nothing,
            hero_only: false,
        }
    }

    /// Draws a light by its power, and a ray from it.
    fn emit<'s>(&self, stage: &mut Stage<'_, 's, Self>, slot: u32, stream: SampleStream) {
        let (numbers, density) = self.aim(EmissionNumbers::draw(&stream));
        let of_slot = &stage.slots[slot as usize];
        let Some((chosen, sample)) = sample_emission(stage.scene, of_slot, &numbers) else {
            return;
        };
        let density = f64::from(chosen.pmf) * sample.density.product() * f64::from(density);
        let ray = sample.ray(of_slot.time);
        let lane = Lane {
            slot,
            split: false,
            stream,
            beta: sample.le * ((f64::from(sample.cos_theta) / density) as f32),
            eta_scale: 1.0,
            cone: RayCone::default(),
            state: State {
                // What light samples do not find belongs to the caustics, as if a mirror had sent it.
                met: if stage.scene.light(chosen.light).is_along_normals() {
                    Met::Specular
                } else {
                    Met::Nothing
                },
                hero_only: false,
            },
        };
        stage.go_on(&lane, &ray);
    }

    fn shade<'s>(&self, stage: &mut Stage<'_, 's, Self>, vertex: Vertex<'_, State>) {
        let Vertex { lane, .. } = vertex;
        let Some(si) = vertex.surface else { return };
        if self.max_depth.is_some_and(|max_depth| stage.depth >= max_depth) {
            return;
        }
        let mut lambda = stage.slots[lane.slot as usize].lambda;
        let bsdf = stage.scene.material(si.hit.geometry).bsdf(si, &mut lambda);
        let hero_only = lane.state.hero_only || lambda.secondary_terminated();
        let is_specular = bsdf.is_specular();
        if !is_specular {
            self.land(stage, lane, si);
        }
        let (mode, numbers) = (TransportMode::Importance, vertex.numbers());
        let Some(sample) = bsdf.sample_f(si.wo, numbers.lobe, numbers.bsdf, mode) else {
            return;
        };
        let met = match sample.density {
            _ if lane.state.met == Met::Diffuse => Met::Diffuse,
            Density::Delta(_) => Met::Specular,
            Density::Continuous(_) if is_specular => Met::Specular,
            Density::Continuous(_) => Met::Diffuse,
        };
        if self.keep == Keep::Caustic && met == Met::Diffuse {
            return;
        }
        let mut beta = lane.beta * sample.weight() * adjoint_correction(si, &bsdf, sample.wi);
        if hero_only {
            beta = SampledSpectrum([beta.0[0], 0.0, 0.0, 0.0]);
        }
        // What survives has the power that arrived.
        let left = beta.max_value() / lane.beta.max_value();
        let Some(survival) = survives(left, numbers.roulette, stage.depth, self.max_depth) else {
            return;
        };
        let next = Lane {
            beta: beta * (1.0 / survival),
            state: State { met, hero_only },
            ..*lane
        };
        stage.go_on(&next, &si.spawn_ray(sample.wi));
    }
}

/// Absorption, chosen by `u` with the probability of what is lost where `left` of the light is left; the probability with which
/// that would not have happened, if it does not. Paths of any length end now and then though nothing is lost.
pub(super) fn survives(left: f32, u: f32, depth: u32, max_depth: Option<u32>) -> Option<f32> {
    let mut survival = left.min(1.0);
    if max_depth.is_none() && depth >= LAST_SURVIVAL_DEPTH {
        survival = survival.min(LAST_SURVIVAL);
    }
    (u < survival).then_some(survival)
}

impl PhotonTracer<'_> {
    /// The numbers that emission starts with, and their density.
    pub fn aim(&self, numbers: EmissionNumbers) -> (EmissionNumbers, f32) {
        match self.guide {
            Some(guide) => guide.aim(numbers),
            None => (numbers, 1.0),
        }
    }

    /// Keeps a photon where it is, if it is of the kind.
    fn land(&self, stage: &mut Stage<'_, '_, Self>, lane: &Lane<State>, si: &SurfaceInteraction) {
        let wanted = match self.keep {
            Keep::Caustic => lane.state.met == Met::Specular,
            Keep::All => true,
            Keep::Indirect => lane.state.met == Met::Diffuse,
        };
        if !wanted {
            return;
        }
        let photon = Photon::new(si.p, si.wo, si.ng, lane.beta, stage.depth, lane.state.hero_only);
        match photon {
            Some(photon) => stage.memory.push(Landed {
                path: lane.slot,
                photon,
            }),
            None => stage.slot(lane).broken |= !lane.beta.is_finite(),
        }
    }
}
