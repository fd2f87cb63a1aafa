//! What surfaces do to light: materials as a scene names them, and the BSDF that one gives at a point for some wavelengths.
//!
//! Each lobe is a file. Lobes work in the local frame of the shading normal, where the cosine to the normal is z.

mod bsdf;
mod conductor;
mod dielectric;
mod diffuse;
mod fresnel;
mod microfacet;
mod roughness;

pub use bsdf::{Bsdf, BsdfSample, BsdfValue, Density, LocalSample, LocalValue, TransportMode};
pub use conductor::Conductor;
pub use dielectric::Dielectric;
pub use diffuse::Diffuse;
pub use fresnel::{fresnel_complex, fresnel_dielectric, refract};
pub use microfacet::Ggx;
pub use roughness::Roughness;

use crate::geometry::SurfaceInteraction;
use crate::math::Frame;
use crate::spectrum::{CompiledSpectrum, SampledSpectrum, Wavelengths};
use crate::texture::SpectrumTexture;

use bsdf::Lobe;

/// The material of a surface.
#[derive(Clone, Debug)]
pub enum Material {
    /// Lambertian reflection on both sides.
    Diffuse {
        /// Albedo, in [0, 1].
        reflectance: SpectrumTexture,
    },
    /// A metal, smooth or rough, on both sides.
    Conductor {
        /// What it reflects.
        ior: ConductorIor,
        /// How rough it is.
        roughness: Roughness,
    },
    /// The boundary of a transparent body, smooth or rough.
    Dielectric {
        /// Index of refraction inside over that outside.
        eta: CompiledSpectrum,
        /// How rough it is.
        roughness: Roughness,
    },
}

/// How the complex index of refraction of a conductor is given.
#[derive(Clone, Debug)]
pub enum ConductorIor {
    /// n + i k.
    Measured {
        /// n.
        eta: SpectrumTexture,
        /// k.
        k: SpectrumTexture,
    },
    /// The reflectance at normal incidence, from which n = 1 and k follow, as in pbrt-v4.
    Reflectance(SpectrumTexture),
}

impl Material {
    /// The BSDF at a surface point. A material whose index of refraction varies with wavelength ends the secondary wavelengths.
    #[inline]
    pub fn bsdf(&self, si: &SurfaceInteraction, lambda: &mut Wavelengths) -> Bsdf {
        let (lobe, is_anisotropic) = self.lobe(si, lambda);
        let frame = if is_anisotropic {
            Frame::from_normal_tangent(si.ns, si.dpdu)
        } else {
            Frame::from_normal(si.ns)
        };
        Bsdf::new(frame, lobe)
    }

    /// The lobe, and whether it matters which way the tangent points.
    fn lobe(&self, si: &SurfaceInteraction, lambda: &mut Wavelengths) -> (Lobe, bool) {
        let is_anisotropic = |ggx: Option<Ggx>| ggx.is_some_and(|ggx| !ggx.is_isotropic());
        match self {
            Self::Diffuse { reflectance } => {
                let albedo = reflectance.reflectance_at(si, lambda);
                (Lobe::Diffuse(Diffuse::new(albedo)), false)
            }
            Self::Conductor { ior, roughness } => {
                let ((eta, k), ggx) = (ior.at(si, lambda), roughness.at(si));
                (Lobe::Conductor(Conductor::new(eta, k, ggx)), is_anisotropic(ggx))
            }
            Self::Dielectric { eta, roughness } => {
                if !eta.is_constant_over_wavelengths() {
                    lambda.terminate_secondary();
                }
                let ggx = roughness.at(si);
                (
                    Lobe::Dielectric(Dielectric::new(eta.sample(lambda).0[0], ggx)),
                    is_anisotropic(ggx),
                )
            }
        }
    }
}

impl ConductorIor {
    fn at(&self, si: &SurfaceInteraction, lambda: &Wavelengths) -> (SampledSpectrum, SampledSpectrum) {
        match self {
            Self::Measured { eta, k } => (eta.at(si, lambda), k.at(si, lambda)),
            Self::Reflectance(r) => {
                // With n = 1, R = k² / (4 + k²) at normal incidence.
                let r = r.at(si, lambda).map(|r| r.clamp(0.0, 0.9999));
                (SampledSpectrum::ONE, r.map(|r| 2.0 * (r / (1.0 - r)).sqrt()))
            }
        }
    }
}
