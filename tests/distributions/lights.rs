//! Lights: sampled directions against their density, the solid angle and the power that they add up to.

use std::f64::consts::PI;

use glam::{DVec3, Vec2, Vec3};
use lucerna::light::{
    AreaLight, DistantLight, EmitterShape, EnvironmentLight, Light, LightDensity, LightEnd, PointLight,
};
use lucerna::math::Bounds3;
use lucerna::sampling::warp;
use lucerna::spectrum::{ColorMode, CompiledSpectrum, Spectrum, SpectrumRole, Wavelengths, cie};

use super::common::chi2::Chi2;
use super::common::means::{FEWEST_RUNS, Means};
use super::common::random::Random;
use super::first_two;

fn constant(value: f32) -> CompiledSpectrum {
    Spectrum::constant(value).compile(ColorMode::Spectral, SpectrumRole::Emission)
}

fn sphere(center: DVec3, radius: f64, inward: bool) -> AreaLight {
    let shape = EmitterShape::Sphere { center, radius, inward };
    AreaLight::new(shape, constant(2.0), false).expect("a sphere has an area")
}

fn triangle(vertices: [Vec3; 3], two_sided: bool) -> AreaLight {
    let [a, b, c] = vertices;
    let ng = (b - a).cross(c - a).normalize();
    AreaLight::new(EmitterShape::Triangle { vertices, ng }, constant(2.0), two_sided).expect("not degenerate")
}

const CORNERS: [Vec3; 3] = [
    Vec3::new(1.0, -0.5, 2.0),
    Vec3::new(2.5, 0.7, 1.5),
    Vec3::new(0.2, 1.1, 3.0),
];

fn wavelengths() -> Wavelengths {
    Wavelengths::sample_visible(0.4)
}

/// The number of chi-squared tests of lights.
const TESTS: usize = 8;

/// A sphere as `from` sees it, in cosine and azimuth about the direction to its centre; its density is asked at the point where a
/// ray meets it, computed here.
#[test]
fn spheres_are_sampled_with_their_density() {
    let center = DVec3::new(0.5, 1.0, 3.0);
    for (from, radius, inward) in [
        (Vec3::ZERO, 0.5, false),
        (Vec3::ZERO, 0.01, false),
        (Vec3::new(0.5, 1.0, 1.4), 1.5, false),
        (Vec3::new(0.7, 1.4, 2.5), 2.0, true),
        (Vec3::new(0.5, 2.9, 3.0), 2.0, true),
    ] {
        let light = sphere(center, radius, inward);
        let axis = center - from.as_dvec3();
        let distance = axis.length();
        let outside = distance > radius;
        // About +z: the sphere's centre is on the axis, the light is turned there.
        let turned = Light::Area(sphere(DVec3::Z * distance, radius, inward));
        let Light::Area(area) = &turned else { unreachable!() };
        // 1 - cos of the cone that it fills, all directions from inside.
        let widest = if outside {
            1.0 - (1.0 - (radius / distance).powi(2)).sqrt()
        } else {
            2.0
        };
        let name = format!("sphere of {radius} at {distance}");
        let report = Chi2::new([[-PI, PI], [0.0, widest]]).of(TESTS).run(
            |u| {
                let sample = turned.sample_li(Vec3::ZERO, first_two(u), &wavelengths())?;
                let w = sample.wi.as_dvec3();
                let sin2 = w.x * w.x + w.y * w.y;
                let one_minus_cos = if w.z > 0.0 { sin2 / (1.0 + w.z) } else { 1.0 - w.z };
                Some([w.y.atan2(w.x), one_minus_cos])
            },
            |[azimuth, one_minus_cos]| {
                let cos = 1.0 - one_minus_cos;
                let sin = (1.0 - cos * cos).max(0.0).sqrt();
                let w = DVec3::new(sin * azimuth.cos(), sin * azimuth.sin(), cos);
                let half = (radius * radius - (distance * sin).powi(2)).max(0.0).sqrt();
                let t = distance * cos + if outside { -half } else { half };
                let p = w * t;
                let ng = (p - DVec3::Z * distance) / radius;
                f64::from(area.pdf_li(Vec3::ZERO, p.as_vec3(), ng.as_vec3()).0)
            },
        );
        report.assert_ok(&name);
        assert!((report.mass - 1.0).abs() < 1e-3, "{name}: {}", report.mass);
        // Where it stands, the sampled densities are those that pdf_li states.
        check_stated_density(&Light::Area(light), from, &name);
    }
}

