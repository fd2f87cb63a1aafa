//! The white furnace: what white surfaces keep of light is all of it, from every direction, whatever the roughness, by their
//! samples and by their values. And samples go where the values say.

use std::f32::consts::FRAC_1_PI;

use glam::{DVec3, Vec3};
use lucerna::material::Distribution::{self, Beckmann, Ggx};
use lucerna::material::{Bsdf, Conductor, Dielectric, Diffuse, DiffuseTransmission, Lobe, Microfacets, OrenNayar};
use lucerna::spectrum::SampledSpectrum;
use rayon::prelude::*;

use super::common::means::{Means, MeansReport};
use super::common::microfacet::{Shape, Slopes, dielectric_reflectance, direction};
use super::common::random::Random;
use super::common::{effort, full_tier};
use super::energy::{MODE, mirror, upright};
use super::first_two;
use super::kinds::{DIRECTIONS, integral};

/// A white surface.
pub struct White {
    pub name: String,
    pub lobe: Lobe<'static>,
    rough: Option<Rough>,
}

/// What light that meets one facet only does on a rough boundary with multiple scattering.
struct Rough {
    lobe: Lobe<'static>,
    slopes: Slopes,
    /// The index of the inside of glass; `None` for a mirror.
    eta: Option<f32>,
}

impl Rough {
    /// What it keeps of light from `wo`, by quadrature.
    fn albedo(&self, wo: DVec3) -> f64 {
        let up = DVec3::new(wo.x, wo.y, wo.z.abs());
        let Some(eta) = self.eta else {
            return self.slopes.reflected(up, |_| 1.0);
        };
        let eta = f64::from(if wo.z > 0.0 { eta } else { 1.0 / eta });
        let reflected = self.slopes.reflected(up, |cos| dielectric_reflectance(cos, eta));
        reflected + self.slopes.transmitted(up, eta)
    }
}

fn slopes(distribution: Distribution, x: f32, y: f32) -> Slopes {
    let shape = match distribution {
        Ggx => Shape::Ggx,
        Beckmann => Shape::Beckmann,
    };
    Slopes(x.into(), y.into(), shape)
}

fn white_metals(distribution: Distribution) -> impl Iterator<Item = White> {
    let cases = [(0.1, 0.1), (0.35, 0.35), (0.7, 0.7), (1.0, 1.0), (0.2, 0.8)];
    cases.into_iter().map(move |(x, y)| {
        let lobe: Conductor = mirror(Microfacets::new(distribution, x, y));
        White {
            name: format!("metal {distribution:?} {x} {y}"),
            lobe: Lobe::Conductor(lobe.with_multiple_scattering(true)),
            rough: Some(Rough {
                lobe: Lobe::Conductor(lobe),
                slopes: slopes(distribution, x, y),
                eta: None,
            }),
        }
    })
}

fn white_glasses(distribution: Distribution) -> impl Iterator<Item = White> {
    let cases = [
        (1.5, 0.1, 0.1),
        (1.5, 0.5, 0.5),
        (1.5, 1.0, 1.0),
        (0.7, 0.6, 0.6),
        (2.4, 0.3, 0.9),
    ];
    cases.into_iter().map(move |(eta, x, y)| {
        let lobe = Dielectric::new(eta, Microfacets::new(distribution, x, y));
        White {
            name: format!("glass {distribution:?} {eta} {x} {y}"),
            lobe: Lobe::Dielectric(lobe.with_multiple_scattering(true)),
            rough: Some(Rough {
                lobe: Lobe::Dielectric(lobe),
                slopes: slopes(distribution, x, y),
                eta: Some(eta),
            }),
        }
    })
}

/// Surfaces that keep all light.
pub fn whites() -> Vec<White> {
    let white = SampledSpectrum::ONE;
    let exact = |name: String, lobe| White {
        name,
        lobe,
        rough: None,
    };
    let mut all = vec![exact("diffuse".to_owned(), Lobe::Diffuse(Diffuse::new(white)))];
    all.extend([0.0, 0.2, 0.6, 1.0].map(|roughness| {
        let lobe = Lobe::OrenNayar(OrenNayar::new(white, roughness));
        exact(format!("grooves {roughness}"), lobe)
    }));
    let paper = DiffuseTransmission::new(white * 0.3, white * 0.7);
    all.push(exact("paper".to_owned(), Lobe::DiffuseTransmission(paper)));
    for distribution in [Ggx, Beckmann] {
        all.extend(white_metals(distribution));
        all.extend(white_glasses(distribution));
    }
    all
}

/// Independently seeded runs.
const RUNS: usize = 64;
/// Values of a run that say how many it takes, and then count no more: rare large ones must not decide when to stop.
fn pilot() -> usize {
    2048 * effort(8)
}
/// What a test notices over the standard deviation (see `Means`), with a quarter for what the pilot did not see.
const REACH: f64 = 7.0 * 1.25;

/// Estimates of what is kept from each direction.
struct Shares<'a> {
    estimate: &'a (dyn Fn(DVec3, &mut Random) -> f64 + Sync),
}

