//! Metals: a smooth mirror, or GGX microfacets that reflect.

use super::{Density, Ggx, LocalSample, LocalValue, fresnel_complex};
use crate::math::{Vec2, Vec3};
use crate::spectrum::SampledSpectrum;

/// Reflection by a conductor, on either side.
#[derive(Clone, Copy, Debug)]
pub struct Conductor {
    eta: SampledSpectrum,
    k: SampledSpectrum,
    roughness: Option<Ggx>,
}

impl Conductor {
    /// Of index `eta` + i `k`; smooth without `roughness`.
    pub fn new(eta: SampledSpectrum, k: SampledSpectrum, roughness: Option<Ggx>) -> Self {
        Self { eta, k, roughness }
    }

    /// Whether it is a mirror.
    pub fn is_delta(&self) -> bool {
        self.roughness.is_none()
    }

    fn fresnel(&self, cos: f32) -> SampledSpectrum {
        SampledSpectrum(std::array::from_fn(|i| {
            fresnel_complex(cos, self.eta.0[i], self.k.0[i])
        }))
    }

    /// See [`Bsdf::eval`](super::Bsdf::eval): F D G / (4 cos cos) (Torrance and Sparrow 1967).
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Option<LocalValue> {
        let ggx = self.roughness.as_ref()?;
        let m = half_vector(wo, wi)?;
        Some(self.eval_facet(ggx, wo, wi, m))
    }

    fn eval_facet(&self, ggx: &Ggx, wo: Vec3, wi: Vec3, m: Vec3) -> LocalValue {
        LocalValue {
            f: self.fresnel(wo.dot(m).abs()) * (ggx.d(m) * ggx.g(wo, wi) / (4.0 * wo.z * wi.z).abs()),
            pdf: reflection_pdf(ggx, wo, m),
        }
    }

    /// See [`Bsdf::sample_f`](super::Bsdf::sample_f).
    pub fn sample_f(&self, wo: Vec3, u: Vec2) -> Option<LocalSample> {
        let Some(ggx) = &self.roughness else {
            return Some(LocalSample {
                value: self.fresnel(wo.z.abs()),
                wi: Vec3::new(-wo.x, -wo.y, wo.z),
                density: Density::Delta(1.0),
                eta: 1.0,
            });
        };
        let (m, wi) = sample_reflection(ggx, wo, u)?;
        Some(LocalSample::continuous(self.eval_facet(ggx, wo, wi, m), wi, 1.0))
    }
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
pub(super) fn reflection_pdf(ggx: &Ggx, wo: Vec3, m: Vec3) -> f32 {
    ggx.visible_normal_pdf(wo, m) / (4.0 * wo.dot(m).abs())
}

/// A visible normal and the direction that it reflects `wo` to; `None` if that goes into the surface.
#[inline]
pub(super) fn sample_reflection(ggx: &Ggx, wo: Vec3, u: Vec2) -> Option<(Vec3, Vec3)> {
    let m = ggx.sample_visible_normal(wo, u);
    let wi = reflect(wo, m);
    (wo.z * wi.z > 0.0).then_some((m, wi))
}

/// Mirror direction of `wo` about `m`.
#[inline]
pub(super) fn reflect(wo: Vec3, m: Vec3) -> Vec3 {
    m * (2.0 * wo.dot(m)) - wo
}
