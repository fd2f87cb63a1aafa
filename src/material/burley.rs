//! Mitsuba's `principled` as it is: the lobes of Burley (2012, 2015) added up, without regard to energy. [`Principled`](super::Principled)
//! has the same parameters and keeps to energy.
//!
//! Opaque surfaces are the same from both sides; glass has an inside, where there are facets only.

use std::f32::consts::{FRAC_1_PI, PI, TAU};

use super::conductor::reflect;
use super::{LocalSample, LocalValue, Microfacets, PrincipledParameters, TransportMode, fresnel_dielectric, refract};
use crate::math::{Vec2, Vec3};
use crate::sampling::warp;
use crate::spectrum::SampledSpectrum;

/// Slopes are not less.
const LEAST_ALPHA: f32 = 0.001;
/// What the clear coat counts for, and its reflectance head on; it is masked as facets of this slope are.
const COAT_WEIGHT: f32 = 0.25;
const COAT_REFLECTANCE: f32 = 0.04;
const COAT_MASKING: f32 = 0.25;

/// The surface at a point.
#[derive(Clone, Copy, Debug)]
pub struct Burley {
    p: PrincipledParameters,
    facets: Microfacets,
    coat_masking: Microfacets,
    /// The base over its luminance.
    hue: SampledSpectrum,
}

/// The probabilities of facets, of the clear coat, and of what is diffuse.
struct Choice {
    facets: f32,
    coat: f32,
    diffuse: f32,
}

impl Burley {
    /// With parameters in their ranges; `luminance` is that of the base.
    pub fn new(p: PrincipledParameters, luminance: f32) -> Self {
        let alpha = p.roughness * p.roughness;
        let aspect = (1.0 - 0.9 * p.anisotropic).sqrt();
        let facets = Microfacets::never_smooth((alpha / aspect).max(LEAST_ALPHA), (alpha * aspect).max(LEAST_ALPHA));
        let hue = if luminance > 0.0 {
            p.base * (1.0 / luminance)
        } else {
            SampledSpectrum::ONE
        };
        Self {
            p,
            facets: facets.with_separable_masking(true),
            coat_masking: Microfacets::never_smooth(COAT_MASKING, COAT_MASKING).with_separable_masking(true),
            hue,
        }
    }

    /// See [`super::Bsdf::is_specular`]: metal or glass alone.
    pub fn is_specular(&self) -> bool {
        self.opaque() == 0.0 && self.p.sheen == 0.0 && self.p.clearcoat == 0.0 && self.facets.is_specular()
    }

    /// See [`super::Bsdf::transmits`].
    pub fn transmits(&self) -> bool {
        self.glass() > 0.0
    }

    /// The shares of opaque dielectric and of glass; the rest is metal.
    fn opaque(&self) -> f32 {
        (1.0 - self.p.metallic) * (1.0 - self.p.spec_trans)
    }

    fn glass(&self) -> f32 {
        (1.0 - self.p.metallic) * self.p.spec_trans
    }

    /// Opaque surfaces are seen as from outside.
    fn oriented(&self, wo: Vec3, wi: Vec3) -> (Vec3, Vec3) {
        if wo.z < 0.0 && !self.transmits() {
            (-wo, -wi)
        } else {
            (wo, wi)
        }
    }

    fn choice(&self, wo: Vec3) -> Choice {
        if wo.z < 0.0 {
            return Choice {
                facets: 1.0,
                coat: 0.0,
                diffuse: 0.0,
            };
        }
        let (coat, diffuse) = (COAT_WEIGHT * self.p.clearcoat, self.opaque());
        let scale = 1.0 / (1.0 + coat + diffuse);
        Choice {
            facets: scale,
            coat: coat * scale,
            diffuse: diffuse * scale,
        }
    }

    /// The probability that a facet is refracted at, by its reflectance.
    fn refracted(&self, wo: Vec3, fresnel: f32) -> f32 {
        (1.0 - fresnel) * if wo.z > 0.0 { self.glass() } else { 1.0 }
    }

