//! Boundaries of transparent bodies: smooth (two delta lobes), or microfacets that reflect and refract (Walter et al. 2007),
//! once or any number of times.

use std::f32::consts::FRAC_1_PI;

use super::conductor::{half_vector, reflect, reflection_pdf};
use super::multiscatter::{RoughSurface, Substance, multiple_share};
use super::{Density, LocalSample, LocalValue, Microfacets, TransportMode, fresnel_dielectric, refract};
use crate::math::{Vec2, Vec3};
use crate::spectrum::SampledSpectrum;

/// Reflection and refraction at a dielectric boundary. The side of positive z is outside.
#[derive(Clone, Copy, Debug)]
pub struct Dielectric {
    /// Index inside over index outside.
    eta: f32,
    roughness: Option<Microfacets>,
    multiple: bool,
}

impl Dielectric {
    /// Of relative index `eta` (positive); smooth without `roughness`. At an index of 1 there is no boundary and light goes
    /// straight through, however rough.
    pub fn new(eta: f32, roughness: Option<Microfacets>) -> Self {
        Self {
            eta,
            roughness: if eta == 1.0 { None } else { roughness },
            multiple: false,
        }
    }

    /// See [`super::Bsdf::is_specular`].
    pub fn is_specular(&self) -> bool {
        self.roughness.is_none_or(|facets| facets.is_specular())
    }

    /// With light that meets several facets: nothing is lost then. Values are estimates.
    #[must_use]
    pub fn with_multiple_scattering(self, multiple: bool) -> Self {
        Self { multiple, ..self }
    }

    /// Whether it is smooth.
    pub fn is_delta(&self) -> bool {
        self.roughness.is_none()
    }

    /// Whether its values are estimates.
    pub fn is_estimate(&self) -> bool {
        self.multiple && self.roughness.is_some()
    }

    /// Index on the far side over that on the side of `wo`.
    fn eta_across(&self, wo: Vec3) -> f32 {
        if wo.z > 0.0 { self.eta } else { 1.0 / self.eta }
    }

