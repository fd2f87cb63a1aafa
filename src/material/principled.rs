//! A surface by the parameters of Burley (2012, 2015) as Mitsuba 3 names them: metal, plastic, glass, cloth and lacquer.
//!
//! The parameters are Burley's, the composition is made so that no energy is gained and directions can be exchanged: what lies
//! under a boundary gets what that does not reflect, by its directional albedo (Kulla and Conty 2017). All reflection is the same
//! from both sides; glass has an inside.

use std::f32::consts::{FRAC_1_PI, PI};
use std::sync::OnceLock;

use super::albedo::{AlbedoRow, ReflectionAlbedo};
use super::conductor::{half_vector, reflection_pdf, sample_reflection};
use super::{Dielectric, LocalSample, LocalValue, Microfacets, TransportMode, fresnel_dielectric};
use crate::math::{Vec2, Vec3};
use crate::sampling::warp;
use crate::spectrum::SampledSpectrum;

/// The index of refraction of lacquer, and how much of it a full coat counts for.
const LACQUER_ETA: f32 = 1.5;
const LACQUER_WEIGHT: f32 = 0.25;

/// The parameters at a point, all in [0, 1] but for `eta`; see [`PrincipledDesc`](crate::desc::PrincipledDesc).
#[derive(Clone, Copy, Debug)]
#[expect(missing_docs, reason = "see the description")]
pub struct PrincipledParameters {
    pub base: SampledSpectrum,
    pub roughness: f32,
    pub anisotropic: f32,
    pub metallic: f32,
    pub spec_trans: f32,
    pub eta: f32,
    pub spec_tint: f32,
    pub sheen: f32,
    pub sheen_tint: f32,
    pub clearcoat: f32,
    pub clearcoat_gloss: f32,
    pub flatness: f32,
}

/// What its eta determines, to be shared by all points of a surface.
#[derive(Clone, Debug)]
pub struct PrincipledTables {
    boundary: ReflectionAlbedo,
}

impl PrincipledTables {
    /// For an index of refraction of 1 or more.
    pub fn new(eta: f32) -> Self {
        Self {
            boundary: ReflectionAlbedo::new(eta),
        }
    }
}

/// The surface at a point.
#[derive(Clone, Copy, Debug)]
pub struct Principled<'a> {
    p: PrincipledParameters,
    facets: Microfacets,
    lacquer: Microfacets,
    glass: Dielectric,
    /// The hue of the base: its largest component is 1.
    hue: SampledSpectrum,
    boundary: AlbedoRow<'a>,
    /// The mean of what the boundary lets through.
    under: f32,
    coat: AlbedoRow<'a>,
}

/// The probabilities of sampling what lacquer reflects, what facets reflect, what is diffuse, and glass.
#[derive(Clone, Copy)]
struct Choice {
    lacquer: f32,
    facets: f32,
    diffuse: f32,
    glass: f32,
}

impl<'a> Principled<'a> {
    /// With parameters in their ranges, and the tables of their `eta`.
    pub fn new(p: PrincipledParameters, tables: &'a PrincipledTables) -> Self {
        let alpha = p.roughness * p.roughness;
        let aspect = (1.0 - 0.9 * p.anisotropic).sqrt();
        let facets = Microfacets::never_smooth((alpha / aspect).min(1.0), alpha * aspect);
        let lacquer_alpha = 0.1 * (1.0 - p.clearcoat_gloss) + 0.01 * p.clearcoat_gloss;
        let most = p.base.max_value();
        let [x, y] = facets.alpha();
        let (boundary, under) = tables.boundary.row((x * y).sqrt());
        Self {
            p,
            facets,
            lacquer: Microfacets::never_smooth(lacquer_alpha, lacquer_alpha),
            glass: Dielectric::new(p.eta.max(1.001), Some(facets)),
            hue: if most > 0.0 {
                p.base * (1.0 / most)
            } else {
                SampledSpectrum::ONE
            },
            boundary,
            under,
            coat: ReflectionAlbedo::of_lacquer().row(lacquer_alpha).0,
        }
    }

    /// See [`super::Bsdf::is_specular`]: metal or glass alone.
    pub fn is_specular(&self) -> bool {
        let (opaque, _) = self.shares();
        opaque == 0.0 && self.p.sheen == 0.0 && self.p.clearcoat == 0.0 && self.facets.is_specular()
    }

    /// The shares of opaque dielectric and of glass; the rest is metal.
    fn shares(&self) -> (f32, f32) {
        let dielectric = 1.0 - self.p.metallic;
        (dielectric * (1.0 - self.p.spec_trans), dielectric * self.p.spec_trans)
    }

    /// What lacquer reflects of light from a cosine.
    fn lacquer_albedo(&self, cos: f32) -> f32 {
        LACQUER_WEIGHT * self.p.clearcoat * self.coat.at(cos.abs())
    }

    fn choice(&self, wo: Vec3) -> Choice {
        let lacquer = self.lacquer_albedo(wo.z);
        let (opaque, glass) = self.shares();
        let boundary = self.boundary.at(wo.z.abs());
        let cloth = self.p.sheen * sheen_albedo(wo.z.abs());
        let metal = self.p.metallic * (0.1 + 0.9 * self.p.base.max_value());
        let facets = metal + opaque * boundary.max(0.02);
        let diffuse = opaque * (1.0 - boundary) * (self.p.base.max_value() + cloth).max(0.02);
        let scale = (1.0 - lacquer) / (facets + diffuse + glass);
        Choice {
            lacquer,
            facets: facets * scale,
            diffuse: diffuse * scale,
            glass: glass * scale,
        }
    }

