//! Rays that leave lights: their flux, their stated densities, and the light that they bring to a receiver, which must be what
//! samples of the light seen from there bring.

mod cases;

use std::f64::consts::PI;

use glam::{DVec2, DVec3, Vec2, Vec3};
use lucerna::geometry::{GeometryId, Hit, PrimitiveId, SurfaceInteraction};
use lucerna::light::{
    DistantLight, EmissionDensity, EmissionImage, EmissionOrigin, EmissionSample, EnvironmentLight, GoniometricLight,
    ImageEnvironment, Light, LightDensity, LightEnd, LightSample, Place, PointLight, ProjectionLight, SpotLight,
};
use lucerna::math::{Bounds3, Frame};
use lucerna::sampling::{AreaPdf, SolidAnglePdf, warp};
use lucerna::spectrum::{ColorMode, RgbEmission, SampledSpectrum, Wavelengths};

use super::common::chi2::Chi2;
use super::common::means::Means;
use super::common::random::Random;
use super::lights::runs_of;
use cases::{ABOVE, BALL, CORNERS, Case, Receiver, SCENE, cases, constant, image, motion, painted_ball, triangle};

/// One failure in a hundred for all lights together.
fn means(cases: &[Case], slack: f64) -> Means {
    Means {
        significance: 0.01 / cases.len() as f64,
        slack,
    }
}

/// How much a ray carries for the flux of its light.
fn carried(sample: &EmissionSample) -> f64 {
    let position = match sample.density.position {
        LightDensity::Continuous(AreaPdf(pdf)) => pdf,
        LightDensity::Delta => 1.0,
    };
    let direction = match sample.density.direction {
        LightDensity::Continuous(SolidAnglePdf(pdf)) => pdf,
        LightDensity::Delta => 1.0,
    };
    f64::from(sample.le.0[0] * sample.cos_theta) / f64::from(position) / f64::from(direction)
}

#[test]
fn rays_carry_the_flux_of_their_light() {
    let cases = cases();
    for case in &cases {
        let Some((flux, slack)) = case.flux else {
            continue;
        };
        let runs = runs_of(|random| case.sample_le(random).map_or(0.0, |sample| carried(&sample)));
        let report = means(&cases, slack).against_exact(&runs, &[flux]);
        report.assert_agrees(case.name);
        report.assert_power(case.name, 0.03, 0.03);
    }
}

/// The flux through a receiver, by rays that leave the light and by samples of the light from points of the receiver.
#[test]
fn rays_bring_to_a_receiver_what_it_sees() {
    let cases = cases();
    for case in &cases {
        // Rays for each sample of the light: few of them meet the receiver, fewest of those from everywhere.
        let batch: u8 = if matches!(case.light, Light::Environment(_)) {
            32
        } else {
            8
        };
        let Receiver { center, normal, radius } = case.receiver;
        let brought = runs_of(|random| {
            let mut sum = 0.0;
            for _ in 0..batch {
                let Some(sample) = case.sample_le(random) else { continue };
                let ray = sample.ray(case.time);
                let cos = ray.direction.dot(normal);
                let t = (center - ray.origin).dot(normal) / cos;
                if cos < 0.0 && t > 0.0 && (ray.origin + ray.direction * t).distance(center) < radius {
                    sum += carried(&sample) / f64::from(batch);
                }
            }
            sum
        });
        let frame = Frame::from_normal(normal);
        let seen = runs_of(|random| {
            let [a, b, c, d] = random.unit4();
            let at = warp::sample_uniform_disk(Vec2::new(a, b)) * radius;
            let p = center + frame.s * at.x + frame.t * at.y;
            let Some(sample) = case.light.sample_li(p, case.time, Vec2::new(c, d), &Wavelengths::rgb()) else {
                return 0.0;
            };
            let density = match sample.density {
                LightDensity::Continuous(SolidAnglePdf(pdf)) => f64::from(pdf),
                LightDensity::Delta => 1.0,
            };
            let cos = f64::from(sample.wi.dot(normal).max(0.0));
            f64::from(sample.li.0[0]) * cos / density * PI * f64::from(radius).powi(2)
        });
        let name = format!("{} at {}", case.name, case.time);
        let report = means(&cases, 0.0).against_runs(&brought, &seen);
        report.assert_agrees(&name);
        report.assert_power(&name, 0.04, 0.04);
    }
}

