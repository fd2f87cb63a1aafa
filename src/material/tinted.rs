//! A specular lobe with factors on what it reflects and on what it transmits, as Mitsuba's have them.

use super::{Conductor, Dielectric, LocalSample, LocalValue, ThinDielectric, TransportMode};
use crate::math::{Vec2, Vec3};
use crate::spectrum::SampledSpectrum;

/// A lobe and its factors. Directions are sampled as from the lobe alone.
#[derive(Clone, Copy, Debug)]
pub struct Tinted {
    lobe: Untinted,
    reflectance: SampledSpectrum,
    transmittance: SampledSpectrum,
}

/// The lobes that may be tinted; light meets their facets once.
#[derive(Clone, Copy, Debug)]
#[expect(missing_docs, reason = "each is its type")]
pub enum Untinted {
    Conductor(Conductor),
    Dielectric(Dielectric),
    ThinDielectric(ThinDielectric),
}

impl Tinted {
    /// With factors in [0, 1].
    pub fn new(lobe: Untinted, reflectance: SampledSpectrum, transmittance: SampledSpectrum) -> Self {
        Self {
            lobe,
            reflectance,
            transmittance,
        }
    }

    /// See [`super::Bsdf::is_delta`].
    pub fn is_delta(&self) -> bool {
        match &self.lobe {
            Untinted::Conductor(lobe) => lobe.is_delta(),
            Untinted::Dielectric(lobe) => lobe.is_delta(),
            Untinted::ThinDielectric(_) => true,
        }
    }

    /// See [`super::Bsdf::is_specular`].
    pub fn is_specular(&self) -> bool {
        match &self.lobe {
            Untinted::Conductor(lobe) => lobe.is_specular(),
            Untinted::Dielectric(lobe) => lobe.is_specular(),
            Untinted::ThinDielectric(_) => true,
        }
    }

    /// See [`super::Bsdf::transmits`].
    pub fn transmits(&self) -> bool {
        !matches!(self.lobe, Untinted::Conductor(_))
    }

    fn factor(&self, wo: Vec3, wi: Vec3) -> SampledSpectrum {
        if wo.z * wi.z > 0.0 {
            self.reflectance
        } else {
            self.transmittance
        }
    }

    /// See [`Bsdf::eval`](super::Bsdf::eval).
    pub fn eval(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> Option<LocalValue> {
        let mut value = match &self.lobe {
            Untinted::Conductor(lobe) => lobe.eval(wo, wi),
            Untinted::Dielectric(lobe) => lobe.eval(wo, wi, mode),
            Untinted::ThinDielectric(_) => None,
        }?;
        value.f *= self.factor(wo, wi);
        Some(value)
    }

    /// See [`Bsdf::sample_f`](super::Bsdf::sample_f).
    pub fn sample_f(&self, wo: Vec3, u_lobe: f32, u: Vec2, mode: TransportMode) -> Option<LocalSample> {
        let mut sample = match &self.lobe {
            Untinted::Conductor(lobe) => lobe.sample_f(wo, u),
            Untinted::Dielectric(lobe) => lobe.sample_f(wo, u_lobe, u, mode),
            Untinted::ThinDielectric(lobe) => lobe.sample_f(wo, u_lobe),
        }?;
        sample.value *= self.factor(wo, sample.wi);
        Some(sample)
    }
}