    /// See [`Bsdf::eval`](super::Bsdf::eval).
    pub fn eval(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> Option<LocalValue> {
        let choice = self.choice(wo);
        let (_, glass_share) = self.shares();
        let mut under = SampledSpectrum::ZERO;
        let mut pdf = 0.0;
        if glass_share > 0.0
            && let Some(glass) = self.glass.eval(wo, wi, mode)
        {
            let tint = if wo.z * wi.z < 0.0 {
                self.p.base.sqrt()
            } else {
                SampledSpectrum::ONE
            };
            under += glass.f * tint * glass_share;
            pdf += choice.glass * glass.pdf;
        }
        let mut lacquer = 0.0;
        if let Some(m) = half_vector(wo, wi) {
            let cos = wo.dot(m).abs();
            let over_cosines = 1.0 / (4.0 * wo.z * wi.z).abs();
            under += self.reflectance(cos) * (self.facets.d(m) * self.facets.g(wo, wi) * over_cosines);
            under += self.diffuse(wo, wi, cos);
            pdf += choice.facets * reflection_pdf(&self.facets, wo, m) + choice.diffuse * wi.z.abs() * FRAC_1_PI;
            if choice.lacquer > 0.0 {
                let weight = LACQUER_WEIGHT * self.p.clearcoat * fresnel_dielectric(cos, LACQUER_ETA);
                lacquer = weight * self.lacquer.d(m) * self.lacquer.g(wo, wi) * over_cosines;
                pdf += choice.lacquer * reflection_pdf(&self.lacquer, wo, m);
            }
        }
        let passed = (1.0 - self.lacquer_albedo(wo.z)) * (1.0 - self.lacquer_albedo(wi.z));
        (pdf > 0.0).then(|| LocalValue {
            f: under * passed + SampledSpectrum::splat(lacquer),
            pdf,
        })
    }

    /// What a facet of metal or plastic reflects.
    fn reflectance(&self, cos: f32) -> SampledSpectrum {
        let (opaque, _) = self.shares();
        let schlick = (1.0 - cos).max(0.0).powi(5);
        let metal = self.p.base * (1.0 - schlick) + SampledSpectrum::splat(schlick);
        let tint = SampledSpectrum::ONE.lerp(self.hue, self.p.spec_tint);
        metal * self.p.metallic + tint * (opaque * fresnel_dielectric(cos, self.p.eta))
    }

    /// What is under the boundary of plastic: cloth over a Lambertian body.
    fn diffuse(&self, wo: Vec3, wi: Vec3, cos: f32) -> SampledSpectrum {
        let (opaque, _) = self.shares();
        if opaque == 0.0 {
            return SampledSpectrum::ZERO;
        }
        let (o, i) = (wo.z.abs(), wi.z.abs());
        let passed = (1.0 - self.boundary.at(o)) * (1.0 - self.boundary.at(i));
        let cloth =
            SampledSpectrum::ONE.lerp(self.hue, self.p.sheen_tint) * (self.p.sheen * (1.0 - cos).max(0.0).powi(5));
        let below = |cos| 1.0 - self.p.sheen * sheen_albedo(cos);
        let body = self.p.base * (FRAC_1_PI * below(o) * below(i) / self.under.max(1e-3));
        (cloth + body) * (opaque * passed)
    }

    /// See [`Bsdf::sample_f`](super::Bsdf::sample_f).
    pub fn sample_f(&self, wo: Vec3, u_lobe: f32, u: Vec2, mode: TransportMode) -> Option<LocalSample> {
        let choice = self.choice(wo);
        let mut rest = u_lobe - choice.lacquer;
        let mut eta = 1.0;
        let wi = if rest < 0.0 {
            sample_reflection(&self.lacquer, wo, u)?.1
        } else if rest < choice.facets {
            sample_reflection(&self.facets, wo, u)?.1
        } else {
            rest -= choice.facets;
            if rest < choice.diffuse || choice.glass == 0.0 {
                let wi = warp::sample_cosine_hemisphere(u);
                if wo.z < 0.0 { -wi } else { wi }
            } else {
                let u_glass = ((rest - choice.diffuse) / choice.glass).clamp(0.0, 1.0 - f32::EPSILON);
                let sample = self.glass.sample_f(wo, u_glass, u, mode)?;
                eta = sample.eta;
                sample.wi
            }
        };
        Some(LocalSample::continuous(self.eval(wo, wi, mode)?, wi, eta))
    }
}

/// What full sheen, (1 - cos)⁵ of the angle to the half vector, reflects of light from a cosine.
fn sheen_albedo(cos: f32) -> f32 {
    static TABLE: OnceLock<[f32; SHEEN_ENTRIES]> = OnceLock::new();
    let table = TABLE.get_or_init(|| std::array::from_fn(|i| sheen_reflected(i as f32 / (SHEEN_ENTRIES - 1) as f32)));
    let scaled = cos.clamp(0.0, 1.0) * (SHEEN_ENTRIES - 1) as f32;
    let i = (scaled as usize).min(SHEEN_ENTRIES - 2);
    let t = scaled - i as f32;
    table[i] * (1.0 - t) + table[i + 1] * t
}

const SHEEN_ENTRIES: usize = 64;

fn sheen_reflected(cos: f32) -> f32 {
    const STRATA: usize = 48;
    let wo = Vec3::new((1.0 - cos * cos).max(0.0).sqrt(), 0.0, cos);
    let terms = (0..STRATA * STRATA).map(|i| {
        let u = Vec2::new((i % STRATA) as f32 + 0.5, (i / STRATA) as f32 + 0.5) / STRATA as f32;
        let wi = warp::sample_cosine_hemisphere(u);
        let half = (0.5 * (1.0 + wo.dot(wi))).max(0.0).sqrt();
        PI * (1.0 - half).max(0.0).powi(5)
    });
    terms.sum::<f32>() / (STRATA * STRATA) as f32
}
