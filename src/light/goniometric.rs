//! A light at a point whose intensity by direction is an image.

use std::f32::consts::PI;

use super::delta::towards_point;
use super::{EmissionSample, LightBounds, LightSample, Place};
use crate::math::{Vec2, Vec3};
use crate::sampling::{CellDistribution, SolidAnglePdf, SphereMap};
use crate::spectrum::{CompiledSpectrum, Wavelengths};

/// An intensity times the pixels of an equal-area octahedral image, whose pole is +z of its place.
#[derive(Clone, Debug)]
pub struct GoniometricLight {
    place: Place,
    intensity: CompiledSpectrum,
    factors: Vec<f32>,
    side: usize,
    mean: f32,
    /// Of pixels by their factors, which all have the same solid angle; `None` if all are 0.
    distribution: Option<CellDistribution>,
}

impl GoniometricLight {
    /// With `intensity` (W·sr⁻¹·nm⁻¹) where a factor is 1; `factors` row by row, not negative. `None` unless they fill a square.
    pub fn new(place: Place, intensity: CompiledSpectrum, factors: Vec<f32>) -> Option<Self> {
        let side = factors.len().isqrt();
        (side > 0 && side * side == factors.len()).then(|| Self {
            place,
            intensity,
            mean: mean(&factors),
            distribution: CellDistribution::new(&factors, side),
            factors,
            side,
        })
    }

    /// The power of a light of intensity 1 with these factors.
    pub fn geometric_power(factors: &[f32]) -> f32 {
        4.0 * PI * mean(factors)
    }

    pub(super) fn place(&self) -> &Place {
        &self.place
    }

    pub(super) fn sample_li(&self, p: Vec3, time: f32, lambda: &Wavelengths) -> Option<LightSample> {
        let pose = self.place.at(time);
        towards_point(p, pose.position, |w| {
            let cell = SphereMap::EqualArea.cell(pose.local_direction(w), [self.side; 2]);
            self.intensity.sample(lambda) * self.factors[cell.y * self.side + cell.x]
        })
    }

    pub(super) fn sample_le(&self, time: f32, u: Vec2, lambda: &Wavelengths) -> Option<EmissionSample> {
        let (cell, probability) = self.distribution.as_ref()?.sample(u);
        let (pose, size) = (self.place.at(time), [self.side; 2]);
        let w = pose.world_direction(SphereMap::EqualArea.direction(&cell, size));
        let pdf = probability / SphereMap::EqualArea.solid_angle(cell.y, size) * pose.stretch(w);
        let intensity = self.intensity.sample(lambda) * self.factors[cell.y * self.side + cell.x];
        EmissionSample::from_point(pose.position, w, intensity, SolidAnglePdf(pdf))
    }

    /// Density of a direction of [`Self::sample_le`].
    pub(super) fn pdf_le(&self, w: Vec3, time: f32) -> SolidAnglePdf {
        let Some(distribution) = &self.distribution else {
            return SolidAnglePdf(0.0);
        };
        let (pose, size) = (self.place.at(time), [self.side; 2]);
        let cell = SphereMap::EqualArea.cell(pose.local_direction(w), size);
        let pdf = distribution.probability(cell.x, cell.y) / SphereMap::EqualArea.solid_angle(cell.y, size);
        SolidAnglePdf(pdf * pose.stretch(w))
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
