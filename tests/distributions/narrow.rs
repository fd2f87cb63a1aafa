//! Spotlights of a degree and less: their profile and power, where a cosine in single precision says little.

use std::f64::consts::PI;

use glam::{DVec3, Vec2};
use lucerna::light::{Light, Place, SpotLight};
use lucerna::math::Bounds3;
use lucerna::spectrum::{ColorMode, Spectrum, SpectrumRole, Wavelengths, cie};

use super::common::means::Means;
use super::lights::runs_of;

/// The angles of the rim and of where the fall-off starts, in degrees.
const CONES: [(f64, f64); 6] = [
    (1.0, 0.5),
    (1.0, 0.0),
    (0.3, 0.2),
    (0.1, 0.0),
    (0.1, 0.09),
    (0.02, 0.005),
];

/// Where the light is, and its axis.
const AT: DVec3 = DVec3::new(0.3, 0.1, 0.2);
const AXIS: DVec3 = DVec3::new(2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0);

fn spot((rim, start): (f64, f64)) -> Light {
    let intensity = Spectrum::constant(2.0).compile(ColorMode::Spectral, SpectrumRole::Emission);
    let [rim, start] = [rim, start].map(|degrees| degrees.to_radians() as f32);
    Light::Spot(SpotLight::new(Place::facing(AT, AXIS), intensity, start, rim))
}

/// What arrives at a distance of 1, at an angle to the axis and an azimuth about it.
fn arriving(light: &Light, angle: f64, azimuth: f64) -> f64 {
    let side = AXIS.cross(DVec3::X).normalize();
    let aside = side * azimuth.cos() + AXIS.cross(side) * azimuth.sin();
    let p = AT + AXIS * angle.cos() + aside * angle.sin();
    let sample = light.sample_li(p.as_vec3(), 0.0, Vec2::ZERO, &Wavelengths::sample_visible(0.4));
    sample.map_or(0.0, |s| f64::from(s.li.0[0]))
}

/// pbrt's smooth step over the cosine, by 1 - cos = 2 sin² of half the angle.
fn profile((rim, start): (f64, f64), angle: f64) -> f64 {
    let rise = |angle: f64| 2.0 * (0.5 * angle).sin().powi(2);
    let (low, high) = (rise(rim.to_radians()), rise(start.to_radians()));
    let t = ((low - rise(angle)) / (low - high)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[test]
fn narrow_spotlights_have_their_profile() {
    for cone in CONES {
        let light = spot(cone);
        let rim = cone.0.to_radians();
        for i in 0..60 {
            let angle = rim * f64::from(i) / 50.0;
            // The point that is lit is in single precision: some 1e-7 of the distance, as is the direction.
            let [nearer, farther] = [-3e-7, 3e-7].map(|error| 2.0 * profile(cone, angle + error));
            let value = arriving(&light, angle, 0.7 * f64::from(i));
            let range = farther - 0.002..=nearer + 0.002;
            assert!(range.contains(&value), "{cone:?} at {angle}: {value}, not in {range:?}");
        }
    }
}

#[test]
fn narrow_spotlights_have_their_power() {
    let bounds = Bounds3::from_points([glam::Vec3::ZERO]);
    for cone in CONES {
        let light = spot(cone);
        // A little beyond the rim, in proportion to solid angle.
        let widest = 2.0 * (0.55 * cone.0.to_radians()).sin().powi(2);
        let runs = runs_of(|random| {
            let rise = widest * f64::from(random.unit());
            let angle = 2.0 * (0.5 * rise).sqrt().asin();
            2.0 * PI * widest * arriving(&light, angle, 2.0 * PI * f64::from(random.unit()))
        });
        let stated = f64::from(light.power(&bounds)) / f64::from(cie::y_integral());
        let means = Means {
            // The directions' rounding, of the narrowest.
            slack: 1e-3,
            ..Means::default()
        };
        let report = means.against_exact(&runs, &[stated]);
        println!("{cone:?}: {report}");
        report.assert_agrees(&format!("{cone:?}"));
        report.assert_power(&format!("{cone:?}"), 0.02, 0.02);
    }
}
