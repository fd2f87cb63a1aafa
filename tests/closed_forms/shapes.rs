//! Disks, cylinders, parts of spheres and bilinear patches: what they light, and closed rooms made of them.

use std::f64::consts::PI;

use glam::DVec3;

use super::irradiance::{check_irradiance, check_with, polygon_irradiance};
use super::{check_uniform, options};
use lucerna::spectrum::ColorMode;

/// A light of radiance `l`, black otherwise.
fn lamp(l: f64, two_sided: bool, transform: &str, shape: &str) -> String {
    format!(
        "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [{l} {l} {l}] \"bool twosided\" {two_sided}\n\
         Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n{transform}\nShape {shape}\nAttributeEnd"
    )
}

/// A disk of radius r at height h above a point that is a from its axis: E / L = pi / 2 (1 - (h² + a² - r²) / sqrt((h² + a² + r²)² -
/// 4 a² r²)).
fn disk_irradiance(h: f64, a: f64, r: f64) -> f64 {
    let (h2, a2, r2) = (h * h, a * a, r * r);
    let root = ((h2 + a2 + r2).powi(2) - 4.0 * a2 * r2).sqrt();
    0.5 * PI * (1.0 - (h2 + a2 - r2) / root)
}

#[test]
fn a_disk_lights_as_known_and_its_hole_does_not() {
    // Its normal is up: turned over it faces the plane.
    let turned = "Translate 0.5 -0.3 2 Rotate 180 1 0 0";
    let a = |p: DVec3| (p - DVec3::new(0.5, -0.3, 0.0)).truncate().length();
    check_irradiance(
        "disk",
        1,
        &lamp(2.0, false, turned, "\"disk\" \"float radius\" 1.2"),
        |p| 2.0 * disk_irradiance(2.0 - p.z, a(p), 1.2),
    );
    let ring = "\"disk\" \"float radius\" 1.2 \"float innerradius\" 0.8 \"float height\" -0.5";
    check_irradiance("ring", 1, &lamp(2.0, false, turned, ring), |p| {
        let h = 2.5 - p.z;
        2.0 * (disk_irradiance(h, a(p), 1.2) - disk_irradiance(h, a(p), 0.8))
    });
    // Half a disk and the other half.
    let half = "\"disk\" \"float radius\" 1.2 \"float phimax\" 180";
    let both = format!(
        "{}\n{}",
        lamp(2.0, false, turned, half),
        lamp(2.0, false, &format!("{turned} Rotate 180 0 0 1"), half)
    );
    check_irradiance("two halves", 1, &both, |p| 2.0 * disk_irradiance(2.0 - p.z, a(p), 1.2));
    // Seen from behind it is dark.
    let up = "Translate 0.5 -0.3 2";
    let dim = format!(
        "{}\nLightSource \"distant\" \"point3 from\" [0 0 1] \"point3 to\" [0 0 0] \"rgb L\" [0 0 0]",
        lamp(1.0, true, turned, "\"disk\"")
    );
    check_irradiance("two-sided disk", 1, &dim, |p| disk_irradiance(2.0 - p.z, a(p), 1.0));
    let reversed = lamp(1.0, false, &format!("ReverseOrientation {up}"), "\"disk\"");
    check_irradiance("reversed disk", 1, &reversed, |p| disk_irradiance(2.0 - p.z, a(p), 1.0));
}

/// The irradiance of a surface of radiance 1, above the horizon and hiding none of itself, by the midpoint rule: `point` gives a point
/// and the unit normal times the area element, by parameters in [0, 1]². `side` is -1 if it emits against the normal, 0 if on both
/// sides.
fn surface_irradiance(p: DVec3, side: f64, point: impl Fn(f64, f64) -> (DVec3, DVec3)) -> f64 {
    const STEPS: usize = 96;
    let at = |i: usize| (i as f64 + 0.5) / STEPS as f64;
    let sum: f64 = (0..STEPS * STEPS)
        .map(|i| {
            let (q, n) = point(at(i % STEPS), at(i / STEPS));
            let d = q - p;
            let cos = if side == 0.0 {
                n.dot(d).abs()
            } else {
                (-side * n.dot(d)).max(0.0)
            };
            d.z.max(0.0) * cos / d.length_squared().powi(2)
        })
        .sum();
    sum / (STEPS * STEPS) as f64
}

#[test]
fn a_cylinder_lights_as_its_quadrature() {
    // Lying above the plane, its axis along x; its outside shines.
    let (radius, length, height) = (0.5, 2.0, 1.6);
    let transform = format!("Translate 0 0 {height} Rotate 90 0 1 0");
    let shape = format!("\"cylinder\" \"float radius\" {radius} \"float zmin\" -1 \"float zmax\" 1");
    let point = |s: f64, t: f64| {
        let (sin, cos) = (2.0 * PI * s).sin_cos();
        let n = DVec3::new(0.0, cos, sin);
        let q = n * radius + DVec3::new(length * (t - 0.5), 0.0, height);
        (q, n * (2.0 * PI * radius * length))
    };
    check_with(
        "cylinder",
        2048,
        &options(1),
        &lamp(3.0, false, &transform, &shape),
        |p| 3.0 * surface_irradiance(p, 1.0, point),
    );
}