/// In barycentric coordinates, where the density of a direction times cos / distance² and twice the area must be uniform.
#[test]
fn triangles_are_sampled_with_their_density() {
    let [a, b, c] = CORNERS.map(Vec3::as_dvec3);
    let normal = (b - a).cross(c - a);
    for from in [Vec3::ZERO, Vec3::new(1.2, 0.4, 2.6), Vec3::new(-30.0, 20.0, 9.0)] {
        let light = Light::Area(triangle(CORNERS, true));
        let Light::Area(area) = &light else { unreachable!() };
        let report = Chi2::new([[0.0, 1.0]; 2]).of(TESTS).run(
            |u| {
                let sample = light.sample_li(from, first_two(u), &wavelengths())?;
                let LightEnd::Point { p, .. } = sample.end else {
                    panic!("a triangle is not infinitely far away");
                };
                let share = |x: DVec3, y: DVec3| {
                    let p = p.as_dvec3();
                    (x - p).cross(y - p).dot(normal) / normal.length_squared()
                };
                Some([share(b, c), share(c, a)])
            },
            |[wa, wb]| {
                if wa + wb > 1.0 {
                    return 0.0;
                }
                let p = a * wa + b * wb + c * (1.0 - wa - wb);
                let d = p - from.as_dvec3();
                let n = normal.normalize();
                let pdf_w = f64::from(area.pdf_li(from, p.as_vec3(), n.as_vec3()).0);
                pdf_w * d.dot(n).abs() / d.length().powi(3) * normal.length()
            },
        );
        report.assert_ok(&format!("triangle from {from}"));
        check_stated_density(&light, from, &format!("triangle from {from}"));
    }
}

/// The density that comes with a sample is that of [`AreaLight::pdf_li`] for its point.
fn check_stated_density(light: &Light, from: Vec3, name: &str) {
    let Light::Area(area) = light else { unreachable!() };
    let mut random = Random::new(11);
    let mut sampled = 0;
    for _ in 0..500 {
        let Some(sample) = light.sample_li(from, first_two(random.unit4()), &wavelengths()) else {
            continue;
        };
        let (LightEnd::Point { p, ng, .. }, LightDensity::Continuous(pdf)) = (sample.end, sample.density) else {
            panic!("{name}: an area light has points and a density");
        };
        let stated = area.pdf_li(from, p, ng).0;
        assert!((stated / pdf.0 - 1.0).abs() < 1e-4, "{name}: {stated} and {}", pdf.0);
        assert!(((p - from).normalize() - sample.wi).length() < 1e-5, "{name}");
        assert_eq!(sample.li.0[0], 2.0, "{name}");
        sampled += 1;
    }
    assert!(sampled > 0, "{name}");
}

