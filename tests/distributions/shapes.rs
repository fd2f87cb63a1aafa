//! Quadrics and bilinear patches as lights: their points are sampled with the stated density, by area and by solid angle.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use glam::{DAffine3, DVec2, DVec3, Vec2, Vec3};
use lucerna::geometry::{PatchMesh, PatchSurface, Quadric, QuadricKind};
use lucerna::light::{
    AreaLight, EmissionOrigin, EmitterShape, Light, LightDensity, LightEnd, MovingEmitter, PatchEmitter,
};
use lucerna::math::{AnimatedTransform, Bounds3};
use lucerna::sampling::warp;
use lucerna::spectrum::{ColorMode, CompiledSpectrum, Spectrum, SpectrumRole, Wavelengths, cie};

use super::common::chi2::Chi2;
use super::common::means::Means;
use super::common::random::Random;
use super::first_two;
use super::lights::runs_of;

/// The number of chi-squared tests here.
const TESTS: usize = 9;

fn constant(value: f32) -> CompiledSpectrum {
    Spectrum::constant(value).compile(ColorMode::Spectral, SpectrumRole::Emission)
}

fn wavelengths() -> Wavelengths {
    Wavelengths::sample_visible(0.4)
}

/// Stretched and turned, so that no two places grow alike.
fn stretched() -> DAffine3 {
    DAffine3::from_rotation_x(0.4) * DAffine3::from_scale(DVec3::new(1.5, 0.4, -0.8))
}

fn quadrics() -> Vec<(&'static str, Quadric)> {
    let even = DAffine3::from_rotation_y(0.5) * DAffine3::from_scale(DVec3::splat(0.7));
    let z = [-0.5, 0.8];
    let new = |kind, phi_max, transform| Quadric::new(kind, phi_max, transform).expect("a surface");
    let disk = |height, inner_radius| QuadricKind::Disk {
        height,
        radius: 1.0,
        inner_radius,
    };
    vec![
        ("disk", new(disk(0.0, 0.0), TAU, even)),
        ("part of a ring", new(disk(0.4, 0.5), 4.0, stretched())),
        ("cylinder", new(QuadricKind::Cylinder { radius: 0.6, z }, TAU, even)),
        (
            "part of a cylinder",
            new(QuadricKind::Cylinder { radius: 0.9, z }, 2.0, stretched()),
        ),
        (
            "part of a sphere",
            new(QuadricKind::Sphere { radius: 1.0, z }, 5.0, even),
        ),
        (
            "part of an ellipsoid",
            new(QuadricKind::Sphere { radius: 1.0, z }, TAU, stretched()),
        ),
    ]
}

fn patches() -> Vec<(&'static str, PatchSurface)> {
    let patch = |corners: [[f32; 3]; 4]| {
        let mesh = PatchMesh::new(corners.map(Vec3::from_array).to_vec(), vec![[0, 1, 2, 3]]);
        mesh.expect("finite").surface(0)
    };
    vec![
        (
            "trapezoid",
            patch([[-1.0, -0.8, 0.1], [1.0, -0.8, 0.1], [-0.2, 0.7, 0.1], [0.4, 0.7, 0.1]]),
        ),
        (
            "twisted patch",
            patch([[-0.9, -0.7, 0.6], [0.8, -0.9, -0.5], [-0.8, 0.5, -0.4], [0.9, 0.8, 0.7]]),
        ),
        (
            "patch with two corners in one",
            patch([[-0.9, -0.7, 0.6], [0.8, -0.9, -0.5], [0.1, 0.9, -0.4], [0.1, 0.9, -0.4]]),
        ),
    ]
}

fn quadric_light(quadric: &Quadric, two_sided: bool) -> AreaLight {
    let shape = EmitterShape::Quadric(Arc::new(quadric.clone()));
    AreaLight::new(shape, constant(2.0), two_sided).expect("an area")
}

fn patch_light(surface: &PatchSurface, two_sided: bool) -> AreaLight {
    let patch = PatchEmitter::new(surface.clone()).expect("an area");
    AreaLight::new(EmitterShape::Patch(Arc::new(patch)), constant(2.0), two_sided).expect("an area")
}

/// Points of the emission from a light.
fn emitted(light: &Light, u: Vec2) -> Option<(Vec3, Vec3)> {
    let bounds = Bounds3::from_points([Vec3::splat(-2.0), Vec3::splat(2.0)]);
    let sample = light.sample_le(0.0, u, Vec2::new(0.3, 0.6), &wavelengths(), &bounds)?;
    match sample.origin {
        EmissionOrigin::Surface { p, ng, .. } => Some((p, ng)),
        _ => panic!("an area light emits from its surface"),
    }
}

