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
    start: f32,
    end: f32,
    /// 1 - cos of both angles: of narrow cones the cosines themselves say little.
    rise_start: f32,
    rise_end: f32,
}

impl SpotLight {
    /// With `intensity` (W·sr⁻¹·nm⁻¹) within the angle `start` of +z and nothing beyond `end`, radians, start <= end.
    pub fn new(place: Place, intensity: CompiledSpectrum, start: f32, end: f32) -> Self {
        Self {
            place,
            intensity,
            start,
            end,
            rise_start: rise(start),
            rise_end: rise(end),
        }
    }

    /// The power of a spotlight of intensity 1, by the same angles.
    pub fn geometric_power(start: f32, end: f32) -> f32 {
        cone_power(rise(start), rise(end))
    }

    pub(super) fn sample_li(&self, p: Vec3, time: f32, lambda: &Wavelengths) -> Option<LightSample> {
        let pose = self.place.at(time);
        towards_point(p, pose.position, |w| {
            let w = pose.local_direction(w);
            let rise = if w.z > 0.0 {
                (w.x * w.x + w.y * w.y) / (1.0 + w.z)
            } else {
                1.0 - w.z
            };
            self.intensity.sample(lambda) * (1.0 - smooth_step(rise, self.rise_start, self.rise_end))
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
            cos_normals: self.start.cos(),
            cos_emission: (self.end - self.start).cos(),
            ..all_around
        }
    }

    pub(super) fn power(&self) -> f32 {
        cone_power(self.rise_start, self.rise_end) * self.intensity.photometric_luminance()
    }
}

/// 1 - cos.
fn rise(angle: f32) -> f32 {
    2.0 * (0.5 * angle).sin().powi(2)
}

/// The smooth step is 1/2 on average over the cosine.
fn cone_power(rise_start: f32, rise_end: f32) -> f32 {
    TAU * 0.5 * (rise_start + rise_end)
}

/// 0 below `low`, 1 above `high`, a cubic between them.
fn smooth_step(x: f32, low: f32, high: f32) -> f32 {
    if low >= high {
        return if x <= low { 0.0 } else { 1.0 };
    }
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
