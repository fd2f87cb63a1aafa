//! Hair: samples against its density, energy without absorption, and where light goes through a smooth fibre.

use std::f64::consts::PI;

use glam::{DVec2, Vec3};
use lucerna::material::{Bsdf, Density, Hair, HairParameters, Lobe, TransportMode, absorption_of_reflectance};
use lucerna::math::Frame;
use lucerna::spectrum::SampledSpectrum;

use super::common::chi2::Chi2;
use super::common::effort;
use super::common::random::Random;
use super::first_two;

const MODE: TransportMode = TransportMode::Radiance;

fn hair(h: f32, beta: [f32; 2], sigma_a: f32, alpha: f32) -> Bsdf<'static> {
    let parameters = HairParameters {
        h,
        eta: 1.55,
        sigma_a: SampledSpectrum::splat(sigma_a),
        beta_m: beta[0],
        beta_n: beta[1],
        alpha,
    };
    Bsdf::new(
        Frame::from_normal_tangent(Vec3::Z, Vec3::X),
        Lobe::Hair(Hair::new(&parameters)),
    )
}

/// A direction by the sine of its angle to the plane across the fibre and its azimuth in that plane.
fn direction(sin: f64, azimuth: f64) -> Vec3 {
    let cos = (1.0 - sin * sin).max(0.0).sqrt();
    Vec3::new(sin as f32, (cos * azimuth.cos()) as f32, (cos * azimuth.sin()) as f32)
}

const BETAS: [[f32; 2]; 4] = [[0.15, 0.2], [0.3, 0.3], [0.9, 0.4], [0.5, 1.0]];
/// h, and wo by sine and azimuth.
const PLACES: [(f32, f64, f64); 4] = [(0.0, 0.1, 1.4), (0.6, -0.5, 1.8), (-0.95, 0.8, 0.6), (0.3, 0.0, -1.2)];

/// The solid angle of (sine, azimuth) is the product of both.
fn fibre() -> Chi2 {
    Chi2 {
        samples: 200_000 * effort(10),
        bins: [24, 24],
        ..Chi2::new([[-1.0, 1.0], [-PI, PI]]).of(BETAS.len() * PLACES.len())
    }
}

#[test]
fn samples_have_the_density_of_pdf() {
    for beta in BETAS {
        for (h, sin, azimuth) in PLACES {
            let (bsdf, wo) = (hair(h, beta, 0.3, 2.0), direction(sin, azimuth));
            let report = fibre().run(
                |u| {
                    let wi = bsdf.sample_f(wo, u[2], first_two(u), MODE)?.wi;
                    assert!((wi.length() - 1.0).abs() < 1e-5);
                    Some([f64::from(wi.x), f64::from(wi.z).atan2(f64::from(wi.y))])
                },
                |[sin, azimuth]| f64::from(bsdf.pdf(wo, direction(sin, azimuth), MODE).0),
            );
            report.assert_ok(&format!("{beta:?} at {h} from {sin}, {azimuth}"));
        }
    }
}

#[test]
fn samples_agree_with_f_and_pdf() {
    let mut random = Random::new(5);
    for beta in BETAS {
        for (h, sin, azimuth) in PLACES {
            let (bsdf, wo) = (hair(h, beta, 0.3, 2.0), direction(sin, azimuth));
            for _ in 0..300 {
                let u = random.unit4();
                let Some(sample) = bsdf.sample_f(wo, u[2], first_two(u), MODE) else {
                    continue;
                };
                let Density::Continuous(pdf) = sample.density else {
                    panic!("a continuum")
                };
                let value = bsdf.eval(wo, sample.wi, MODE).expect("not along the surface");
                let near = |a: f32, b: f32| (a - b).abs() <= 2e-3 * a.abs().max(b.abs());
                assert!(near(value.pdf.0, pdf.0), "{beta:?}: {} and {}", value.pdf.0, pdf.0);
                assert!(near(
                    value.f.0[0] * value.cos_theta,
                    sample.value.0[0] * sample.cos_theta
                ));
                // What is not absorbed is at most all; the colour only changes how much is left.
                assert!(sample.weight().0[0] <= 1.0 + 1e-4);
            }
        }
    }
}

