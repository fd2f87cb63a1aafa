//! A thin sheet of glass, as in pbrt-v4: two parallel boundaries, between which light goes to and fro, as one surface.

use super::{Density, LocalSample, fresnel_dielectric};
use crate::math::Vec3;
use crate::spectrum::SampledSpectrum;

/// Mirror reflection, and transmission straight on. Each wavelength has its own index: nothing is dispersed, as both sides refract
/// alike.
#[derive(Clone, Copy, Debug)]
pub struct ThinDielectric {
    eta: SampledSpectrum,
}

impl ThinDielectric {
    /// Of index `eta` (positive) relative to both sides.
    pub fn new(eta: SampledSpectrum) -> Self {
        Self { eta }
    }

    /// R + T R T + T R R R T + ... = 2 R / (1 + R), where R is that of one boundary and T = 1 - R.
    fn reflectance(&self, cos: f32) -> SampledSpectrum {
        self.eta.map(|eta| {
            let r = fresnel_dielectric(cos, eta);
            2.0 * r / (1.0 + r)
        })
    }

    /// See [`Bsdf::sample_f`](super::Bsdf::sample_f).
    pub fn sample_f(&self, wo: Vec3, u_lobe: f32) -> Option<LocalSample> {
        let reflectance = self.reflectance(wo.z.abs());
        let probability = reflectance.mean();
        let (value, wi, probability) = if u_lobe < probability {
            (reflectance, Vec3::new(-wo.x, -wo.y, wo.z), probability)
        } else {
            (SampledSpectrum::ONE - reflectance, -wo, 1.0 - probability)
        };
        Some(LocalSample {
            value,
            wi,
            density: Density::Delta(probability),
            eta: 1.0,
        })
    }
}
