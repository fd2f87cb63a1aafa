//! Hair: a rough, tinted dielectric fibre with slanted scales, by Chiang et al. (2016), "A Practical and Controllable Hair and Fur Model for
//! Production Path Tracing", as in pbrt-v4.
//!
//! In the local frame x is along the fibre; directions have an angle theta to the plane across it, and in that plane an azimuth phi. Light is
//! reflected (p = 0, R), goes through (p = 1, TT), comes back out after a reflection inside (p = 2, TRT), or scatters on (the rest). Each way
//! has an attenuation A_p, and spreads by M_p along the fibre and N_p around it:
//!
//! ```text
//! f(wo, wi) |cos wi| = sum over p of A_p M_p(theta_o, theta_i) N_p(phi_i - phi_o).
//! ```
//!
//! All depends on where across the fibre it is hit by the path so far: at h in [-1, 1]. The model is not reciprocal.

mod lobes;

use std::f32::consts::{PI, TAU};

use self::lobes::{longitudinal, sample_longitudinal, sample_trimmed_logistic, trimmed_logistic};
use super::fresnel::fresnel_dielectric;
use super::{LocalSample, LocalValue};
use crate::geometry::SurfaceInteraction;
use crate::math::{Vec2, Vec3};
use crate::spectrum::{CompiledSpectrum, SampledSpectrum, Wavelengths};
use crate::texture::{FloatTexture, SpectrumTexture};

/// The ways of light that are told apart, and one for all others.
const WAYS: usize = 4;

/// A fibre at the wavelengths of a path.
#[derive(Clone, Copy, Debug)]
pub struct Hair {
    /// Where it is hit: the sine of the angle to the normal of a round fibre.
    h: f32,
    eta: f32,
    /// Absorption, for a fibre of radius 1.
    sigma_a: SampledSpectrum,
    /// Variance along the fibre, by way.
    variance: [f32; WAYS],
    /// Scale of the logistic distribution around it.
    scale: f32,
    /// Sine and cosine of the slant of scales times 1, 2 and 4.
    tilt: [[f32; 2]; 3],
}

/// What a [`Hair`] is made of.
#[derive(Clone, Copy, Debug)]
pub struct HairParameters {
    /// In [-1, 1]; see [`Hair`].
    pub h: f32,
    /// Index of refraction.
    pub eta: f32,
    /// Absorption over the radius of the fibre.
    pub sigma_a: SampledSpectrum,
    /// Roughness along the fibre, in [0, 1].
    pub beta_m: f32,
    /// Roughness around it, in [0, 1].
    pub beta_n: f32,
    /// Slant of the scales, in degrees.
    pub alpha: f32,
}

/// The least roughness.
const LEAST_BETA: f32 = 0.01;

/// The absorption of a fibre whose multiple scattering, with the roughness `beta_n`, has this reflectance (equation 9 of the paper).
pub fn absorption_of_reflectance(reflectance: SampledSpectrum, beta_n: f32) -> SampledSpectrum {
    let b = beta_n;
    let d = 5.969 + b * (-0.215 + b * (2.532 + b * (-10.73 + b * (5.574 + b * 0.245))));
    // Black would be an infinite one.
    reflectance.map(|c| (c.max(1e-4).ln() / d).powi(2))
}

impl Hair {
    /// From its parameters.
    pub fn new(parameters: &HairParameters) -> Self {
        let HairParameters { h, eta, sigma_a, .. } = *parameters;
        let [m, n] = [parameters.beta_m, parameters.beta_n].map(|beta| beta.clamp(LEAST_BETA, 1.0));
        let v = (0.726 * m + 0.812 * m * m + 3.7 * m.powi(20)).powi(2);
        // The root of pi / 8 takes a Gaussian's width to a logistic's.
        let scale = 0.626_657_07 * (0.265 * n + 1.194 * n * n + 5.372 * n.powi(22));
        let slant = parameters.alpha.to_radians();
        Self {
            h: h.clamp(-1.0, 1.0),
            eta,
            sigma_a,
            variance: [v, 0.25 * v, 4.0 * v, 4.0 * v],
            scale,
            tilt: [1.0, 2.0, 4.0].map(|k| {
                let (sin, cos) = (k * slant).sin_cos();
                [sin, cos]
            }),
        }
    }

