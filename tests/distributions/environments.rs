//! Environments by images and behind portals: samples against densities; pictures against what is sampled; stated power.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DAffine3, DVec3, Vec2, Vec3};
use lucerna::light::{
    Behind, EmissionImage, EnvironmentLight, ImageEnvironment, Light, LightDensity, LightEnd, Place, Portal,
    PortalEnvironment,
};
use lucerna::math::{AnimatedTransform, Bounds3};
use lucerna::sampling::{Cell, SphereMap, warp};
use lucerna::spectrum::{ColorMode, RgbEmission, Spectrum, SpectrumRole, Wavelengths, cie};

use super::common::chi2::Chi2;
use super::common::means::Means;
use super::common::random::Random;
use super::first_two;
use super::lights::runs_of;

/// A picture of grey pixels between 0 and 2, some of them black, one of them the sun.
fn image(size: [usize; 2], sun: f32) -> EmissionImage {
    let mut random = Random::new(3);
    let mut rgb: Vec<[f32; 3]> = (0..size[0] * size[1])
        .map(|_| [(2.5 * random.unit() - 0.5).max(0.0); 3])
        .collect();
    rgb[size[0] + 3] = [sun; 3];
    EmissionImage::new(&rgb, size[0], RgbEmission::new(ColorMode::Rgb)).expect("pixels")
}

/// A turn and, if asked for, a stretch.
fn transform(stretch: bool) -> DAffine3 {
    let turn = DAffine3::from_rotation_x(0.7) * DAffine3::from_rotation_z(2.1);
    let scale = if stretch {
        DVec3::new(1.0, 0.5, 2.0)
    } else {
        DVec3::splat(3.0)
    };
    turn * DAffine3::from_scale(scale)
}

fn sky(size: [usize; 2], stretch: bool) -> EnvironmentLight {
    let motion = AnimatedTransform::fixed(transform(stretch)).expect("invertible");
    let place = Place::new(motion, DAffine3::IDENTITY);
    let sky = ImageEnvironment::new(place, image(size, 40.0)).expect("a map of the sphere");
    EnvironmentLight::Image(Box::new(sky))
}

fn sample(light: &EnvironmentLight, p: Vec3, u: Vec2) -> Option<(Vec3, f32, f32)> {
    let sample = Light::Environment(light.clone()).sample_li(p, 0.0, u, &Wavelengths::rgb())?;
    let LightDensity::Continuous(pdf) = sample.density else {
        panic!("an environment has a density");
    };
    assert!(matches!(sample.end, LightEnd::Infinity));
    Some((sample.wi, pdf.0, sample.li.0[0]))
}

/// In the coordinates of the image, in which all pixels have the same area; a turned sky and a stretched one.
#[test]
fn skies_are_sampled_with_their_density() {
    for (map, size) in [(SphereMap::EqualArea, [8, 8]), (SphereMap::LatLong, [16, 8])] {
        let light = sky(size, false);
        let matrix = transform(false).matrix3;
        let report = Chi2 {
            bins: size.map(|n| 2 * n),
            ..Chi2::new([[0.0, size[0] as f64], [0.0, size[1] as f64]]).of(2)
        }
        .run(
            |u| {
                let (w, ..) = sample(&light, Vec3::ONE, first_two(u))?;
                let cell = map.cell((matrix.inverse() * w.as_dvec3()).normalize().as_vec3(), size);
                Some([
                    cell.x as f64 + f64::from(cell.offset.x),
                    cell.y as f64 + f64::from(cell.offset.y),
                ])
            },
            |[x, y]| {
                let offset = Vec2::new(x.fract() as f32, y.fract() as f32);
                let (x, y) = (x as usize, y as usize);
                let w = map.direction(&Cell { x, y, offset }, size);
                let world = (matrix * w.as_dvec3()).normalize().as_vec3();
                f64::from(light.pdf_li(Vec3::ONE, world, 0.0).0 * map.solid_angle(y, size))
            },
        );
        report.assert_ok(&format!("{map:?}"));
        assert!((report.mass - 1.0).abs() < 1e-3, "{map:?}: {}", report.mass);
    }
    // Of a stretched one no pixel has straight edges: by means.
    let light = sky([8, 8], true);
    let density = |w: Vec3| f64::from(light.pdf_li(Vec3::ONE, w, 0.0).0);
    let mean = runs_of(|random| 4.0 * PI * density(uniform(random)));
    let means = Means::default().against_exact(&mean, &[1.0]);
    means.assert_agrees("the density of a stretched sky integrates to 1");
    let observed = runs_of(|random| {
        let u = random.unit4();
        sample(&light, Vec3::ONE, first_two(u)).map_or(0.0, |(w, ..)| f64::from(w.z))
    });
    let expected = runs_of(|random| {
        let w = uniform(random);
        4.0 * PI * density(w) * f64::from(w.z)
    });
    let means = Means::default().against_runs(&observed, &expected);
    means.assert_agrees("the mean height of a stretched sky's samples");
}

