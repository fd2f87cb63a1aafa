//! Boundaries of transparent bodies: smooth (two delta lobes), or GGX microfacets that reflect and refract (Walter et al. 2007).

use super::conductor::{half_vector, reflect, reflection_pdf};
use super::{Density, Ggx, LocalSample, TransportMode, fresnel_dielectric, refract};
use crate::math::{Vec2, Vec3};
use crate::sampling::SolidAnglePdf;
use crate::spectrum::SampledSpectrum;

/// Reflection and refraction at a dielectric boundary. The side of positive z is outside.
#[derive(Clone, Copy, Debug)]
pub struct Dielectric {
    /// Index inside over index outside.
    eta: f32,
    roughness: Option<Ggx>,
}

impl Dielectric {
    /// Of relative index `eta` (positive); smooth without `roughness`. At an index of 1 there is no boundary and light goes
    /// straight through, however rough.
    pub fn new(eta: f32, roughness: Option<Ggx>) -> Self {
        Self {
            eta,
            roughness: if eta == 1.0 { None } else { roughness },
        }
    }

    /// Whether it is smooth.
    pub fn is_delta(&self) -> bool {
        self.roughness.is_none()
    }

    /// Index on the far side over that on the side of `wo`.
    fn eta_across(&self, wo: Vec3) -> f32 {
        if wo.z > 0.0 { self.eta } else { 1.0 / self.eta }
    }

    /// See [`Bsdf::f`](super::Bsdf::f).
    pub fn f(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> SampledSpectrum {
        let Some(ggx) = &self.roughness else {
            return SampledSpectrum::ZERO;
        };
        let value = if wo.z * wi.z > 0.0 {
            half_vector(wo, wi).map_or(0.0, |m| self.reflection(ggx, wo, wi, m))
        } else {
            self.refraction_normal(wo, wi)
                .map_or(0.0, |m| self.refraction(ggx, wo, wi, m, mode))
        };
        SampledSpectrum::splat(value)
    }

    /// See [`Bsdf::pdf`](super::Bsdf::pdf).
    pub fn pdf(&self, wo: Vec3, wi: Vec3, _mode: TransportMode) -> SolidAnglePdf {
        let Some(ggx) = &self.roughness else {
            return SolidAnglePdf(0.0);
        };
        let pdf = if wo.z * wi.z > 0.0 {
            half_vector(wo, wi).map_or(0.0, |m| {
                reflection_pdf(ggx, wo, m) * fresnel_dielectric(wo.dot(m), self.eta)
            })
        } else {
            self.refraction_normal(wo, wi)
                .map_or(0.0, |m| self.refraction_pdf(ggx, wo, wi, m))
        };
        SolidAnglePdf(pdf)
    }

    /// See [`Bsdf::sample_f`](super::Bsdf::sample_f).
    pub fn sample_f(&self, wo: Vec3, u_lobe: f32, u: Vec2, mode: TransportMode) -> Option<LocalSample> {
        let Some(ggx) = &self.roughness else {
            return self.sample_smooth(wo, u_lobe, mode);
        };
        let m = ggx.sample_visible_normal(wo, u);
        let reflectance = fresnel_dielectric(wo.dot(m), self.eta);
        if u_lobe < reflectance {
            let wi = reflect(wo, m);
            if wo.z * wi.z <= 0.0 {
                return None;
            }
            return Some(LocalSample {
                value: SampledSpectrum::splat(self.reflection(ggx, wo, wi, m)),
                wi,
                density: Density::Continuous(SolidAnglePdf(reflection_pdf(ggx, wo, m) * reflectance)),
                eta: 1.0,
            });
        }
        let (wi, eta) = refract(wo, m, self.eta)?;
        if wo.z * wi.z >= 0.0 {
            return None;
        }
        let pdf = self.refraction_pdf(ggx, wo, wi, m);
        (pdf > 0.0).then(|| LocalSample {
            value: SampledSpectrum::splat(self.refraction(ggx, wo, wi, m, mode)),
            wi,
            density: Density::Continuous(SolidAnglePdf(pdf)),
            eta,
        })
    }

    fn sample_smooth(&self, wo: Vec3, u_lobe: f32, mode: TransportMode) -> Option<LocalSample> {
        let reflectance = fresnel_dielectric(wo.z, self.eta);
        if u_lobe < reflectance {
            return Some(LocalSample {
                value: SampledSpectrum::splat(reflectance),
                wi: Vec3::new(-wo.x, -wo.y, wo.z),
                density: Density::Delta(reflectance),
                eta: 1.0,
            });
        }
        let (wi, eta) = refract(wo, Vec3::Z, self.eta)?;
        let transmittance = 1.0 - reflectance;
        Some(LocalSample {
            value: SampledSpectrum::splat(transmittance * radiance_scale(eta, mode)),
            wi,
            density: Density::Delta(transmittance),
            eta,
        })
    }

    /// The normal, with z >= 0, of the microfacets that refract `wo` to `wi`; `None` if there are none.
    fn refraction_normal(&self, wo: Vec3, wi: Vec3) -> Option<Vec3> {
        let m = (wi * self.eta_across(wo) + wo).try_normalize()?;
        let m = if m.z < 0.0 { -m } else { m };
        // Both must meet the facet's side that faces as the surface does.
        (m.dot(wi) * wi.z > 0.0 && m.dot(wo) * wo.z > 0.0).then_some(m)
    }

    fn reflection(&self, ggx: &Ggx, wo: Vec3, wi: Vec3, m: Vec3) -> f32 {
        fresnel_dielectric(wo.dot(m), self.eta) * ggx.d(m) * ggx.g(wo, wi) / (4.0 * wo.z * wi.z).abs()
    }

    /// Walter et al. 2007, equation 21; scaled by the change of solid angle where radiance is carried.
    fn refraction(&self, ggx: &Ggx, wo: Vec3, wi: Vec3, m: Vec3, mode: TransportMode) -> f32 {
        let eta = self.eta_across(wo);
        let transmittance = 1.0 - fresnel_dielectric(wo.dot(m), self.eta);
        let denominator = (wi.dot(m) + wo.dot(m) / eta).powi(2);
        transmittance
            * ggx.d(m)
            * ggx.g(wo, wi)
            * (wi.dot(m) * wo.dot(m) / (wi.z * wo.z * denominator)).abs()
            * radiance_scale(eta, mode)
    }

    /// Walter et al. 2007, equation 17.
    fn refraction_pdf(&self, ggx: &Ggx, wo: Vec3, wi: Vec3, m: Vec3) -> f32 {
        let transmittance = 1.0 - fresnel_dielectric(wo.dot(m), self.eta);
        let denominator = (wi.dot(m) + wo.dot(m) / self.eta_across(wo)).powi(2);
        ggx.visible_normal_pdf(wo, m) * wi.dot(m).abs() / denominator * transmittance
    }
}

/// Radiance is squeezed into a smaller solid angle by 1 / eta²; importance is not (Veach 1997, section 5.2).
fn radiance_scale(eta: f32, mode: TransportMode) -> f32 {
    match mode {
        TransportMode::Radiance => 1.0 / (eta * eta),
        TransportMode::Importance => 1.0,
    }
}
