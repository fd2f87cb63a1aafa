//! Metals: a smooth mirror, or microfacets that reflect, once or any number of times.

use std::f32::consts::FRAC_1_PI;

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

    /// Whether its values are estimates.
    pub fn is_estimate(&self) -> bool {
        self.multiple && self.roughness.is_some()
    }

    /// The reflectance of a facet.
    pub(super) fn fresnel(&self, cos: f32) -> SampledSpectrum {
        SampledSpectrum(std::array::from_fn(|i| {
            fresnel_complex(cos, self.eta.0[i], self.k.0[i])
        }))
    }

    /// See [`Bsdf::eval`](super::Bsdf::eval): F D G / (4 cos cos) (Torrance and Sparrow 1967).
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Option<LocalValue> {
        let facets = self.roughness.as_ref()?;
        let m = half_vector(wo, wi)?;
        let single = self.eval_facet(facets, wo, wi, m);
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

    fn eval_facet(&self, facets: &Microfacets, wo: Vec3, wi: Vec3, m: Vec3) -> LocalValue {
        LocalValue {
            f: self.fresnel(wo.dot(m).abs()) * (facets.d(m) * facets.g(wo, wi) / (4.0 * wo.z * wi.z).abs()),
            pdf: reflection_pdf(facets, wo, m),
        }
    }

    /// See [`Bsdf::sample_f`](super::Bsdf::sample_f).
    pub fn sample_f(&self, wo: Vec3, u: Vec2) -> Option<LocalSample> {
        let Some(facets) = &self.roughness else {
            return Some(LocalSample {
                value: self.fresnel(wo.z.abs()),
                wi: Vec3::new(-wo.x, -wo.y, wo.z),
                density: Density::Delta(1.0),
                eta: 1.0,
            });
        };
        if self.multiple {
            return self.sample_walk(facets, wo, u);
        }
        let (m, wi) = sample_reflection(facets, wo, u)?;
        Some(LocalSample::continuous(self.eval_facet(facets, wo, wi, m), wi, 1.0))
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
    if wo.z * wi.z <= 0.0 {
        return None;
    }
    let m = (wo + wi).try_normalize()?;
    Some(if m.z < 0.0 { -m } else { m })
}

/// Density of the direction reflected by a visible normal `m`: the reflection doubles angles.
#[inline]
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
#[inline]
pub(super) fn reflect(wo: Vec3, m: Vec3) -> Vec3 {
    m * (2.0 * wo.dot(m)) - wo
}