/// The integral of f |cos| over all directions, by the midpoint rule.
fn reflected(bsdf: &Bsdf<'_>, wo: Vec3) -> f64 {
    const STEPS: usize = 600;
    let mut sum = 0.0;
    for i in 0..STEPS {
        let sin = -1.0 + 2.0 * (i as f64 + 0.5) / STEPS as f64;
        for j in 0..STEPS {
            let azimuth = -PI + 2.0 * PI * (j as f64 + 0.5) / STEPS as f64;
            if let Some(value) = bsdf.eval(wo, direction(sin, azimuth), MODE) {
                sum += f64::from(value.f.0[0] * value.cos_theta);
            }
        }
    }
    sum * 4.0 * PI / (STEPS * STEPS) as f64
}

/// Without absorption a fibre in a white furnace is white.
#[test]
fn no_energy_is_lost_or_gained_without_absorption() {
    for beta in BETAS {
        for (h, sin, azimuth) in PLACES {
            let wo = direction(sin, azimuth);
            for alpha in [0.0, 3.0] {
                let white = reflected(&hair(h, beta, 0.0, alpha), wo);
                assert!((white - 1.0).abs() < 3e-3, "{beta:?} at {h}, {alpha} degrees: {white}");
            }
            let tinted = [0.2, 1.0].map(|sigma| reflected(&hair(h, beta, sigma, 2.0), wo));
            assert!(tinted[0] < 0.95 && tinted[1] < tinted[0], "{tinted:?}");
        }
    }
}

/// Where a ray that comes from +y at the offset `h` (towards +x) leaves a circle of glass: reflected at once, after a passage, and after
/// a reflection inside.
fn through_circle(h: f64, eta: f64) -> [f64; 3] {
    let refract = |d: DVec2, n: DVec2, eta: f64| {
        let cos = -d.dot(n);
        d * eta + n * (eta * cos - (1.0 - eta * eta * (1.0 - cos * cos)).sqrt())
    };
    let across = |p: DVec2, d: DVec2| p - d * (2.0 * p.dot(d));
    let (p, d) = (DVec2::new(h, (1.0 - h * h).sqrt()), DVec2::new(0.0, -1.0));
    let reflected = d - p * (2.0 * d.dot(p));
    let inside = refract(d, p, 1.0 / eta);
    let exit = across(p, inside);
    let passed = refract(inside, -exit, eta);
    let back = inside - exit * (2.0 * inside.dot(exit));
    let second = across(exit, back);
    let returned = refract(back, -second, eta);
    [reflected, passed, returned].map(|d| d.y.atan2(d.x))
}

/// A smooth fibre sends light where a circle of glass does: most of it lies within a few degrees of one of these azimuths.
#[test]
fn a_smooth_fibre_is_a_cylinder_of_glass() {
    for h in [-0.8_f32, -0.3, 0.2, 0.7] {
        let expected = through_circle(h.into(), 1.55);
        let (bsdf, wo) = (hair(h, [0.05, 0.02], 0.0, 0.0), direction(0.0, PI / 2.0));
        let mut near = [0_u32; 3];
        let mut random = Random::new(9);
        const SAMPLES: u32 = 20_000;
        for _ in 0..SAMPLES {
            let u = random.unit4();
            let Some(sample) = bsdf.sample_f(wo, u[2], first_two(u), MODE) else {
                continue;
            };
            let azimuth = f64::from(sample.wi.z).atan2(f64::from(sample.wi.y));
            for (near, expected) in near.iter_mut().zip(expected) {
                let off = (azimuth - expected + PI).rem_euclid(2.0 * PI) - PI;
                *near += u32::from(off.abs() < 0.1);
            }
        }
        // Fresnel's reflectance outside, twice passed, and reflected in between.
        let f = f64::from(lucerna::material::fresnel_dielectric((1.0 - h * h).sqrt(), 1.55));
        for (near, share) in near.into_iter().zip([f, (1.0 - f).powi(2), (1.0 - f).powi(2) * f]) {
            let found = f64::from(near) / f64::from(SAMPLES);
            // Lobes may overlap, and the fourth part goes anywhere.
            assert!(
                found > 0.9 * share && found < 1.1 * share + 0.03,
                "{h}: {found} and {share}"
            );
        }
    }
}

