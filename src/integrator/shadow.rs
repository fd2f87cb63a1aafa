//! Deferred visibility: every shadow ray of a wave goes through one queue, with what it brings if nothing is in its way.

use std::time::{Duration, Instant};

use crate::accel::RayKind;
use crate::geometry::{LANES, Ray, RayQueue, SurfaceInteraction};
use crate::light::LightEnd;
use crate::math::{Vec2, Vec3};
use crate::scene::Scene;
use crate::spectrum::SampledSpectrum;

/// The ray from `si` in direction `wi` to where a light was sampled. It ends just before the light's own surface.
#[inline]
pub(super) fn shadow_ray(si: &SurfaceInteraction, wi: Vec3, end: LightEnd) -> Ray {
    match end {
        LightEnd::Point { p, error, ng } => si.spawn_ray_to(p, error, ng),
        LightEnd::Infinity => si.spawn_ray(wi),
    }
}

/// What arrives at a slot if a shadow ray is not blocked.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contribution {
    pub slot: u32,
    /// See [`Estimator::arrived`](super::stage::Estimator::arrived), or [`NO_NOTE`].
    pub note: u32,
    pub value: SampledSpectrum,
}

/// Of a contribution that its estimator has not noted.
pub(super) const NO_NOTE: u32 = u32::MAX;

/// What a light path brings to a place of the film if a shadow ray is not blocked.
#[derive(Clone, Copy, Debug)]
pub(super) struct SplatContribution {
    /// Whose wavelengths it has.
    pub slot: u32,
    /// As [`Contribution::note`].
    pub note: u32,
    /// In pixels of the whole picture; may be outside of it by the radius of the filter.
    pub film: Vec2,
    /// Spectral radiance, to be divided by the number of all light paths.
    pub value: SampledSpectrum,
}

/// Shadow rays and their contributions, in the order in which they were found.
#[derive(Debug)]
pub(super) struct ShadowQueue<T> {
    rays: RayQueue,
    contributions: Vec<T>,
}

impl<T> Default for ShadowQueue<T> {
    fn default() -> Self {
        Self {
            rays: RayQueue::default(),
            contributions: Vec::new(),
        }
    }
}

impl<T: Copy> ShadowQueue<T> {
    /// Adds a ray, which must be valid, and what it brings.
    #[inline(always)]
    pub fn push(&mut self, ray: &Ray, contribution: T) {
        self.rays.push(ray);
        self.contributions.push(contribution);
    }

    /// Number of rays.
    pub fn len(&self) -> usize {
        self.contributions.len()
    }

    /// Traces all rays, hands the contributions of those that are not blocked to `add` in order, and empties the queue. Returns
    /// the time inside the backend.
    pub fn flush(&mut self, scene: &Scene, mut add: impl FnMut(T)) -> Duration {
        if self.contributions.is_empty() {
            return Duration::ZERO;
        }
        let start = Instant::now();
        scene.occluded(RayKind::Shadow, self.rays.packets_mut());
        let elapsed = start.elapsed();
        for (rays, contributions) in self.rays.packets().iter().zip(self.contributions.chunks(LANES)) {
            for (lane, contribution) in contributions.iter().enumerate() {
                if !rays.is_occluded(lane) {
                    add(*contribution);
                }
            }
        }
        self.rays.clear();
        self.contributions.clear();
        elapsed
    }
}
