//! What an estimator is given at the points that a batch's rays met, and what it may do there: add light, ask for light through
//! shadow rays, and go on.

use std::sync::Mutex;

use super::RenderStats;
use super::lane::{Batch, Lane, LanePacket, LaneState, Slot};
use super::numbers::{EventLanes, EventNumbers};
use super::shadow::{Contribution, ContributionLanes, NO_NOTE, ShadowQueue, SplatContribution, SplatLanes, shadow_ray};
use super::wave::WAVE_LANES;
use crate::film::{Film, TileSums};
use crate::geometry::{Hit, HitPacket, LANES, Ray, RayCone, RayLanes, RayPacket, SurfaceInteraction, SurfaceLanes};
use crate::light::LightSample;
use crate::material::TransportMode;
use crate::math::{Columns, LaneSet, Vectorizer};
use crate::sampling::SampleStream;
use crate::scene::{Scene, View};
use crate::spectrum::{ColorMode, SampledSpectrum, Wavelengths};

/// An estimator of the radiance along camera rays, one scattering event after the other; or of what light paths bring to the
/// camera.
pub(super) trait Estimator: Sync + Sized {
    /// What a path carries from event to event, beside what [`Lane`] has.
    type State: LaneState;
    /// What a wave keeps of its light paths, to connect its camera paths to.
    type Memory<'s>: Default;
    /// Whether each pixel sample has a light path, which goes before its camera path.
    const LIGHT_PATHS: bool = false;

    /// What a camera path starts with.
    fn camera_state(&self, view: &View, ray: &Ray) -> Self::State;

    /// The wavelengths and the time of all paths of a pass, where they share them; else each pixel sample has its own.
    fn moment(&self) -> Option<Moment> {
        None
    }

    /// What a wave starts with that renders to `film`.
    fn memory<'s>(&self, film: &Film) -> Self::Memory<'s> {
        let _ = film;
        Default::default()
    }

    /// Takes to the layers of the film what a wave kept for them.
    fn retire_layers(&self, memory: &mut Self::Memory<'_>, wave: &Retiring<'_>) {
        let _ = (memory, wave);
    }

    /// A contribution with this note was not blocked: what the estimator noted of it in `memory` counts.
    fn arrived(memory: &mut Self::Memory<'_>, note: u32) {
        let _ = (memory, note);
    }

    /// How many shadow rays the estimator keeps for itself, in `memory`.
    fn own_shadows(memory: &Self::Memory<'_>) -> usize {
        let _ = memory;
        0
    }

    /// Traces those, and adds what they bring to the slots.
    fn flush_own_shadows(
        &self,
        scene: &Scene,
        memory: &mut Self::Memory<'_>,
        slots: &mut [Slot],
        stats: &mut RenderStats,
    ) {
        let _ = (scene, memory, slots, stats);
    }

    /// Starts the light path of a slot.
    fn emit<'s>(&self, stage: &mut Stage<'_, 's, Self>, slot: u32, stream: SampleStream) {
        let _ = (stage, slot, stream);
    }

    /// Takes paths to their next scattering events, or ends, that can be taken there together, and says which of `packet` those are: the others,
    /// and all where nothing is gained, are [shaded](Self::shade) one by one. What a path brings and where it goes must not depend on the
    /// paths beside it.
    fn shade_together<'s>(&self, stage: &mut Stage<'_, 's, Self>, packet: &PacketVertices<'_, Self::State>) -> LaneSet {
        let _ = (stage, packet);
        LaneSet::NONE
    }

    /// Takes a path to its next scattering event.
    fn shade<'s>(&self, stage: &mut Stage<'_, 's, Self>, vertex: Vertex<'_, Self::State>);
}

/// At which wavelengths and at which time paths are followed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moment {
    /// Chooses the wavelengths, in [0, 1).
    pub wavelength: f32,
    /// Chooses the time within the shutter's opening, in [0, 1).
    pub time: f32,
}

impl Moment {
    /// The wavelengths that it means for transport in `color`.
    #[inline]
    pub fn wavelengths(&self, color: ColorMode) -> Wavelengths {
        match color {
            ColorMode::Spectral => Wavelengths::sample_visible(self.wavelength),
            ColorMode::Rgb => Wavelengths::rgb(),
        }
    }
}

/// A wave whose paths have ended.
pub(super) struct Retiring<'a> {
    pub view: &'a View,
    pub film: &'a Film,
    pub slots: &'a [Slot],
    /// The tile of the film that has the pixels of the slots, or some of them.
    pub tile: Option<&'a Mutex<TileSums>>,
}

