//! Unidirectional path tracing: next-event estimation and BSDF sampling at every vertex, combined by the power heuristic
//! (Veach 1997, section 9.2.4), and Russian roulette on the throughput.

use super::shadow::shadow_ray;
use super::wave::{FIRST_PATH_GROUP, Lane, Origin, Slot, Stage};
use crate::geometry::{Hit, Ray, SurfaceInteraction};
use crate::light::LightDensity;
use crate::material::{Bsdf, Density, TransportMode};
use crate::math::{Vec2, Vec3};
use crate::sampling::power_heuristic;
use crate::spectrum::SampledSpectrum;

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
    pub(super) fn shade(&self, stage: &mut Stage, lane: &Lane, ray: &Ray, hit: Option<Hit>) -> Option<(Lane, Ray)> {
        let Some(hit) = hit else {
            add_environment(stage, lane, ray);
            return None;
        };
        let mut si = stage.scene.world().interaction(ray, hit);
        let cone = lane.cone.after(si.t);
        si.footprint = cone.width;
        let wo = -ray.direction;
        add_emission(stage, lane, &si, wo);
        if self.max_depth == Some(stage.depth) {
            return None;
        }
        let slot = &mut stage.slots[lane.slot as usize];
        let bsdf = stage.scene.material(hit.geometry).bsdf(&si, &mut slot.lambda);
        let [light_x, light_y, u_light, u_roulette] = slot.stream.draw4(FIRST_PATH_GROUP + 2 * stage.depth);
        let bsdf_group = FIRST_PATH_GROUP + 2 * stage.depth + 1;
        // The first two numbers are the same, and cheaper alone.
        let ([bsdf_x, bsdf_y], u_lobe) = if bsdf.has_several_lobes() {
            let [x, y, lobe, _] = slot.stream.draw4(bsdf_group);
            ([x, y], lobe)
        } else {
            (slot.stream.draw2(bsdf_group), 0.0)
        };
        if !bsdf.is_delta() {
            sample_light(stage, lane, &si, &bsdf, wo, u_light, Vec2::new(light_x, light_y));
        }

        let sample = bsdf.sample_f(wo, u_lobe, Vec2::new(bsdf_x, bsdf_y), TransportMode::Radiance)?;
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
            if u_roulette >= survival {
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
    u_light: f32,
    u: Vec2,
) -> Option<()> {
    let slot: &mut Slot = &mut stage.slots[lane.slot as usize];
    let chosen = stage.scene.light_sampler().sample(si.p, si.ns, u_light)?;
    let sample = stage
        .scene
        .light(chosen.light)
        .sample_li(si.p, si.time, u, &slot.lambda)?;
    let f: SampledSpectrum = bsdf.f(wo, sample.wi, TransportMode::Radiance);
    if f.is_black() {
        return None;
    }
    let mut factor = bsdf.abs_cos(sample.wi) / chosen.pmf;
    if let LightDensity::Continuous(pdf) = sample.density {
        let pdf_light = chosen.pmf * pdf.0;
        let pdf_bsdf = bsdf.pdf(wo, sample.wi, TransportMode::Radiance).0;
        factor *= power_heuristic(pdf_light, pdf_bsdf) / pdf.0;
    }
    let ray = shadow_ray(si, sample.wi, sample.end);
    if ray.is_valid() {
        stage.shadows.push(&ray, lane.slot, lane.beta * f * sample.li * factor);
    } else {
        slot.broken = true;
    }
    Some(())
}
