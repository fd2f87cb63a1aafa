//! A diffuse base under a dielectric boundary, smooth or rough, in closed form: Mitsuba's `plastic` and `roughplastic`.
//!
//! What enters is scattered by the base and reflected back inside any number of times (Saunderson and Wiegand 1942):
//! f = T(wo) T(wi) rho / (pi eta² (1 - rho F_i)), where F_i is what the boundary reflects of diffuse light from inside. With the
//! `nonlinear` flag off, the base's colour shifts no more than once: the rho in the denominator is 1.

use std::f32::consts::FRAC_1_PI;

use super::conductor::{half_vector, reflection_pdf, sample_reflection};
use super::{Density, LocalSample, LocalValue, Microfacets, fresnel_dielectric, refract};
use crate::geometry::SurfaceInteraction;
use crate::math::{Vec2, Vec3};
use crate::sampling::{SolidAnglePdf, warp};
use crate::spectrum::{SampledSpectrum, Wavelengths};
use crate::texture::SpectrumTexture;

/// The parameters at a point.
#[derive(Clone, Copy, Debug)]
pub struct PlasticParameters {
    /// Albedo of the base, in [0, 1].
    pub diffuse: SampledSpectrum,
    /// Factor of what the boundary reflects, in [0, 1].
    pub specular: SampledSpectrum,
    /// Whether light takes on more of the base's colour each time it comes to it.
    pub nonlinear: bool,
}

/// What a boundary does, to be shared by all points of a surface.
#[derive(Clone, Debug)]
pub struct PlasticTables {
    /// Index inside over that outside.
    eta: f32,
    facets: Option<Microfacets>,
    /// What is transmitted from outside, by cosine from 0 to 1; empty for a smooth boundary.
    transmittance: Vec<f32>,
    /// What is reflected of diffuse light from inside.
    internal: f32,
}

/// Entries of the table, and strata of its quadrature, each way.
const COSINES: usize = 64;
const STRATA: usize = 48;

impl PlasticTables {
    /// For an index `eta` (positive); smooth without `facets`.
    pub fn new(eta: f32, facets: Option<Microfacets>) -> Self {
        let cosine = |i: usize| i as f32 / (COSINES - 1) as f32;
        let Some(rough) = facets else {
            // Twice the integral of F cos, by the midpoint rule.
            let steps = 4096;
            let cos = |i: u32| (i as f32 + 0.5) / steps as f32;
            let sum: f32 = (0..steps).map(|i| fresnel_dielectric(cos(i), 1.0 / eta) * cos(i)).sum();
            return Self {
                eta,
                facets,
                transmittance: Vec::new(),
                internal: 2.0 * sum / steps as f32,
            };
        };
        // Not quite 0: there are no normals to be seen along a plane.
        let transmittance = (0..COSINES)
            .map(|i| transmitted(&rough, cosine(i).max(1e-6), eta))
            .collect();
        // As in Mitsuba the mean over the entries of the table, both ends included, for the integral: 1.6 % less.
        let internal = (0..COSINES).map(|i| {
            let cos = cosine(i).max(1e-6);
            2.0 * reflected(&rough, cos, 1.0 / eta) * cos
        });
        Self {
            eta,
            facets,
            transmittance,
            internal: internal.sum::<f32>() / COSINES as f32,
        }
    }

    /// What is transmitted from outside.
    fn transmittance(&self, cos: f32) -> f32 {
        if self.facets.is_none() {
            return 1.0 - fresnel_dielectric(cos, self.eta);
        }
        let at = cos.clamp(0.0, 1.0) * (COSINES - 1) as f32;
        let i = (at as usize).min(COSINES - 2);
        let t = at - i as f32;
        self.transmittance[i] * (1.0 - t) + self.transmittance[i + 1] * t
    }

    /// Whether the boundary is smooth.
    pub fn is_smooth(&self) -> bool {
        self.facets.is_none()
    }
}

/// The mean over visible normals of what `share` says of one.
fn over_normals(facets: &Microfacets, cos: f32, share: impl Fn(Vec3, Vec3) -> f32) -> f32 {
    let wo = Vec3::new((1.0 - cos * cos).max(0.0).sqrt(), 0.0, cos);
    let shares = (0..STRATA * STRATA).map(|i| {
        let u = Vec2::new((i % STRATA) as f32 + 0.5, (i / STRATA) as f32 + 0.5) / STRATA as f32;
        share(wo, facets.sample_visible_normal(wo, u))
    });
    shares.sum::<f32>() / (STRATA * STRATA) as f32
}

