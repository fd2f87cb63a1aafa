//! A light at a point that shines into a cone.

use std::f32::consts::TAU;

use super::delta::towards_point;
use super::{LightBounds, LightSample, Place};
use crate::math::Vec3;
use crate::spectrum::{CompiledSpectrum, Wavelengths};

/// Full intensity up to an angle from +z of its place, then a smooth step down to nothing at another.
#[derive(Clone, Debug)]
pub struct SpotLight {
    place: Place,
    intensity: CompiledSpectrum,
    cos_start: f32,
    cos_end: f32,
}

impl SpotLight {
    /// With `intensity` (W·sr⁻¹·nm⁻¹) within the angle `start` of +z and nothing beyond `end`, radians, start <= end.
    pub fn new(place: Place, intensity: CompiledSpectrum, start: f32, end: f32) -> Self {
        Self {
            place,
            intensity,
            cos_start: start.cos(),
            cos_end: end.cos(),
        }
    }

    /// The power of a spotlight of intensity 1, by the same angles.
    pub fn geometric_power(start: f32, end: f32) -> f32 {
        cone_power(start.cos(), end.cos())
    }

    pub(super) fn sample_li(&self, p: Vec3, time: f32, lambda: &Wavelengths) -> Option<LightSample> {
        let pose = self.place.at(time);
        towards_point(p, pose.position, |w| {
            let cos = pose.local_direction(w).z;
            self.intensity.sample(lambda) * smooth_step(cos, self.cos_end, self.cos_start)
        })
    }

    pub(super) fn bounds(&self) -> LightBounds {
        let intensity = self.intensity.photometric_luminance();
        let all_around = LightBounds::omnidirectional(self.place.bounds(), intensity);
        if !self.place.is_static() {
            return all_around;
        }
        LightBounds {
            axis: self.place.at(0.0).axis(),
            cos_normals: self.cos_start,
            cos_emission: (self.cos_end.acos() - self.cos_start.acos()).cos(),
            ..all_around
        }
    }

    pub(super) fn power(&self) -> f32 {
        cone_power(self.cos_start, self.cos_end) * self.intensity.photometric_luminance()
    }
}

/// The smooth step is 1/2 on average over the cosine.
fn cone_power(cos_start: f32, cos_end: f32) -> f32 {
    TAU * ((1.0 - cos_start) + 0.5 * (cos_start - cos_end))
}

/// 0 below `low`, 1 above `high`, a cubic between them.
fn smooth_step(x: f32, low: f32, high: f32) -> f32 {
    if low >= high {
        return if x < low { 0.0 } else { 1.0 };
    }
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
