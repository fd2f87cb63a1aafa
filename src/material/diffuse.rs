//! Lambertian reflection, on whichever side the light is.

use std::f32::consts::FRAC_1_PI;

use super::{Density, LocalSample, LocalValue};
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

    /// The albedo.
    #[inline]
    pub fn albedo(&self) -> SampledSpectrum {
        self.albedo
    }

    /// See [`Bsdf::eval`](super::Bsdf::eval).
    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Option<LocalValue> {
        (wo.z * wi.z > 0.0).then(|| LocalValue {
            f: self.albedo * FRAC_1_PI,
            pdf: wi.z.abs() * FRAC_1_PI,
        })
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