#[test]
fn the_absorption_for_a_color_is_the_papers() {
    let sigma = absorption_of_reflectance(SampledSpectrum::splat(0.5), 0.3).0[0];
    // (ln 0.5 / 5.8884)².
    assert!((sigma - 0.013_857).abs() < 1e-5, "{sigma}");
    assert_eq!(absorption_of_reflectance(SampledSpectrum::ONE, 0.3).0[0], 0.0);
    assert!(absorption_of_reflectance(SampledSpectrum::ZERO, 0.3).is_finite());
}

/// wo, wi, f |cos| and density by Mitsuba 3.9.1, of a round fibre whose normal is +z: longitudinal roughness 0.3, azimuthal 0.4, tilt 2,
/// absorption 0.3, index 1.55. (Its fibres are along y, and x is our y.)
const BY_MITSUBA: [([f32; 3], [f32; 3], f32, f32); 10] = [
    (
        [-0.104961, -0.914149, 0.391554],
        [0.067414, 0.992154, -0.105286],
        0.0628973,
        0.0983717,
    ),
    (
        [-0.521855, -0.219732, 0.824248],
        [0.724993, -0.587884, -0.358857],
        0.0038376,
        0.0070578,
    ),
    (
        [-0.204155, 0.978625, 0.024788],
        [0.317806, 0.901241, -0.294557],
        0.0016623,
        0.0018627,
    ),
    (
        [0.267923, -0.090628, 0.959168],
        [-0.22845, -0.252895, 0.940136],
        0.0507686,
        0.0915868,
    ),
    (
        [-0.227119, -0.690153, 0.6871],
        [0.10269, 0.651207, 0.75192],
        0.0868715,
        0.1466055,
    ),
    (
        [0.323573, -0.896026, 0.304037],
        [0.151005, -0.911463, 0.382664],
        0.0276962,
        0.0428130,
    ),
    (
        [-0.923979, -0.381785, 0.022425],
        [0.882453, -0.033115, 0.469233],
        0.0071568,
        0.0080171,
    ),
    (
        [-0.590118, 0.787982, 0.17563],
        [0.801596, -0.597738, -0.012344],
        0.5471404,
        0.8162257,
    ),
    (
        [-0.706213, -0.153003, 0.691269],
        [0.48348, 0.482976, 0.730055],
        0.0315814,
        0.0600118,
    ),
    (
        [-0.590736, 0.322725, 0.739513],
        [0.635347, -0.371079, -0.677226],
        0.521368,
        0.9589605,
    ),
];

/// Mitsuba's series for the Bessel function is shorter: half a percent.
#[test]
fn values_are_those_of_mitsuba() {
    for (wo, wi, f, pdf) in BY_MITSUBA {
        // A round fibre is hit where its normal is turned away from wo.
        let h = -wo[1] / wo[1].hypot(wo[2]);
        let value = hair(h, [0.3, 0.4], 0.3, 2.0)
            .eval(wo.into(), wi.into(), MODE)
            .expect("a value");
        let near = |a: f32, b: f32| (a / b - 1.0).abs() < 6e-3;
        let found = value.f.0[0] * value.cos_theta;
        assert!(
            near(found, f) && near(value.pdf.0, pdf),
            "{wo:?} {wi:?}: {found} {f}, {} {pdf}",
            value.pdf.0
        );
    }
}
