//! Boundaries of transparent bodies: smooth (two delta lobes), or GGX microfacets that reflect and refract (Walter et al. 2007).

use super::conductor::{half_vector, reflect, reflection_pdf};
use super::{Density, Ggx, LocalSample, LocalValue, TransportMode, fresnel_dielectric, refract};
use crate::math::{Vec2, Vec3};
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

    /// See [`Bsdf::eval`](super::Bsdf::eval).
    pub fn eval(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> Option<LocalValue> {
        let ggx = self.roughness.as_ref()?;
        if wo.z * wi.z > 0.0 {
            let m = half_vector(wo, wi)?;
            Some(reflection(ggx, wo, wi, m, fresnel_dielectric(wo.dot(m), self.eta)))
        } else {
            let m = self.refraction_normal(wo, wi)?;
            let transmittance = 1.0 - fresnel_dielectric(wo.dot(m), self.eta);
            Some(self.refraction(ggx, wo, wi, m, transmittance, mode))
        }
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
            return (wo.z * wi.z > 0.0)
                .then(|| LocalSample::continuous(reflection(ggx, wo, wi, m, reflectance), wi, 1.0));
        }
        let (wi, eta) = refract(wo, m, self.eta)?;
        if wo.z * wi.z >= 0.0 {
            return None;
        }
        let value = self.refraction(ggx, wo, wi, m, 1.0 - reflectance, mode);
        (value.pdf > 0.0).then(|| LocalSample::continuous(value, wi, eta))
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

    /// Walter et al. 2007, equations 21 and 17; scaled by the change of solid angle where radiance is carried.
    fn refraction(
        &self,
        ggx: &Ggx,
        wo: Vec3,
        wi: Vec3,
        m: Vec3,
        transmittance: f32,
        mode: TransportMode,
    ) -> LocalValue {
        let eta = self.eta_across(wo);
        let (cos_o, cos_i) = (wo.dot(m), wi.dot(m));
        let jacobian = cos_i.abs() / (cos_i + cos_o / eta).powi(2);
        let f = transmittance * ggx.d(m) * ggx.g(wo, wi) * (jacobian * cos_o / (wi.z * wo.z)).abs();
        LocalValue {
            f: SampledSpectrum::splat(f * radiance_scale(eta, mode)),
            pdf: transmittance * ggx.visible_normal_pdf(wo, m) * jacobian,
        }
    }
}

/// What facets of normal `m` and the given reflectance reflect.
fn reflection(ggx: &Ggx, wo: Vec3, wi: Vec3, m: Vec3, reflectance: f32) -> LocalValue {
    LocalValue {
        f: SampledSpectrum::splat(reflectance * ggx.d(m) * ggx.g(wo, wi) / (4.0 * wo.z * wi.z).abs()),
        pdf: reflectance * reflection_pdf(ggx, wo, m),
    }
}

/// Radiance is squeezed into a smaller solid angle by 1 / eta²; importance is not (Veach 1997, section 5.2).
fn radiance_scale(eta: f32, mode: TransportMode) -> f32 {
    match mode {
        TransportMode::Radiance => 1.0 / (eta * eta),
        TransportMode::Importance => 1.0,
    }
}