/// What a rough boundary of relative index `eta` reflects, to where it is not shadowed.
fn reflected(facets: &Microfacets, cos: f32, eta: f32) -> f32 {
    over_normals(facets, cos, |wo, m| {
        let wi = m * (2.0 * wo.dot(m)) - wo;
        if wi.z > 0.0 {
            fresnel_dielectric(wo.dot(m), eta) * facets.g1(wi)
        } else {
            0.0
        }
    })
}

/// What it transmits.
fn transmitted(facets: &Microfacets, cos: f32, eta: f32) -> f32 {
    over_normals(facets, cos, |wo, m| match refract(wo, m, eta) {
        Some((wi, _)) if wi.z < 0.0 => (1.0 - fresnel_dielectric(wo.dot(m), eta)) * facets.g1(wi),
        _ => 0.0,
    })
}

/// The surface at a point, the same from both sides.
#[derive(Clone, Copy, Debug)]
pub struct Plastic<'a> {
    p: PlasticParameters,
    tables: &'a PlasticTables,
    /// The base with all light that comes to it again: albedo over eta² (1 - F_i).
    base: SampledSpectrum,
}

impl<'a> Plastic<'a> {
    /// With the tables of its boundary.
    pub fn new(p: PlasticParameters, tables: &'a PlasticTables) -> Self {
        let over_eta2 = 1.0 / (tables.eta * tables.eta);
        let base = p.diffuse.map(|rho| {
            let again = if p.nonlinear {
                rho * tables.internal
            } else {
                tables.internal
            };
            rho * over_eta2 / (1.0 - again)
        });
        Self { p, tables, base }
    }

    /// See [`super::Bsdf::has_delta`].
    pub fn has_delta(&self) -> bool {
        self.tables.is_smooth()
    }

    /// The probability of sampling what the boundary reflects.
    fn specular_probability(&self, wo: Vec3) -> f32 {
        let transmitted = self.tables.transmittance(wo.z.abs());
        let specular = (1.0 - transmitted) * self.p.specular.mean();
        let diffuse = transmitted * self.p.diffuse.mean();
        if specular + diffuse > 0.0 {
            specular / (specular + diffuse)
        } else {
            0.0
        }
    }

    /// See [`Bsdf::eval`](super::Bsdf::eval).
    pub fn eval(&self, wo: Vec3, wi: Vec3) -> Option<LocalValue> {
        if wo.z * wi.z <= 0.0 {
            return None;
        }
        let specular = self.specular_probability(wo);
        let passed = self.tables.transmittance(wo.z.abs()) * self.tables.transmittance(wi.z.abs());
        let mut value = LocalValue {
            f: self.base * (passed * FRAC_1_PI),
            pdf: (1.0 - specular) * wi.z.abs() * FRAC_1_PI,
        };
        if let Some(facets) = &self.tables.facets
            && let Some(m) = half_vector(wo, wi)
        {
            let fresnel = fresnel_dielectric(wo.dot(m).abs(), self.tables.eta);
            let over_cosines = 1.0 / (4.0 * wo.z * wi.z);
            value.f += self.p.specular * (fresnel * facets.d(m) * facets.g(wo, wi) * over_cosines);
            value.pdf += specular * reflection_pdf(facets, wo, m);
        }
        Some(value)
    }

    /// See [`Bsdf::sample_f`](super::Bsdf::sample_f).
    pub fn sample_f(&self, wo: Vec3, u_lobe: f32, u: Vec2) -> Option<LocalSample> {
        let specular = self.specular_probability(wo);
        if u_lobe < specular {
            let Some(facets) = &self.tables.facets else {
                return Some(LocalSample {
                    value: self.p.specular * fresnel_dielectric(wo.z.abs(), self.tables.eta),
                    wi: Vec3::new(-wo.x, -wo.y, wo.z),
                    density: Density::Delta(specular),
                    eta: 1.0,
                });
            };
            let wi = sample_reflection(facets, wo, u)?.1;
            return Some(LocalSample::continuous(self.eval(wo, wi)?, wi, 1.0));
        }
        let mut wi = warp::sample_cosine_hemisphere(u);
        if wo.z < 0.0 {
            wi.z = -wi.z;
        }
        let value = self.eval(wo, wi)?;
        Some(LocalSample {
            value: value.f,
            wi,
            density: Density::Continuous(SolidAnglePdf(value.pdf)),
            eta: 1.0,
        })
    }
}

