//! A light at a point whose intensity by direction is an image.

use std::f32::consts::PI;

use super::delta::towards_point;
use super::{LightBounds, LightSample, Place};
use crate::math::Vec3;
use crate::sampling::SphereMap;
use crate::spectrum::{CompiledSpectrum, Wavelengths};

/// An intensity times the pixels of an equal-area octahedral image, whose pole is +z of its place.
#[derive(Clone, Debug)]
pub struct GoniometricLight {
    place: Place,
    intensity: CompiledSpectrum,
    factors: Vec<f32>,
    side: usize,
    mean: f32,
}

impl GoniometricLight {
    /// With `intensity` (W·sr⁻¹·nm⁻¹) where a factor is 1; `factors` row by row, not negative. `None` unless they fill a square.
    pub fn new(place: Place, intensity: CompiledSpectrum, factors: Vec<f32>) -> Option<Self> {
        let side = factors.len().isqrt();
        (side > 0 && side * side == factors.len()).then(|| Self {
            place,
            intensity,
            mean: mean(&factors),
            factors,
            side,
        })
    }

    /// The power of a light of intensity 1 with these factors.
    pub fn geometric_power(factors: &[f32]) -> f32 {
        4.0 * PI * mean(factors)
    }

    pub(super) fn sample_li(&self, p: Vec3, time: f32, lambda: &Wavelengths) -> Option<LightSample> {
        let pose = self.place.at(time);
        towards_point(p, pose.position, |w| {
            let cell = SphereMap::EqualArea.cell(pose.local_direction(w), [self.side; 2]);
            self.intensity.sample(lambda) * self.factors[cell.y * self.side + cell.x]
        })
    }

    pub(super) fn bounds(&self) -> LightBounds {
        let intensity = self.mean * self.intensity.photometric_luminance();
        LightBounds::omnidirectional(self.place.bounds(), intensity)
    }

    pub(super) fn power(&self) -> f32 {
        4.0 * PI * self.mean * self.intensity.photometric_luminance()
    }
}

fn mean(factors: &[f32]) -> f32 {
    let sum: f64 = factors.iter().map(|&f| f64::from(f)).sum();
    (sum / factors.len() as f64) as f32
}