impl Shares<'_> {
    /// The means of `count` values, and of their squares, in each run for one direction.
    fn runs(&self, i: usize, count: usize, first_seed: usize) -> Vec<(f64, f64)> {
        let (theta, phi) = DIRECTIONS[i];
        let wo = direction(theta, phi);
        let run = |r: usize| {
            let mut random = Random::new((first_seed + r) as u64);
            let values = (0..count).map(|_| (self.estimate)(wo, &mut random));
            let (sum, squares) = values.fold((0.0, 0.0), |(sum, squares), v| (sum + v, squares + v * v));
            (sum / count as f64, squares / count as f64)
        };
        (0..RUNS).into_par_iter().map(run).collect()
    }

    /// Compares with 1, with `least` values or as many as it takes to notice an error of `one` in one direction.
    fn compare(&self, means: Means, one: f64, least: usize) -> MeansReport {
        let by_direction = (0..DIRECTIONS.len()).map(|i| {
            let pilot = self.runs(i, pilot(), 1);
            let mean_of = |of: fn(&(f64, f64)) -> f64| pilot.iter().map(of).sum::<f64>() / RUNS as f64;
            let variance = mean_of(|run| run.1) - mean_of(|run| run.0).powi(2);
            let count = variance * (REACH / (one - means.slack)).powi(2) / RUNS as f64;
            self.runs(i, least.div_ceil(RUNS).max(count as usize), 1 + RUNS)
        });
        let by_direction: Vec<_> = by_direction.collect();
        let run = |r: usize| by_direction.iter().map(|runs| runs[r].0).collect();
        means.against_exact(&(0..RUNS).map(run).collect::<Vec<_>>(), &[1.0; DIRECTIONS.len()])
    }
}

/// What is noticed: an error in one direction, and in the mean of all.
struct Power {
    one: f64,
    all: f64,
    /// Fewest values for a direction.
    least: usize,
}

impl Power {
    const ALL: Self = Self {
        one: 0.005,
        all: 0.005,
        least: 1 << 12,
    };

    /// That of values that are estimates. Facets that are nearly flat send light on rarely, but then much of it to few directions,
    /// of which a pilot sees too little; they are for the full tier.
    fn of_estimates(rough: &Rough) -> Option<Self> {
        let (is_nearly_flat, is_full) = (rough.slopes.0.max(rough.slopes.1) < 0.15, full_tier());
        let (one, all, least) = match (is_nearly_flat, is_full) {
            (false, false) => (0.015, 0.005, 1 << 15),
            (false, true) => (0.005, 0.0025, 1 << 15),
            (true, true) => (0.015, 0.005, 1 << 22),
            (true, false) => return None,
        };
        Some(Self { one, all, least })
    }
}

/// Compares what `white` keeps of light from each direction with all of it.
fn furnace(white: &White, tests: usize, power: &Power, kept: &(dyn Fn(DVec3, &mut Random) -> f64 + Sync)) {
    let means = Means {
        significance: 0.01 / tests as f64,
        // The quadratures of single scattering, and single precision.
        slack: 2e-4,
    };
    let report = Shares { estimate: kept }.compare(means, 0.8 * power.one, power.least);
    println!("{}: {report}", white.name);
    report.assert_agrees(&white.name);
    report.assert_power(&white.name, power.one, power.all);
}

/// By samples.
#[test]
fn samples_of_white_surfaces_keep_all_light() {
    let whites = whites();
    for white in &whites {
        let bsdf = upright(white.lobe);
        furnace(white, whites.len(), &Power::ALL, &|wo, random| {
            let u = random.unit4();
            let sample = bsdf.sample_f(wo.as_vec3(), u[2], first_two(u), MODE);
            sample.map_or(0.0, |s| f64::from(s.weight().0[0]))
        });
    }
}

/// By values: they integrate to 1. Where they are estimates the exact part, of one facet, is integrated by quadrature and the rest by
/// directions that are drawn from that part or in proportion to the cosine.
#[test]
fn values_of_white_surfaces_integrate_to_one() {
    let whites = whites();
    for white in &whites {
        let bsdf = upright(white.lobe);
        let Some(rough) = &white.rough else {
            for (theta, phi) in DIRECTIONS {
                let integral = integral(&bsdf, direction(theta, phi), MODE);
                assert!((integral - 1.0).abs() < 1e-3, "{} from {theta}: {integral}", white.name);
            }
            continue;
        };
        let Some(power) = Power::of_estimates(rough) else {
            continue;
        };
        let single = upright(rough.lobe);
        let albedos = DIRECTIONS.map(|(theta, phi)| rough.albedo(direction(theta, phi)));
        furnace(white, whites.len(), &power, &|wo, random| {
            let i = DIRECTIONS.iter().position(|&(theta, phi)| direction(theta, phi) == wo);
            albedos[i.expect("one of the directions")] + rest(&bsdf, &single, rough.eta.is_some(), wo.as_vec3(), random)
        });
    }
}

/// An estimate of the integral of the values of `bsdf` less those of `single`.
fn rest(bsdf: &Bsdf<'_>, single: &Bsdf<'_>, transmits: bool, wo: Vec3, random: &mut Random) -> f64 {
    drawn(single, transmits, wo, random).map_or(0.0, |(wi, density)| {
        let f = bsdf.f(wo, wi, MODE).0[0] - single.f(wo, wi, MODE).0[0];
        f64::from(f * wi.z.abs() / density)
    })
}

/// A direction from `single` or, as often, in proportion to the cosine, on both sides of what transmits; and its density.
fn drawn(single: &Bsdf<'_>, transmits: bool, wo: Vec3, random: &mut Random) -> Option<(Vec3, f32)> {
    let u = random.unit4();
    let wi = if u[3] < 0.5 {
        single.sample_f(wo, u[2], first_two(u), MODE)?.wi
    } else {
        let z = f64::from(u[0]).sqrt();
        let up = direction(z.acos().to_degrees(), 360.0 * f64::from(u[1])).as_vec3();
        let other = transmits && u[3] < 0.75;
        if (wo.z < 0.0) == other { up } else { -up }
    };
    let sides = if transmits { 2.0 } else { 1.0 };
    let cosine = wi.z.abs() * FRAC_1_PI / sides;
    let density = 0.5 * single.pdf(wo, wi, MODE).0 + 0.5 * cosine;
    (density > 0.0).then_some((wi, density))
}