/// What a light sample would be that the ray brings.
fn as_light_sample(sample: &EmissionSample) -> LightSample {
    let end = match sample.origin {
        EmissionOrigin::Surface { p, error, ng } => LightEnd::Point { p, error, ng },
        EmissionOrigin::Point(p) => LightEnd::Point {
            p,
            error: 0.0,
            ng: Vec3::ZERO,
        },
        EmissionOrigin::Infinity(_) => LightEnd::Infinity,
    };
    LightSample {
        li: SampledSpectrum::ZERO,
        wi: -sample.direction,
        end,
        density: LightDensity::Delta,
    }
}

fn surface(p: Vec3, ng: Vec3, time: f32) -> SurfaceInteraction {
    SurfaceInteraction {
        p,
        error: 0.0,
        ng,
        ns: ng,
        dpdu: Vec3::ZERO,
        dpdv: Vec3::ZERO,
        uv: Vec2::ZERO,
        barycentrics: Vec2::ZERO,
        wo: ng,
        footprint: 0.0,
        time,
        hit: Hit {
            geometry: GeometryId(0),
            primitive: PrimitiveId(0),
            instance: None,
        },
    }
}

fn agree(a: EmissionDensity, b: EmissionDensity) -> bool {
    let close = |a: f32, b: f32| (a / b - 1.0).abs() < 2e-3;
    let positions = match (a.position, b.position) {
        (LightDensity::Continuous(a), LightDensity::Continuous(b)) => close(a.0, b.0),
        (a, b) => a == b,
    };
    positions
        && match (a.direction, b.direction) {
            (LightDensity::Continuous(a), LightDensity::Continuous(b)) => close(a.0, b.0),
            (a, b) => a == b,
        }
}

/// The densities of a sample are those stated for the ray that it is; a light without black parts always has one.
#[test]
fn densities_of_rays_are_those_stated() {
    const RAYS: usize = 4000;
    for case in cases() {
        let mut random = Random::new(29);
        let (mut same, mut all) = (0, 0);
        for _ in 0..RAYS {
            let Some(sample) = case.sample_le(&mut random) else {
                continue;
            };
            all += 1;
            assert!((sample.direction.length() - 1.0).abs() < 1e-5, "{}", case.name);
            let ray = sample.ray(case.time);
            // Beyond the scene, and beyond a portal in it.
            let p = ray.origin + ray.direction * (2.0 * SCENE.radius());
            let density = case
                .light
                .emission_density(p, &as_light_sample(&sample), case.time, &SCENE);
            let stated = match sample.origin {
                EmissionOrigin::Surface { p, ng, .. } => {
                    let (position, direction) = case.light.pdf_le(&surface(p, ng, case.time), sample.direction);
                    assert_eq!(LightDensity::Continuous(direction), sample.density.direction);
                    let invisible = case.light.is_delta();
                    assert!(invisible || agree_on_position(position, sample.density));
                    assert!((sample.cos_theta - ng.dot(sample.direction).abs()).abs() < 1e-6);
                    true
                }
                EmissionOrigin::Point(_) => sample.density.position == LightDensity::Delta,
                EmissionOrigin::Infinity(at) => {
                    let before = (at - SCENE.center()).dot(sample.direction);
                    assert!(before <= -SCENE.radius(), "{}: {before}", case.name);
                    true
                }
            };
            // At the edge of a pixel, or of a portal, rounding may find another one.
            same += usize::from(stated && agree(density, sample.density));
        }
        assert!(same * 1000 >= all * 995, "{}: {same} of {all}", case.name);
        assert!(all == RAYS || case.dark && all > RAYS / 3, "{}: {all}", case.name);
    }
}

fn agree_on_position(stated: AreaPdf, density: EmissionDensity) -> bool {
    match density.position {
        LightDensity::Continuous(pdf) => (stated.0 / pdf.0 - 1.0).abs() < 2e-3,
        LightDensity::Delta => false,
    }
}

/// What leaves a point of a painted sphere is what is painted there, wherever the sphere has moved to.
#[test]
fn paint_moves_with_its_sphere() {
    let lambda = Wavelengths::rgb();
    for time in [0.0, 0.4, 1.0] {
        let case = Case { time, ..painted_ball() };
        let mut random = Random::new(41);
        for _ in 0..500 {
            let Some(sample) = case.sample_le(&mut random) else {
                continue;
            };
            let EmissionOrigin::Surface { p, .. } = sample.origin else {
                panic!("a sphere has a surface");
            };
            let object = motion().at(time).inverse().transform_point3(p.as_dvec3());
            let w = (object - BALL.0) / BALL.1;
            let uv = DVec2::new(
                (w.y.atan2(w.x) / (2.0 * PI)).rem_euclid(1.0),
                1.0 - w.z.clamp(-1.0, 1.0).acos() / PI,
            );
            let painted = image([8, 4]).sample_bilinear(uv.as_vec2(), &lambda);
            let error = (painted.0[0] - sample.le.0[0]).abs();
            assert!(error < 1e-4, "{painted:?} and {:?} at {time}", sample.le);
        }
    }
}

