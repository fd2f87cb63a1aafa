//! No surface gives back more light than came. Lobes whose values are estimates by random walks: their samples agree with their
//! values, and the same directions give the same value.

use glam::{DVec3, Vec3};
use lucerna::material::{
    Body, Bsdf, Conductor, Dielectric, Diffuse, Interlayer, Layered, Lobe, Microfacets, Plastic, PlasticParameters,
    PlasticTables, ThinDielectric, Tinted, TransportMode, Untinted,
};
use lucerna::math::Frame;
use lucerna::spectrum::SampledSpectrum;

use super::common::means::{FEWEST_RUNS, Means};
use super::common::microfacet::direction;
use super::common::random::Random;
use super::common::{effort, full_tier};
use super::first_two;
use super::furnace::whites;
use super::kinds::{DIRECTIONS, KINDS};

pub const MODE: TransportMode = TransportMode::Importance;

pub fn upright(lobe: Lobe<'static>) -> Bsdf<'static> {
    Bsdf::new(Frame::from_normal_tangent(Vec3::Z, Vec3::X), lobe)
}

/// Facets of index 0 + i reflect everything.
pub fn mirror(facets: Option<Microfacets>) -> Conductor {
    Conductor::new(SampledSpectrum::ZERO, SampledSpectrum::ONE, facets)
}

/// The integral of f |cos|, by samples of a proposal or, one in four, of the whole sphere.
fn integrated(bsdf: &Bsdf<'_>, proposal: &Bsdf<'_>, wo: DVec3, seed: usize, samples: usize) -> f64 {
    let mut random = Random::new(1000 + seed as u64);
    let wo = wo.as_vec3();
    let uniform = 1.0 / (4.0 * std::f32::consts::PI);
    let values = (0..samples).map(|_| {
        let u = random.unit4();
        let wi = if u[3] < 0.75 {
            match proposal.sample_f(wo, u[2], first_two(u), MODE) {
                Some(sample) => sample.wi,
                None => return 0.0,
            }
        } else {
            let z = 1.0 - 2.0 * f64::from(u[0]);
            direction(z.acos().to_degrees(), 360.0 * f64::from(u[1])).as_vec3()
        };
        let density = 0.75 * proposal.pdf(wo, wi, MODE).0 + 0.25 * uniform;
        f64::from(bsdf.f(wo, wi, MODE).0[0] * wi.z.abs() / density)
    });
    values.sum::<f64>() / samples as f64
}

fn layers() -> Vec<(String, Layered)> {
    let thin = Interlayer {
        thickness: 0.01,
        albedo: SampledSpectrum::ZERO,
        g: 0.0,
        max_depth: 100,
        samples: 1,
    };
    let thick = Interlayer {
        thickness: 0.5,
        albedo: SampledSpectrum::splat(0.9),
        g: 0.4,
        ..thin
    };
    let coat = |alpha| Dielectric::new(1.5, Microfacets::ggx(alpha, alpha));
    let white = Body::Diffuse(Diffuse::new(SampledSpectrum::ONE));
    let silver = |alpha| Body::Conductor(mirror(Microfacets::ggx(alpha, alpha)));
    let mut all = Vec::new();
    for (between, interlayer) in [("thin", thin), ("thick", thick)] {
        for alpha in [0.0, 0.3] {
            let name = format!("{between}, coat {alpha}");
            all.push((format!("{name} on white"), Layered::new(coat(alpha), white, interlayer)));
            all.push((
                format!("{name} on metal"),
                Layered::new(coat(alpha), silver(0.4), interlayer),
            ));
            all.push((
                format!("{name} on mirror"),
                Layered::new(coat(alpha), silver(0.0), interlayer),
            ));
        }
    }
    all
}

/// Layers: samples and values agree, and there is no more light than came.
#[test]
fn layers_agree_with_themselves_and_gain_no_energy() {
    let layers = layers();
    let tests = layers.len() * DIRECTIONS.len();
    let means = Means {
        significance: 0.01 / tests as f64,
        slack: 1e-3,
    };
    for (name, layered) in layers {
        let bsdf = upright(Lobe::Layered(layered));
        let proposal = upright(Lobe::Diffuse(Diffuse::new(SampledSpectrum::ONE)));
        for (theta, phi) in DIRECTIONS {
            let wo = direction(theta, phi);
            let name = format!("{name} from {theta}, {phi}");
            let samples = 4096 * effort(16);
            let runs: Vec<_> = (1..=FEWEST_RUNS)
                .map(|seed| vec![smooth_and_rough(&bsdf, wo, seed, samples)])
                .collect();
            let specular: Vec<_> = runs.iter().map(|run| run[0].0).collect();
            let rough: Vec<_> = runs.iter().map(|run| vec![run[0].1]).collect();
            let total: Vec<f64> = runs.iter().map(|run| run[0].0 + run[0].1).collect();
            let mean = total.iter().sum::<f64>() / total.len() as f64;
            assert!(mean < 1.005, "{name}: {mean}");
            assert!(mean > 0.2, "{name}: {mean}");
            if bsdf.is_delta() {
                assert!(specular.iter().all(|&s| s > 0.9), "{name}: {specular:?}");
                continue;
            }
            let integrals: Vec<_> = (1..=FEWEST_RUNS)
                .map(|seed| vec![integrated(&bsdf, &proposal, wo, seed, samples)])
                .collect();
            let report = means.against_runs(&rough, &integrals);
            report.assert_agrees(&name);
            let noticed = if full_tier() { 0.04 } else { 0.15 };
            report.assert_power(&name, noticed, noticed);
        }
    }
}

/// What samples carry in delta directions, and what in all others.
fn smooth_and_rough(bsdf: &Bsdf<'_>, wo: DVec3, seed: usize, samples: usize) -> (f64, f64) {
    let mut random = Random::new(seed as u64);
    let (mut smooth, mut rough) = (0.0, 0.0);
    for _ in 0..samples {
        let u = random.unit4();
        if let Some(sample) = bsdf.sample_f(wo.as_vec3(), u[2], first_two(u), MODE) {
            let weight = f64::from(sample.weight().0[0]);
            match sample.density {
                lucerna::material::Density::Delta(_) => smooth += weight,
                lucerna::material::Density::Continuous(pdf) => {
                    // The density is the one that is evaluated, for weights that agree.
                    let evaluated = bsdf.pdf(wo.as_vec3(), sample.wi, MODE).0;
                    assert!(
                        (evaluated - pdf.0).abs() <= 1e-2 * pdf.0.max(1e-3),
                        "{evaluated} and {}",
                        pdf.0
                    );
                    rough += weight;
                }
            }
        }
    }
    (smooth / samples as f64, rough / samples as f64)
}

/// An estimate is a function of its arguments.
#[test]
fn the_same_directions_give_the_same_value() {
    let mut random = Random::new(5);
    let mut lobes: Vec<(String, Lobe<'static>)> = whites().into_iter().map(|w| (w.name, w.lobe)).collect();
    lobes.extend(
        layers()
            .into_iter()
            .map(|(name, layered)| (name, Lobe::Layered(layered))),
    );
    for (name, lobe) in lobes {
        let bsdf = upright(lobe);
        for _ in 0..50 {
            let [wo, wi] = [(); 2].map(|()| {
                let z = 2.0 * f64::from(random.unit()) - 1.0;
                direction(z.acos().to_degrees(), 360.0 * f64::from(random.unit())).as_vec3()
            });
            let value = bsdf.eval(wo, wi, MODE);
            assert_eq!(value, bsdf.eval(wo, wi, MODE), "{name}");
            assert_eq!(
                bsdf.f(wo, wi, MODE),
                value.map_or(SampledSpectrum::ZERO, |v| v.f),
                "{name}"
            );
            let u = random.unit4();
            let draw = || bsdf.sample_f(wo, u[2], first_two(u), MODE).map(|s| (s.wi, s.value));
            assert_eq!(draw(), draw(), "{name}");
        }
    }
}

/// No kind reflects and transmits more than there is.
#[test]
fn nothing_gains_energy() {
    for kind in KINDS.into_iter().filter(|kind| kind.keeps_energy()) {
        for (theta, phi) in DIRECTIONS {
            let albedo = kind.albedo(direction(theta, phi), MODE);
            assert!(albedo <= 1.003, "{kind:?} from {theta}: {albedo}");
        }
    }
}

/// A white base under a smooth boundary loses nothing: neither what the boundary reflects, nor what comes out again.
#[test]
fn white_plastic_keeps_its_energy() {
    let tables: &'static PlasticTables = Box::leak(Box::new(PlasticTables::new(1.5, None)));
    let parameters = PlasticParameters {
        diffuse: SampledSpectrum::ONE,
        specular: SampledSpectrum::ONE,
        nonlinear: true,
    };
    let bsdf = upright(Lobe::Plastic(Plastic::new(parameters, tables)));
    let means = Means {
        significance: 0.01 / DIRECTIONS.len() as f64,
        slack: 1e-3,
    };
    for (theta, phi) in DIRECTIONS {
        let samples = 16_384 * effort(16);
        let run = |seed| {
            let (smooth, rough) = smooth_and_rough(&bsdf, direction(theta, phi), seed, samples);
            vec![smooth + rough]
        };
        let report = means.against_exact(&(1..=FEWEST_RUNS).map(run).collect::<Vec<_>>(), &[1.0]);
        report.assert_agrees(&format!("white plastic from {theta}"));
        report.assert_power(&format!("white plastic from {theta}"), 0.01, 0.01);
    }
}

/// Smooth lobes with factors: each times what the lobe alone reflects, or transmits.
#[test]
fn factors_of_smooth_lobes_are_those_of_what_they_send_on() {
    let splat = SampledSpectrum::splat;
    let glass = Dielectric::new(1.5, None);
    let sheet = ThinDielectric::new(splat(1.5));
    let pairs = [
        (Lobe::Conductor(mirror(None)), Untinted::Conductor(mirror(None))),
        (Lobe::Dielectric(glass), Untinted::Dielectric(glass)),
        (Lobe::ThinDielectric(sheet), Untinted::ThinDielectric(sheet)),
    ];
    let mut random = Random::new(11);
    for (plain, lobe) in pairs {
        let tinted = upright(Lobe::Tinted(Tinted::new(lobe, splat(0.25), splat(0.5))));
        let plain = upright(plain);
        assert!(tinted.is_delta());
        for _ in 0..200 {
            let u = random.unit4();
            let (theta, phi) = DIRECTIONS[(u[3] * DIRECTIONS.len() as f32) as usize];
            let wo = direction(theta, phi).as_vec3();
            let samples = [&plain, &tinted].map(|bsdf| bsdf.sample_f(wo, u[2], first_two(u), MODE));
            let [Some(plain), Some(tinted)] = samples else {
                panic!("smooth lobes send all on");
            };
            let factor = if plain.wi.z * wo.z > 0.0 { 0.25 } else { 0.5 };
            assert_eq!(tinted.value, plain.value * factor);
            assert_eq!(
                (tinted.wi, tinted.density, tinted.eta),
                (plain.wi, plain.density, plain.eta)
            );
        }
    }
}

/// A thin sheet: what is reflected and transmitted straight on is all, and both grow with the angle as one boundary's do.
#[test]
fn thin_sheets_keep_their_energy() {
    let eta = SampledSpectrum([1.5, 1.6, 1.3, 2.0]);
    let bsdf = upright(Lobe::ThinDielectric(ThinDielectric::new(eta)));
    assert!(bsdf.is_delta());
    for (theta, phi) in DIRECTIONS {
        let wo = direction(theta, phi).as_vec3();
        let reflected = bsdf
            .sample_f(wo, 0.0, glam::Vec2::ZERO, MODE)
            .expect("some is reflected");
        let transmitted = bsdf
            .sample_f(wo, 1.0 - f32::EPSILON, glam::Vec2::ZERO, MODE)
            .expect("some is transmitted");
        assert!((transmitted.wi + wo).length() < 1e-6);
        assert!((reflected.wi + wo - Vec3::Z * 2.0 * wo.z).length() < 1e-6);
        for i in 0..4 {
            assert!((reflected.value.0[i] + transmitted.value.0[i] - 1.0).abs() < 1e-6);
        }
        if theta == 0.0 {
            // R of one boundary is 0.04; of both with all bounces between 2 R / (1 + R).
            assert!((reflected.value.0[0] - 0.08 / 1.04).abs() < 1e-5);
        }
    }
}
