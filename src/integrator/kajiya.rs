//! The rendering equation (Kajiya 1986), estimated literally: the oracle that the other integrators are held against.
//!
//! At the point that a ray meets: with probability alpha the estimate is L_e alone; else it is L_e plus, over 1 - alpha, the
//! probability of going on,
//!
//! - the mean over N directions wi, drawn from a density P, of f(wo, wi) L(wi) |cos| / P(wi), where L(wi) is estimated in the same way;
//! - for lights that no such direction meets (points, distant ones): their sum, each with its shadow ray.
//!
//! Where the BSDF is a delta function directions are drawn from itself. Where it has delta lobes beside others and P does not know
//! them, each of the N draws is from P or, by a fair coin, from the BSDF, of which only the delta lobes count then.

use super::lane::Lane;
use super::numbers::EventNumbers;
use super::stage::{Estimator, Stage, Vertex};
use crate::desc::{Distribution, Termination};
use crate::geometry::{Ray, SurfaceInteraction};
use crate::material::{Bsdf, Density, TransportMode};
use crate::math::{Vec2, Vec3};
use crate::sampling::{SolidAnglePdf, warp};
use crate::scene::View;
use crate::spectrum::SampledSpectrum;

/// The literal estimator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KajiyaIntegrator {
    /// The greatest number of scattering events; `None` for any number.
    pub max_depth: Option<u32>,
    /// How alpha is chosen.
    pub termination: Termination,
    /// N.
    pub branching: u32,
    /// P.
    pub distribution: Distribution,
}

/// Bounds of alpha where it follows the albedo.
const ALPHA: std::ops::RangeInclusive<f32> = 0.05..=0.95;

/// A direction that a path goes on in, and what its throughput is multiplied by.
struct Direction {
    wi: Vec3,
    weight: SampledSpectrum,
}

impl Estimator for KajiyaIntegrator {
    type State = ();
    type Memory<'s> = ();

    fn camera_state(&self, _view: &View, _ray: &Ray) {}

    fn shade<'s>(&self, stage: &mut Stage<'_, 's, Self>, vertex: Vertex<'_, ()>) {
        let Vertex { lane, ray, cone, .. } = vertex;
        let Some(si) = vertex.surface else {
            for (_, light) in stage.scene.environments() {
                let le = light.le(ray.origin, ray.direction, ray.time, &stage.slot(lane).lambda);
                stage.add(lane, lane.beta * le);
            }
            return;
        };
        if let Some(id) = stage.scene.light_of(si.hit.geometry, si.hit.primitive) {
            let le = stage.scene.light(id).le(si, si.wo, &stage.slot(lane).lambda);
            stage.add(lane, lane.beta * le);
        }
        if self.max_depth == Some(stage.depth) {
            return;
        }
        let lambda = &mut stage.slots[lane.slot as usize].lambda;
        let bsdf = stage.scene.material(si.hit.geometry).bsdf(si, lambda);
        let alpha = match self.termination {
            Termination::Constant(alpha) => alpha,
            Termination::Albedo => (1.0 - albedo(&bsdf, si.wo)).clamp(*ALPHA.start(), *ALPHA.end()),
        };
        let numbers = vertex.numbers();
        if numbers.roulette < alpha {
            return;
        }
        let whole = Lane {
            beta: lane.beta * (1.0 / (1.0 - alpha)),
            cone,
            ..*lane
        };
        if !bsdf.is_delta() {
            add_delta_lights(stage, &whole, si, &bsdf, numbers.light);
        }
        for branch in 0..self.branching {
            let mut next = whole;
            let mut numbers = numbers;
            if self.branching > 1 {
                next.stream = lane.stream.branch(branch);
                numbers = EventNumbers::draw(&next.stream, stage.depth);
            }
            if let Some(direction) = self.direction(&bsdf, si.wo, &numbers) {
                next.beta = whole.beta * direction.weight * (1.0 / self.branching as f32);
                stage.go_on(&next, &si.spawn_ray(direction.wi));
            }
        }
    }
}