    /// See [`Bsdf::eval`](super::Bsdf::eval).
    pub fn eval(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> Option<LocalValue> {
        let facets = self.roughness.as_ref()?;
        if self.multiple {
            return Some(self.eval_walk(facets, wo, wi, mode));
        }
        self.eval_single(facets, wo, wi, mode)
    }

    fn eval_single(&self, facets: &Microfacets, wo: Vec3, wi: Vec3, mode: TransportMode) -> Option<LocalValue> {
        if wo.z * wi.z > 0.0 {
            let m = half_vector(wo, wi)?;
            Some(reflection(facets, wo, wi, m, fresnel_dielectric(wo.dot(m), self.eta)))
        } else {
            let m = self.refraction_normal(wo, wi)?;
            let transmittance = 1.0 - fresnel_dielectric(wo.dot(m), self.eta);
            Some(self.refraction(facets, wo, wi, m, transmittance, mode))
        }
    }

    fn eval_walk(&self, facets: &Microfacets, wo: Vec3, wi: Vec3, mode: TransportMode) -> LocalValue {
        let single = self.eval_single(facets, wo, wi, mode);
        let estimate = self.surface(facets).estimate(wo, wi) * (1.0 / wi.z.abs());
        let f = if wo.z * wi.z > 0.0 {
            estimate + single.map_or(SampledSpectrum::ZERO, |single| single.f)
        } else {
            estimate * radiance_scale(self.eta_across(wo), mode)
        };
        LocalValue {
            f,
            pdf: density_of_all(facets, single.map_or(0.0, |single| single.pdf), wi),
        }
    }

    fn sample_walk(
        &self,
        facets: &Microfacets,
        wo: Vec3,
        u_lobe: f32,
        u: Vec2,
        mode: TransportMode,
    ) -> Option<LocalSample> {
        let (wi, weight) = self.surface(facets).sample(wo, u_lobe, u)?;
        let single = self.eval_single(facets, wo, wi, mode);
        let pdf = density_of_all(facets, single.map_or(0.0, |single| single.pdf), wi);
        if wo.z * wi.z > 0.0 {
            LocalSample::weighted(weight, pdf, wi, 1.0)
        } else {
            let eta = self.eta_across(wo);
            LocalSample::weighted(weight * radiance_scale(eta, mode), pdf, wi, eta)
        }
    }

    fn surface<'a>(&self, facets: &'a Microfacets) -> RoughSurface<'a> {
        RoughSurface {
            facets,
            substance: Substance::Glass(self.eta),
        }
    }

    /// See [`Bsdf::sample_f`](super::Bsdf::sample_f).
    pub fn sample_f(&self, wo: Vec3, u_lobe: f32, u: Vec2, mode: TransportMode) -> Option<LocalSample> {
        let Some(facets) = &self.roughness else {
            return self.sample_smooth(wo, u_lobe, mode);
        };
        if self.multiple {
            return self.sample_walk(facets, wo, u_lobe, u, mode);
        }
        let m = facets.sample_visible_normal(wo, u);
        let reflectance = fresnel_dielectric(wo.dot(m), self.eta);
        if u_lobe < reflectance {
            let wi = reflect(wo, m);
            return (wo.z * wi.z > 0.0)
                .then(|| LocalSample::continuous(reflection(facets, wo, wi, m, reflectance), wi, 1.0));
        }
        let (wi, eta) = refract(wo, m, self.eta)?;
        if wo.z * wi.z >= 0.0 {
            return None;
        }
        let value = self.refraction(facets, wo, wi, m, 1.0 - reflectance, mode);
        (value.pdf > 0.0).then(|| LocalSample::continuous(value, wi, eta))
    }

    /// Index inside over index outside.
    pub(super) fn eta(&self) -> f32 {
        self.eta
    }

    /// Reflectance of a smooth boundary for a cosine.
    pub(super) fn reflectance(&self, cos: f32) -> f32 {
        fresnel_dielectric(cos, self.eta)
    }

    /// Density of `wi` among what is reflected, above or below alike; `None` for a smooth boundary.
    pub(super) fn reflection_pdf(&self, wo: Vec3, wi: Vec3) -> Option<f32> {
        let facets = self.roughness.as_ref()?;
        Some(half_vector(wo, wi).map_or(0.0, |m| reflection_pdf(facets, wo, m)))
    }

    /// Samples what is reflected only, at facets that meet light once.
    pub(super) fn sample_reflection(&self, wo: Vec3, u: Vec2, mode: TransportMode) -> Option<LocalSample> {
        let Some(facets) = &self.roughness else {
            // A number of 0 reflects; the probability is then 1.
            let sample = self.sample_smooth(wo, 0.0, mode)?;
            return (sample.wi.z * wo.z > 0.0).then_some(LocalSample {
                density: Density::Delta(1.0),
                ..sample
            });
        };
        let m = facets.sample_visible_normal(wo, u);
        let wi = reflect(wo, m);
        let f = reflection(facets, wo, wi, m, fresnel_dielectric(wo.dot(m), self.eta)).f;
        let pdf = reflection_pdf(facets, wo, m);
        (wo.z * wi.z > 0.0 && pdf > 0.0).then(|| LocalSample::continuous(LocalValue { f, pdf }, wi, 1.0))
    }

    /// Samples what is transmitted only, at facets that meet light once.
    pub(super) fn sample_transmission(&self, wo: Vec3, u: Vec2, mode: TransportMode) -> Option<LocalSample> {
        let Some(facets) = &self.roughness else {
            let sample = self.sample_smooth(wo, 1.0, mode)?;
            return (sample.wi.z * wo.z < 0.0).then_some(LocalSample {
                density: Density::Delta(1.0),
                ..sample
            });
        };
        let m = facets.sample_visible_normal(wo, u);
        let (wi, eta) = refract(wo, m, self.eta)?;
        if wo.z * wi.z >= 0.0 {
            return None;
        }
        let value = self.conditional_refraction(facets, wo, wi, m, mode);
        (value.pdf > 0.0).then(|| LocalSample::continuous(value, wi, eta))
    }

    /// The value of a rough boundary for directions on its two sides, with the density of
    /// [`Dielectric::sample_transmission`].
    pub(super) fn transmission(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> Option<LocalValue> {
        let facets = self.roughness.as_ref()?;
        if wo.z * wi.z >= 0.0 {
            return None;
        }
        let m = self.refraction_normal(wo, wi)?;
        Some(self.conditional_refraction(facets, wo, wi, m, mode))
    }

    fn conditional_refraction(
        &self,
        facets: &Microfacets,
        wo: Vec3,
        wi: Vec3,
        m: Vec3,
        mode: TransportMode,
    ) -> LocalValue {
        let certain = self.refraction(facets, wo, wi, m, 1.0, mode);
        let transmittance = 1.0 - fresnel_dielectric(wo.dot(m), self.eta);
        LocalValue {
            f: certain.f * transmittance,
            pdf: certain.pdf,
        }
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
        facets: &Microfacets,
        wo: Vec3,
        wi: Vec3,
        m: Vec3,
        transmittance: f32,
        mode: TransportMode,
    ) -> LocalValue {
        let eta = self.eta_across(wo);
        let (cos_o, cos_i) = (wo.dot(m), wi.dot(m));
        let jacobian = cos_i.abs() / (cos_i + cos_o / eta).powi(2);
        let f = transmittance * facets.d(m) * facets.g(wo, wi) * (jacobian * cos_o / (wi.z * wo.z)).abs();
        LocalValue {
            f: SampledSpectrum::splat(f * radiance_scale(eta, mode)),
            pdf: transmittance * facets.visible_normal_pdf(wo, m) * jacobian,
        }
    }
}

/// A density for all orders of scattering, from that of the first.
fn density_of_all(facets: &Microfacets, single: f32, wi: Vec3) -> f32 {
    let share = multiple_share(facets);
    (1.0 - share) * single + 0.5 * share * wi.z.abs() * FRAC_1_PI
}

/// What facets of normal `m` and the given reflectance reflect.
fn reflection(facets: &Microfacets, wo: Vec3, wi: Vec3, m: Vec3, reflectance: f32) -> LocalValue {
    LocalValue {
        f: SampledSpectrum::splat(reflectance * facets.d(m) * facets.g(wo, wi) / (4.0 * wo.z * wi.z).abs()),
        pdf: reflectance * reflection_pdf(facets, wo, m),
    }
}

/// Radiance is squeezed into a smaller solid angle by 1 / eta²; importance is not (Veach 1997, section 5.2).
fn radiance_scale(eta: f32, mode: TransportMode) -> f32 {
    match mode {
        TransportMode::Radiance => 1.0 / (eta * eta),
        TransportMode::Importance => 1.0,
    }
}
