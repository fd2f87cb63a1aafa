//! Unidirectional path tracing: next-event estimation and BSDF sampling at every vertex, combined by multiple importance sampling
//! (Veach 1997, section 9.2), and Russian roulette on the throughput.
//!
//! With `splitting` N a path becomes N at its first scattering event that is not specular: N light samples and N BSDF samples, each
//! with a weight of 1/N. As both techniques take the same number, the weights between them stay.

use super::fault::Fault;
use super::lane::Lane;
use super::numbers::EventNumbers;
use super::stage::{Estimator, Stage, Vertex};
use crate::desc::{Heuristic, Strategy};
use crate::geometry::{Ray, RayCone, SurfaceInteraction};
use crate::light::{LightDensity, LightEnd, LightSample};
use crate::material::{Bsdf, Density, TransportMode};
use crate::math::Vec3;
use crate::sampling::{SolidAnglePdf, balance_heuristic, power_heuristic};
use crate::scene::View;

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
const LAST_SURVIVAL_DEPTH: u32 = 64;
const LAST_SURVIVAL: f32 = 0.95;

/// Where a path's ray came from, which says how else the light that it meets could have been found.
#[derive(Clone, Copy, Debug)]
pub(super) enum Origin {
    /// The camera or a delta lobe: in no other way.
    Delta,
    /// A BSDF sample with this density, at a point of this shading normal: by light sampling too.
    Sampled { p: Vec3, n: Vec3, pdf: SolidAnglePdf },
}

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
    type Memory<'s> = ();

    #[inline]
    fn camera_state(&self, _view: &View, _ray: &Ray) -> Origin {
        Origin::Delta
    }

    #[inline]
    fn shade<'s>(&self, stage: &mut PathStage<'_, 's>, vertex: Vertex<'_, Origin>) {
        let Vertex { lane, ray, cone, .. } = vertex;
        let Some(si) = vertex.surface else {
            self.add_environment(stage, lane, ray);
            return;
        };
        self.add_emission(stage, lane, si);
        if self.max_depth == Some(stage.depth) {
            return;
        }
        let lambda = &mut stage.slots[lane.slot as usize].lambda;
        let bsdf = stage.scene.material(si.hit.geometry).bsdf(si, lambda);
        let event = Event {
            lane,
            si,
            bsdf: &bsdf,
            numbers: vertex.numbers,
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
        if self.strategy != Strategy::Bsdf && !event.bsdf.is_delta() {
            self.sample_light(stage, event);
        }
        let Event { lane, si, numbers, .. } = event;
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
        let survival = self.survival(stage.depth, &next);
        if survival < 1.0 {
            if numbers.roulette >= survival {
                return;
            }
            next.beta *= 1.0 / survival;
        }
        stage.go_on(&next, &si.spawn_ray(sample.wi));
    }

    /// The probability with which a path goes on after the scattering event `depth`: the square root of its throughput, which on the
    /// Cornell box needs a sixth fewer rays than the throughput itself for the same error. A path that was split is as worthy of
    /// going on as the whole.
    fn survival(&self, depth: u32, lane: &PathLane) -> f32 {
        if depth < FIRST_ROULETTE_DEPTH {
            return 1.0;
        }
        let whole = if lane.split { self.splitting as f32 } else { 1.0 };
        let throughput = (lane.beta.max_value() * lane.eta_scale * whole).sqrt();
        let limit = if self.max_depth.is_none() && depth >= LAST_SURVIVAL_DEPTH {
            LAST_SURVIVAL
        } else {
            1.0
        };
        throughput.min(limit)
    }

    /// Adds what the environment sends along a ray that left the scene.
    fn add_environment(&self, stage: &mut PathStage<'_, '_>, lane: &PathLane, ray: &Ray) {
        let slot = &mut stage.slots[lane.slot as usize];
        for (id, light) in stage.scene.environments() {
            let weight = self.weight_of_hit(lane, |p, n| {
                let pmf = stage.scene.light_sampler().pmf(p, n, id);
                SolidAnglePdf(pmf * light.pdf_li(p, ray.direction, ray.time).0)
            });
            slot.l += lane.beta * light.le(ray.origin, ray.direction, ray.time, &slot.lambda) * weight;
        }
    }

    /// Adds what the surface that a ray hit emits.
    #[inline]
    fn add_emission(&self, stage: &mut PathStage<'_, '_>, lane: &PathLane, si: &SurfaceInteraction) {
        let Some(id) = stage.scene.light_of(si.hit.geometry, si.hit.primitive) else {
            return;
        };
        let light = stage.scene.light(id);
        let slot = &mut stage.slots[lane.slot as usize];
        let le = light.le(si, si.wo, &slot.lambda);
        if le.is_black() {
            return;
        }
        let weight = self.weight_of_hit(lane, |p, n| {
            let pdf = stage.scene.light_sampler().pmf(p, n, id) * light.pdf_li(p, si).0;
            if self.fault.is(Fault::PdfInWrongMeasure) {
                return SolidAnglePdf(pdf * si.ng.dot(si.wo).abs() / p.distance_squared(si.p));
            }
            SolidAnglePdf(pdf)
        });
        slot.l += lane.beta * le * weight;
    }

    /// The weight of light that a lane's ray met, which light samples from point p with normal n would have found with the density
    /// `pdf_light(p, n)`.
    #[inline]
    fn weight_of_hit(&self, lane: &PathLane, pdf_light: impl FnOnce(Vec3, Vec3) -> SolidAnglePdf) -> f32 {
        match lane.state {
            Origin::Delta => 1.0,
            Origin::Sampled { p, n, pdf } => match self.strategy {
                Strategy::Bsdf => 1.0,
                Strategy::Light => 0.0,
                Strategy::Mis => self.weight(pdf, pdf_light(p, n)),
            },
        }
    }

    /// The weight of a sample with density `pdf` where the other technique has the density `other`.
    #[inline]
    fn weight(&self, pdf: SolidAnglePdf, other: SolidAnglePdf) -> f32 {
        if self.fault.is(Fault::LightTwice) {
            return 1.0;
        }
        match self.heuristic {
            Heuristic::Power => power_heuristic(pdf.0, other.0),
            Heuristic::Balance => balance_heuristic(pdf.0, other.0),
        }
    }

    /// Samples a point of a light and asks for its light.
    #[inline]
    fn sample_light(&self, stage: &mut PathStage<'_, '_>, event: &Event<'_>) -> Option<()> {
        let Event { lane, si, numbers, .. } = event;
        let chosen = stage.scene.light_sampler().sample(si.p, si.ns, numbers.which_light)?;
        let light = stage.scene.light(chosen.light);
        let sample = light.sample_li(si.p, si.time, numbers.light, &stage.slot(lane).lambda)?;
        let bsdf = event.bsdf.eval(si.wo, sample.wi, TransportMode::Radiance)?;
        if bsdf.f.is_black() {
            return None;
        }
        let cos = if self.fault.is(Fault::MissingCosine) {
            1.0
        } else {
            bsdf.cos_theta
        };
        let mut factor = cos / chosen.pmf;
        if let LightDensity::Continuous(pdf) = sample.density {
            if self.strategy == Strategy::Mis {
                factor *= self.weight(SolidAnglePdf(chosen.pmf * pdf.0), bsdf.pdf);
            }
            factor /= pdf.0;
        }
        if self.fault.is(Fault::WrongJacobian) {
            factor /= cos_at_light(&sample);
        }
        stage.connect(lane, si, &sample, lane.beta * bsdf.f * sample.li * factor);
        Some(())
    }
}

/// |cos| at the point of a light; 1 where it has no surface.
fn cos_at_light(sample: &LightSample) -> f32 {
    match sample.end {
        LightEnd::Point { ng, .. } if ng != Vec3::ZERO => ng.dot(sample.wi).abs(),
        LightEnd::Point { .. } | LightEnd::Infinity => 1.0,
    }
}