/// Where a lane's ray ended.
pub(super) struct Vertex<'a, S> {
    /// The path.
    pub lane: &'a Lane<S>,
    /// Its ray.
    pub ray: &'a Ray,
    /// What it hit; `None` if it left the scene.
    pub surface: Option<&'a SurfaceInteraction>,
    /// The cone of the ray from there on.
    pub cone: RayCone,
    /// Which lane of its packet it is, and the packet's random numbers: see [`Vertex::numbers`].
    pub index: usize,
    pub events: &'a EventLanes<'a>,
}

impl<S> Vertex<'_, S> {
    /// Random numbers for the scattering event there.
    #[inline]
    pub fn numbers(&self) -> EventNumbers {
        self.events.get(self.index)
    }
}

/// Where the rays of a packet ended.
pub(super) struct PacketVertices<'a, S: LaneState> {
    /// Those that are paths, and whose rays were traced.
    pub active: LaneSet,
    /// The paths.
    pub lanes: &'a LanePacket<S>,
    /// Their rays.
    pub rays: &'a RayPacket,
    /// What they hit.
    pub hits: &'a HitPacket,
    /// The surfaces there.
    pub surfaces: &'a SurfaceLanes<'a>,
    /// Random numbers for the scattering events there.
    pub numbers: &'a EventLanes<'a>,
}

impl<S: LaneState> PacketVertices<'_, S> {
    /// The surface that a lane `hit`.
    #[inline]
    pub fn surface(&self, lane: usize, hit: Hit) -> SurfaceInteraction {
        SurfaceInteraction {
            footprint: self.cone(lane).width,
            ..self.surfaces.get(lane, hit, self.rays, self.hits)
        }
    }

    /// The cone of the ray from the surface on that a lane hit.
    #[inline]
    pub fn cone(&self, lane: usize) -> RayCone {
        self.lanes.cone(lane).after(self.surfaces.all().distance[lane])
    }
}

/// Shadow rays that are traced before the end of a batch, if there are so many.
const MOST_SHADOWS: usize = 1 << 14;

/// The shading of a batch.
pub(super) struct Stage<'a, 's, E: Estimator> {
    /// The scene.
    pub scene: &'s Scene,
    /// The picture.
    pub view: &'s View,
    pub(super) estimator: &'s E,
    pub(super) vectorizer: Vectorizer,
    /// What the paths of the batch carry.
    pub mode: TransportMode,
    /// Scattering events before this stage.
    pub depth: u32,
    /// All slots.
    pub slots: &'a mut [Slot],
    /// The estimator's own.
    pub memory: &'a mut E::Memory<'s>,
    pub(super) shadows: &'a mut ShadowQueue<ContributionLanes>,
    pub(super) splats: &'a mut ShadowQueue<SplatLanes>,
    pub(super) landed: &'a mut Vec<SplatContribution>,
    pub(super) pending: &'a mut Vec<Batch<E::State>>,
    pub(super) spare: &'a mut Vec<Batch<E::State>>,
    /// Where paths are collected that go on without having been scattered: no more than the batch has.
    pub(super) passed: Batch<E::State>,
    /// Where paths that go on are collected.
    pub(super) next: Batch<E::State>,
}

impl<E: Estimator> Stage<'_, '_, E> {
    /// The slot of a lane.
    #[inline]
    pub fn slot(&mut self, lane: &Lane<E::State>) -> &mut Slot {
        &mut self.slots[lane.slot as usize]
    }

    /// Adds light to the slot of a lane.
    #[inline]
    pub fn add(&mut self, lane: &Lane<E::State>, l: SampledSpectrum) {
        self.slots[lane.slot as usize].l += l;
    }

    /// Sends a path on its way by `ray`.
    #[inline]
    pub fn go_on(&mut self, lane: &Lane<E::State>, ray: &Ray) {
        self.go_on_if(ray.is_valid(), lane, ray);
    }

    /// [`Self::go_on`] by a ray of which it is known whether it is valid.
    #[inline(always)]
    pub fn go_on_if(&mut self, is_valid: bool, lane: &Lane<E::State>, ray: &Ray) {
        if !is_valid {
            self.slot(lane).broken = true;
            return;
        }
        self.make_room(1);
        self.next.paths.push(ray, *lane);
    }

    /// [`Self::go_on`] of the `chosen` ones of the paths that `lanes` become by `rays` that are valid.
    #[inline(always)]
    pub fn go_on_together(
        &mut self,
        chosen: LaneSet,
        rays: &RayLanes,
        next: &impl Columns<LanePacket<E::State>>,
        lanes: &LanePacket<E::State>,
    ) {
        self.make_room(LANES);
        self.next.paths.append(self.vectorizer, chosen, rays, next, lanes);
    }

    /// Notes that the `chosen` lanes have rays that cannot be traced.
    #[inline]
    pub fn note_broken(&mut self, chosen: LaneSet, lanes: &LanePacket<E::State>) {
        for lane in chosen.lanes() {
            self.slots[lanes.slot[lane] as usize].broken = true;
        }
    }

