//! Slots and lanes: the state of a wave.

use crate::accel::RayKind;
use crate::geometry::{Ray, RayCone, RayQueue};
use crate::material::TransportMode;
use crate::sampling::SampleStream;
use crate::spectrum::{SampledSpectrum, Wavelengths};

/// A pixel sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slot {
    /// Column and row of its pixel.
    pub pixel: [u32; 2],
    /// Which sample of the pixel.
    pub sample: u32,
    /// Of the pixel filter.
    pub filter_weight: f32,
    /// What the radiance counts besides, see [`crate::camera::Camera::importance`].
    pub importance: f32,
    /// Scene time.
    pub time: f32,
    /// Its wavelengths.
    pub lambda: Wavelengths,
    /// Radiance gathered so far, not divided by the density of the wavelengths.
    pub l: SampledSpectrum,
    /// Set if a ray of it could not be traced.
    pub broken: bool,
}

impl Slot {
    /// Whether what it gathered counts: it is finite and nowhere negative.
    #[inline]
    pub fn is_good(&self) -> bool {
        !self.broken && self.l.is_finite() && self.l.min_value() >= 0.0
    }
}

/// A live path. `S` is what its estimator has to know of the way that it came.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lane<S> {
    /// Its slot; [`NO_SLOT`] for a camera ray that is traced for the sake of its packet only.
    pub slot: u32,
    /// Whether the path has been split, which it is once at most.
    pub split: bool,
    /// Its random numbers.
    pub stream: SampleStream,
    /// Throughput.
    pub beta: SampledSpectrum,
    /// Product of the squared relative indices of the refractions so far: without it Russian roulette would see the squeezing
    /// of radiance inside glass as absorption.
    pub eta_scale: f32,
    /// How wide the ray is.
    pub cone: RayCone,
    /// The estimator's.
    pub state: S,
}

/// The slot of a camera ray that is traced for the sake of its packet only: nothing is wanted of it.
pub(super) const NO_SLOT: u32 = u32::MAX;

/// Paths of the same number of scattering events, and the rays that they go on by.
#[derive(Debug)]
pub(super) struct Batch<S> {
    /// Which end the paths started from: what they carry.
    pub mode: TransportMode,
    /// Whose rays they are.
    pub kind: RayKind,
    /// Scattering events before the rays.
    pub depth: u32,
    /// The paths.
    pub lanes: Vec<Lane<S>>,
    /// Their rays.
    pub rays: RayQueue,
}

impl<S> Default for Batch<S> {
    fn default() -> Self {
        Self {
            mode: TransportMode::Radiance,
            kind: RayKind::Bounce,
            depth: 0,
            lanes: Vec::new(),
            rays: RayQueue::default(),
        }
    }
}

impl<S: Copy> Batch<S> {
    /// Forgets all paths; others of `depth` will follow, scattered ones unless [`Self::kind`] is set.
    pub fn restart(&mut self, mode: TransportMode, depth: u32) {
        (self.mode, self.kind, self.depth) = (mode, RayKind::Bounce, depth);
        self.lanes.clear();
        self.rays.clear();
    }

    /// Adds a path with a ray that is valid.
    #[inline(always)]
    pub fn push(&mut self, lane: &Lane<S>, ray: &Ray) {
        self.rays.push(ray);
        self.lanes.push(*lane);
    }
}