/// The textures of [`PlasticParameters`].
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "see there")]
pub struct PlasticMaterial {
    pub diffuse: SpectrumTexture,
    pub specular: SpectrumTexture,
    pub nonlinear: bool,
    pub tables: PlasticTables,
}

impl PlasticMaterial {
    /// The lobe at a point.
    pub(super) fn at(&self, si: &SurfaceInteraction, lambda: &Wavelengths) -> Plastic<'_> {
        let p = PlasticParameters {
            diffuse: self.diffuse.reflectance_at(si, lambda),
            specular: self.specular.reflectance_at(si, lambda),
            nonlinear: self.nonlinear,
        };
        Plastic::new(p, &self.tables)
    }
}

#[cfg(test)]
mod tests {
    use std::f32::consts::TAU;

    use super::super::Distribution;
    use super::*;

    /// What is reflected of light from a cosine, by quadrature over the hemisphere, delta lobe included.
    fn albedo(plastic: &Plastic<'_>, cos: f32) -> f32 {
        let wo = Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
        let (rows, columns) = (400, 200);
        let mut sum = 0.0_f64;
        for i in 0..rows {
            for j in 0..columns {
                let z = (i as f32 + 0.5) / rows as f32;
                let (sin, cos) = (TAU * (j as f32 + 0.5) / columns as f32).sin_cos();
                let r = (1.0 - z * z).sqrt();
                let value = plastic.eval(wo, Vec3::new(r * cos, r * sin, z));
                sum += f64::from(value.map_or(0.0, |value| value.f.0[0]) * z);
            }
        }
        let mean = (sum / f64::from(rows * columns)) as f32 * TAU;
        let delta = if plastic.has_delta() {
            fresnel_dielectric(cos, plastic.tables.eta)
        } else {
            0.0
        };
        mean + delta
    }

    fn plastic(tables: &PlasticTables, diffuse: f32, nonlinear: bool) -> Plastic<'_> {
        let p = PlasticParameters {
            diffuse: SampledSpectrum::splat(diffuse),
            specular: SampledSpectrum::ONE,
            nonlinear,
        };
        Plastic::new(p, tables)
    }

    /// A white base under a smooth boundary returns all light: (1 - F) (1 - F_e) / (eta² (1 - F_i)) = 1 - F, as eta² (1 - F_i) is
    /// 1 - F_e.
    #[test]
    fn a_white_base_loses_nothing() {
        let tables = PlasticTables::new(1.5, None);
        for cos in [0.1, 0.5, 0.9] {
            let found = albedo(&plastic(&tables, 1.0, true), cos);
            assert!((found - 1.0).abs() < 2e-3, "{cos}: {found}");
        }
    }

    #[test]
    fn nonlinear_bases_are_darker() {
        let tables = PlasticTables::new(1.5, None);
        let [linear, nonlinear] = [false, true].map(|flag| albedo(&plastic(&tables, 0.5, flag), 0.7));
        assert!(nonlinear < linear - 0.05, "{nonlinear} and {linear}");
    }

    #[test]
    fn a_nearly_smooth_boundary_is_like_a_smooth_one() {
        let facets = Microfacets::new(Distribution::Ggx, 0.01, 0.01);
        let (smooth, rough) = (PlasticTables::new(1.49, None), PlasticTables::new(1.49, facets));
        let ratio = rough.internal / smooth.internal;
        assert!((0.975..0.995).contains(&ratio), "{ratio}");
        for cos in [0.2, 0.6, 1.0] {
            let (a, b) = (smooth.transmittance(cos), rough.transmittance(cos));
            assert!((a - b).abs() < 5e-3, "{cos}: {a} and {b}");
        }
    }

    #[test]
    fn plastic_is_reciprocal() {
        let facets = Microfacets::new(Distribution::Beckmann, 0.3, 0.3).map(|f| f.with_separable_masking(true));
        let tables = PlasticTables::new(1.49, facets);
        let plastic = plastic(&tables, 0.4, false);
        let (a, b) = (Vec3::new(0.6, 0.0, 0.8), Vec3::new(-0.3, 0.4, 0.866_025_4));
        let (there, back) = (plastic.eval(a, b).unwrap().f.0[0], plastic.eval(b, a).unwrap().f.0[0]);
        assert!((there - back).abs() < 1e-6 * there);
    }
}
