//! A body under a dielectric coat, with a scattering medium between them or none, as in pbrt-v4: light that enters the coat is
//! followed by a random walk until it leaves (Guo, Hašan, Zhao 2018, "Position-Free Monte Carlo Simulation for Arbitrary Layered
//! BSDFs").
//!
//! Values are estimates by walks whose numbers are a hash of the directions.

mod walk;

use std::f32::consts::FRAC_1_PI;

use super::argument_random::ArgumentRandom;
use super::{Conductor, Density, Dielectric, Diffuse, LocalSample, LocalValue, TransportMode, refract};
use crate::math::{Vec2, Vec3};
use crate::spectrum::SampledSpectrum;
use walk::{Flight, Walk};

/// What is under the coat.
#[derive(Clone, Copy, Debug)]
pub enum Body {
    /// Lambertian.
    Diffuse(Diffuse),
    /// A metal; its index is relative to the coat.
    Conductor(Conductor),
}

/// What lies between coat and body, and how it is estimated; pbrt-v4's parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interlayer {
    /// Distance in mean free paths, not negative: the medium has an extinction of 1.
    pub thickness: f32,
    /// The share of that which is scattered; in [0, 1].
    pub albedo: SampledSpectrum,
    /// Henyey and Greenstein's asymmetry, in (-1, 1).
    pub g: f32,
    /// Most events of a walk.
    pub max_depth: u32,
    /// Walks a value is the mean of, at least 1.
    pub samples: u32,
}

/// A coated body, the same from both sides.
#[derive(Clone, Copy, Debug)]
pub struct Layered {
    coat: Dielectric,
    body: Body,
    interlayer: Interlayer,
}

/// The share of densities that covers what the guess of single bounces misses.
const SPREAD: f32 = 0.1;

impl Body {
    fn is_delta(&self) -> bool {
        match self {
            Self::Diffuse(_) => false,
            Self::Conductor(metal) => metal.is_delta(),
        }
    }

    /// The reflectance of a mirror for a direction; `None` of anything else.
    fn mirror_reflectance(&self, w: Vec3) -> Option<SampledSpectrum> {
        match self {
            Self::Conductor(metal) if metal.is_delta() => Some(metal.fresnel(w.z.abs())),
            Self::Diffuse(_) | Self::Conductor(_) => None,
        }
    }

    fn eval(&self, wo: Vec3, wi: Vec3) -> Option<LocalValue> {
        match self {
            Self::Diffuse(lobe) => lobe.eval(wo, wi),
            Self::Conductor(lobe) => lobe.eval(wo, wi),
        }
    }

    fn sample_f(&self, wo: Vec3, u: Vec2) -> Option<LocalSample> {
        match self {
            Self::Diffuse(lobe) => lobe.sample_f(wo, u),
            Self::Conductor(lobe) => lobe.sample_f(wo, u),
        }
    }
}

impl Layered {
    /// A `body` under a `coat`.
    pub fn new(coat: Dielectric, body: Body, interlayer: Interlayer) -> Self {
        Self { coat, body, interlayer }
    }

    /// Whether it is a coated mirror.
    pub fn is_delta(&self) -> bool {
        self.coat.is_delta() && self.body.is_delta() && self.interlayer.albedo.is_black()
    }

    /// Whether light is reflected by a smooth coat.
    pub fn has_delta(&self) -> bool {
        self.coat.is_delta()
    }

    /// See [`Bsdf::eval`](super::Bsdf::eval).
    pub fn eval(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> Option<LocalValue> {
        if wo.z * wi.z <= 0.0 || self.is_delta() {
            return None;
        }
        let (wo, wi) = if wo.z < 0.0 { (-wo, -wi) } else { (wo, wi) };
        let mut random = ArgumentRandom::of_directions(wo, wi);
        let samples = self.interlayer.samples;
        let walks: SampledSpectrum = (0..samples).map(|_| self.estimate(wo, wi, mode, &mut random)).sum();
        let coat = self
            .coat
            .eval(wo, wi, mode)
            .map_or(SampledSpectrum::ZERO, |value| value.f);
        Some(LocalValue {
            f: coat + walks * (1.0 / samples as f32),
            pdf: self.density(wo, wi),
        })
    }

    /// See [`Bsdf::sample_f`](super::Bsdf::sample_f).
    pub fn sample_f(&self, wo: Vec3, u_lobe: f32, u: Vec2, mode: TransportMode) -> Option<LocalSample> {
        let flip = if wo.z < 0.0 { -1.0 } else { 1.0 };
        let wo = wo * flip;
        let entered = self.coat.sample_f(wo, u_lobe, u, mode)?;
        if entered.wi.z > 0.0 {
            return match entered.density {
                Density::Delta(_) => Some(LocalSample {
                    wi: entered.wi * flip,
                    ..entered
                }),
                Density::Continuous(_) => self.leaving(wo, entered.wi, entered.weight(), flip),
            };
        }
        let mut random = ArgumentRandom::of_sample(wo, u_lobe, u);
        let mut specular = matches!(entered.density, Density::Delta(_));
        let mut walk = Walk {
            z: self.interlayer.thickness,
            w: entered.wi,
            beta: entered.weight(),
        };
        for depth in 0..self.interlayer.max_depth {
            walk.survive(depth, &mut random)?;
            let next = match self.fly(&mut walk, &mut random)? {
                Flight::Medium => {
                    self.scatter_in_medium(&mut walk, &mut random);
                    specular = false;
                    continue;
                }
                Flight::Coat => self.coat.sample_f(-walk.w, random.unit(), random.pair(), mode)?,
                Flight::Body => self.body.sample_f(-walk.w, random.pair())?,
            };
            walk.beta *= next.weight();
            specular &= matches!(next.density, Density::Delta(_));
            if walk.w.z > 0.0 && next.wi.z > 0.0 {
                if specular {
                    return Some(LocalSample {
                        value: walk.beta,
                        wi: next.wi * flip,
                        density: Density::Delta(1.0),
                        eta: 1.0,
                    });
                }
                return self.leaving(wo, next.wi, walk.beta, flip);
            }
            walk.w = next.wi;
        }
        None
    }

    fn leaving(&self, wo: Vec3, wi: Vec3, weight: SampledSpectrum, flip: f32) -> Option<LocalSample> {
        LocalSample::weighted(weight, self.density(wo, wi), wi * flip, 1.0)
    }

    /// A density like that of samples, for directions above: what the coat reflects, what the body reflects once and a smooth coat
    /// refracts, and some everywhere.
    fn density(&self, wo: Vec3, wi: Vec3) -> f32 {
        let reflectance = self.coat.reflectance(wo.z);
        let coat = self.coat.reflection_pdf(wo, wi);
        let everywhere = wi.z * FRAC_1_PI;
        let eta = self.coat.eta();
        let below = match (refract(wo, Vec3::Z, eta), refract(wi, Vec3::Z, eta)) {
            _ if self.body.is_delta() => coat.unwrap_or(everywhere),
            (Some((o, _)), Some((i, _))) => {
                let pdf = self.body.eval(-o, -i).map_or(0.0, |value| value.pdf);
                pdf * wi.z / (eta * eta * i.z.abs())
            }
            _ => everywhere,
        };
        let guess = match coat {
            Some(coat) => reflectance * coat + (1.0 - reflectance) * below,
            None => below,
        };
        (1.0 - SPREAD) * guess + SPREAD * everywhere
    }
}