/// The mean of 1 / pdf is the solid angle of the light, which is known.
#[test]
fn inverse_densities_add_up_to_the_solid_angle() {
    let from = Vec3::new(0.3, -0.2, 0.5);
    // Van Oosterom and Strackee 1983.
    let [a, b, c] = CORNERS.map(|v| (v - from).as_dvec3().normalize());
    let tan_half = a.dot(b.cross(c)).abs() / (1.0 + a.dot(b) + b.dot(c) + c.dot(a));
    let center = DVec3::new(0.5, 1.0, 3.0);
    let cos_max = (1.0 - 0.9 * 0.9 / (center - from.as_dvec3()).length_squared()).sqrt();
    let cases = [
        ("triangle", triangle(CORNERS, true), 2.0 * tan_half.atan()),
        ("sphere", sphere(center, 0.9, false), 2.0 * PI * (1.0 - cos_max)),
        ("sphere around", sphere(center, 5.0, true), 4.0 * PI),
    ];
    for (name, light, solid_angle) in cases {
        let light = Light::Area(light);
        let mean = Means {
            slack: 1e-4,
            ..Means::default()
        };
        let runs = runs_of(|random| {
            let sample = light.sample_li(from, first_two(random.unit4()), &wavelengths());
            let density = sample.map(|s| s.density);
            match density {
                Some(LightDensity::Continuous(pdf)) => 1.0 / f64::from(pdf.0),
                _ => 0.0,
            }
        });
        let report = mean.against_exact(&runs, &[solid_angle]);
        report.assert_agrees(name);
        report.assert_power(name, 0.02, 0.02);
    }
}

/// 16 means of 16,384 values.
fn runs_of(value: impl Fn(&mut Random) -> f64) -> Vec<Vec<f64>> {
    const VALUES: usize = 16_384;
    let run = |seed: usize| {
        let mut random = Random::new(seed as u64);
        vec![(0..VALUES).map(|_| value(&mut random)).sum::<f64>() / VALUES as f64]
    };
    (1..=FEWEST_RUNS).map(run).collect()
}

/// All that a light emits passes a sphere around the scene: its power is the mean irradiance there times the area (of what comes
/// from infinitely far, what enters: the part that faces the light).
#[test]
fn power_is_the_flux_through_a_sphere_around_it() {
    let bounds = Bounds3 {
        min: Vec3::splat(-1.0),
        max: Vec3::splat(1.0),
    };
    let scene_radius = bounds.radius();
    let far = 5.0_f32;
    let towards = Vec3::new(2.0, -1.0, 2.0) / 3.0;
    let cases = [
        (
            "triangle",
            Light::Area(triangle(CORNERS.map(|v| v - CORNERS[0]), false)),
            far,
        ),
        (
            "two-sided",
            Light::Area(triangle(CORNERS.map(|v| v - CORNERS[0]), true)),
            far,
        ),
        (
            "sphere",
            Light::Area(sphere(DVec3::new(0.5, 0.2, -0.4), 0.8, false)),
            far,
        ),
        (
            "point",
            Light::Point(PointLight::new(Vec3::new(0.3, 0.1, 0.2), constant(2.0))),
            far,
        ),
        (
            "distant",
            Light::Distant(DistantLight::new(towards, constant(2.0))),
            scene_radius,
        ),
        (
            "environment",
            Light::Environment(EnvironmentLight::new(constant(2.0))),
            scene_radius,
        ),
    ];
    for (name, light, radius) in cases {
        let infinite = matches!(light, Light::Distant(_) | Light::Environment(_));
        let runs = runs_of(|random| {
            let u = random.unit4();
            let outward = warp::sample_uniform_sphere(Vec2::new(u[2], u[3]));
            let Some(sample) = light.sample_li(outward * radius, first_two(u), &wavelengths()) else {
                return 0.0;
            };
            // Finite lights shine outward through the sphere, infinite ones inward.
            let cos = f64::from(sample.wi.dot(outward)) * if infinite { 1.0 } else { -1.0 };
            let density = match sample.density {
                LightDensity::Continuous(pdf) => f64::from(pdf.0),
                LightDensity::Delta => 1.0,
            };
            f64::from(sample.li.0[0]) * cos.max(0.0) / density * 4.0 * PI * f64::from(radius).powi(2)
        });
        let stated = f64::from(light.power(&bounds)) / f64::from(cie::y_integral());
        let means = Means {
            slack: 1e-4,
            ..Means::default()
        };
        let report = means.against_exact(&runs, &[stated]);
        report.assert_agrees(name);
        report.assert_power(name, 0.05, 0.05);
    }
}