/// The places of emitted points in the angle and along the axis of object space, where equal areas have equal probability up to the
/// stretching that the density states.
#[test]
fn quadrics_are_sampled_with_their_density() {
    for (name, quadric) in quadrics() {
        let area = quadric_light(&quadric, true);
        let light = Light::Area(area.clone());
        let object = *quadric.object_from_world();
        let world = object.inverse();
        // The second coordinate is the one that is uniform by area in object space.
        let place = |p: DVec3| {
            let q = object.transform_point3(p);
            let phi = q.y.atan2(q.x).rem_euclid(TAU);
            match quadric.kind() {
                QuadricKind::Disk { .. } => [phi, q.truncate().length_squared()],
                _ => [phi, q.z],
            }
        };
        let point = |phi: f64, s: f64| {
            let (sin, cos) = phi.sin_cos();
            world.transform_point3(match quadric.kind() {
                QuadricKind::Disk { height, .. } => DVec3::new(s.sqrt() * cos, s.sqrt() * sin, height),
                QuadricKind::Cylinder { radius, .. } => DVec3::new(radius * cos, radius * sin, s),
                QuadricKind::Sphere { radius, .. } => {
                    let r = (radius * radius - s * s).max(0.0).sqrt();
                    DVec3::new(r * cos, r * sin, s)
                }
            })
        };
        let (range, phi_max) = match (quadric.kind(), name) {
            (QuadricKind::Disk { inner_radius, .. }, "disk") => ([inner_radius, 1.0], TAU),
            (QuadricKind::Disk { inner_radius, .. }, _) => ([inner_radius * inner_radius, 1.0], 4.0),
            (QuadricKind::Cylinder { z, .. }, "cylinder") => (z, TAU),
            (QuadricKind::Cylinder { z, .. }, _) => (z, 2.0),
            (QuadricKind::Sphere { z, .. }, "part of a sphere") => (z, 5.0),
            (QuadricKind::Sphere { z, .. }, _) => (z, TAU),
        };
        let report = Chi2::new([[0.0, phi_max], range]).of(TESTS).run(
            |u| emitted(&light, first_two(u)).map(|(p, _)| place(p.as_dvec3())),
            |[phi, s]| {
                // Area by the two coordinates, by differences.
                let e = 1e-4;
                let (by_phi, by_s) = (
                    point(phi + e, s) - point(phi - e, s),
                    point(phi, (s + e).min(range[1])) - point(phi, (s - e).max(range[0])),
                );
                let width = (s + e).min(range[1]) - (s - e).max(range[0]);
                let element = by_phi.cross(by_s).length() / (2.0 * e * width);
                let p = point(phi, s).as_vec3();
                area_pdf(&area, p) * element
            },
        );
        report.assert_ok(name);
        assert!((report.mass - 1.0).abs() < 2e-3, "{name}: {}", report.mass);
    }
}

/// The density by area of a quadric's point, which does not depend on the normal.
fn area_pdf(area: &AreaLight, p: Vec3) -> f64 {
    // From a point nearby along z: the density by solid angle, turned back.
    let from = p + Vec3::new(0.0, 0.0, 10.0);
    let pdf = area.pdf_li(from, p, Vec3::Z, 0.0).0;
    f64::from(pdf) / 100.0
}

#[test]
fn patches_are_sampled_with_their_density() {
    for (name, surface) in patches() {
        let area = patch_light(&surface, true);
        let light = Light::Area(area.clone());
        let report = Chi2::new([[0.0, 1.0]; 2]).of(TESTS).run(
            |u| {
                let (p, ng) = emitted(&light, first_two(u))?;
                Some(surface.patch.invert(p.as_dvec3(), ng.as_dvec3()).to_array())
            },
            |[u, v]| {
                let uv = DVec2::new(u, v);
                let [dpdu, dpdv] = surface.patch.derivatives(uv);
                let (p, ng) = (surface.patch.point(uv).as_vec3(), surface.ng(uv).as_vec3());
                let pdf = f64::from(area.pdf_li(p + ng * 10.0, p, ng, 0.0).0) / 100.0;
                pdf * dpdu.cross(dpdv).length()
            },
        );
        report.assert_ok(name);
        assert!((report.mass - 1.0).abs() < 2e-3, "{name}: {}", report.mass);
    }
}