#[test]
fn a_dome_lights_as_all_of_the_sky_that_it_fills() {
    // It begins below the plane, so that nothing else is seen from there.
    let dome = "\"sphere\" \"float radius\" 6 \"float zmin\" 0.2";
    let lights = lamp(1.5, false, "ReverseOrientation", dome);
    check_irradiance("dome", 1, &lights, |_| 1.5 * PI);
}

#[test]
fn patches_light_as_their_quadrature() {
    let flat = [
        DVec3::new(-1.0, -0.5, 2.0),
        DVec3::new(1.5, -0.8, 2.0),
        DVec3::new(-0.5, 1.0, 2.0),
        DVec3::new(0.5, 0.9, 2.0),
    ];
    let twisted = [
        DVec3::new(-1.0, -0.9, 1.6),
        DVec3::new(1.1, -0.8, 2.4),
        DVec3::new(-0.9, 1.0, 2.3),
        DVec3::new(0.8, 0.9, 1.5),
    ];
    let light = |corners: &[DVec3; 4]| {
        let points: Vec<String> = corners.iter().map(|p| format!("{} {} {}", p.x, p.y, p.z)).collect();
        let shape = format!("\"bilinearmesh\" \"point3 P\" [{}]", points.join("  "));
        lamp(2.0, true, "", &shape)
    };
    check_irradiance("flat patch", 1, &light(&flat), |p| {
        let [a, b, c, d] = flat;
        2.0 * polygon_irradiance(p, DVec3::Z, &[a, b, d, c])
    });
    check_irradiance("twisted patch", 1, &light(&twisted), |p| {
        let [a, b, c, d] = twisted;
        2.0 * surface_irradiance(p, 0.0, |u, v| {
            let q = a.lerp(b, u).lerp(c.lerp(d, u), v);
            let (dpdu, dpdv) = ((b - a).lerp(d - c, v), (c - a).lerp(d - b, u));
            (q, dpdu.cross(dpdv))
        })
    });
}

/// Closed rooms of emission 1 and albedo 1/2: 2 everywhere, whatever they are made of. Hits, shadow rays and light samples must mean
/// the same surface.
#[test]
fn closed_rooms_have_their_radiance() {
    let can = "Shape \"cylinder\" \"float radius\" 2 \"float zmin\" -1.5 \"float zmax\" 2.5
        AttributeBegin Translate 0 0 2.5 Shape \"disk\" \"float radius\" 2 AttributeEnd
        AttributeBegin Translate 0 0 -1.5 Rotate 180 1 0 0 Shape \"disk\" \"float radius\" 2 AttributeEnd";
    let half = "Shape \"cylinder\" \"float radius\" 2 \"float zmin\" -1.5 \"float zmax\" 2.5 \"float phimax\" 180
        Shape \"disk\" \"float radius\" 2 \"float height\" 2.5 \"float phimax\" 180
        AttributeBegin ReverseOrientation Shape \"disk\" \"float radius\" 2 \"float height\" -1.5 \"float phimax\" 180 AttributeEnd";
    let halves = format!("{half} Rotate 180 0 0 1 {half}");
    let globe =
        "Shape \"sphere\" \"float radius\" 2 \"float zmin\" 0.5 Shape \"sphere\" \"float radius\" 2 \"float zmax\" 0.5";
    // A box with a lid of four patches that are not flat, its walls up to their rim of flat ones.
    let tent = "Shape \"bilinearmesh\" \"point3 P\" [
        -2 -2 -2  2 -2 -2  2 2 -2  -2 2 -2   -2 -2 1  2 -2 2  2 2 1  -2 2 2 ]
        \"integer indices\" [1 0 2 3  0 1 4 5  1 2 5 6  2 3 6 7  3 0 7 4  4 5 7 6]";
    for (name, shapes) in [
        ("can", can.to_owned()),
        ("two halves of a can", halves),
        ("globe of two parts", globe.to_owned()),
        ("stretched globe", format!("Scale 1 0.6 1.4 Rotate 30 1 1 0 {globe}")),
        ("tent", tent.to_owned()),
    ] {
        let text = format!(
            "Camera \"perspective\" \"float fov\" 100\n{}WorldBegin\nTranslate 0.2 -0.3 0.1\n\
             AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"bool twosided\" true\n\
             Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n{shapes}\n",
            options(-1)
        );
        check_uniform(name, &text, 128, |_: ColorMode| [2.0; 3]);
    }
}
