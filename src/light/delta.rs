//! Lights that no ray can hit: a point, and a direction.

use std::f32::consts::PI;

use super::{EmissionSample, LightBounds, LightDensity, LightEnd, LightSample, Place};
use crate::math::{Bounds3, Vec2, Vec3};
use crate::sampling::warp;
use crate::spectrum::{CompiledSpectrum, SampledSpectrum, Wavelengths};

/// The same intensity in all directions from a point.
#[derive(Clone, Debug)]
pub struct PointLight {
    place: Place,
    intensity: CompiledSpectrum,
}

/// What comes to `p` from a light at the point `position` with an intensity by direction from it (of unit length).
#[inline]
pub(super) fn towards_point(
    p: Vec3,
    position: Vec3,
    intensity: impl Fn(Vec3) -> SampledSpectrum,
) -> Option<LightSample> {
    let to_light = position - p;
    let distance_squared = to_light.length_squared();
    if distance_squared <= 0.0 {
        return None;
    }
    let wi = to_light / distance_squared.sqrt();
    let li = intensity(-wi) * (1.0 / distance_squared);
    (!li.is_black()).then_some(LightSample {
        li,
        wi,
        end: LightEnd::Point {
            p: position,
            error: 0.0,
            ng: Vec3::ZERO,
        },
        density: LightDensity::Delta,
    })
}

impl PointLight {
    /// At the origin of `place`, with `intensity` in W·sr⁻¹·nm⁻¹.
    pub fn new(place: Place, intensity: CompiledSpectrum) -> Self {
        Self { place, intensity }
    }

    pub(super) fn place(&self) -> &Place {
        &self.place
    }

    pub(super) fn sample_li(&self, p: Vec3, time: f32, lambda: &Wavelengths) -> Option<LightSample> {
        towards_point(p, self.place.at(time).position, |_| self.intensity.sample(lambda))
    }

    pub(super) fn sample_le(&self, time: f32, u: Vec2, lambda: &Wavelengths) -> Option<EmissionSample> {
        let (position, intensity) = (self.place.at(time).position, self.intensity.sample(lambda));
        let w = warp::sample_uniform_sphere(u);
        EmissionSample::from_point(position, w, intensity, warp::uniform_sphere_pdf())
    }

    pub(super) fn bounds(&self) -> LightBounds {
        LightBounds::omnidirectional(self.place.bounds(), self.intensity.photometric_luminance())
    }

    pub(super) fn power(&self) -> f32 {
        4.0 * PI * self.intensity.photometric_luminance()
    }
}

/// Parallel light from infinitely far away.
#[derive(Clone, Debug)]
pub struct DistantLight {
    place: Place,
    irradiance: CompiledSpectrum,
}

impl DistantLight {
    /// From the direction +z of `place`, giving `irradiance` (W·m⁻²·nm⁻¹) to a surface that faces it.
    pub fn new(place: Place, irradiance: CompiledSpectrum) -> Self {
        Self { place, irradiance }
    }

    pub(super) fn sample_li(&self, time: f32, lambda: &Wavelengths) -> LightSample {
        LightSample {
            li: self.irradiance.sample(lambda),
            wi: self.place.at(time).axis(),
            end: LightEnd::Infinity,
            density: LightDensity::Delta,
        }
    }

    pub(super) fn sample_le(
        &self,
        time: f32,
        u: Vec2,
        lambda: &Wavelengths,
        scene: &Bounds3,
    ) -> Option<EmissionSample> {
        let (w, irradiance) = (-self.place.at(time).axis(), self.irradiance.sample(lambda));
        EmissionSample::from_disk(w, u, scene, irradiance, LightDensity::Delta)
    }

    pub(super) fn power(&self, bounds: &Bounds3) -> f32 {
        PI * bounds.radius().powi(2) * self.irradiance.photometric_luminance()
    }
}
