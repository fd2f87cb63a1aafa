//! Measured materials: a file written from an analytic metal gives that metal back.

use glam::Vec3;
use lucerna::desc::{MeasuredDesc, rgl};
use lucerna::material::{Bsdf, Density, Lobe, Measured, MeasuredTables, Microfacets, TransportMode};
use lucerna::math::Frame;
use lucerna::spectrum::{ColorMode, Wavelengths};

use super::common::chi2::Chi2;
use super::common::effort;
use super::common::means::{FEWEST_RUNS, Means};
use super::common::microfacet::direction;
use super::common::random::Random;
use super::first_two;
use super::kinds::{DIRECTIONS, integral};

const MODE: TransportMode = TransportMode::Radiance;
const FILE: &[u8] = include_bytes!("../../scenes/parts/measured-ggx.bsdf");

fn desc() -> MeasuredDesc {
    rgl::parse(FILE).expect("a measured material")
}

fn bsdf(tables: &MeasuredTables) -> Bsdf<'_> {
    // Lanes at 500, 550, 600 and 360 nm.
    let lambda = Wavelengths {
        lambda: [500.0, 550.0, 600.0, 360.0],
        pdf: [1.0; 4],
    };
    let frame = Frame::from_normal_tangent(Vec3::Z, Vec3::X);
    Bsdf::new(frame, Lobe::Measured(Measured::new(tables, &lambda)))
}

/// The metal that the file was written from, with what tools/make_measured_ggx.py says.
fn analytic(wo: Vec3, wi: Vec3, head_on: f32) -> f32 {
    let facets = Microfacets::ggx(0.4, 0.4).expect("rough");
    let m = (wo + wi).normalize();
    let fresnel = head_on + (1.0 - head_on) * (1.0 - wo.dot(m)).powi(5);
    fresnel * facets.d(m) * facets.g(wo, wi) / (4.0 * wo.z * wi.z)
}

#[test]
fn values_are_those_of_the_metal() {
    let desc = desc();
    let tables = MeasuredTables::new(&desc, ColorMode::Spectral);
    let bsdf = bsdf(&tables);
    for (theta_o, phi_o) in [(20.0, 30.0), (45.0, -100.0), (60.0, 170.0), (5.0, 0.0)] {
        for (theta_i, turn) in [(30.0, 180.0), (30.0, 120.0), (10.0, 20.0), (60.0, 180.0), (70.0, 150.0)] {
            let (wo, wi) = (
                direction(theta_o, phi_o).as_vec3(),
                direction(theta_i, phi_o + turn).as_vec3(),
            );
            let f = bsdf.f(wo, wi, MODE);
            for (lane, head_on) in [(0, 0.4), (1, 0.65), (2, 0.9), (3, 0.3)] {
                let expected = analytic(wo, wi, head_on);
                let error = f.0[lane] / expected - 1.0;
                // What a grid of 20 x 20 and angles some 10 degrees apart leave out.
                assert!(
                    error.abs() < 0.02,
                    "{theta_o} to {theta_i}, {turn}, lane {lane}: {error}"
                );
            }
            let below = bsdf.f(-wo, -wi, MODE);
            assert!((below.0[0] - f.0[0]).abs() <= 1e-4 * f.0[0], "the same from below");
        }
    }
}

#[test]
fn samples_have_the_density_of_pdf_and_the_value_of_f() {
    let desc = desc();
    let tables = MeasuredTables::new(&desc, ColorMode::Spectral);
    let bsdf = bsdf(&tables);
    let mut random = Random::new(2);
    for (theta, phi) in DIRECTIONS {
        let wo = direction(theta, phi).as_vec3();
        let test = Chi2 {
            samples: 100_000 * effort(10),
            bins: [24, 24],
            ..Chi2::sphere().of(DIRECTIONS.len())
        };
        let report = test.run_directions(
            |u| Some(bsdf.sample_f(wo, u[2], first_two(u), MODE)?.wi),
            |wi| bsdf.pdf(wo, wi, MODE).0,
        );
        report.assert_ok(&format!("from {theta}"));
        for _ in 0..200 {
            let u = random.unit4();
            let Some(sample) = bsdf.sample_f(wo, u[2], first_two(u), MODE) else {
                continue;
            };
            let Density::Continuous(pdf) = sample.density else {
                panic!("a delta sample of a rough surface");
            };
            let value = bsdf.eval(wo, sample.wi, MODE).expect("a value for a sample");
            let close = |a: f32, b: f32| (a - b).abs() <= 1e-2 * b.max(1e-2);
            assert!(close(value.f.0[0], sample.value.0[0]), "from {theta}");
            assert!(close(value.pdf.0, pdf.0), "from {theta}: {} and {}", value.pdf.0, pdf.0);
        }
    }
}

#[test]
fn weights_average_to_the_integral_which_is_below_one() {
    let desc = desc();
    let tables = MeasuredTables::new(&desc, ColorMode::Spectral);
    let bsdf = bsdf(&tables);
    let means = Means {
        significance: 0.01 / DIRECTIONS.len() as f64,
        slack: 2e-3,
    };
    for (theta, phi) in DIRECTIONS {
        let wo = direction(theta, phi);
        let run = |seed: usize| {
            let mut random = Random::new(seed as u64);
            let weights = (0..4096).map(|_| {
                let u = random.unit4();
                let sample = bsdf.sample_f(wo.as_vec3(), u[2], first_two(u), MODE);
                sample.map_or(0.0, |s| f64::from(s.weight().0[0]))
            });
            vec![weights.sum::<f64>() / 4096.0]
        };
        let runs: Vec<_> = (1..=FEWEST_RUNS).map(run).collect();
        let expected = integral(&bsdf, wo, MODE);
        assert!(expected < 1.0, "from {theta}: {expected}");
        let report = means.against_exact(&runs, &[expected]);
        report.assert_agrees(&format!("from {theta}"));
        report.assert_power(&format!("from {theta}"), 0.03, 0.03);
    }
}

/// In rgb mode the lanes are the channels under the film's white: a metal that reflects long waves is red.
#[test]
fn rgb_lanes_are_channels() {
    let tables = MeasuredTables::new(&desc(), ColorMode::Rgb);
    let measured = Measured::new(&tables, &Wavelengths::rgb());
    let bsdf = Bsdf::new(Frame::from_normal(Vec3::Z), Lobe::Measured(measured));
    let f = bsdf
        .f(direction(30.0, 0.0).as_vec3(), direction(30.0, 180.0).as_vec3(), MODE)
        .0;
    assert!(f[0] > 1.2 * f[1] && f[1] > f[2] && f[2] > 0.0 && f[3] == 0.0, "{f:?}");
}

/// Whatever is wrong with a file is an error: no panic, no table that does not fit.
#[test]
fn broken_files_are_refused() {
    for length in (0..FILE.len()).step_by(997).chain([FILE.len() - 1]) {
        assert!(rgl::parse(&FILE[..length]).is_err(), "{length} bytes");
    }
    let mut other = FILE.to_vec();
    other[0] = b'T';
    assert!(rgl::parse(&other).is_err_and(|e| e.contains("no tensor file")));
    let mut random = Random::new(8);
    for _ in 0..2000 {
        let mut bytes = FILE.to_vec();
        for _ in 0..3 {
            // Mostly in the header, where the shapes are.
            let at = random.bits() as usize % 500;
            bytes[at] = random.bits() as u8;
        }
        // Any answer will do.
        let _ = rgl::parse(&bytes);
    }
}
