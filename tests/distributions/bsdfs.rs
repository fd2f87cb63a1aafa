//! BSDFs: samples against pdf by chi-squared; values against the pdf-free quadrature of the model; reciprocity.

use glam::{DVec3, Quat, Vec3};
use lucerna::material::Distribution::Ggx;
use lucerna::material::{Bsdf, Density, TransportMode};

use super::common::chi2::Chi2;
use super::common::effort;
use super::common::means::{FEWEST_RUNS, Means};
use super::common::microfacet::{dielectric_reflectance, direction};
use super::common::random::Random;
use super::first_two;
use super::kinds::{DIRECTIONS, KINDS, Kind};

const RADIANCE: TransportMode = TransportMode::Radiance;
const IMPORTANCE: TransportMode = TransportMode::Importance;
const MODES: [TransportMode; 2] = [RADIANCE, IMPORTANCE];

fn each_case() -> impl Iterator<Item = (Kind, DVec3, String)> {
    KINDS.into_iter().flat_map(|kind| {
        DIRECTIONS.into_iter().map(move |(theta, phi)| {
            let name = format!("{kind:?} from {theta}, {phi}");
            (kind, direction(theta, phi), name)
        })
    })
}

#[test]
fn samples_have_the_density_of_pdf() {
    for (kind, wo, name) in each_case() {
        let (bsdf, wo) = (kind.bsdf(), wo.as_vec3());
        let test = Chi2 {
            samples: 200_000 * effort(10),
            bins: [24, 24],
            ..Chi2::sphere().of(KINDS.len() * DIRECTIONS.len())
        };
        let report = test.run_directions(
            |u| {
                let sample = bsdf.sample_f(wo, u[2], first_two(u), RADIANCE)?;
                assert!((sample.wi.length() - 1.0).abs() < 1e-5, "{name}");
                Some(sample.wi)
            },
            |wi| bsdf.pdf(wo, wi, RADIANCE).0,
        );
        report.assert_ok(&name);
        if matches!(kind, Kind::Diffuse | Kind::OrenNayar(_) | Kind::Paper(..)) {
            assert!((report.mass - 1.0).abs() < 1e-4, "{name}: {}", report.mass);
        }
    }
}

/// A pdf that is off by 4 % on one side is noticed with the budget of the test above.
#[test]
fn a_wrong_density_is_noticed() {
    let (bsdf, wo) = (Kind::Glass(Ggx, 1.5, 0.5, 0.5).bsdf(), direction(35.0, 70.0).as_vec3());
    let test = Chi2 {
        samples: 200_000 * effort(10),
        bins: [24, 24],
        ..Chi2::sphere().of(KINDS.len() * DIRECTIONS.len())
    };
    let report = test.run_directions(
        |u| Some(bsdf.sample_f(wo, u[2], first_two(u), RADIANCE)?.wi),
        |wi| bsdf.pdf(wo, wi, RADIANCE).0 * if wi.z < 0.0 { 0.96 } else { 1.0 },
    );
    assert!(report.problem().is_some());
}

/// A sample's value and density are those that f and pdf give for its direction, in both modes.
#[test]
fn samples_agree_with_f_and_pdf() {
    let mut random = Random::new(3);
    for (kind, wo, name) in each_case() {
        let (bsdf, wo) = (kind.bsdf(), wo.as_vec3());
        for mode in MODES {
            for _ in 0..200 {
                let u = random.unit4();
                let Some(sample) = bsdf.sample_f(wo, u[2], first_two(u), mode) else {
                    continue;
                };
                let Density::Continuous(pdf) = sample.density else {
                    panic!("{name}: a delta sample of a rough surface");
                };
                let (f, expected) = (bsdf.f(wo, sample.wi, mode).0[0], sample.value.0[0]);
                // At a narrow peak, single precision loses digits of the half vector: by 1 / alpha².
                let close = |a: f32, b: f32| (a - b).abs() <= 5e-3 * b.max(1e-4);
                assert!(close(f, expected), "{name}, {mode:?}: f {f}, sampled {expected}");
                let again = bsdf.pdf(wo, sample.wi, mode).0;
                assert!(close(again, pdf.0), "{name}, {mode:?}: pdf {again}, sampled {}", pdf.0);
                assert!((bsdf.abs_cos(sample.wi) - sample.cos_theta).abs() < 1e-5, "{name}");
                let expected_eta = if sample.wi.z * wo.z > 0.0 {
                    1.0
                } else if wo.z > 0.0 {
                    kind.eta()
                } else {
                    1.0 / kind.eta()
                };
                assert_eq!(sample.eta, expected_eta, "{name}");
            }
        }
    }
}

