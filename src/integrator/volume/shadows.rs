//! Light by next-event estimation through media: on its way it is weakened, and passes boundaries between them.

use std::time::{Duration, Instant};

use super::flight::Chances;
use crate::accel::RayKind;
use crate::geometry::{Hit, HitPacket, LANES, Ray, RayQueue};
use crate::integrator::direct::DirectLight;
use crate::integrator::lane::Slot;
use crate::medium::MediumId;
use crate::sampling::SolidAnglePdf;
use crate::scene::Scene;
use crate::spectrum::SampledSpectrum;

/// What arrives at a slot if nothing is in the way of a ray to a light.
#[derive(Clone, Copy, Debug)]
pub(in crate::integrator) struct LightOnItsWay {
    pub slot: u32,
    /// Divided by its density, not weighed, weakened so far.
    pub value: SampledSpectrum,
    /// The medium that the rest of the ray starts in.
    pub medium: Option<MediumId>,
    /// Of a path that came to the light by the same way.
    pub chances: Chances,
    /// See [`FoundLight`](crate::integrator::direct::FoundLight).
    pub pdf_light: Option<SolidAnglePdf>,
    /// See [`FoundLight`](crate::integrator::direct::FoundLight).
    pub pdf_scatter: SolidAnglePdf,
}

/// The rays of a wave to lights.
#[derive(Debug, Default)]
pub(in crate::integrator) struct MediaShadows {
    rays: RayQueue,
    lights: Vec<LightOnItsWay>,
    hits: Vec<HitPacket>,
}

impl MediaShadows {
    /// Adds a ray, which must be valid.
    pub fn push(&mut self, ray: &Ray, light: LightOnItsWay) {
        self.rays.push(ray);
        self.lights.push(light);
    }

    pub fn len(&self) -> usize {
        self.lights.len()
    }

    /// Traces all rays to their ends and adds what is left of their light to the slots. Returns how many were traced, those anew after
    /// a boundary included, and the time inside the backend.
    pub fn flush(&mut self, scene: &Scene, direct: &DirectLight, slots: &mut [Slot]) -> (u64, Duration) {
        let (mut traced, mut elapsed) = (0, Duration::ZERO);
        while !self.rays.is_empty() {
            traced += self.rays.len() as u64;
            elapsed += self.trace(scene);
            let Self { rays, lights, hits } = std::mem::take(self);
            for (i, light) in lights.iter().enumerate() {
                let (packet, lane) = (i / LANES, i % LANES);
                if !rays.packets()[packet].is_occluded(lane) {
                    let hit = hits.get(packet).and_then(|hits| Some((hits.get(lane)?, hits.t[lane])));
                    let ray = &rays.packets()[packet].get(lane);
                    self.arrive(scene, direct, &mut slots[light.slot as usize], (ray, hit), *light);
                }
            }
        }
        (traced, elapsed)
    }

    /// Finds what is in the way of each ray: only whether anything is if there are no boundaries to pass.
    fn trace(&mut self, scene: &Scene) -> Duration {
        let start = Instant::now();
        self.hits.clear();
        if scene.has_interfaces() {
            self.hits.resize(self.rays.packets().len(), HitPacket::EMPTY);
            scene.intersect(RayKind::Bounce, self.rays.packets(), &mut self.hits);
        } else {
            scene.occluded(RayKind::Shadow, self.rays.packets_mut());
        }
        start.elapsed()
    }

    /// Takes light to the end of a ray: to a light, to what blocks it, or to a boundary, from which it goes on.
    fn arrive(
        &mut self,
        scene: &Scene,
        direct: &DirectLight,
        slot: &mut Slot,
        (ray, hit): (&Ray, Option<(Hit, f32)>),
        mut light: LightOnItsWay,
    ) {
        let met = hit.map(|(hit, t)| scene.interaction(ray, hit, t));
        if met.is_some_and(|si| !scene.is_interface(si.hit.geometry)) {
            return;
        }
        let distance = met.map_or(ray.tfar * ray.direction.length(), |si| si.p.distance(ray.origin));
        if let Some(id) = light.medium {
            let medium = scene.medium(id);
            let (transmittance, _) = light.chances.pass(medium, &medium.at(&slot.lambda), distance);
            light.value *= transmittance;
            if light.value.is_black() {
                return;
            }
        }
        let Some(si) = met else {
            let of_scatter = SolidAnglePdf(light.pdf_scatter.0 * light.chances.passed());
            slot.l += light.value * direct.weight_of_light(light.pdf_light, of_scatter);
            return;
        };
        let rest = si.rest_of_ray(ray);
        if !rest.is_valid() {
            slot.broken = true;
            return;
        }
        light.medium = scene.medium_beyond(&si, ray.direction, light.medium);
        self.push(&rest, light);
    }
}
