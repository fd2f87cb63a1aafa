//! A BSDF at a point: one lobe in a frame, evaluated and sampled in world space.

use super::Lobe;
use super::sides::Sides;
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

impl TransportMode {
    /// What travels along the path, seen from its other end.
    #[inline]
    #[must_use]
    pub fn reversed(self) -> Self {
        match self {
            Self::Radiance => Self::Importance,
            Self::Importance => Self::Radiance,
        }
    }
}

/// How likely a sampled direction was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Density {
    /// One of a continuum.
    Continuous(SolidAnglePdf),
    /// One of finitely many, with this probability.
    Delta(f32),
}

impl Density {
    /// That of each of `count` directions that share it.
    fn divided(self, count: f32) -> Self {
        match self {
            Self::Continuous(pdf) => Self::Continuous(SolidAnglePdf(pdf.0 / count)),
            Self::Delta(probability) => Self::Delta(probability / count),
        }
    }
}

/// A direction sampled in proportion to a BSDF.
#[derive(Clone, Copy, Debug)]
pub struct BsdfSample {
    /// `f(wo, wi)`, in sr⁻¹, without the cosine; for a delta lobe its coefficient: the fraction of radiance that it carries. For a
    /// lobe whose value is an estimate ([`Bsdf::is_estimate`]), what makes the [weight](BsdfSample::weight) right in the mean.
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

/// The greatest facet slope (alpha, in either direction) of a surface that counts as specular, see [`Bsdf::is_specular`].
pub const SPECULAR_ALPHA: f32 = 0.1;

/// The scattering function at a point of a surface for the wavelengths of a path.
///
/// `f` and `pdf` are functions of their arguments alone. Most lobes have closed forms. Of others `f` is an estimate by a random
/// walk seeded by the directions: it is right in the mean over directions close together, and its `pdf` is one to weight with,
/// not exactly that of the samples, though never 0 where they fall.
#[derive(Clone, Copy, Debug)]
pub struct Bsdf<'a> {
    frame: Frame,
    lobe: Lobe<'a>,
    /// Where a map has bent the shading normal.
    sides: Option<Sides>,
}

impl<'a> Bsdf<'a> {
    /// A lobe whose local z is the normal of `frame` and whose local x is its tangent.
    #[inline]
    pub fn new(frame: Frame, lobe: Lobe<'a>) -> Self {
        Self {
            frame,
            lobe,
            sides: None,
        }
    }

    /// This BSDF under a bent normal, where `ng` (world space, in the shading normal's hemisphere) says which side a direction is on.
    #[must_use]
    pub(super) fn with_sides_of(self, ng: Vec3) -> Self {
        Self {
            sides: Some(Sides::new(self.frame.to_local(ng))),
            ..self
        }
    }

    /// What a lobe's value is divided by where directions look alike; see `sides.rs`.
    fn share(&self, sides: &Sides, wo: Vec3, wi: Vec3) -> f32 {
        match &self.lobe {
            Lobe::Diffuse(_) | Lobe::DiffuseTransmission(_) => 1.0,
            _ => sides.count(wo).max(sides.count(wi)),
        }
    }

    /// Whether it has only delta lobes, so that `f` is 0 for any two directions that were not sampled from it.
    #[inline]
    pub fn is_delta(&self) -> bool {
        match &self.lobe {
            Lobe::Diffuse(_)
            | Lobe::OrenNayar(_)
            | Lobe::DiffuseTransmission(_)
            | Lobe::Principled(_)
            | Lobe::Plastic(_)
            | Lobe::Burley(_)
            | Lobe::Measured(_)
            | Lobe::Hair(_) => false,
            Lobe::ThinDielectric(_) => true,
            Lobe::Tinted(lobe) => lobe.is_delta(),
            Lobe::Layered(lobe) => lobe.is_delta(),
            Lobe::Conductor(lobe) => lobe.is_delta(),
            Lobe::Dielectric(lobe) => lobe.is_delta(),
        }
    }

    /// The frame of the shading normal.
    #[inline]
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Whether directions on the other side of the shading normal than `wo` may carry light, by other than delta lobes.
    pub fn transmits(&self) -> bool {
        // Where a map has bent that normal, some of them reflect.
        self.sides.is_some()
            || match &self.lobe {
                Lobe::Diffuse(_)
                | Lobe::OrenNayar(_)
                | Lobe::Conductor(_)
                | Lobe::Layered(_)
                | Lobe::Plastic(_)
                | Lobe::Measured(_) => false,
                Lobe::Tinted(lobe) => lobe.transmits(),
                Lobe::Burley(lobe) => lobe.transmits(),
                Lobe::DiffuseTransmission(_)
                | Lobe::Dielectric(_)
                | Lobe::ThinDielectric(_)
                | Lobe::Principled(_)
                | Lobe::Hair(_) => true,
            }
    }

