//! Metals: a smooth mirror, or microfacets that reflect, once or any number of times.

use std::f32::consts::FRAC_1_PI;

use super::lobe::{LaneSample, LaneValue};
use super::multiscatter::{RoughSurface, Substance, multiple_share};
use super::{Density, LocalSample, LocalValue, Microfacets, fresnel_complex};
use crate::math::{Vec2, Vec3};
use crate::spectrum::SampledSpectrum;

/// Reflection by a conductor, on either side.
#[derive(Clone, Copy, Debug)]
pub struct Conductor {
    eta: SampledSpectrum,
    k: SampledSpectrum,
    roughness: Option<Microfacets>,
    multiple: bool,
}

impl Conductor {
    /// Of index `eta` + i `k`; smooth without `roughness`.
    pub fn new(eta: SampledSpectrum, k: SampledSpectrum, roughness: Option<Microfacets>) -> Self {
        Self {
            eta,
            k,
            roughness,
            multiple: false,
        }
    }

    /// See [`super::Bsdf::is_specular`].
    pub fn is_specular(&self) -> bool {
        self.roughness.is_none_or(|facets| facets.is_specular())
    }

    /// With light that meets several facets: what is then not absorbed is not lost. Values are estimates.
    #[must_use]
    pub fn with_multiple_scattering(self, multiple: bool) -> Self {
        Self { multiple, ..self }
    }

    /// Whether it is a mirror.
    pub fn is_delta(&self) -> bool {
        self.roughness.is_none()
    }

    /// Its facets; `None` if it is smooth.
    pub(super) fn facets(&self) -> Option<&Microfacets> {
        self.roughness.as_ref()
    }

    /// Its index, eta and k.
    pub(super) fn index(&self) -> (SampledSpectrum, SampledSpectrum) {
        (self.eta, self.k)
    }

    /// Whether its values are estimates.
    pub fn is_estimate(&self) -> bool {
        self.multiple && self.roughness.is_some()
    }

    /// The reflectance of a facet.
    #[inline(always)]
    pub(super) fn fresnel(&self, cos: f32) -> SampledSpectrum {
        let ([eta_a, eta_b, eta_c, eta_d], [k_a, k_b, k_c, k_d]) = (self.eta.0, self.k.0);
        SampledSpectrum([
            fresnel_complex(cos, eta_a, k_a),
            fresnel_complex(cos, eta_b, k_b),
            fresnel_complex(cos, eta_c, k_c),
            fresnel_complex(cos, eta_d, k_d),
        ])
    }

    /// See [`Bsdf::eval`](super::Bsdf::eval): F D G / (4 cos cos) (Torrance and Sparrow 1967).
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Option<LocalValue> {
        let facets = self.roughness.as_ref()?;
        let LaneValue { value: single, exists } = self.eval_once(facets, wo, wi);
        if !exists {
            return None;
        }
        Some(if self.multiple {
            LocalValue {
                f: single.f + self.surface(facets).estimate(wo, wi) * (1.0 / wi.z.abs()),
                pdf: density_of_all(facets, single.pdf, wi),
            }
        } else {
            single
        })
    }

    fn surface<'a>(&'a self, facets: &'a Microfacets) -> RoughSurface<'a> {
        RoughSurface {
            facets,
            substance: Substance::Metal(self),
        }
    }

    fn sample_walk(&self, facets: &Microfacets, wo: Vec3, u: Vec2) -> Option<LocalSample> {
        let (wi, weight) = self.surface(facets).sample(wo, 0.0, u)?;
        let m = half_vector(wo, wi)?;
        let pdf = density_of_all(facets, reflection_pdf(facets, wo, m), wi);
        LocalSample::weighted(weight, pdf, wi, 1.0)
    }

    /// What light brings that is reflected once.
    #[inline(always)]
    pub(super) fn eval_once(&self, facets: &Microfacets, wo: Vec3, wi: Vec3) -> LaneValue {
        let (m, exists) = half_vector_if(wo, wi);
        LaneValue {
            value: self.eval_facet(facets, wo, wi, m),
            exists,
        }
    }

