//! A specular lobe with factors on what it reflects and on what it transmits, as Mitsuba's have them.

use super::{Conductor, Dielectric, Diffuse, Lobe, LocalSample, LocalValue, Material, ThinDielectric, TransportMode};
use crate::geometry::SurfaceInteraction;
use crate::math::{Vec2, Vec3};
use crate::spectrum::{SampledSpectrum, Wavelengths};
use crate::texture::SpectrumTexture;

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

/// A conductor, dielectric or thin dielectric with factors.
#[derive(Clone, Debug)]
pub struct TintedMaterial {
    /// Which; any other is black.
    pub material: Material,
    /// Factor of what is reflected.
    pub reflectance: SpectrumTexture,
    /// Factor of what is transmitted.
    pub transmittance: SpectrumTexture,
}

impl TintedMaterial {
    pub(super) fn lobe(&self, si: &SurfaceInteraction, lambda: &mut Wavelengths) -> (Lobe<'_>, bool) {
        let (lobe, is_anisotropic) = self.material.lobe(si, lambda);
        let lobe = match lobe {
            Lobe::Conductor(lobe) => Untinted::Conductor(lobe),
            Lobe::Dielectric(lobe) => Untinted::Dielectric(lobe),
            Lobe::ThinDielectric(lobe) => Untinted::ThinDielectric(lobe),
            _ => return (Lobe::Diffuse(Diffuse::new(SampledSpectrum::ZERO)), false),
        };
        let [r, t] = [&self.reflectance, &self.transmittance].map(|tint| tint.reflectance_at(si, lambda));
        (Lobe::Tinted(Tinted::new(lobe, r, t)), is_anisotropic)
    }
}
