//! Irradiance of lights on a plane, seen as radiance rho E / pi.

use std::f64::consts::PI;

use glam::DVec3;

use super::common::render::Judge;
use super::{check, grey, mean_over, options, quad};

const RHO: f64 = 0.8;
/// The height of the plane.
const Z: f64 = 0.35;
const SPP: u32 = 256;

/// Judges a diffuse plane at z = Z where `lights`, which are white and above it, give the irradiance `e`. The camera looks straight
/// down on x, y in [-2, 2] from just above the plane, so that no light is in its way.
pub(super) fn check_irradiance(name: &str, max_depth: i32, lights: &str, e: impl Fn(DVec3) -> f64) {
    check_with(name, SPP, &options(max_depth), lights, e);
}

pub(super) fn check_with(name: &str, spp: u32, options: &str, lights: &str, e: impl Fn(DVec3) -> f64) {
    let text = format!(
        "LookAt 0 0 0.36  0 0 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [-2 2 -2 2]\n{options}WorldBegin\n\
         {lights}\nMaterial \"diffuse\" \"rgb reflectance\" [{RHO} {RHO} {RHO}]\n{}",
        quad([-3.0, -3.0, Z], [6.0, 0.0, 0.0], [0.0, 6.0, 0.0])
    );
    // Looking down with y up, x grows to the left.
    let block = |i: usize| {
        let (x, y) = (2.0 - (i % 4) as f64, 2.0 - (i / 4) as f64);
        mean_over([x - 1.0, x], [y - 1.0, y], |x, y| RHO / PI * e(DVec3::new(x, y, Z)))
    };
    let expected = grey((0..16).map(block));
    check(name, &text, spp, [2, 2], &Judge::USUAL, |_| expected.clone());
}

#[test]
fn a_sphere_lights_as_its_cross_section() {
    // E = L pi r² / d² cos, where all of the sphere is above the horizon.
    for (center, radius) in [
        (DVec3::new(1.0, -0.5, 3.0), 0.8),
        (DVec3::new(0.4, 0.2, 2.0), 1.5),
        (DVec3::new(2.0, 1.0, 5.0), 0.01),
    ] {
        let DVec3 { x, y, z } = center;
        let l = 2.0 / (radius * radius);
        let light = format!(
            "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [{l} {l} {l}]\n\
             Material \"diffuse\" \"rgb reflectance\" [0 0 0]\nTranslate {x} {y} {z}\n\
             Shape \"sphere\" \"float radius\" {radius}\nAttributeEnd"
        );
        check_irradiance(&format!("sphere of radius {radius}"), 1, &light, |p| {
            let d = center - p;
            l * PI * radius * radius * d.z / d.length().powi(3)
        });
    }
}

/// Lambert's formula: the irradiance of a polygon of radiance 1 that is above the horizon of `p`.
pub(super) fn polygon_irradiance(p: DVec3, normal: DVec3, corners: &[DVec3]) -> f64 {
    let edges = (0..corners.len()).map(|i| {
        let [a, b] = [corners[i] - p, corners[(i + 1) % corners.len()] - p].map(DVec3::normalize);
        let angle = a.cross(b).length().atan2(a.dot(b));
        angle * a.cross(b).normalize().dot(normal)
    });
    0.5 * edges.sum::<f64>().abs()
}

#[test]
fn a_rectangle_lights_as_lambert_says() {
    // Overhead and facing down; and leaning, close to the plane.
    for (corner, a, b) in [
        (
            DVec3::new(-1.0, -0.5, 2.5),
            DVec3::new(0.0, 2.0, 0.0),
            DVec3::new(1.5, 0.0, 0.0),
        ),
        (
            DVec3::new(3.0, -2.0, 0.6),
            DVec3::new(-1.0, 0.5, 1.0),
            DVec3::new(0.3, 4.0, 0.4),
        ),
    ] {
        let light = format!(
            "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [3 3 3] \"bool twosided\" true\n\
             Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n{}AttributeEnd",
            quad(corner.to_array(), a.to_array(), b.to_array())
        );
        let corners = [corner, corner + a, corner + a + b, corner + b];
        check_irradiance(&format!("rectangle at {corner}"), 1, &light, |p| {
            3.0 * polygon_irradiance(p, DVec3::Z, &corners)
        });
    }
}

#[test]
fn a_point_light_follows_the_inverse_square() {
    let at = DVec3::new(1.0, -1.5, 2.0);
    let e = |intensity: f64| {
        move |p: DVec3| {
            let d = at - p;
            intensity * d.z / d.length().powi(3)
        }
    };
    let from = "\"point3 from\" [0.5 -1.5 2]";
    let moved = |parameters: &str| {
        format!("AttributeBegin\nTranslate 0.5 0 0\nLightSource \"point\" {from} {parameters}\nAttributeEnd")
    };
    check_irradiance("intensity", 1, &moved("\"rgb I\" [7 7 7]"), e(7.0));
    // The plane lights nothing that could light it back.
    check_irradiance("intensity, any depth", -1, &moved("\"rgb I\" [7 7 7]"), e(7.0));
    let power = 4.0 * PI * 5.0;
    check_irradiance("power", 1, &moved(&format!("\"float power\" {power}")), e(5.0));
    check_irradiance(
        "power and scale",
        1,
        &moved(&format!(
            "\"rgb I\" [1 1 1] \"float power\" {power} \"float scale\" 0.5"
        )),
        e(2.5),
    );
}

#[test]
fn a_distant_light_follows_the_cosine() {
    let direction = DVec3::new(1.0, 2.0, 2.0) / 3.0;
    let geometry = "\"point3 from\" [1 2 2] \"point3 to\" [0 0 0]";
    for (parameters, e) in [
        ("\"rgb L\" [4 4 4]", 4.0),
        ("\"rgb L\" [1 1 1] \"float illuminance\" 2.5", 2.5),
        ("\"rgb L\" [2 2 2] \"float scale\" 1.5", 3.0),
    ] {
        let light = format!("LightSource \"distant\" {geometry} {parameters}");
        check_irradiance(parameters, 1, &light, |_| e * direction.z);
    }
}

#[test]
fn the_environment_lights_by_pi_times_its_radiance() {
    for (parameters, l) in [
        ("\"rgb L\" [1 1 1]", 1.0),
        ("\"rgb L\" [1 1 1] \"float illuminance\" 5", 5.0 / PI),
        ("\"float scale\" 0.25", 0.25),
    ] {
        check_irradiance(parameters, 1, &format!("LightSource \"infinite\" {parameters}"), |_| {
            PI * l
        });
    }
}

#[test]
fn lights_add_up() {
    let lights = "LightSource \"infinite\" \"rgb L\" [0.2 0.2 0.2]\n\
                  LightSource \"distant\" \"point3 from\" [0 0 1] \"point3 to\" [0 0 0] \"rgb L\" [1.5 1.5 1.5]\n\
                  LightSource \"infinite\" \"rgb L\" [0.1 0.1 0.1]\n\
                  LightSource \"point\" \"point3 from\" [0 0 3.35] \"rgb I\" [9 9 9]";
    for sampler in ["bvh", "power", "uniform"] {
        let by_this = format!("Integrator \"path\" \"string lightsampler\" \"{sampler}\"");
        let options = options(1).replace("Integrator \"path\"", &by_this);
        check_with(&format!("four lights by {sampler}"), 2 * SPP, &options, lights, |p| {
            0.3 * PI + 1.5 + 9.0 * 3.0 / (9.0 + p.x * p.x + p.y * p.y).powf(1.5)
        });
    }
}
