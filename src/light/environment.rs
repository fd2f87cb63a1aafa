//! Light from all around the scene.

use std::f32::consts::PI;

use super::portal::PortalEnvironment;
use super::sky::ImageEnvironment;
use super::{LightDensity, LightEnd, LightSample};
use crate::math::{Bounds3, Vec2, Vec3};
use crate::sampling::{SolidAnglePdf, warp};
use crate::spectrum::{CompiledSpectrum, SampledSpectrum, Wavelengths};

/// Radiance that a ray meets when it leaves the scene.
#[derive(Clone, Debug)]
pub enum EnvironmentLight {
    /// The same from every direction, in W·m⁻²·sr⁻¹·nm⁻¹.
    Constant(CompiledSpectrum),
    /// By an image.
    Image(Box<ImageEnvironment>),
    /// Through a portal.
    Portal(Box<PortalEnvironment>),
}

impl EnvironmentLight {
    /// Radiance along a ray from `p` in direction `w`, of unit length, that leaves the scene at `time`.
    #[inline]
    pub fn le(&self, p: Vec3, w: Vec3, time: f32, lambda: &Wavelengths) -> SampledSpectrum {
        match self {
            Self::Constant(radiance) => radiance.sample(lambda),
            Self::Image(image) => image.le(w, time, lambda),
            Self::Portal(portal) => portal.le(p, w, lambda),
        }
    }

    /// Density with which [`Light::sample_li`](super::Light::sample_li) from `p` gives the direction `w`.
    #[inline]
    pub fn pdf_li(&self, p: Vec3, w: Vec3, time: f32) -> SolidAnglePdf {
        match self {
            Self::Constant(_) => warp::uniform_sphere_pdf(),
            Self::Image(image) => image.pdf_li(w, time),
            Self::Portal(portal) => portal.pdf_li(p, w),
        }
    }

    pub(super) fn sample_li(&self, p: Vec3, time: f32, u: Vec2, lambda: &Wavelengths) -> Option<LightSample> {
        let (wi, pdf, li) = match self {
            Self::Constant(radiance) => {
                let wi = warp::sample_uniform_sphere(u);
                (wi, warp::uniform_sphere_pdf(), radiance.sample(lambda))
            }
            Self::Image(image) => image.sample(time, u, lambda)?,
            Self::Portal(portal) => portal.sample(p, u, lambda)?,
        };
        let sampled = pdf.0 > 0.0 && pdf.0.is_finite() && !li.is_black();
        sampled.then_some(LightSample {
            li,
            wi,
            end: LightEnd::Infinity,
            density: LightDensity::Continuous(pdf),
        })
    }

    /// What enters a sphere around the scene; of a portal, what goes through it.
    pub(super) fn power(&self, bounds: &Bounds3) -> f32 {
        let disk = PI * bounds.radius().powi(2);
        match self {
            Self::Constant(radiance) => 4.0 * PI * disk * radiance.photometric_luminance(),
            Self::Image(image) => disk * image.fluence(),
            Self::Portal(portal) => portal.power(),
        }
    }
}
