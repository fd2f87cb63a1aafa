//! Unidirectional path tracing: next-event estimation and BSDF sampling at every vertex, combined by the power heuristic
//! (Veach 1997, section 9.2.4), and Russian roulette on the throughput.

use super::shadow::shadow_ray;
use super::wave::{EventNumbers, Lane, Origin, Slot, Stage};
use crate::geometry::{Ray, SurfaceInteraction};
use crate::light::LightDensity;
use crate::material::{Bsdf, Density, TransportMode};
use crate::math::Vec3;
use crate::sampling::power_heuristic;

/// The path tracer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PathIntegrator {
    /// The greatest number of scattering events, as in pbrt; `None` for any number.
    pub max_depth: Option<u32>,
}

/// From this depth on a path without limit survives with at most [`LAST_SURVIVAL`], or one between perfect mirrors would not end.
const LAST_SURVIVAL_DEPTH: u32 = 64;
const LAST_SURVIVAL: f32 = 0.95;

impl PathIntegrator {
    /// Shades the point that a lane's ray hit (or the environment, if it hit nothing), and gives the lane's next ray.
    #[inline]
    pub(super) fn shade(
        &self,
        stage: &mut Stage,
        lane: &Lane,
        ray: &Ray,
        surface: Option<SurfaceInteraction>,
        numbers: &EventNumbers,
    ) -> Option<(Lane, Ray)> {
        let Some(mut si) = surface else {
            add_environment(stage, lane, ray);
            return None;
        };
        let cone = lane.cone.after(si.p.distance(ray.origin));
        si.footprint = cone.width;
        let (si, wo) = (&si, si.wo);
        add_emission(stage, lane, si, wo);
        if self.max_depth == Some(stage.depth) {
            return None;
        }
        let slot = &mut stage.slots[lane.slot as usize];
        let bsdf = stage.scene.material(si.hit.geometry).bsdf(si, &mut slot.lambda);
        if !bsdf.is_delta() {
            sample_light(stage, lane, si, &bsdf, wo, numbers);
        }
        let sample = bsdf.sample_f(wo, numbers.lobe, numbers.bsdf, TransportMode::Radiance)?;
        let mut next = Lane {
            slot: lane.slot,
            beta: lane.beta * sample.weight(),
            eta_scale: lane.eta_scale * sample.eta * sample.eta,
            origin: match sample.density {
                Density::Delta(_) => Origin::Delta,
                Density::Continuous(pdf) => Origin::Sampled { p: si.p, n: si.ns, pdf },
            },
            cone,
        };
        let survival = self.survival(stage.depth, &next);
        if survival < 1.0 {
            if numbers.roulette >= survival {
                return None;
            }
            next.beta *= 1.0 / survival;
        }
        Some((next, si.spawn_ray(sample.wi)))
    }

    /// The probability with which a path goes on after the scattering event `depth`.
    fn survival(&self, depth: u32, lane: &Lane) -> f32 {
        if depth == 0 {
            return 1.0;
        }
        let throughput = lane.beta.max_value() * lane.eta_scale;
        let limit = if self.max_depth.is_none() && depth >= LAST_SURVIVAL_DEPTH {
            LAST_SURVIVAL
        } else {
            1.0
        };
        throughput.min(limit)
    }
}

/// Adds what the environment sends along a ray that left the scene.
fn add_environment(stage: &mut Stage, lane: &Lane, ray: &Ray) {
    let slot = &mut stage.slots[lane.slot as usize];
    for (id, light) in stage.scene.environments() {
        let weight = match lane.origin {
            Origin::Delta => 1.0,
            Origin::Sampled { p, n, pdf } => power_heuristic(
                pdf.0,
                stage.scene.light_sampler().pmf(p, n, id) * light.pdf_li(p, ray.direction, ray.time).0,
            ),
        };
        slot.l += lane.beta * light.le(ray.origin, ray.direction, ray.time, &slot.lambda) * weight;
    }
}

/// Adds what the surface that a ray hit emits.
#[inline]
fn add_emission(stage: &mut Stage, lane: &Lane, si: &SurfaceInteraction, wo: Vec3) {
    let Some(id) = stage.scene.light_of(si.hit.geometry, si.hit.primitive) else {
        return;
    };
    let light = stage.scene.light(id);
    let slot = &mut stage.slots[lane.slot as usize];
    let le = light.le(si, wo, &slot.lambda);
    if le.is_black() {
        return;
    }
    let weight = match lane.origin {
        Origin::Delta => 1.0,
        Origin::Sampled { p, n, pdf } => {
            power_heuristic(pdf.0, stage.scene.light_sampler().pmf(p, n, id) * light.pdf_li(p, si).0)
        }
    };
    slot.l += lane.beta * le * weight;
}

/// Samples a point of a light and queues the shadow ray to it.
#[inline]
fn sample_light(
    stage: &mut Stage,
    lane: &Lane,
    si: &SurfaceInteraction,
    bsdf: &Bsdf,
    wo: Vec3,
    numbers: &EventNumbers,
) -> Option<()> {
    let slot: &mut Slot = &mut stage.slots[lane.slot as usize];
    let chosen = stage.scene.light_sampler().sample(si.p, si.ns, numbers.which_light)?;
    let sample = stage
        .scene
        .light(chosen.light)
        .sample_li(si.p, si.time, numbers.light, &slot.lambda)?;
    let bsdf = bsdf.eval(wo, sample.wi, TransportMode::Radiance)?;
    if bsdf.f.is_black() {
        return None;
    }
    let mut factor = bsdf.cos_theta / chosen.pmf;
    if let LightDensity::Continuous(pdf) = sample.density {
        factor *= power_heuristic(chosen.pmf * pdf.0, bsdf.pdf.0) / pdf.0;
    }
    let ray = shadow_ray(si, sample.wi, sample.end);
    if ray.is_valid() {
        stage
            .shadows
            .push(&ray, lane.slot, lane.beta * bsdf.f * sample.li * factor);
    } else {
        slot.broken = true;
    }
    Some(())
}