    /// A direction that light is reflected in once.
    #[inline(always)]
    pub(super) fn sample_once(&self, facets: &Microfacets, wo: Vec3, u: Vec2) -> LaneSample {
        let m = facets.visible_normal(wo, u);
        let wi = reflect(wo, m);
        LaneSample {
            wi,
            value: self.eval_facet(facets, wo, wi, m),
            exists: wo.z * wi.z > 0.0,
        }
    }

    /// The direction that a smooth one reflects `wo` in, and how much of it.
    #[inline(always)]
    pub(super) fn mirror(&self, wo: Vec3) -> (Vec3, SampledSpectrum) {
        (Vec3::new(-wo.x, -wo.y, wo.z), self.fresnel(wo.z.abs()))
    }

    #[inline(always)]
    fn eval_facet(&self, facets: &Microfacets, wo: Vec3, wi: Vec3, m: Vec3) -> LocalValue {
        LocalValue {
            f: self.fresnel(wo.dot(m).abs()) * (facets.d(m) * facets.g(wo, wi) / (4.0 * wo.z * wi.z).abs()),
            pdf: reflection_pdf(facets, wo, m),
        }
    }

    /// See [`Bsdf::sample_f`](super::Bsdf::sample_f).
    pub fn sample_f(&self, wo: Vec3, u: Vec2) -> Option<LocalSample> {
        let Some(facets) = &self.roughness else {
            let (wi, value) = self.mirror(wo);
            return Some(LocalSample {
                value,
                wi,
                density: Density::Delta(1.0),
                eta: 1.0,
            });
        };
        if self.multiple {
            return self.sample_walk(facets, wo, u);
        }
        let LaneSample { wi, value, exists } = self.sample_once(facets, wo, u);
        exists.then(|| LocalSample::continuous(value, wi, 1.0))
    }
}

/// A density for all orders of reflection, from that of the first.
fn density_of_all(facets: &Microfacets, single: f32, wi: Vec3) -> f32 {
    let share = multiple_share(facets);
    (1.0 - share) * single + share * wi.z.abs() * FRAC_1_PI
}

/// The microfacet normal, with z >= 0, that reflects `wo` to `wi`; `None` if they are on different sides.
#[inline]
pub(super) fn half_vector(wo: Vec3, wi: Vec3) -> Option<Vec3> {
    let (m, exists) = half_vector_if(wo, wi);
    exists.then_some(m)
}

/// [`half_vector`] for kernels, and whether there is one.
#[inline(always)]
fn half_vector_if(wo: Vec3, wi: Vec3) -> (Vec3, bool) {
    let m = (wo + wi).normalize_or(Vec3::ZERO);
    let exists = (wo.z * wi.z > 0.0) & ((m.x != 0.0) | (m.y != 0.0) | (m.z != 0.0));
    (m * if m.z < 0.0 { -1.0 } else { 1.0 }, exists)
}

/// Density of the direction reflected by a visible normal `m`: the reflection doubles angles.
#[inline(always)]
pub(super) fn reflection_pdf(facets: &Microfacets, wo: Vec3, m: Vec3) -> f32 {
    facets.visible_normal_pdf(wo, m) / (4.0 * wo.dot(m).abs())
}

/// A visible normal and the direction that it reflects `wo` to; `None` if that goes into the surface.
#[inline]
pub(super) fn sample_reflection(facets: &Microfacets, wo: Vec3, u: Vec2) -> Option<(Vec3, Vec3)> {
    let m = facets.sample_visible_normal(wo, u);
    let wi = reflect(wo, m);
    (wo.z * wi.z > 0.0).then_some((m, wi))
}

/// Mirror direction of `wo` about `m`.
#[inline(always)]
pub(super) fn reflect(wo: Vec3, m: Vec3) -> Vec3 {
    m * (2.0 * wo.dot(m)) - wo
}