/// The mean of f cos / pdf is the albedo of the model, without any of its Jacobians, and never above 1 for importance.
#[test]
fn weights_average_to_the_albedo_of_the_model() {
    let samples = 32_768 * effort(16);
    let means = Means {
        significance: 0.01 / (KINDS.len() * DIRECTIONS.len() * MODES.len()) as f64,
        slack: 1e-3,
    };
    for (kind, wo, name) in each_case() {
        let bsdf = kind.bsdf();
        for mode in MODES {
            let run = |seed: usize| {
                let mut random = Random::new(seed as u64);
                let weights = (0..samples).map(|_| {
                    let u = random.unit4();
                    let sample = bsdf.sample_f(wo.as_vec3(), u[2], first_two(u), mode);
                    sample.map_or(0.0, |s| f64::from(s.weight().0[0]))
                });
                vec![weights.sum::<f64>() / samples as f64]
            };
            let runs: Vec<_> = (1..=FEWEST_RUNS).map(run).collect();
            let albedo = kind.albedo(wo, mode);
            let name = format!("{name}, {mode:?}");
            let report = means.against_exact(&runs, &[albedo]);
            report.assert_agrees(&name);
            report.assert_power(&name, 0.03, 0.03);
            assert!(!means.against_exact(&runs, &[1.03 * albedo]).agrees(), "{name}");
            if mode == IMPORTANCE && kind.keeps_energy() {
                assert!(albedo <= 1.0 + 1e-4, "{name}: {albedo}");
            }
        }
    }
}

/// f(wo, wi) / n² is symmetric for radiance, where n is the index on the side of the first; importance is the other way round.
#[test]
fn scattering_is_reciprocal() {
    let mut random = Random::new(7);
    let mut compared = 0;
    for kind in KINDS {
        let bsdf = kind.bsdf();
        let index = |w: Vec3| if w.z < 0.0 { kind.eta() } else { 1.0 };
        for _ in 0..2000 {
            let [a, b] = [(); 2].map(|()| {
                let z = 2.0 * f64::from(random.unit()) - 1.0;
                direction(z.acos().to_degrees(), 360.0 * f64::from(random.unit())).as_vec3()
            });
            let forth = bsdf.f(a, b, RADIANCE).0[0] * index(b).powi(2);
            let back = bsdf.f(b, a, RADIANCE).0[0] * index(a).powi(2);
            // The half vector is off by some 1e-7, its slope over alpha of 0.1 by a hundred times that. Where a facet is met at a
            // flat angle on one side, the cosine on the other is a square root that loses its digits.
            let m = (a * index(a) + b * index(b)).normalize();
            let flattest = a.dot(m).abs().min(b.dot(m).abs());
            let tolerance = 1e-3 + 1e-6 / (flattest * flattest);
            let close = |x: f32, y: f32| (x - y).abs() <= tolerance * x.max(y) + 1e-9;
            assert!(close(forth, back), "{kind:?}, {a} and {b}: {forth} and {back}");
            let (radiance, adjoint) = (bsdf.f(a, b, RADIANCE).0[0], bsdf.f(b, a, IMPORTANCE).0[0]);
            assert!(
                close(radiance, adjoint),
                "{kind:?}, {a} and {b}: {radiance} and {adjoint}"
            );
            compared += usize::from(forth > 0.0);
        }
    }
    assert!(compared > 5000, "only {compared} pairs scatter");
}

