//! Lambertian reflection, on whichever side the light is.

use std::f32::consts::FRAC_1_PI;

use super::{Density, LocalSample};
use crate::math::{Vec2, Vec3};
use crate::sampling::{SolidAnglePdf, warp};
use crate::spectrum::SampledSpectrum;

/// f = albedo / pi.
#[derive(Clone, Copy, Debug)]
pub struct Diffuse {
    albedo: SampledSpectrum,
}

impl Diffuse {
    /// With an albedo in [0, 1].
    pub fn new(albedo: SampledSpectrum) -> Self {
        Self { albedo }
    }

    /// See [`Bsdf::f`](super::Bsdf::f).
    #[inline]
    pub fn f(&self, wo: Vec3, wi: Vec3) -> SampledSpectrum {
        if wo.z * wi.z > 0.0 {
            self.albedo * FRAC_1_PI
        } else {
            SampledSpectrum::ZERO
        }
    }

    /// See [`Bsdf::pdf`](super::Bsdf::pdf).
    #[inline]
    pub fn pdf(&self, wo: Vec3, wi: Vec3) -> SolidAnglePdf {
        SolidAnglePdf(if wo.z * wi.z > 0.0 { wi.z.abs() * FRAC_1_PI } else { 0.0 })
    }

    /// See [`Bsdf::sample_f`](super::Bsdf::sample_f).
    #[inline]
    pub fn sample_f(&self, wo: Vec3, u: Vec2) -> Option<LocalSample> {
        let mut wi = warp::sample_cosine_hemisphere(u);
        if wo.z < 0.0 {
            wi.z = -wi.z;
        }
        Some(LocalSample {
            value: self.albedo * FRAC_1_PI,
            wi,
            density: Density::Continuous(SolidAnglePdf(wi.z.abs() * FRAC_1_PI)),
            eta: 1.0,
        })
    }
}
