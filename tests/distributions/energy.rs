//! What surfaces keep of light: white ones all of it, none more than there is. Lobes whose values are estimates by random walks:
//! their samples agree with their values, and the same directions give the same value.

use glam::{DVec3, Vec3};
use lucerna::material::Distribution::{self, Beckmann, Ggx};
use lucerna::material::{
    Body, Bsdf, Conductor, Dielectric, Diffuse, DiffuseTransmission, Interlayer, Layered, Lobe, Microfacets, OrenNayar,
    ThinDielectric, TransportMode,
};
use lucerna::math::Frame;
use lucerna::spectrum::SampledSpectrum;

use super::common::effort;
use super::common::means::{FEWEST_RUNS, Means};
use super::common::microfacet::direction;
use super::common::random::Random;
use super::first_two;
use super::kinds::{DIRECTIONS, KINDS, integral};

const MODE: TransportMode = TransportMode::Importance;

fn upright(lobe: Lobe<'static>) -> Bsdf<'static> {
    Bsdf::new(Frame::from_normal_tangent(Vec3::Z, Vec3::X), lobe)
}

/// A lobe, and one that draws directions with a density that is known, like its own.
struct White {
    name: String,
    lobe: Lobe<'static>,
    proposal: Lobe<'static>,
}

/// Facets of index 0 + i reflect everything.
fn mirror(facets: Option<Microfacets>) -> Conductor {
    Conductor::new(SampledSpectrum::ZERO, SampledSpectrum::ONE, facets)
}

fn white_metals(distribution: Distribution) -> impl Iterator<Item = White> {
    [(0.1, 0.1), (0.35, 0.35), (0.7, 0.7), (1.0, 1.0), (0.2, 0.8)]
        .into_iter()
        .map(move |(x, y)| {
            let lobe = mirror(Microfacets::new(distribution, x, y));
            White {
                name: format!("metal {distribution:?} {x} {y}"),
                lobe: Lobe::Conductor(lobe.with_multiple_scattering(true)),
                proposal: Lobe::Conductor(lobe),
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
            proposal: Lobe::Dielectric(lobe),
        }
    })
}

fn whites() -> Vec<White> {
    let white = SampledSpectrum::ONE;
    let mut all: Vec<White> = [0.0, 0.2, 0.6, 1.0]
        .into_iter()
        .map(|roughness| White {
            name: format!("grooves {roughness}"),
            lobe: Lobe::OrenNayar(OrenNayar::new(white, roughness)),
            proposal: Lobe::Diffuse(Diffuse::new(white)),
        })
        .collect();
    let paper = DiffuseTransmission::new(white * 0.3, white * 0.7);
    all.push(White {
        name: "paper".to_owned(),
        lobe: Lobe::DiffuseTransmission(paper),
        proposal: Lobe::DiffuseTransmission(paper),
    });
    for distribution in [Ggx, Beckmann] {
        all.extend(white_metals(distribution));
        all.extend(white_glasses(distribution));
    }
    all
}

/// The mean over `samples` of the weights of a BSDF's samples.
fn sampled(bsdf: &Bsdf<'_>, wo: DVec3, seed: usize, samples: usize) -> f64 {
    let mut random = Random::new(seed as u64);
    let weights = (0..samples).map(|_| {
        let u = random.unit4();
        let sample = bsdf.sample_f(wo.as_vec3(), u[2], first_two(u), MODE);
        sample.map_or(0.0, |s| f64::from(s.weight().0[0]))
    });
    weights.sum::<f64>() / samples as f64
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

/// Notices errors of `one` in one direction and of `all` in all of them. Compares what `share` of light is kept from each direction, in independently seeded runs, with all of it.
fn furnace(
    white: &White,
    tests: usize,
    (one, all): (f64, f64),
    share: impl Fn(&Bsdf<'_>, &Bsdf<'_>, DVec3, usize) -> f64,
) {
    let means = Means {
        significance: 0.01 / tests as f64,
        slack: 1e-4,
    };
    let (bsdf, proposal) = (upright(white.lobe), upright(white.proposal));
    let from = |seed, (theta, phi)| share(&bsdf, &proposal, direction(theta, phi), seed);
    let runs: Vec<Vec<f64>> = (1..=FEWEST_RUNS)
        .map(|seed| DIRECTIONS.map(|d| from(seed, d)).to_vec())
        .collect();
    let report = means.against_exact(&runs, &[1.0; DIRECTIONS.len()]);
    report.assert_agrees(&white.name);
    report.assert_power(&white.name, one, all);
}

/// White furnace, by samples: they carry all light, in every direction, whatever the roughness.
#[test]
fn samples_of_white_surfaces_keep_all_light() {
    let whites = whites();
    for white in &whites {
        furnace(white, whites.len(), (0.03, 0.01), |bsdf, _, wo, seed| {
            sampled(bsdf, wo, seed, 8192 * effort(8))
        });
    }
}

/// White furnace, by values: they integrate to 1.
#[test]
fn values_of_white_surfaces_integrate_to_one() {
    let whites = whites();
    for white in &whites {
        if upright(white.lobe).is_estimate() {
            furnace(white, whites.len(), (0.08, 0.025), |bsdf, proposal, wo, seed| {
                integrated(bsdf, proposal, wo, seed, 16_384 * effort(8))
            });
            continue;
        }
        for (theta, phi) in DIRECTIONS {
            let integral = integral(&upright(white.lobe), direction(theta, phi), MODE);
            assert!((integral - 1.0).abs() < 1e-3, "{} from {theta}: {integral}", white.name);
        }
    }
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
    for kind in KINDS {
        for (theta, phi) in DIRECTIONS {
            let albedo = kind.albedo(direction(theta, phi), MODE);
            assert!(albedo <= 1.003, "{kind:?} from {theta}: {albedo}");
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
