//! Slots and lanes: the state of a wave.

use crate::geometry::{Ray, RayCone, RayQueue};
use crate::math::Vec3;
use crate::sampling::{SampleStream, SolidAnglePdf};
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
    /// Its wavelengths.
    pub lambda: Wavelengths,
    /// Radiance gathered so far, not divided by the density of the wavelengths.
    pub l: SampledSpectrum,
    /// Set if a ray of it could not be traced.
    pub broken: bool,
}

/// Where a lane's ray came from, which says how else the light that it meets could have been found.
#[derive(Clone, Copy, Debug)]
pub(super) enum Origin {
    /// The camera or a delta lobe: in no other way.
    Delta,
    /// A BSDF sample with this density, at a point of this shading normal: by light sampling too.
    Sampled { p: Vec3, n: Vec3, pdf: SolidAnglePdf },
}

/// A live path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lane {
    /// Its slot; [`Lane::NO_SLOT`] for a camera ray that is traced for the sake of its packet only.
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
    /// Where the ray came from.
    pub origin: Origin,
    /// How wide the ray is.
    pub cone: RayCone,
}

impl Lane {
    /// No slot: nothing is wanted of this ray.
    pub const NO_SLOT: u32 = u32::MAX;
}

/// Paths of the same number of scattering events, and the rays that they go on by.
#[derive(Debug, Default)]
pub(super) struct Batch {
    /// Scattering events before the rays.
    pub depth: u32,
    /// The paths.
    pub lanes: Vec<Lane>,
    /// Their rays.
    pub rays: RayQueue,
}

impl Batch {
    /// Forgets all paths.
    pub fn clear(&mut self) {
        self.lanes.clear();
        self.rays.clear();
    }

    /// Adds a path with a ray that is valid.
    #[inline]
    pub fn push(&mut self, lane: &Lane, ray: &Ray) {
        self.rays.push(ray);
        self.lanes.push(*lane);
    }
}