    /// Whether it has delta lobes, perhaps beside others.
    pub fn has_delta(&self) -> bool {
        match &self.lobe {
            Lobe::Layered(lobe) => lobe.has_delta(),
            Lobe::Plastic(lobe) => lobe.has_delta(),
            _ => self.is_delta(),
        }
    }

    /// Whether it is a mirror or a window, or nearly so: it has nothing but delta lobes and facets of [`SPECULAR_ALPHA`] at most. Light
    /// is then better followed on its way than looked for from here; photon maps keep nothing of it.
    pub fn is_specular(&self) -> bool {
        match &self.lobe {
            Lobe::Diffuse(_)
            | Lobe::OrenNayar(_)
            | Lobe::DiffuseTransmission(_)
            | Lobe::Plastic(_)
            | Lobe::Measured(_)
            | Lobe::Hair(_) => false,
            Lobe::Tinted(lobe) => lobe.is_specular(),
            Lobe::Burley(lobe) => lobe.is_specular(),
            Lobe::ThinDielectric(_) => true,
            Lobe::Layered(lobe) => lobe.is_delta(),
            Lobe::Conductor(lobe) => lobe.is_specular(),
            Lobe::Dielectric(lobe) => lobe.is_specular(),
            Lobe::Principled(lobe) => lobe.is_specular(),
        }
    }

    /// The reflectance, if it is Lambertian and nothing else: `f` is that over pi for any two directions on one side.
    #[inline]
    pub fn lambertian_reflectance(&self) -> Option<SampledSpectrum> {
        match (&self.lobe, &self.sides) {
            (Lobe::Diffuse(lobe), None) => Some(lobe.albedo()),
            _ => None,
        }
    }

    /// Whether `f` is an estimate that only its mean over neighbouring directions makes right, and `pdf` only a likeness of the
    /// samples' density.
    pub fn is_estimate(&self) -> bool {
        match &self.lobe {
            Lobe::Conductor(lobe) => lobe.is_estimate(),
            Lobe::Dielectric(lobe) => lobe.is_estimate(),
            Lobe::Layered(lobe) => !lobe.is_delta(),
            Lobe::Diffuse(_)
            | Lobe::OrenNayar(_)
            | Lobe::DiffuseTransmission(_)
            | Lobe::ThinDielectric(_)
            | Lobe::Principled(_)
            | Lobe::Plastic(_)
            | Lobe::Burley(_)
            | Lobe::Tinted(_)
            | Lobe::Measured(_)
            | Lobe::Hair(_) => false,
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
        let (mut wo, mut wi) = (self.frame.to_local(wo), self.frame.to_local(wi));
        if wo.z == 0.0 || wi.z == 0.0 {
            return None;
        }
        if let Some(sides) = &self.sides {
            (wo, wi) = (sides.seen(wo), sides.seen(wi));
        }
        let mut value = self.lobe.eval(wo, wi, mode)?;
        if let Some(sides) = &self.sides {
            value.f *= 1.0 / self.share(sides, wo, wi);
            value.pdf /= sides.count(wi);
        }
        Some(BsdfValue {
            f: value.f,
            pdf: SolidAnglePdf(value.pdf),
            cos_theta: wi.z.abs(),
        })
    }

    /// [`Bsdf::eval`], and the density of the way back: [`Bsdf::pdf`] of (wi, wo) in the mode of the other end, at little more than the
    /// price of one where the lobe is Lambertian.
    #[inline]
    pub fn eval_both_ways(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> Option<(BsdfValue, SolidAnglePdf)> {
        if let (Lobe::Diffuse(lobe), None) = (&self.lobe, &self.sides) {
            let (wo, wi) = (self.frame.to_local(wo), self.frame.to_local(wi));
            let value = lobe.eval(wo, wi)?;
            let reverse = lobe.eval(wi, wo)?.pdf;
            let value = BsdfValue {
                f: value.f,
                pdf: SolidAnglePdf(value.pdf),
                cos_theta: wi.z.abs(),
            };
            return Some((value, SolidAnglePdf(reverse)));
        }
        let value = self.eval(wo, wi, mode)?;
        Some((value, self.pdf(wi, wo, mode.reversed())))
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
        let mut wo = self.frame.to_local(wo);
        if wo.z == 0.0 {
            return None;
        }
        // The number that chooses among lobes first chooses between two directions that look alike.
        let (mut u_lobe, mut other) = (u_lobe, false);
        if let Some(sides) = &self.sides {
            wo = sides.seen(wo);
            other = u_lobe >= 0.5;
            u_lobe = (2.0 * u_lobe).fract();
        }
        let mut local = self.lobe.sample_f(wo, u_lobe, u, mode)?;
        if local.wi.z == 0.0 || local.value.is_black() {
            return None;
        }
        if let Some(sides) = &self.sides {
            local.value *= 1.0 / self.share(sides, wo, local.wi);
            local.density = local.density.divided(sides.count(local.wi));
            local.wi = sides.real(local.wi, other)?;
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
