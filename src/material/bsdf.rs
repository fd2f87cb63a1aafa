//! A BSDF at a point: one lobe in a frame, evaluated and sampled in world space.

use super::{Conductor, Dielectric, Diffuse};
use crate::math::{Frame, Vec2, Vec3};
use crate::sampling::SolidAnglePdf;
use crate::spectrum::SampledSpectrum;

/// What travels against the path: radiance from a camera, importance from a light. Refraction scales the two differently
/// (Veach 1997, section 5.2).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TransportMode {
    /// Paths from the camera.
    Radiance,
    /// Paths from a light.
    Importance,
}

/// How likely a sampled direction was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Density {
    /// One of a continuum.
    Continuous(SolidAnglePdf),
    /// One of finitely many, with this probability.
    Delta(f32),
}

/// A direction sampled in proportion to a BSDF.
#[derive(Clone, Copy, Debug)]
pub struct BsdfSample {
    /// `f(wo, wi)`, in sr⁻¹, without the cosine; for a delta lobe its coefficient: the fraction of radiance that it carries.
    pub value: SampledSpectrum,
    /// The direction, world space.
    pub wi: Vec3,
    /// Its density or probability.
    pub density: Density,
    /// The index of refraction on the side of `wi` over that on the side of `wo`; 1 for a reflection.
    pub eta: f32,
    /// |cos| of `wi` to the shading normal.
    pub cos_theta: f32,
}

impl BsdfSample {
    /// What the path's throughput is multiplied by: f cos / pdf, or coefficient / probability.
    #[inline]
    pub fn weight(&self) -> SampledSpectrum {
        match self.density {
            Density::Continuous(pdf) => self.value * (self.cos_theta / pdf.0),
            Density::Delta(probability) => self.value * (1.0 / probability),
        }
    }
}

/// What a BSDF is for a pair of directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfValue {
    /// See [`Bsdf::f`].
    pub f: SampledSpectrum,
    /// See [`Bsdf::pdf`].
    pub pdf: SolidAnglePdf,
    /// |cos| of `wi` to the shading normal.
    pub cos_theta: f32,
}

/// [`BsdfValue`] in the local frame of a lobe, where the cosine is z.
#[derive(Clone, Copy, Debug)]
pub struct LocalValue {
    /// As [`BsdfValue::f`].
    pub f: SampledSpectrum,
    /// As [`BsdfValue::pdf`].
    pub pdf: f32,
}

/// [`BsdfSample`] in the local frame of a lobe.
#[derive(Clone, Copy, Debug)]
pub struct LocalSample {
    /// As [`BsdfSample::value`].
    pub value: SampledSpectrum,
    /// The direction, local.
    pub wi: Vec3,
    /// As [`BsdfSample::density`].
    pub density: Density,
    /// As [`BsdfSample::eta`].
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
}

/// The lobes there are.
#[derive(Clone, Copy, Debug)]
pub(super) enum Lobe {
    Diffuse(Diffuse),
    Conductor(Conductor),
    Dielectric(Dielectric),
}

/// The scattering function at a point of a surface for the wavelengths of a path. `f` and `pdf` are functions of their arguments
/// alone.
#[derive(Clone, Copy, Debug)]
pub struct Bsdf {
    frame: Frame,
    lobe: Lobe,
}

impl Bsdf {
    pub(super) fn new(frame: Frame, lobe: Lobe) -> Self {
        Self { frame, lobe }
    }

    /// Whether it has only delta lobes, so that `f` is 0 for any two directions that were not sampled from it.
    #[inline]
    pub fn is_delta(&self) -> bool {
        match &self.lobe {
            Lobe::Diffuse(_) => false,
            Lobe::Conductor(lobe) => lobe.is_delta(),
            Lobe::Dielectric(lobe) => lobe.is_delta(),
        }
    }

    /// |cos| of `w` to the shading normal.
    #[inline]
    pub fn abs_cos(&self, w: Vec3) -> f32 {
        w.dot(self.frame.n).abs()
    }

    /// Value and density for a pair of directions, at the price of one. `None` where no light goes, or only by delta lobes; where
    /// a surface could send light but is black, the value is 0 and the density is not.
    #[inline]
    pub fn eval(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> Option<BsdfValue> {
        let (wo, wi) = (self.frame.to_local(wo), self.frame.to_local(wi));
        if wo.z == 0.0 || wi.z == 0.0 {
            return None;
        }
        let value = match &self.lobe {
            Lobe::Diffuse(lobe) => lobe.eval(wo, wi),
            Lobe::Conductor(lobe) => lobe.eval(wo, wi),
            Lobe::Dielectric(lobe) => lobe.eval(wo, wi, mode),
        }?;
        Some(BsdfValue {
            f: value.f,
            pdf: SolidAnglePdf(value.pdf),
            cos_theta: wi.z.abs(),
        })
    }

    /// The value of the BSDF in sr⁻¹, without the cosine and without delta lobes. 0 where no light goes.
    #[inline]
    pub fn f(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> SampledSpectrum {
        self.eval(wo, wi, mode).map_or(SampledSpectrum::ZERO, |value| value.f)
    }

    /// The density with which [`Bsdf::sample_f`] gives `wi` for `wo`; 0 for delta lobes.
    #[inline]
    pub fn pdf(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> SolidAnglePdf {
        self.eval(wo, wi, mode).map_or(SolidAnglePdf(0.0), |value| value.pdf)
    }

    /// Samples a direction for `wo`: `u_lobe` chooses among lobes, `u` within one. `None` carries nothing.
    #[inline]
    pub fn sample_f(&self, wo: Vec3, u_lobe: f32, u: Vec2, mode: TransportMode) -> Option<BsdfSample> {
        let wo = self.frame.to_local(wo);
        if wo.z == 0.0 {
            return None;
        }
        let local = match &self.lobe {
            Lobe::Diffuse(lobe) => lobe.sample_f(wo, u),
            Lobe::Conductor(lobe) => lobe.sample_f(wo, u),
            Lobe::Dielectric(lobe) => lobe.sample_f(wo, u_lobe, u, mode),
        }?;
        if local.wi.z == 0.0 || local.value.is_black() {
            return None;
        }
        Some(BsdfSample {
            value: local.value,
            wi: self.frame.to_world(local.wi).normalize(),
            density: local.density,
            eta: local.eta,
            cos_theta: local.wi.z.abs(),
        })
    }
}
