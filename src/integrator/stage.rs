//! What an estimator is given at the points that a batch's rays met, and what it may do there: add light, ask for light through
//! shadow rays, and go on.

use super::RenderStats;
use super::lane::{Batch, Lane, Slot};
use super::numbers::EventNumbers;
use super::shadow::{ShadowQueue, shadow_ray};
use super::wave::WAVE_LANES;
use crate::geometry::{Ray, RayCone, SurfaceInteraction};
use crate::light::LightSample;
use crate::scene::Scene;
use crate::spectrum::SampledSpectrum;

/// An estimator of the radiance along camera rays, one scattering event after the other.
pub(super) trait Estimator: Sync {
    /// Takes a path to its next scattering event.
    fn shade(&self, stage: &mut Stage<'_>, vertex: Vertex<'_>);
}

/// Where a lane's ray ended.
pub(super) struct Vertex<'a> {
    /// The path.
    pub lane: &'a Lane,
    /// Its ray.
    pub ray: &'a Ray,
    /// What it hit; `None` if it left the scene.
    pub surface: Option<&'a SurfaceInteraction>,
    /// The cone of the ray from there on.
    pub cone: RayCone,
    /// Random numbers for the scattering event there.
    pub numbers: &'a EventNumbers,
}

/// Shadow rays that are traced before the end of a batch, if there are so many.
const MOST_SHADOWS: usize = 1 << 14;

/// The shading of a batch.
pub(super) struct Stage<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Scattering events before this stage.
    pub depth: u32,
    /// All slots.
    pub slots: &'a mut [Slot],
    pub(super) shadows: &'a mut ShadowQueue,
    pub(super) pending: &'a mut Vec<Batch>,
    pub(super) spare: &'a mut Vec<Batch>,
    /// Where paths that go on are collected.
    pub(super) next: Batch,
}

impl Stage<'_> {
    /// The slot of a lane.
    #[inline]
    pub fn slot(&mut self, lane: &Lane) -> &mut Slot {
        &mut self.slots[lane.slot as usize]
    }

    /// Adds light to the slot of a lane.
    #[inline]
    pub fn add(&mut self, lane: &Lane, l: SampledSpectrum) {
        self.slots[lane.slot as usize].l += l;
    }

    /// Sends a path on its way by `ray`.
    #[inline]
    pub fn go_on(&mut self, lane: &Lane, ray: &Ray) {
        if !ray.is_valid() {
            self.slot(lane).broken = true;
            return;
        }
        if self.next.lanes.len() == WAVE_LANES as usize {
            self.finish_batch();
            self.start_batch();
        }
        self.next.push(lane, ray);
    }

    /// Adds `value` to the slot of a lane if nothing is between `si` and the point of a light that was sampled.
    #[inline]
    pub fn connect(&mut self, lane: &Lane, si: &SurfaceInteraction, light: &LightSample, value: SampledSpectrum) {
        let ray = shadow_ray(si, light.wi, light.end);
        if ray.is_valid() {
            self.shadows.push(&ray, lane.slot, value);
        } else {
            self.slot(lane).broken = true;
        }
    }

    /// Begins to collect paths.
    pub(super) fn start_batch(&mut self) {
        self.next = self.spare.pop().unwrap_or_default();
        self.next.clear();
        self.next.depth = self.depth + 1;
    }

    /// Leaves the collected paths to be traced.
    pub(super) fn finish_batch(&mut self) {
        let batch = std::mem::take(&mut self.next);
        if batch.lanes.is_empty() {
            self.spare.push(batch);
        } else {
            self.pending.push(batch);
        }
    }

    /// Traces the shadow rays if there are many.
    pub(super) fn limit_shadows(&mut self, stats: &mut RenderStats) {
        if self.shadows.len() >= MOST_SHADOWS {
            self.flush_shadows(stats);
        }
    }

    /// Traces all shadow rays.
    pub(super) fn flush_shadows(&mut self, stats: &mut RenderStats) {
        stats.shadow_rays += self.shadows.len() as u64;
        let slots = &mut *self.slots;
        stats.backend_time += self
            .shadows
            .flush(self.scene, |slot, value| slots[slot as usize].l += value);
    }
}
