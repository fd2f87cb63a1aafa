//! Rough diffuse reflection: the energy-preserving form of Oren and Nayar's model (Portsmouth, Kutz, Hill 2024, "EON: A practical
//! energy-preserving rough diffuse BRDF").

use std::f32::consts::{FRAC_1_PI, PI};

use super::{LocalSample, LocalValue};
use crate::math::{Vec2, Vec3};
use crate::sampling::warp;
use crate::spectrum::SampledSpectrum;

/// A surface of white V-shaped grooves over which light is scattered any number of times. Reflects on whichever side the light is.
/// It is reciprocal, and of albedo 1 in every direction where its facets are white.
#[derive(Clone, Copy, Debug)]
pub struct OrenNayar {
    albedo: SampledSpectrum,
    roughness: f32,
    /// What single scattering leaves of the Lambertian part, "A_F".
    base: f32,
}

/// Of "A_F" and of the mean albedo of single scattering, in closed form.
const FACTOR: f32 = 0.5 - 2.0 / (3.0 * PI);
const MEAN_FACTOR: f32 = 2.0 / 3.0 - 28.0 / (15.0 * PI);

impl OrenNayar {
    /// With facets of an albedo in [0, 1] and a roughness in [0, 1]; 0 is Lambert's law.
    pub fn new(albedo: SampledSpectrum, roughness: f32) -> Self {
        Self {
            albedo,
            roughness,
            base: 1.0 / (1.0 + FACTOR * roughness),
        }
    }

    /// The share of light from `cos` that white facets scatter just once.
    fn single_albedo(&self, cos: f32) -> f32 {
        let sin = (1.0 - cos * cos).max(0.0).sqrt();
        // sin / cos (1 - sin³) without dividing by a small cosine: 1 - sin = cos² / (1 + sin).
        let grazing = sin * cos * (1.0 + sin + sin * sin) / (1.0 + sin);
        let g = sin * (cos.min(1.0).acos() - sin * cos) + 2.0 / 3.0 * (grazing - sin);
        self.base * (1.0 + self.roughness * FRAC_1_PI * g)
    }

    /// See [`Bsdf::eval`](super::Bsdf::eval).
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Option<LocalValue> {
        (wo.z * wi.z > 0.0).then(|| LocalValue {
            f: self.f(wo, wi),
            pdf: wi.z.abs() * FRAC_1_PI,
        })
    }

    fn f(&self, wo: Vec3, wi: Vec3) -> SampledSpectrum {
        let (cos_o, cos_i) = (wo.z.abs(), wi.z.abs());
        let s = wo.x * wi.x + wo.y * wi.y;
        let s_over_t = if s > 0.0 { s / cos_o.max(cos_i) } else { s };
        let single = FRAC_1_PI * self.base * (1.0 + self.roughness * s_over_t);
        let mean = self.base * (1.0 + MEAN_FACTOR * self.roughness);
        let lost = |cos| (1.0 - self.single_albedo(cos)).max(0.0);
        // At roughness 0 nothing is lost: the quotient's limit is 0, as the numerator is a square.
        let lost = lost(cos_o) * lost(cos_i) / (1.0 - mean).max(1e-7);
        let multiple = self.albedo.map(|a| a * mean / (1.0 - a * (1.0 - mean))) * (FRAC_1_PI * lost);
        self.albedo * (multiple + SampledSpectrum::splat(single))
    }

    /// See [`Bsdf::sample_f`](super::Bsdf::sample_f).
    pub fn sample_f(&self, wo: Vec3, u: Vec2) -> Option<LocalSample> {
        let wi = warp::sample_cosine_hemisphere(u);
        let wi = if wo.z < 0.0 { -wi } else { wi };
        Some(LocalSample::continuous(self.eval(wo, wi)?, wi, 1.0))
    }
}