    /// Begins another batch if the paths that are collected and `more` would be too many for one.
    #[inline(always)]
    fn make_room(&mut self, more: usize) {
        if self.next.paths.len() + more > WAVE_LANES as usize {
            let depth = self.next.depth;
            self.finish_batch();
            self.start_batch(depth);
        }
    }

    /// Adds `value` to the slot of a lane if nothing is between `si` and the point of a light that was sampled.
    #[inline]
    pub fn connect(
        &mut self,
        lane: &Lane<E::State>,
        si: &SurfaceInteraction,
        light: &LightSample,
        value: SampledSpectrum,
    ) {
        let (slot, note) = (lane.slot, NO_NOTE);
        self.add_unless_occluded(&shadow_ray(si, light.wi, light.end), Contribution { slot, note, value });
    }

    /// Adds a contribution to its slot if nothing is in the way of `ray`.
    #[inline]
    pub fn add_unless_occluded(&mut self, ray: &Ray, contribution: Contribution) {
        self.add_unless_occluded_if(ray.is_valid(), ray, contribution);
    }

    /// [`Self::add_unless_occluded`] by a ray of which it is known whether it is valid.
    #[inline(always)]
    pub fn add_unless_occluded_if(&mut self, is_valid: bool, ray: &Ray, contribution: Contribution) {
        if is_valid {
            self.shadows.push(ray, contribution);
        } else {
            self.slots[contribution.slot as usize].broken = true;
        }
    }

    /// [`Self::add_unless_occluded`] of the `chosen` lanes of packets of `rays` that are valid.
    #[inline(always)]
    pub fn add_unless_occluded_together(
        &mut self,
        chosen: LaneSet,
        rays: &RayLanes,
        contributions: &impl Columns<ContributionLanes>,
    ) {
        let any = &ContributionLanes::default();
        self.shadows.append(self.vectorizer, chosen, rays, contributions, any);
    }

    /// Splats a contribution of a slot's light path if nothing is in the way of `ray`.
    pub fn splat_unless_occluded(&mut self, ray: &Ray, splat: SplatContribution) {
        if ray.is_valid() {
            self.splats.push(ray, splat);
        } else {
            self.slots[splat.slot as usize].broken = true;
        }
    }

    /// Sends a path on its way by `ray` that was not scattered: in a batch of its own, of the same depth.
    pub fn pass_on(&mut self, lane: &Lane<E::State>, ray: &Ray) {
        if !ray.is_valid() {
            self.slot(lane).broken = true;
            return;
        }
        if self.passed.paths.is_empty() {
            self.passed = self.spare.pop().unwrap_or_default();
            self.passed.restart(self.mode, self.depth);
        }
        self.passed.paths.push(ray, *lane);
    }

    /// Begins to collect paths of `depth`.
    pub(super) fn start_batch(&mut self, depth: u32) {
        self.next = self.spare.pop().unwrap_or_default();
        self.next.restart(self.mode, depth);
    }

    /// Leaves the collected paths to be traced.
    pub(super) fn finish_batch(&mut self) {
        let batch = std::mem::take(&mut self.next);
        if batch.paths.is_empty() {
            self.spare.push(batch);
        } else {
            self.pending.push(batch);
        }
    }

    /// Leaves all paths that go on to be traced.
    pub(super) fn finish(&mut self) {
        let passed = std::mem::take(&mut self.passed);
        if !passed.paths.is_empty() {
            self.pending.push(passed);
        }
        self.finish_batch();
    }

    /// Traces the shadow rays if there are many.
    pub(super) fn limit_shadows(&mut self, stats: &mut RenderStats) {
        if self.shadows.len() + self.splats.len() + E::own_shadows(self.memory) >= MOST_SHADOWS {
            self.flush_shadows(stats);
        }
    }

    /// Traces all shadow rays.
    pub(super) fn flush_shadows(&mut self, stats: &mut RenderStats) {
        stats.shadow_rays += (self.shadows.len() + self.splats.len()) as u64;
        let (slots, landed, memory) = (&mut *self.slots, &mut *self.landed, &mut *self.memory);
        stats.times.shadow += self.shadows.flush(self.scene, |Contribution { slot, note, value }| {
            slots[slot as usize].l += value;
            if note != NO_NOTE {
                E::arrived(memory, note);
            }
        });
        stats.times.shadow += self.splats.flush(self.scene, |splat| {
            landed.push(splat);
            if splat.note != NO_NOTE {
                E::arrived(memory, splat.note);
            }
        });
        self.estimator
            .flush_own_shadows(self.scene, self.memory, self.slots, stats);
    }
}
