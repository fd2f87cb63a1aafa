//! Lobes: what scatters in the local frame of a point, where z is the shading normal.

use super::bsdf::{Density, TransportMode};
use super::{
    Burley, Conductor, Dielectric, Diffuse, DiffuseTransmission, Hair, Layered, Measured, OrenNayar, Plastic,
    Principled, ThinDielectric, Tinted,
};
use crate::math::{Vec2, Vec3};
use crate::sampling::SolidAnglePdf;
use crate::spectrum::SampledSpectrum;

/// [`BsdfValue`](super::BsdfValue) in the local frame of a lobe, where the cosine is z.
#[derive(Clone, Copy, Debug)]
pub struct LocalValue {
    /// As [`BsdfValue::f`](super::BsdfValue::f).
    pub f: SampledSpectrum,
    /// As [`BsdfValue::pdf`](super::BsdfValue::pdf).
    pub pdf: f32,
}

/// [`BsdfSample`](super::BsdfSample) in the local frame of a lobe.
#[derive(Clone, Copy, Debug)]
pub struct LocalSample {
    /// As [`BsdfSample::value`](super::BsdfSample::value).
    pub value: SampledSpectrum,
    /// The direction, local.
    pub wi: Vec3,
    /// As [`BsdfSample::density`](super::BsdfSample::density).
    pub density: Density,
    /// As [`BsdfSample::eta`](super::BsdfSample::eta).
    pub eta: f32,
}

impl LocalSample {
    /// One of a continuum.
    #[inline]
    pub(super) fn continuous(value: LocalValue, wi: Vec3, eta: f32) -> Self {
        Self {
            value: value.f,
            wi,
            density: Density::Continuous(SolidAnglePdf(value.pdf)),
            eta,
        }
    }

    /// As [`BsdfSample::weight`](super::BsdfSample::weight).
    #[inline]
    pub(super) fn weight(&self) -> SampledSpectrum {
        match self.density {
            Density::Continuous(pdf) => self.value * (self.wi.z.abs() / pdf.0),
            Density::Delta(probability) => self.value * (1.0 / probability),
        }
    }

    /// One whose throughput is `weight`, where the value is only known as an estimate: what times cos / pdf is the weight. The
    /// density has to be that which the lobe evaluates to for the same directions. `None` where it is 0.
    #[inline]
    pub(super) fn weighted(weight: SampledSpectrum, pdf: f32, wi: Vec3, eta: f32) -> Option<Self> {
        let f = weight * (pdf / wi.z.abs());
        (pdf > 0.0 && wi.z != 0.0).then(|| Self::continuous(LocalValue { f, pdf }, wi, eta))
    }
}

/// What a kernel has for an `Option<LocalValue>`.
#[derive(Clone, Copy, Debug)]
pub struct LaneValue {
    /// Without meaning unless it exists.
    pub value: LocalValue,
    /// Whether it does.
    pub exists: bool,
}

/// What a kernel has for an `Option<LocalSample>` of a reflection that is one of a continuum.
#[derive(Clone, Copy, Debug)]
pub struct LaneSample {
    /// The direction, local.
    pub wi: Vec3,
    /// Of the direction; without meaning unless it exists.
    pub value: LocalValue,
    /// Whether it does.
    pub exists: bool,
}

/// The lobes there are.
#[derive(Clone, Copy, Debug)]
#[expect(missing_docs, reason = "each is its type")]
pub enum Lobe<'a> {
    Diffuse(Diffuse),
    OrenNayar(OrenNayar),
    DiffuseTransmission(DiffuseTransmission),
    Conductor(Conductor),
    Dielectric(Dielectric),
    ThinDielectric(ThinDielectric),
    Layered(Layered),
    Principled(Principled<'a>),
    Measured(Measured<'a>),
    Plastic(Plastic<'a>),
    Burley(Burley),
    Tinted(Tinted),
    Hair(Hair),
}

// The commonest lobe is where it is asked for, the others are calls away: together they would push its numbers out of registers.
impl Lobe<'_> {
    #[inline(always)]
    pub(super) fn eval(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> Option<LocalValue> {
        match self {
            Self::Diffuse(lobe) => lobe.eval(wo, wi),
            _ => self.eval_other(wo, wi, mode),
        }
    }

    #[inline(never)]
    fn eval_other(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> Option<LocalValue> {
        match self {
            Self::Diffuse(lobe) => lobe.eval(wo, wi),
            Self::OrenNayar(lobe) => lobe.eval(wo, wi),
            Self::DiffuseTransmission(lobe) => lobe.eval(wo, wi),
            Self::ThinDielectric(_) => None,
            Self::Layered(lobe) => lobe.eval(wo, wi, mode),
            Self::Principled(lobe) => lobe.eval(wo, wi, mode),
            Self::Measured(lobe) => lobe.eval(wo, wi),
            Self::Plastic(lobe) => lobe.eval(wo, wi),
            Self::Burley(lobe) => lobe.eval(wo, wi, mode),
            Self::Tinted(lobe) => lobe.eval(wo, wi, mode),
            Self::Hair(lobe) => lobe.eval(wo, wi),
            Self::Conductor(lobe) => lobe.eval(wo, wi),
            Self::Dielectric(lobe) => lobe.eval(wo, wi, mode),
        }
    }

    #[inline(always)]
    pub(super) fn sample_f(&self, wo: Vec3, u_lobe: f32, u: Vec2, mode: TransportMode) -> Option<LocalSample> {
        match self {
            Self::Diffuse(lobe) => lobe.sample_f(wo, u),
            _ => self.sample_f_other(wo, u_lobe, u, mode),
        }
    }

    #[inline(never)]
    fn sample_f_other(&self, wo: Vec3, u_lobe: f32, u: Vec2, mode: TransportMode) -> Option<LocalSample> {
        match self {
            Self::Diffuse(lobe) => lobe.sample_f(wo, u),
            Self::OrenNayar(lobe) => lobe.sample_f(wo, u),
            Self::DiffuseTransmission(lobe) => lobe.sample_f(wo, u_lobe, u),
            Self::ThinDielectric(lobe) => lobe.sample_f(wo, u_lobe),
            Self::Layered(lobe) => lobe.sample_f(wo, u_lobe, u, mode),
            Self::Principled(lobe) => lobe.sample_f(wo, u_lobe, u, mode),
            Self::Measured(lobe) => lobe.sample_f(wo, u),
            Self::Plastic(lobe) => lobe.sample_f(wo, u_lobe, u),
            Self::Burley(lobe) => lobe.sample_f(wo, u_lobe, u, mode),
            Self::Tinted(lobe) => lobe.sample_f(wo, u_lobe, u, mode),
            Self::Hair(lobe) => lobe.sample_f(wo, u_lobe, u),
            Self::Conductor(lobe) => lobe.sample_f(wo, u),
            Self::Dielectric(lobe) => lobe.sample_f(wo, u_lobe, u, mode),
        }
    }
}