fn uniform(random: &mut Random) -> Vec3 {
    let z = 2.0 * random.unit() - 1.0;
    let (sin, cos) = (std::f32::consts::TAU * random.unit()).sin_cos();
    let r = (1.0 - z * z).max(0.0).sqrt();
    Vec3::new(r * cos, r * sin, z)
}

/// In the plane z = 1, seen from below: from (-1, -1) to (1, 1).
fn portal() -> Portal {
    let corner = |x: f32, y: f32| Vec3::new(x, y, 1.0);
    // (p3 - p0) x (p1 - p0) is +z.
    let corners = [
        corner(-1.0, -1.0),
        corner(-1.0, 1.0),
        corner(1.0, 1.0),
        corner(1.0, -1.0),
    ];
    Portal::new(corners).expect("a rectangle")
}

fn behind_portal(constant: bool) -> EnvironmentLight {
    let behind = if constant {
        Behind::Constant(Spectrum::constant(2.0).compile(ColorMode::Spectral, SpectrumRole::Emission))
    } else {
        Behind::Image(image([8, 8], 5.0))
    };
    EnvironmentLight::Portal(Box::new(PortalEnvironment::new(portal(), behind)))
}

/// By the angles in the planes of the portal's edges. From the origin it is seen between -45 and 45 degrees: whole pixels.
#[test]
fn portals_are_sampled_with_their_density() {
    for constant in [false, true] {
        let light = behind_portal(constant);
        let range = [-0.5 * FRAC_PI_2, 0.5 * FRAC_PI_2];
        let report = Chi2 {
            bins: [32, 32],
            ..Chi2::new([range; 2]).of(2)
        }
        .run(
            |u| {
                let (w, ..) = sample(&light, Vec3::ZERO, first_two(u))?;
                let [x, y, z] = w.as_dvec3().to_array();
                Some([x.atan2(z), y.atan2(z)])
            },
            |[a, b]| {
                let (x, y) = (a.tan(), b.tan());
                let w = DVec3::new(x, y, 1.0);
                // dx = (1 + x²) da, and the solid angle of dx dy is cos³ dx dy.
                let solid_angle = (1.0 + x * x) * (1.0 + y * y) / w.length().powi(3);
                f64::from(light.pdf_li(Vec3::ZERO, w.normalize().as_vec3(), 0.0).0) * solid_angle
            },
        );
        report.assert_ok(&format!("portal, constant: {constant}"));
        assert!((report.mass - 1.0).abs() < 1e-3, "{}", report.mass);
    }
}

