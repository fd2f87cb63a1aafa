//! Lamps with an image: their power is the flux through a sphere around them.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DAffine3, DMat3, Vec2, Vec3};
use lucerna::geometry::Sphere;
use lucerna::light::{AreaLight, Coordinates, EmissionImage, EmitterShape, Light, LightDensity};
use lucerna::math::Bounds3;
use lucerna::sampling::warp;
use lucerna::spectrum::{ColorMode, RgbEmission, Spectrum, SpectrumRole, Wavelengths};

use super::common::means::Means;
use super::common::random::Random;
use super::lights::runs_of;

/// Grey pixels by chance, a quarter of them black, and one that is brighter by far.
fn image([width, height]: [usize; 2], sun: f32) -> Arc<EmissionImage> {
    let mut random = Random::new(9);
    let mut rgb: Vec<[f32; 3]> = (0..width * height)
        .map(|_| [(2.0 * random.unit() - 0.5).max(0.0); 3])
        .collect();
    rgb[width * (height / 3) + width / 4] = [sun; 3];
    Arc::new(EmissionImage::new(&rgb, width, RgbEmission::new(ColorMode::Rgb)).expect("pixels"))
}

fn triangle(two_sided: bool) -> AreaLight {
    let vertices = [Vec3::ZERO, Vec3::new(1.5, 0.2, -0.5), Vec3::new(-0.3, 1.2, 0.4)];
    let ng = (vertices[1] - vertices[0]).cross(vertices[2] - vertices[0]).normalize();
    let radiance = Spectrum::constant(1.0).compile(ColorMode::Rgb, SpectrumRole::Emission);
    AreaLight::new(EmitterShape::Triangle { vertices, ng }, radiance, two_sided).expect("an area")
}

fn ball() -> (AreaLight, Coordinates) {
    let world = DAffine3::from_rotation_y(0.8);
    let sphere = Sphere::new(0.9, world).expect("a sphere");
    let radiance = Spectrum::constant(1.0).compile(ColorMode::Rgb, SpectrumRole::Emission);
    let light = AreaLight::sphere(&sphere, radiance, false).expect("an area");
    (light, Coordinates::Sphere(DMat3::from_rotation_y(-0.8)))
}

#[test]
fn the_power_of_a_lamp_with_an_image_is_its_flux() {
    let whole = Coordinates::Corners([Vec2::ZERO, Vec2::X, Vec2::Y]);
    let part = Coordinates::Corners([Vec2::new(0.1, 0.2), Vec2::new(0.6, 0.3), Vec2::new(0.2, 0.9)]);
    let repeated = Coordinates::Corners([Vec2::ZERO, Vec2::new(3.0, 0.5), Vec2::new(-0.5, 2.5)]);
    let (ball, around) = ball();
    // And what error is noticed.
    let cases = [
        ("whole", triangle(false).with_image(image([16, 8], 1.0), whole), 0.0075),
        ("part", triangle(true).with_image(image([16, 8], 1.0), part), 0.0075),
        (
            "repeated",
            triangle(false).with_image(image([16, 8], 1.0), repeated),
            0.0075,
        ),
        (
            "fine",
            triangle(false).with_image(image([256, 128], 1.0), whole),
            0.0075,
        ),
        ("sun", triangle(false).with_image(image([16, 16], 40.0), whole), 0.015),
        (
            "small sun",
            triangle(false).with_image(image([64, 64], 400.0), whole),
            0.03,
        ),
        ("ball", ball.clone().with_image(image([16, 8], 1.0), around), 0.0075),
        (
            "ball with a sun",
            ball.with_image(image([32, 16], 40.0), around),
            0.0075,
        ),
    ];
    let bounds = Bounds3::from_points([Vec3::ZERO]);
    let far = 6.0_f32;
    for (name, area, power) in cases {
        let light = Light::Area(area);
        let flux = |random: &mut Random| {
            let u = random.unit4();
            let outward = warp::sample_uniform_sphere(Vec2::new(u[2], u[3]));
            let sample = light.sample_li(outward * far, 0.0, Vec2::new(u[0], u[1]), &Wavelengths::rgb());
            sample.map_or(0.0, |s| {
                let LightDensity::Continuous(pdf) = s.density else {
                    panic!("an area light has a density");
                };
                let cos = (-s.wi.dot(outward)).max(0.0);
                f64::from(s.li.0[0] * cos / pdf.0) * 4.0 * PI * f64::from(far).powi(2)
            })
        };
        let runs = runs_of(|random| (0..16).map(|_| flux(random)).sum::<f64>() / 16.0);
        let stated = f64::from(light.power(&bounds));
        let means = Means {
            significance: 0.01 / 8.0,
            slack: 1e-3,
        };
        let report = means.against_exact(&runs, &[stated]);
        report.assert_agrees(name);
        report.assert_power(name, power, power);
    }
}
