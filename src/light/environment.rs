//! Light from all around the scene.

use std::f32::consts::PI;

use super::{LightDensity, LightEnd, LightSample};
use crate::math::{Bounds3, Vec2};
use crate::sampling::{SolidAnglePdf, warp};
use crate::spectrum::{CompiledSpectrum, SampledSpectrum, Wavelengths};

/// The same radiance from every direction.
#[derive(Clone, Debug)]
pub struct EnvironmentLight {
    radiance: CompiledSpectrum,
}

impl EnvironmentLight {
    /// With `radiance` in W·m⁻²·sr⁻¹·nm⁻¹.
    pub fn new(radiance: CompiledSpectrum) -> Self {
        Self { radiance }
    }

    /// Radiance along a ray that leaves the scene.
    #[inline]
    pub fn le(&self, lambda: &Wavelengths) -> SampledSpectrum {
        self.radiance.sample(lambda)
    }

    /// Density of any direction of [`Light::sample_li`](super::Light::sample_li).
    #[inline]
    pub fn pdf_li(&self) -> SolidAnglePdf {
        warp::uniform_sphere_pdf()
    }

    pub(super) fn sample_li(&self, u: Vec2, lambda: &Wavelengths) -> LightSample {
        LightSample {
            li: self.le(lambda),
            wi: warp::sample_uniform_sphere(u),
            end: LightEnd::Infinity,
            density: LightDensity::Continuous(self.pdf_li()),
        }
    }

    pub(super) fn power(&self, bounds: &Bounds3) -> f32 {
        4.0 * PI * PI * bounds.radius().powi(2) * self.radiance.photometric_luminance()
    }
}
