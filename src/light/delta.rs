//! Lights that no ray can hit: a point, and a direction.

use std::f32::consts::PI;

use super::{LightBounds, LightDensity, LightEnd, LightSample};
use crate::math::{Bounds3, Vec3};
use crate::spectrum::{CompiledSpectrum, SampledSpectrum, Wavelengths};

/// The same intensity in all directions from a point.
#[derive(Clone, Debug)]
pub struct PointLight {
    position: Vec3,
    intensity: CompiledSpectrum,
}

impl PointLight {
    /// At `position`, with `intensity` in W·sr⁻¹·nm⁻¹.
    pub fn new(position: Vec3, intensity: CompiledSpectrum) -> Self {
        Self { position, intensity }
    }

    pub(super) fn sample_li(&self, p: Vec3, lambda: &Wavelengths) -> Option<LightSample> {
        let to_light = self.position - p;
        let distance_squared = to_light.length_squared();
        (distance_squared > 0.0).then(|| LightSample {
            li: self.intensity.sample(lambda) * (1.0 / distance_squared),
            wi: to_light / distance_squared.sqrt(),
            end: LightEnd::Point {
                p: self.position,
                error: 0.0,
                ng: Vec3::ZERO,
            },
            density: LightDensity::Delta,
        })
    }

    pub(super) fn bounds(&self) -> LightBounds {
        let here = Bounds3::from_points([self.position]);
        LightBounds::omnidirectional(here, self.intensity.photometric_luminance())
    }

    pub(super) fn power(&self) -> f32 {
        4.0 * PI * self.intensity.photometric_luminance()
    }
}

/// Parallel light from infinitely far away.
#[derive(Clone, Debug)]
pub struct DistantLight {
    /// Unit direction towards the light.
    towards: Vec3,
    irradiance: CompiledSpectrum,
}

impl DistantLight {
    /// From the unit direction `towards`, giving `irradiance` (W·m⁻²·nm⁻¹) to a surface that faces it.
    pub fn new(towards: Vec3, irradiance: CompiledSpectrum) -> Self {
        Self { towards, irradiance }
    }

    pub(super) fn sample_li(&self, lambda: &Wavelengths) -> LightSample {
        let li: SampledSpectrum = self.irradiance.sample(lambda);
        LightSample {
            li,
            wi: self.towards,
            end: LightEnd::Infinity,
            density: LightDensity::Delta,
        }
    }

    pub(super) fn power(&self, bounds: &Bounds3) -> f32 {
        PI * bounds.radius().powi(2) * self.irradiance.photometric_luminance()
    }
}