/// All shapes at rest and in motion.
fn lights(two_sided: bool) -> Vec<(String, AreaLight)> {
    let turn = DAffine3::from_rotation_z(1.1) * DAffine3::from_translation(DVec3::new(0.5, 1.0, 0.2));
    let motion = AnimatedTransform::new(DAffine3::IDENTITY, turn).expect("a motion");
    let mut lights = Vec::new();
    for (name, quadric) in quadrics() {
        lights.push((name.to_owned(), quadric_light(&quadric, two_sided)));
        let moving = AreaLight::moving(
            MovingEmitter::quadric(quadric, motion.clone()),
            constant(2.0),
            two_sided,
        );
        lights.push((format!("moving {name}"), moving.expect("an area")));
    }
    for (name, surface) in patches() {
        lights.push((name.to_owned(), patch_light(&surface, two_sided)));
        let moving = AreaLight::moving(MovingEmitter::patch(surface, motion.clone()), constant(2.0), two_sided);
        lights.push((format!("moving {name}"), moving.expect("an area")));
    }
    lights
}

/// The density that comes with a sample is the stated one; the mean of cos / (pdf distance²) is the area.
#[test]
fn samples_have_the_stated_density_and_add_up_to_the_area() {
    let from = Vec3::new(3.0, -1.0, -2.0);
    let mut random = Random::new(29);
    for (name, area) in lights(true) {
        let light = Light::Area(area.clone());
        for time in [0.0, 0.4, 1.0] {
            for _ in 0..500 {
                let u = Vec2::new(random.unit(), random.unit());
                let Some(sample) = light.sample_li(from, time, u, &wavelengths()) else {
                    continue;
                };
                let (LightEnd::Point { p, ng, .. }, LightDensity::Continuous(pdf)) = (sample.end, sample.density)
                else {
                    panic!("{name}: an area light has points and a density");
                };
                let stated = area.pdf_li(from, p, ng, time).0;
                // Where a patch runs into a point its parameters are ill known.
                let tolerance = if name.contains("in one") { 0.02 } else { 2e-3 };
                assert!(
                    (stated / pdf.0 - 1.0).abs() < tolerance,
                    "{name}: {stated} and {}",
                    pdf.0
                );
            }
        }
        let runs = runs_of(|random| {
            let sample = light.sample_li(from, 0.0, first_two(random.unit4()), &wavelengths());
            sample.map_or(0.0, |s| match (s.end, s.density) {
                (LightEnd::Point { p, ng, .. }, LightDensity::Continuous(pdf)) => {
                    let distance_squared = (p - from).length_squared();
                    f64::from(distance_squared / (pdf.0 * ng.dot(s.wi).abs()))
                }
                _ => f64::NAN,
            })
        });
        let means = Means {
            slack: 1e-3,
            ..Means::default()
        };
        let report = means.against_exact(&runs, &[f64::from(area.area())]);
        report.assert_agrees(&name);
        report.assert_power(&name, 0.02, 0.02);
    }
}

/// All that a light emits passes a sphere around it: its power is the flux there.
#[test]
fn power_is_the_flux_through_a_sphere_around_it() {
    let radius = 5.0_f32;
    for (name, light) in lights(false).into_iter().filter(|(name, _)| !name.contains("moving")) {
        let light = Light::Area(light);
        let runs = runs_of(|random| {
            let u = random.unit4();
            let outward = warp::sample_uniform_sphere(Vec2::new(u[2], u[3]));
            let Some(sample) = light.sample_li(outward * radius, 0.0, first_two(u), &wavelengths()) else {
                return 0.0;
            };
            let LightDensity::Continuous(pdf) = sample.density else {
                panic!("{name} has a density")
            };
            let cos = f64::from(-sample.wi.dot(outward)).max(0.0);
            f64::from(sample.li.0[0]) * cos / f64::from(pdf.0) * 4.0 * PI * f64::from(radius).powi(2)
        });
        let bounds = Bounds3::from_points([Vec3::splat(-1.0), Vec3::splat(1.0)]);
        let stated = f64::from(light.power(&bounds)) / f64::from(cie::y_integral());
        let means = Means {
            slack: 1e-3,
            ..Means::default()
        };
        let report = means.against_exact(&runs, &[stated]);
        report.assert_agrees(&name);
        report.assert_power(&name, 0.05, 0.05);
    }
}