impl KajiyaIntegrator {
    /// Draws a direction; `None` carries nothing.
    fn direction(&self, bsdf: &Bsdf, wo: Vec3, numbers: &EventNumbers) -> Option<Direction> {
        let from_bsdf = |lobe| {
            let sample = bsdf.sample_f(wo, lobe, numbers.bsdf, TransportMode::Radiance)?;
            let is_delta = matches!(sample.density, Density::Delta(_));
            let (wi, weight) = (sample.wi, sample.weight());
            Some((Direction { wi, weight }, is_delta))
        };
        if self.distribution == Distribution::Bsdf || bsdf.is_delta() {
            return from_bsdf(numbers.lobe).map(|(direction, _)| direction);
        }
        if !bsdf.has_delta() {
            return self.drawn_from_distribution(bsdf, wo, numbers.lobe, numbers.bsdf);
        }
        let twice = |direction: Direction| Direction {
            weight: direction.weight * 2.0,
            ..direction
        };
        if numbers.lobe < 0.5 {
            let (direction, is_delta) = from_bsdf(2.0 * numbers.lobe)?;
            is_delta.then(|| twice(direction))
        } else {
            self.drawn_from_distribution(bsdf, wo, 2.0 * numbers.lobe - 1.0, numbers.bsdf)
                .map(twice)
        }
    }

    /// Draws a direction from P: over the hemisphere of `wo`, or over both where the surface transmits.
    fn drawn_from_distribution(&self, bsdf: &Bsdf, wo: Vec3, u_side: f32, u: Vec2) -> Option<Direction> {
        let (mut local, pdf) = match self.distribution {
            Distribution::Cosine => {
                let w = warp::sample_cosine_hemisphere(u);
                (w, warp::cosine_hemisphere_pdf(w.z))
            }
            Distribution::Uniform | Distribution::Bsdf => {
                (warp::sample_uniform_hemisphere(u), warp::uniform_hemisphere_pdf())
            }
        };
        let transmits = bsdf.transmits();
        let other_side = transmits && u_side < 0.5;
        let pdf = SolidAnglePdf(if transmits { 0.5 * pdf.0 } else { pdf.0 });
        if (bsdf.frame().to_local(wo).z < 0.0) != other_side {
            local.z = -local.z;
        }
        let wi = bsdf.frame().to_world(local).normalize();
        let value = bsdf.eval(wo, wi, TransportMode::Radiance)?;
        let weight = value.f * (value.cos_theta / pdf.0);
        (pdf.0 > 0.0 && !weight.is_black()).then_some(Direction { wi, weight })
    }
}

/// Adds the light of all lights that no direction drawn from a density meets.
fn add_delta_lights(
    stage: &mut Stage<'_, '_, KajiyaIntegrator>,
    lane: &Lane<()>,
    si: &SurfaceInteraction,
    bsdf: &Bsdf,
    u: Vec2,
) {
    for light in stage.scene.lights().iter().filter(|light| light.is_delta()) {
        let Some(sample) = light.sample_li(si.p, si.time, u, &stage.slot(lane).lambda) else {
            continue;
        };
        if let Some(value) = bsdf.eval(si.wo, sample.wi, TransportMode::Radiance) {
            let value = lane.beta * value.f * sample.li * value.cos_theta;
            stage.connect(lane, si, &sample, value);
        }
    }
}

/// About how much of the light from `wo` a surface scatters: the mean over four directions. Any value keeps the estimate's mean.
fn albedo(bsdf: &Bsdf, wo: Vec3) -> f32 {
    const POINTS: [[f32; 3]; 4] = [
        [0.125, 0.125, 0.625],
        [0.375, 0.625, 0.125],
        [0.625, 0.375, 0.875],
        [0.875, 0.875, 0.375],
    ];
    let weight = |[lobe, x, y]: [f32; 3]| {
        let sample = bsdf.sample_f(wo, lobe, Vec2::new(x, y), TransportMode::Radiance);
        sample.map_or(0.0, |sample| sample.weight().max_value())
    };
    POINTS.into_iter().map(weight).sum::<f32>() / POINTS.len() as f32
}