/// Nothing leaves the dark side, and nothing is said to.
#[test]
fn sides_are_kept() {
    for (two_sided, below) in [(false, 0.0), (true, 0.5)] {
        let light = Light::Area(triangle(two_sided));
        let case = Case::new("triangle", light, ABOVE);
        let ng = (CORNERS[1] - CORNERS[0]).cross(CORNERS[2] - CORNERS[0]).normalize();
        let share = runs_of(|random| {
            let sample = case.sample_le(random).expect("no black part");
            f64::from(u8::from(sample.direction.dot(ng) < 0.0))
        });
        if two_sided {
            let report = Means::default().against_exact(&share, &[below]);
            report.assert_agrees("sides");
            report.assert_power("sides", 0.02, 0.02);
        } else {
            assert!(share.iter().all(|run| run[0] == 0.0));
            let (_, back) = case.light.pdf_le(&surface(CORNERS[0], ng, 0.0), -ng);
            assert_eq!(back, SolidAnglePdf(0.0));
        }
    }
}

/// By azimuth and 1 - cos about its axis.
#[test]
fn spots_are_sampled_with_their_density() {
    for (start, end) in [(0.3, 1.1), (0.0, 0.7), (0.002, 0.005), (0.5, 2.6)] {
        let place = Place::at_point(Vec3::ZERO);
        let light = Light::Spot(SpotLight::new(place, constant(2.0), start, end));
        let widest = 2.0 * (0.5 * f64::from(end)).sin().powi(2);
        let report = Chi2::new([[-PI, PI], [0.0, widest]]).of(4).run(
            |u| {
                let (position, direction) = (Vec2::new(u[0], u[1]), Vec2::new(u[2], u[3]));
                let sample = light.sample_le(0.0, position, direction, &Wavelengths::rgb(), &SCENE)?;
                let w = sample.direction.as_dvec3();
                let sin2 = w.x * w.x + w.y * w.y;
                Some([w.y.atan2(w.x), if w.z > 0.0 { sin2 / (1.0 + w.z) } else { 1.0 - w.z }])
            },
            |[azimuth, one_minus_cos]| {
                let sin = (one_minus_cos * (2.0 - one_minus_cos)).max(0.0).sqrt();
                let w = DVec3::new(sin * azimuth.cos(), sin * azimuth.sin(), 1.0 - one_minus_cos).as_vec3();
                let sample = LightSample {
                    li: SampledSpectrum::ZERO,
                    wi: -w,
                    end: LightEnd::Infinity,
                    density: LightDensity::Delta,
                };
                match light.emission_density(w, &sample, 0.0, &SCENE).direction {
                    LightDensity::Continuous(SolidAnglePdf(pdf)) => f64::from(pdf),
                    LightDensity::Delta => f64::NAN,
                }
            },
        );
        report.assert_ok(&format!("spot from {start} to {end}"));
        assert!((report.mass - 1.0).abs() < 2e-3, "{start} to {end}: {}", report.mass);
    }
}

/// What is black, and what has nowhere to come to, sends nothing.
#[test]
fn black_lights_send_no_rays() {
    let black = || EmissionImage::new(&[[0.0; 3]; 16], 4, RgbEmission::new(ColorMode::Rgb)).expect("pixels");
    let place = || Place::at_point(Vec3::ZERO);
    let sky = ImageEnvironment::new(place(), black()).expect("a square");
    let lights = [
        Light::Goniometric(GoniometricLight::new(place(), constant(2.0), vec![0.0; 16]).expect("a square")),
        Light::Projection(ProjectionLight::new(place(), black(), 1.0)),
        Light::Environment(EnvironmentLight::Image(Box::new(sky))),
        Light::Point(PointLight::new(place(), constant(0.0))),
    ];
    let half = Vec2::splat(0.5);
    for light in lights {
        assert!(light.sample_le(0.0, half, half, &Wavelengths::rgb(), &SCENE).is_none());
    }
    for scene in [Bounds3::EMPTY, Bounds3::from_points([Vec3::ONE])] {
        for light in [
            Light::Distant(DistantLight::new(place(), constant(2.0))),
            Light::Environment(EnvironmentLight::Constant(constant(2.0))),
        ] {
            assert!(light.sample_le(0.0, half, half, &Wavelengths::rgb(), &scene).is_none());
        }
    }
}