    /// What `wo` finds out: its angles, the attenuations, and the angles of refraction around the fibre.
    fn view(&self, wo: Vec3) -> View {
        let (sin, cos) = (wo.x.clamp(-1.0, 1.0), Vec2::new(wo.y, wo.z).length());
        let cos_refracted = (1.0 - (sin / self.eta).powi(2)).max(0.0).sqrt();
        // The index that the projection to the plane across the fibre has (Bravais).
        let eta_across = (self.eta * self.eta - sin * sin).max(0.0).sqrt() / cos.max(1e-6);
        let sin_gamma = (self.h / eta_across).clamp(-1.0, 1.0);
        let cos_gamma = (1.0 - sin_gamma * sin_gamma).sqrt();
        let length = 2.0 * cos_gamma / cos_refracted.max(1e-6);
        let transmitted = self.sigma_a.map(|sigma| (-sigma * length).exp());
        View {
            sin,
            cos,
            phi: wo.z.atan2(wo.y),
            gamma: self.h.asin(),
            gamma_refracted: sin_gamma.asin(),
            attenuation: self.attenuation(cos, transmitted),
        }
    }

    /// A_p, where inside a ray keeps the share `t`.
    fn attenuation(&self, cos: f32, t: SampledSpectrum) -> [SampledSpectrum; WAYS] {
        let cos_normal = cos * (1.0 - self.h * self.h).max(0.0).sqrt();
        let f = fresnel_dielectric(cos_normal, self.eta);
        let through = t * (1.0 - f) * (1.0 - f);
        let back = through * t * f;
        // All that follows is a geometric series.
        let rest = back.0.iter().zip(t.0).map(|(&back, t)| {
            let share = t * f;
            if share < 1.0 { back * share / (1.0 - share) } else { 0.0 }
        });
        let mut others = SampledSpectrum::ZERO;
        for (other, value) in others.0.iter_mut().zip(rest) {
            *other = value;
        }
        [SampledSpectrum::splat(f), through, back, others]
    }

    /// Sine and cosine of theta_o as way `p` sees it between slanted scales.
    fn tilted(&self, p: usize, view: &View) -> [f32; 2] {
        let turn = |[sin, cos]: [f32; 2]| [view.sin * cos + view.cos * sin, view.cos * cos - view.sin * sin];
        let [one, two, four] = self.tilt;
        let [sin, cos] = match p {
            0 => turn([-two[0], two[1]]),
            1 => turn(one),
            2 => turn(four),
            _ => [view.sin, view.cos],
        };
        [sin, cos.abs()]
    }

    /// M_p N_p for a direction.
    fn spread(&self, p: usize, view: &View, wi: Vec3) -> f32 {
        let (sin, cos) = (wi.x.clamp(-1.0, 1.0), Vec2::new(wi.y, wi.z).length());
        let along = longitudinal([sin, cos], self.tilted(p, view), self.variance[p]);
        let around = if p + 1 == WAYS {
            1.0 / TAU
        } else {
            let phi = wi.z.atan2(wi.y) - view.phi;
            trimmed_logistic(within_half_turn(phi - view.deflection(p)), self.scale)
        };
        along * around
    }

    /// See [`Bsdf::eval`](super::Bsdf::eval).
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Option<LocalValue> {
        let view = self.view(wo);
        let probabilities = view.probabilities();
        let (mut f, mut pdf) = (SampledSpectrum::ZERO, 0.0);
        for (p, (&attenuation, probability)) in view.attenuation.iter().zip(probabilities).enumerate() {
            let spread = self.spread(p, &view, wi);
            f += attenuation * spread;
            pdf += probability * spread;
        }
        Some(LocalValue {
            f: f * (1.0 / wi.z.abs()),
            pdf,
        })
    }

