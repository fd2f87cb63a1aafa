//! Deferred visibility: every shadow ray of a wave goes through one queue, with what it brings if nothing is in its way.

use std::time::{Duration, Instant};

use super::queue::{Packet, Queue};
use crate::accel::RayKind;
use crate::geometry::{LANES, Ray, SurfaceInteraction};
use crate::light::LightEnd;
use crate::math::{Each, Vec2, Vec3, columns};
use crate::scene::Scene;
use crate::spectrum::{SampledSpectrum, SpectrumLanes};

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

/// Eight of them.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(32))]
pub(super) struct ContributionLanes {
    pub slot: [u32; LANES],
    pub note: [u32; LANES],
    pub value: SpectrumLanes,
}

columns!(ContributionLanes { slot, note, value });

impl Packet for ContributionLanes {
    type Lane = Contribution;

    #[inline(always)]
    fn all(Contribution { slot, note, value }: Contribution) -> Self {
        Self {
            slot: [slot; LANES],
            note: [note; LANES],
            value: SpectrumLanes::all(value),
        }
    }

    #[inline(always)]
    fn get(&self, lane: usize) -> Contribution {
        Contribution {
            slot: self.slot[lane],
            note: self.note[lane],
            value: self.value.get(lane),
        }
    }

    #[inline(always)]
    fn set(&mut self, lane: usize, Contribution { slot, note, value }: Contribution) {
        (self.slot[lane], self.note[lane]) = (slot, note);
        self.value.set(lane, value);
    }
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

/// Eight of them.
pub(super) type SplatLanes = Each<SplatContribution>;

/// Shadow rays and their contributions, in the order in which they were found.
pub(super) type ShadowQueue<P> = Queue<P>;

impl<P: Packet> ShadowQueue<P> {
    /// Traces all rays, hands the contributions of those that are not blocked to `add` in order, and empties the queue. Returns
    /// the time inside the backend.
    pub fn flush(&mut self, scene: &Scene, mut add: impl FnMut(P::Lane)) -> Duration {
        if self.is_empty() {
            return Duration::ZERO;
        }
        let start = Instant::now();
        scene.occluded(RayKind::Shadow, self.rays_mut());
        let elapsed = start.elapsed();
        for (rays, contributions) in self.packets() {
            // Lanes without a ray look as if something were in the way.
            for lane in (0..LANES).filter(|&lane| !rays.is_occluded(lane)) {
                add(contributions.get(lane));
            }
        }
        self.clear();
        elapsed
    }
}
