//! Lambertian reflection and Lambertian transmission, as in pbrt-v4: paper, leaves, lampshades.

use std::f32::consts::FRAC_1_PI;

use super::{LocalSample, LocalValue};
use crate::math::{Vec2, Vec3};
use crate::sampling::warp;
use crate::spectrum::SampledSpectrum;

/// f = reflectance / pi on the side of `wo`, transmittance / pi on the other.
#[derive(Clone, Copy, Debug)]
pub struct DiffuseTransmission {
    reflectance: SampledSpectrum,
    transmittance: SampledSpectrum,
    /// The probability with which a sample is reflected.
    reflects: f32,
}

impl DiffuseTransmission {
    /// With both in [0, 1]; a scene keeps their sum there if energy is to be kept.
    pub fn new(reflectance: SampledSpectrum, transmittance: SampledSpectrum) -> Self {
        let (r, t) = (reflectance.max_value(), transmittance.max_value());
        Self {
            reflectance,
            transmittance,
            reflects: if r + t > 0.0 { r / (r + t) } else { 1.0 },
        }
    }

    /// See [`Bsdf::eval`](super::Bsdf::eval).
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Option<LocalValue> {
        let (part, probability) = if wo.z * wi.z > 0.0 {
            (self.reflectance, self.reflects)
        } else {
            (self.transmittance, 1.0 - self.reflects)
        };
        Some(LocalValue {
            f: part * FRAC_1_PI,
            pdf: probability * wi.z.abs() * FRAC_1_PI,
        })
    }

    /// See [`Bsdf::sample_f`](super::Bsdf::sample_f).
    pub fn sample_f(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<LocalSample> {
        let up = warp::sample_cosine_hemisphere(u);
        let same_side = u_lobe < self.reflects;
        let wi = if (wo.z > 0.0) == same_side { up } else { -up };
        Some(LocalSample::continuous(self.eval(wo, wi)?, wi, 1.0))
    }
}