    /// See [`Bsdf::eval`](super::Bsdf::eval).
    pub fn eval(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> Option<LocalValue> {
        let (wo, wi) = self.oriented(wo, wi);
        let eta = if wo.z > 0.0 { self.p.eta } else { 1.0 / self.p.eta };
        let reflects = wo.z * wi.z > 0.0;
        if !reflects && !self.transmits() {
            return None;
        }
        let m = (wo + wi * if reflects { 1.0 } else { eta }).try_normalize()?;
        let m = if m.z < 0.0 { -m } else { m };
        let fresnel = fresnel_dielectric(wo.dot(m), self.p.eta);
        // Facets face both directions from where they are, or lie between them.
        let compatible = wo.dot(m) * wo.z > 0.0 && (wi.dot(m) * wo.z > 0.0) == reflects;
        let value = if reflects {
            self.reflection(wo, wi, m, fresnel, compatible)
        } else if compatible {
            self.refraction(wo, wi, m, fresnel, eta, mode)
        } else {
            return None;
        };
        (value.pdf > 0.0).then_some(value)
    }

    fn reflection(&self, wo: Vec3, wi: Vec3, m: Vec3, fresnel: f32, compatible: bool) -> LocalValue {
        let choice = self.choice(wo);
        let mut value = LocalValue {
            f: SampledSpectrum::ZERO,
            pdf: choice.diffuse * wi.z.abs() * FRAC_1_PI,
        };
        if compatible {
            let over_cosines = 1.0 / (4.0 * wo.z * wi.z);
            value.f = self.reflectance(wo, m, fresnel) * (self.facets.d(m) * self.facets.g(wo, wi) * over_cosines);
            let density = self.facets.visible_normal_pdf(wo, m) / (4.0 * wo.dot(m).abs());
            value.pdf += choice.facets * (1.0 - self.refracted(wo, fresnel)) * density;
        }
        if wo.z > 0.0 {
            value.f += self.diffuse(wo, wi, m);
            if compatible && choice.coat > 0.0 {
                let schlick = COAT_REFLECTANCE + (1.0 - COAT_REFLECTANCE) * schlick_weight(wo.dot(m));
                let d = coat_distribution(m.z, self.coat_alpha());
                let masking = self.coat_masking.g(wo, wi);
                value.f += SampledSpectrum::splat(COAT_WEIGHT * self.p.clearcoat * schlick * d * masking);
                value.pdf += choice.coat * d * m.z / (4.0 * wi.dot(m).abs());
            }
        }
        value
    }

    fn refraction(&self, wo: Vec3, wi: Vec3, m: Vec3, fresnel: f32, eta: f32, mode: TransportMode) -> LocalValue {
        let scale = match mode {
            TransportMode::Radiance => 1.0 / (eta * eta),
            TransportMode::Importance => 1.0,
        };
        let (cos_o, cos_i) = (wo.dot(m), wi.dot(m));
        let sum = cos_o + eta * cos_i;
        let jacobian = eta * eta * cos_i.abs() / (sum * sum);
        let facets = self.facets.d(m) * self.facets.g(wo, wi) * (cos_o / (wo.z * wi.z)).abs();
        let refracted = self.refracted(wo, fresnel);
        LocalValue {
            f: self.p.base.sqrt() * (self.glass() * scale * (1.0 - fresnel) * facets * jacobian),
            pdf: self.choice(wo).facets * refracted * self.facets.visible_normal_pdf(wo, m) * jacobian,
        }
    }

    /// What a facet reflects: of metal and of tinted dielectrics by Schlick's approximation.
    fn reflectance(&self, wo: Vec3, m: Vec3, fresnel: f32) -> SampledSpectrum {
        if wo.z < 0.0 {
            return SampledSpectrum::splat(self.glass() * fresnel);
        }
        let weight = schlick_weight(wo.dot(m));
        let schlick = |head_on: SampledSpectrum| head_on * (1.0 - weight) + SampledSpectrum::splat(weight);
        let dielectric = 1.0 - self.p.metallic;
        let head_on = ((self.p.eta - 1.0) / (self.p.eta + 1.0)).powi(2);
        schlick(self.p.base) * self.p.metallic
            + schlick(self.hue * head_on) * (dielectric * self.p.spec_tint)
            + SampledSpectrum::splat(dielectric * (1.0 - self.p.spec_tint) * fresnel)
    }

    /// What is diffuse, its retroreflection, and cloth.
    fn diffuse(&self, wo: Vec3, wi: Vec3, m: Vec3) -> SampledSpectrum {
        let (o, i) = (schlick_weight(wo.z), schlick_weight(wi.z));
        let cos_d = m.dot(wi);
        let retro = 2.0 * self.p.roughness * cos_d * cos_d;
        let lambert = (1.0 - 0.5 * o) * (1.0 - 0.5 * i);
        let rough = lambert + retro * (o + i + o * i * (retro - 1.0));
        let shape = rough + (self.flat(wo.z, wi.z, retro) - rough) * self.p.flatness;
        let cloth = SampledSpectrum::ONE.lerp(self.hue, self.p.sheen_tint);
        let sheen = if self.opaque() > 0.0 { self.p.sheen } else { 0.0 };
        self.p.base * (self.opaque() * FRAC_1_PI * shape)
            + cloth * (sheen * (1.0 - self.p.metallic) * schlick_weight(cos_d.abs()))
    }

    /// Like diffuse light that went some way under the surface (Hanrahan and Krueger 1993, nearly).
    fn flat(&self, cos_o: f32, cos_i: f32, retro: f32) -> f32 {
        let shadow = |cos: f32| 1.0 + (0.5 * retro - 1.0) * schlick_weight(cos);
        let under = shadow(cos_o) * shadow(cos_i);
        1.25 * (under * (1.0 / (cos_o.abs() + cos_i.abs()) - 0.5) + 0.5)
    }

    fn coat_alpha(&self) -> f32 {
        0.1 + (0.001 - 0.1) * self.p.clearcoat_gloss
    }

    /// See [`Bsdf::sample_f`](super::Bsdf::sample_f).
    pub fn sample_f(&self, wo: Vec3, u_lobe: f32, u: Vec2, mode: TransportMode) -> Option<LocalSample> {
        let turned = wo.z < 0.0 && !self.transmits();
        let wo = if turned { -wo } else { wo };
        let choice = self.choice(wo);
        let mut eta = 1.0;
        let wi = if u_lobe < choice.diffuse {
            warp::sample_cosine_hemisphere(u)
        } else if u_lobe < choice.diffuse + choice.coat {
            reflect(wo, sample_coat(u, self.coat_alpha()))
        } else {
            let rest = (u_lobe - choice.diffuse - choice.coat) / choice.facets;
            let m = self.facets.sample_visible_normal(wo, u);
            let refracted = self.refracted(wo, fresnel_dielectric(wo.dot(m), self.p.eta));
            if rest < refracted {
                let (wi, across) = refract(wo, m, self.p.eta)?;
                eta = across;
                wi
            } else {
                reflect(wo, m)
            }
        };
        // What was to be reflected stays above, what was to be refracted goes below.
        if wi.z == 0.0 || (wo.z * wi.z > 0.0) != (eta == 1.0) {
            return None;
        }
        let value = self.eval(wo, wi, mode)?;
        Some(LocalSample::continuous(value, if turned { -wi } else { wi }, eta))
    }
}

/// (1 - cos)⁵.
fn schlick_weight(cos: f32) -> f32 {
    (1.0 - cos).clamp(0.0, 1.0).powi(5)
}

/// Burley's distribution with exponent 1 (2012, appendix B), by the cosine of the normal.
fn coat_distribution(cos: f32, alpha: f32) -> f32 {
    let a2 = alpha * alpha;
    (a2 - 1.0) / (PI * a2.ln() * (1.0 + (a2 - 1.0) * cos * cos))
}

/// A normal by that distribution times its cosine.
fn sample_coat(u: Vec2, alpha: f32) -> Vec3 {
    let a2 = alpha * alpha;
    let cos2 = ((1.0 - a2.powf(1.0 - u.y)) / (1.0 - a2)).clamp(0.0, 1.0);
    let (sin_phi, cos_phi) = (TAU * u.x).sin_cos();
    let sin = (1.0 - cos2).sqrt();
    Vec3::new(cos_phi * sin, sin_phi * sin, cos2.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn burley(change: impl Fn(&mut PrincipledParameters)) -> Burley {
        let mut p = PrincipledParameters {
            base: SampledSpectrum([0.7, 0.4, 0.2, 0.5]),
            roughness: 0.5,
            anisotropic: 0.0,
            metallic: 0.0,
            spec_trans: 0.0,
            eta: 1.5,
            spec_tint: 0.0,
            sheen: 0.0,
            sheen_tint: 0.0,
            clearcoat: 0.0,
            clearcoat_gloss: 0.0,
            flatness: 0.0,
        };
        change(&mut p);
        Burley::new(p, 0.45)
    }

    /// The mean weight of samples is the integral of f cos over all directions, by a grid over the sphere.
    #[test]
    fn samples_agree_with_values() {
        let cases = [
            burley(|_| {}),
            burley(|p| p.metallic = 0.8),
            burley(|p| (p.clearcoat, p.clearcoat_gloss) = (1.0, 0.3)),
            burley(|p| (p.sheen, p.sheen_tint, p.spec_tint) = (1.0, 0.5, 0.7)),
            burley(|p| (p.spec_trans, p.anisotropic) = (0.7, 0.6)),
            burley(|p| p.flatness = 0.8),
        ];
        for (number, lobe) in cases.iter().enumerate() {
            for wo in [Vec3::new(0.6, 0.0, 0.8), Vec3::new(-0.5, 0.3, -0.812_404)] {
                let sides = 256;
                let at = |i: usize| (i as f32 + 0.5) / sides as f32;
                let mut weights = 0.0_f64;
                for i in 0..sides * sides {
                    let u = Vec2::new(at(i % sides), at(i / sides));
                    // A third number, even over the grid.
                    let u_lobe = (i as f32 * 0.618_034).fract();
                    if let Some(sample) = lobe.sample_f(wo, u_lobe, u, TransportMode::Importance) {
                        weights += f64::from(sample.weight().0[0]);
                    }
                }
                let (rows, columns) = (1024, 512);
                let mut integral = 0.0_f64;
                for row in 0..rows {
                    let z = 2.0 * (row as f32 + 0.5) / rows as f32 - 1.0;
                    let r = (1.0 - z * z).sqrt();
                    for column in 0..columns {
                        let (sin, cos) = (TAU * (column as f32 + 0.5) / columns as f32).sin_cos();
                        let value = lobe.eval(wo, Vec3::new(r * cos, r * sin, z), TransportMode::Importance);
                        integral += f64::from(value.map_or(0.0, |value| value.f.0[0] * z.abs()));
                    }
                }
                let found = weights / (sides * sides) as f64;
                let expected = integral * f64::from(2.0 * TAU) / f64::from(rows * columns);
                assert!(
                    (found / expected - 1.0).abs() < 0.02,
                    "{number}, {wo}: {found} and {expected}"
                );
            }
        }
    }
}
