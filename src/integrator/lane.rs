//! Slots and lanes: the state of a wave.
//!
//! Lanes lie side by side in packets of eight, column by column: what takes them together reads and writes columns, what takes them one by one
//! asks a packet for a [`Lane`].

use super::DroppedSample;
use super::queue::{Packet, Queue};
use crate::accel::RayKind;
use crate::geometry::RayCone;
use crate::material::TransportMode;
use crate::math::{Each, LANES, Lanes, columns};
use crate::sampling::{SampleStream, StreamLanes};
use crate::spectrum::{SampledSpectrum, SpectrumLanes, Wavelengths};

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
    #[inline(always)]
    pub fn is_good(&self) -> bool {
        // Comparisons are false of NaN. Without branches, for kernels.
        let is_good = |l: f32| (l >= 0.0) & l.is_finite();
        let [a, b, c, d] = self.l.0.map(is_good);
        !self.broken & a & b & c & d
    }

    /// It, as one that was dropped.
    pub fn dropped(&self) -> DroppedSample {
        DroppedSample {
            pixel: self.pixel,
            sample: self.sample,
        }
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

/// What an estimator has to know of the way that a path came.
pub(super) trait LaneState: Copy {
    /// Eight of them.
    type Lanes: Packet<Lane = Self>;
}

impl LaneState for () {
    type Lanes = Each<()>;
}

/// Eight lanes side by side.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(super) struct LanePacket<S: LaneState> {
    /// See [`Lane::slot`].
    pub slot: [u32; LANES],
    /// See [`Lane::split`]: 0 or 1.
    pub split: [u32; LANES],
    /// See [`Lane::stream`].
    pub streams: StreamLanes,
    /// See [`Lane::beta`].
    pub beta: SpectrumLanes,
    /// See [`Lane::eta_scale`].
    pub eta_scale: Lanes,
    /// See [`RayCone::width`].
    pub cone_width: Lanes,
    /// See [`RayCone::spread`].
    pub cone_spread: Lanes,
    /// See [`Lane::state`].
    pub states: S::Lanes,
}

columns!(LanePacket<S: LaneState> { slot, split, streams, beta, eta_scale, cone_width, cone_spread, states });

impl<S: LaneState> LanePacket<S> {
    /// How wide the ray of a lane is.
    #[inline(always)]
    pub fn cone(&self, lane: usize) -> RayCone {
        RayCone {
            width: self.cone_width[lane],
            spread: self.cone_spread[lane],
        }
    }
}

impl<S: LaneState> Packet for LanePacket<S> {
    type Lane = Lane<S>;

    #[inline(always)]
    fn all(lane: Lane<S>) -> Self {
        Self {
            slot: [lane.slot; LANES],
            split: [lane.split.into(); LANES],
            streams: StreamLanes::all(lane.stream),
            beta: SpectrumLanes::all(lane.beta),
            eta_scale: [lane.eta_scale; LANES],
            cone_width: [lane.cone.width; LANES],
            cone_spread: [lane.cone.spread; LANES],
            states: S::Lanes::all(lane.state),
        }
    }

    #[inline(always)]
    fn get(&self, lane: usize) -> Lane<S> {
        Lane {
            slot: self.slot[lane],
            split: self.split[lane] != 0,
            stream: self.streams.get(lane),
            beta: self.beta.get(lane),
            eta_scale: self.eta_scale[lane],
            cone: self.cone(lane),
            state: self.states.get(lane),
        }
    }

    #[inline(always)]
    fn set(&mut self, i: usize, lane: Lane<S>) {
        self.slot[i] = lane.slot;
        self.split[i] = lane.split.into();
        self.streams.set(i, lane.stream);
        self.beta.set(i, lane.beta);
        self.eta_scale[i] = lane.eta_scale;
        (self.cone_width[i], self.cone_spread[i]) = (lane.cone.width, lane.cone.spread);
        self.states.set(i, lane.state);
    }
}

/// Paths of the same number of scattering events, and the rays that they go on by.
pub(super) struct Batch<S: LaneState> {
    /// Which end the paths started from: what they carry.
    pub mode: TransportMode,
    /// Whose rays they are.
    pub kind: RayKind,
    /// Scattering events before the rays.
    pub depth: u32,
    /// The rays, and the paths that they belong to.
    pub paths: Queue<LanePacket<S>>,
}

impl<S: LaneState> Default for Batch<S> {
    fn default() -> Self {
        Self {
            mode: TransportMode::Radiance,
            kind: RayKind::Bounce,
            depth: 0,
            paths: Queue::default(),
        }
    }
}

impl<S: LaneState> Batch<S> {
    /// Forgets all paths; others of `depth` will follow, scattered ones unless [`Self::kind`] is set.
    pub fn restart(&mut self, mode: TransportMode, depth: u32) {
        (self.mode, self.kind, self.depth) = (mode, RayKind::Bounce, depth);
        self.paths.clear();
    }
}