/// What comes with a sample is what a ray in that direction meets, with the density that is stated; nothing comes past a portal.
#[test]
fn samples_of_environments_are_what_rays_meet() {
    let lambda = Wavelengths::rgb();
    let mut random = Random::new(17);
    let lights = [
        ("square", sky([8, 8], false)),
        ("wide", sky([16, 8], false)),
        ("stretched", sky([8, 8], true)),
        ("portal", behind_portal(false)),
        ("portal of one radiance", behind_portal(true)),
    ];
    for (name, light) in lights {
        let (mut same, mut all) = (0, 0);
        for i in 0..4000 {
            let p = Vec3::new(random.unit() - 0.5, random.unit() - 0.5, -2.0 * random.unit());
            let Some((w, pdf, li)) = sample(&light, p, first_two(random.unit4())) else {
                continue;
            };
            let (stated, le) = (light.pdf_li(p, w, 0.0).0, light.le(p, w, 0.0, &lambda).0[0]);
            // At the edge of a pixel, or of the portal, rounding may find another one.
            same += u32::from((stated / pdf - 1.0).abs() < 1e-3 && (le - li).abs() <= 1e-4 * li);
            all += 1;
            if name.starts_with("portal") {
                let at = p + w * ((1.0 - p.z) / w.z);
                assert!(at.truncate().abs().max_element() < 1.0 + 1e-3, "{name} {i}: {at}");
                let beside = (Vec3::new(1.5, 0.3, 1.0) - p).normalize();
                assert_eq!(light.le(p, beside, 0.0, &lambda).0[0], 0.0);
                assert_eq!(light.pdf_li(p, beside, 0.0).0, 0.0);
                // From behind it nothing is seen.
                let above = Vec3::new(0.1, 0.2, 3.0);
                assert!(sample(&light, above, Vec2::splat(0.5)).is_none());
            }
        }
        assert!(all > 3000 && same * 1000 >= all * 995, "{name}: {same} of {all}");
    }
}

#[test]
fn the_power_of_an_environment_is_what_enters() {
    let bounds = Bounds3 {
        min: Vec3::splat(-1.0),
        max: Vec3::splat(1.0),
    };
    let disk = PI * f64::from(bounds.radius()).powi(2);
    for (name, light) in [("square", sky([8, 8], false)), ("wide", sky([16, 8], false))] {
        let flux = runs_of(|random| {
            let w = uniform(random);
            4.0 * PI * disk * f64::from(light.le(Vec3::ZERO, w, 0.0, &Wavelengths::rgb()).0[0])
        });
        let stated = f64::from(Light::Environment(light).power(&bounds));
        let report = Means::default().against_exact(&flux, &[stated]);
        report.assert_agrees(name);
        report.assert_power(name, 0.05, 0.05);
    }
}

/// What comes through a portal is what its power says; by points of equal area of a half sphere, in proportion to the cosine.
#[test]
fn the_power_of_a_portal_is_what_comes_through() {
    let bounds = Bounds3 {
        min: Vec3::splat(-1.0),
        max: Vec3::splat(1.0),
    };
    for constant in [false, true] {
        let light = behind_portal(constant);
        let lambda = Wavelengths::rgb();
        let through = |random: &mut Random| {
            let u = random.unit4();
            // Not so near that a direction's rounding matters at the edges.
            let p = Vec3::new(1.8 * u[0] - 0.9, 1.8 * u[1] - 0.9, 1.0 - 1e-4);
            let w = warp::sample_cosine_hemisphere(Vec2::new(u[2], u[3]));
            4.0 * PI * f64::from(light.le(p, w, 0.0, &lambda).0[0])
        };
        let flux = runs_of(|random| (0..8).map(|_| through(random)).sum::<f64>() / 8.0);
        let power = f64::from(Light::Environment(light).power(&bounds));
        let stated = if constant {
            power / f64::from(cie::y_integral())
        } else {
            power
        };
        // Some directions near the horizon pass beside it.
        let means = Means {
            slack: 1e-3,
            ..Means::default()
        };
        let report = means.against_exact(&flux, &[stated]);
        println!("constant: {constant}, {report}");
        report.assert_agrees("portal");
        report.assert_power("portal", 0.005, 0.005);
    }
}
