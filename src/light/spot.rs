//! A light at a point that shines into a cone.

use std::f32::consts::TAU;

use super::delta::towards_point;
use super::{EmissionSample, LightBounds, LightSample, Place};
use crate::desc::SpotFalloff;
use crate::math::{Vec2, Vec3};
use crate::sampling::SolidAnglePdf;
use crate::spectrum::{CompiledSpectrum, Wavelengths};

/// Full intensity up to an angle from +z of its place, then down to nothing at another: by a smooth step or in proportion to the angle.
#[derive(Clone, Debug)]
pub struct SpotLight {
    place: Place,
    intensity: CompiledSpectrum,
    start: f32,
    end: f32,
    /// 1 - cos of both angles: of narrow cones the cosines themselves say little.
    rise_start: f32,
    rise_end: f32,
    falloff: SpotFalloff,
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
            falloff: SpotFalloff::Smooth,
        }
    }

    /// This light with another falloff; it is smooth at first.
    #[must_use]
    pub fn with_falloff(self, falloff: SpotFalloff) -> Self {
        Self { falloff, ..self }
    }

    /// The power of a spotlight of intensity 1 and smooth falloff, by the same angles.
    pub fn geometric_power(start: f32, end: f32) -> f32 {
        cone_power(rise(start), rise(end))
    }

    pub(super) fn place(&self) -> &Place {
        &self.place
    }

    pub(super) fn sample_li(&self, p: Vec3, time: f32, lambda: &Wavelengths) -> Option<LightSample> {
        let pose = self.place.at(time);
        towards_point(p, pose.position, |w| {
            self.intensity.sample(lambda) * self.profile(pose.local_direction(w))
        })
    }

    /// How much of the full intensity goes in a direction of the light's space.
    fn profile(&self, w: Vec3) -> f32 {
        match self.falloff {
            SpotFalloff::Smooth => 1.0 - smooth_step(rise_of(w), self.rise_start, self.rise_end),
            SpotFalloff::Linear => {
                let angle = w.truncate().length().atan2(w.z);
                1.0 - linear_step(angle, self.start, self.end)
            }
        }
    }

    /// What the density of directions is in proportion to: the profile, or where that is linear in the angle, one that is linear in
    /// the cosine. Both integrate to [`cone_power`].
    fn density_profile(&self, w: Vec3) -> f32 {
        match self.falloff {
            SpotFalloff::Smooth => self.profile(w),
            SpotFalloff::Linear => 1.0 - linear_step(rise_of(w), self.rise_start, self.rise_end),
        }
    }

    /// By intensity, or nearly so.
    pub(super) fn sample_le(&self, time: f32, u: Vec2, lambda: &Wavelengths) -> Option<EmissionSample> {
        let pose = self.place.at(time);
        let rise = self.sample_rise(u.x);
        let sin = (rise * (2.0 - rise)).max(0.0).sqrt();
        let (sin_phi, cos_phi) = (TAU * u.y).sin_cos();
        let w = pose.world_direction(Vec3::new(sin * cos_phi, sin * sin_phi, 1.0 - rise));
        let intensity = self.intensity.sample(lambda) * self.profile(pose.local_direction(w));
        EmissionSample::from_point(pose.position, w, intensity, self.pdf_le(w, time))
    }

    /// Density of a direction of [`Self::sample_le`].
    pub(super) fn pdf_le(&self, w: Vec3, time: f32) -> SolidAnglePdf {
        let pose = self.place.at(time);
        let pdf = self.density_profile(pose.local_direction(w)) / cone_power(self.rise_start, self.rise_end);
        SolidAnglePdf(pdf * pose.stretch(w))
    }

    /// 1 - cos of an angle from +z whose density by solid angle is in proportion to the density profile.
    fn sample_rise(&self, u: f32) -> f32 {
        let (full, step) = (self.rise_start, self.rise_end - self.rise_start);
        let at = u * (full + 0.5 * step);
        if at < full {
            return at;
        }
        let beyond = 1.0 - (at - full) / (0.5 * step);
        let to_rim = match self.falloff {
            SpotFalloff::Smooth => invert_smooth_step(beyond),
            SpotFalloff::Linear => beyond.max(0.0).sqrt(),
        };
        full + step * (1.0 - to_rim)
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
        let geometric = match self.falloff {
            SpotFalloff::Linear if self.start < self.end => {
                // The integral of sin times what falls from 1 to 0 between the angles.
                TAU * (1.0 - (self.end.sin() - self.start.sin()) / (self.end - self.start))
            }
            _ => cone_power(self.rise_start, self.rise_end),
        };
        geometric * self.intensity.photometric_luminance()
    }
}

/// 1 - cos of the angle of a direction from +z.
fn rise_of(w: Vec3) -> f32 {
    if w.z > 0.0 {
        (w.x * w.x + w.y * w.y) / (1.0 + w.z)
    } else {
        1.0 - w.z
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

/// 0 below `low`, 1 above `high`, a straight line between them.
fn linear_step(x: f32, low: f32, high: f32) -> f32 {
    if low >= high {
        return if x <= low { 0.0 } else { 1.0 };
    }
    ((x - low) / (high - low)).clamp(0.0, 1.0)
}

/// Where the smooth step's integral from 0, t³ - t⁴ / 2, is `u` times that to 1.
fn invert_smooth_step(u: f32) -> f32 {
    // Newton's method for t³ (2 - t) = u, which is convex: from above it comes down to the root.
    let mut t = u.clamp(0.0, 1.0).cbrt();
    for _ in 0..5 {
        let slope = 2.0 * t * t * (3.0 - 2.0 * t);
        if slope > 0.0 {
            t -= (t * t * t * (2.0 - t) - u) / slope;
        }
    }
    t.clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smooth_step_is_inverted() {
        for i in 0..=1000 {
            let u = i as f32 / 1000.0;
            let t = invert_smooth_step(u);
            assert!((t * t * t * (2.0 - t) - u).abs() < 1e-6, "{u}: {t}");
        }
    }
}