/// A surface that is turned scatters as the upright one does, turned: the tangent is what the derivative leaves along the surface.
#[test]
fn scattering_turns_with_the_surface() {
    let turn = Quat::from_axis_angle(Vec3::new(2.0, -1.0, 2.0) / 3.0, 1.1);
    let mut random = Random::new(13);
    for (kind, wo, name) in each_case() {
        let upright = kind.bsdf();
        let turned = kind.bsdf_in(turn * Vec3::Z, turn * Vec3::new(3.0, 0.0, 0.7));
        let wo = wo.as_vec3();
        for _ in 0..50 {
            let u = random.unit4();
            let Some(sample) = upright.sample_f(wo, u[2], first_two(u), RADIANCE) else {
                continue;
            };
            // As in `samples_agree_with_f_and_pdf`.
            let close = |a: f32, b: f32| (a - b).abs() <= 5e-3 * a.max(b).max(1e-4);
            let values = |bsdf: &Bsdf, o: Vec3, i: Vec3| (bsdf.f(o, i, RADIANCE).0[0], bsdf.pdf(o, i, RADIANCE).0);
            let (f, pdf) = values(&upright, wo, sample.wi);
            let (f_turned, pdf_turned) = values(&turned, turn * wo, turn * sample.wi);
            assert!(close(f, f_turned), "{name}: {f} and {f_turned}");
            assert!(close(pdf, pdf_turned), "{name}: {pdf} and {pdf_turned}");
        }
    }
}

/// Delta lobes: their coefficients over their probabilities leave what Fresnel's equations say, and add up to 1.
#[test]
fn smooth_surfaces_keep_their_energy() {
    let mut random = Random::new(9);
    for (eta, (theta, phi)) in [1.5_f32, 0.75, 2.4]
        .into_iter()
        .flat_map(|e| DIRECTIONS.map(|d| (e, d)))
    {
        let bsdf = Kind::Glass(Ggx, eta, 0.0, 0.0).bsdf();
        assert!(bsdf.is_delta());
        let wo = direction(theta, phi).as_vec3();
        let across = f64::from(if wo.z > 0.0 { eta } else { 1.0 / eta });
        let reflectance = dielectric_reflectance(f64::from(wo.z.abs()), across);
        let (mut reflected, mut transmitted) = (None, None);
        for _ in 0..400 {
            let u = random.unit4();
            let sample = bsdf
                .sample_f(wo, u[2], first_two(u), IMPORTANCE)
                .expect("no light is lost");
            let Density::Delta(probability) = sample.density else {
                panic!("a smooth surface has delta lobes");
            };
            assert!((sample.weight().0[0] - 1.0).abs() < 1e-5);
            assert_eq!(bsdf.f(wo, sample.wi, RADIANCE).0[0], 0.0);
            assert_eq!(bsdf.pdf(wo, sample.wi, RADIANCE).0, 0.0);
            let seen = if sample.wi.z * wo.z > 0.0 {
                &mut reflected
            } else {
                // Snell's law.
                let sin = |w: Vec3| f64::from(w.truncate().length());
                assert!((sin(wo) - across * sin(sample.wi)).abs() < 1e-5);
                &mut transmitted
            };
            *seen = Some(f64::from(probability));
        }
        let name = format!("eta {eta} from {theta}");
        if reflectance > 0.02 {
            assert!(
                (reflected.expect("some are reflected") - reflectance).abs() < 1e-5,
                "{name}"
            );
        }
        if reflectance < 0.98 {
            assert!(
                (transmitted.expect("some are transmitted") - (1.0 - reflectance)).abs() < 1e-5,
                "{name}"
            );
        } else {
            assert!(reflectance < 1.0 || transmitted.is_none(), "{name}");
        }
    }
}