    /// See [`Bsdf::sample_f`](super::Bsdf::sample_f).
    pub fn sample_f(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<LocalSample> {
        let view = self.view(wo);
        let (p, u_lobe) = choose(view.probabilities(), u_lobe);
        let [sin, cos] = sample_longitudinal(self.tilted(p, &view), self.variance[p], u);
        let around = if p + 1 == WAYS {
            TAU * u_lobe
        } else {
            view.deflection(p) + sample_trimmed_logistic(u_lobe, self.scale)
        };
        let (sin_phi, cos_phi) = (view.phi + around).sin_cos();
        let wi = Vec3::new(sin, cos * cos_phi, cos * sin_phi).normalize();
        Some(LocalSample::continuous(self.eval(wo, wi)?, wi, 1.0))
    }
}

/// What a direction finds out of a fibre.
struct View {
    /// Of theta.
    sin: f32,
    cos: f32,
    phi: f32,
    /// Angles between the ray in the plane across the fibre and the normal there, outside and inside.
    gamma: f32,
    gamma_refracted: f32,
    attenuation: [SampledSpectrum; WAYS],
}

impl View {
    /// By how much the azimuth changes on way `p` through a smooth fibre.
    fn deflection(&self, p: usize) -> f32 {
        2.0 * p as f32 * self.gamma_refracted - 2.0 * self.gamma + p as f32 * PI
    }

    /// With which probability a way is sampled.
    fn probabilities(&self) -> [f32; WAYS] {
        let means = self.attenuation.map(SampledSpectrum::mean);
        let sum: f32 = means.iter().sum();
        means.map(|mean| mean / sum)
    }
}

/// The way that a number chooses, and what is left of the number.
fn choose(probabilities: [f32; WAYS], u: f32) -> (usize, f32) {
    let mut left = u;
    for (p, probability) in probabilities.into_iter().enumerate() {
        if left < probability {
            return (p, (left / probability).min(crate::sampling::BELOW_ONE));
        }
        left -= probability;
    }
    (0, 0.5)
}

/// The same angle in [-pi, pi].
fn within_half_turn(angle: f32) -> f32 {
    let turned = (angle + PI).rem_euclid(TAU) - PI;
    turned.clamp(-PI, PI)
}

/// Hair as a scene has it. It is hit at 2 v - 1, where v is the second texture coordinate: across a curve.
#[derive(Clone, Debug)]
pub struct HairMaterial {
    /// What it absorbs.
    pub color: HairColor,
    /// Index of refraction.
    pub eta: f32,
    /// See [`HairParameters`].
    pub beta_m: FloatTexture,
    /// See [`HairParameters`].
    pub beta_n: FloatTexture,
    /// See [`HairParameters`].
    pub alpha: FloatTexture,
}

/// What hair absorbs.
#[derive(Clone, Debug)]
pub enum HairColor {
    /// So much over its radius.
    Absorption(SpectrumTexture),
    /// As much as makes many fibres look like this.
    Reflectance(SpectrumTexture),
    /// By its pigments: how much there is of each, and what a unit absorbs.
    Pigments([(FloatTexture, CompiledSpectrum); 2]),
}

impl HairMaterial {
    /// The lobe at a point.
    pub fn at(&self, si: &SurfaceInteraction, lambda: &Wavelengths) -> Hair {
        let beta_n = self.beta_n.at(si).clamp(LEAST_BETA, 1.0);
        let sigma_a = match &self.color {
            HairColor::Absorption(texture) => texture.at(si, lambda).map(|sigma| sigma.max(0.0)),
            HairColor::Reflectance(texture) => absorption_of_reflectance(texture.reflectance_at(si, lambda), beta_n),
            HairColor::Pigments(pigments) => {
                let mut sum = SampledSpectrum::ZERO;
                for (amount, absorption) in pigments {
                    sum += absorption.sample(lambda) * amount.at(si).max(0.0);
                }
                sum
            }
        };
        Hair::new(&HairParameters {
            h: 2.0 * si.uv.y - 1.0,
            eta: self.eta,
            sigma_a,
            beta_m: self.beta_m.at(si),
            beta_n,
            alpha: self.alpha.at(si),
        })
    }
}
