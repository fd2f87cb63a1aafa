//! Shapes that rays pass with the probability 1 - alpha: means behind one, two and both sides of one, for rays from the camera and
//! for shadow rays; and lights on them.

use std::f64::consts::PI;

use glam::DVec3;

use super::irradiance::polygon_irradiance;
use super::{check, grey, mean_over, options, quad};
use crate::common::render::Judge;

/// A ray passes or does not: half a percent of the whole would take four times as long.
const JUDGE: Judge = Judge { power: (0.05, 0.01) };

/// Judges a picture of one grey.
fn check_alpha(name: &str, text: &str, spp: u32, expected: f64) {
    check(name, text, spp, [4, 4], &JUDGE, |_| grey([expected; 4]));
}

/// Black walls with an `alpha` at some depths, before an environment of radiance 2.
fn walls(depths: &[f64], alpha: &str) -> String {
    let wall = |z: &f64| quad([-5.0, -5.0, *z], [0.0, 10.0, 0.0], [10.0, 0.0, 0.0]);
    let walls: String = depths.iter().map(wall).collect();
    let walls = walls.replace("\"trianglemesh\"", &format!("\"trianglemesh\" {alpha}"));
    format!(
        "Camera \"perspective\" \"float fov\" 30\n{}WorldBegin\nLightSource \"infinite\" \"rgb L\" [2 2 2]\n\
         Texture \"half\" \"float\" \"constant\" \"float value\" 0.5\n\
         Texture \"half-there\" \"float\" \"scale\" \"texture tex\" \"half\" \"float scale\" 0.5\n\
         Texture \"ramp\" \"float\" \"bilerp\"\n\
         Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n{walls}",
        options(3)
    )
}

#[test]
fn rays_pass_a_wall_as_its_alpha_says() {
    for (name, depths, alpha, passes) in [
        ("one wall", &[5.0][..], "\"float alpha\" 0.3", 0.7),
        ("two walls", &[5.0, 6.0], "\"float alpha\" 0.3", 0.49),
        ("a texture", &[5.0], "\"texture alpha\" \"half-there\"", 0.75),
        ("nothing there", &[5.0], "\"float alpha\" 0", 1.0),
        ("all there", &[5.0], "\"float alpha\" 1", 0.0),
    ] {
        check_alpha(name, &walls(depths, alpha), 1024, 2.0 * passes);
    }
}

#[test]
fn both_sides_of_a_sphere_count() {
    let text = format!(
        "Camera \"perspective\" \"float fov\" 8\n{}WorldBegin\nLightSource \"infinite\" \"rgb L\" [1 1 1]\n\
         Material \"diffuse\" \"rgb reflectance\" [0 0 0]\nTranslate 0 0 10\nShape \"sphere\" \"float radius\" 2 \"float alpha\" 0.4",
        options(3)
    );
    check_alpha("a sphere", &text, 1024, 0.36);
    // Within an instance that moves, too.
    let moving = text.replace("Translate 0 0 10\nShape", "ObjectBegin \"ball\" Shape")
        + "\nObjectEnd ActiveTransform EndTime Translate 0.2 0 0 ActiveTransform All Translate 0 0 10 ObjectInstance \"ball\"";
    check_alpha("a moving sphere", &moving, 1024, 0.36);
}

/// A wall whose alpha rises from 0 to 1 lets less and less through.
#[test]
fn alpha_follows_its_texture() {
    // Bilerp's default is 0 at v = 0 and 1 at v = 1. The wall fills the view exactly: the field of view is 90 degrees.
    let text = walls(&[5.0], "\"texture alpha\" \"ramp\"")
        // u runs along y, and v along x: to the right of the picture.
        .replace("\"float fov\" 30", "\"float fov\" 90");
    let expected = grey((0..4).map(|i| {
        let column = f64::from(i % 2);
        2.0 * (1.0 - (0.25 + 0.5 * column))
    }));
    check("a ramp", &text, 1024, [4, 4], &JUDGE, |_| expected.clone());
}

#[test]
fn shadow_rays_pass_as_well() {
    // A point light 2 above a plane; a screen of alpha 0.4 between. Seen from above the screen only what passes it twice.
    let text = |alpha: &str| {
        format!(
            "LookAt 0 0 0.5  0 0 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [-0.1 0.1 -0.1 0.1]\n{}WorldBegin\n\
             LightSource \"point\" \"rgb I\" [10 10 10] \"point3 from\" [0 0 2]\n\
             Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n{}{}",
            options(1),
            quad([-3.0, -3.0, 0.0], [6.0, 0.0, 0.0], [0.0, 6.0, 0.0]),
            quad([-3.0, -3.0, 1.0], [6.0, 0.0, 0.0], [0.0, 6.0, 0.0])
                .replace("\"trianglemesh\"", &format!("\"trianglemesh\" {alpha}"))
        )
    };
    // The light is so nearly overhead that E = I / d² to 0.5 %, less 3 r² / (2 d²), of which the mean r² is 2 / 3 of 0.01.
    let e = 10.0 / 4.0 * (1.0 - 1.5 * (0.02 / 3.0) / 4.0);
    for (name, alpha, passes) in [
        ("a screen", "\"float alpha\" 0.4", 0.6),
        ("a textured screen", "\"texture alpha\" \"t\"", 0.5),
    ] {
        let texture = "WorldBegin\nTexture \"t\" \"float\" \"constant\" \"float value\" 0.5";
        let text = text(alpha).replace("WorldBegin", texture);
        check_alpha(name, &text, 1024, 0.5 / PI * e * passes);
    }
}

/// A lamp of alpha a lights as if it sent a times as much; one of alpha 0, as in pbrt-v4, all of it, but is not seen.
#[test]
fn a_lamp_may_have_an_alpha() {
    let text = |alpha: f64, depth: i32| {
        format!(
            "LookAt 0 0 0.5  0 0 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [-0.1 0.1 -0.1 0.1]\n{}WorldBegin\n\
             Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n{}\
             AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [3 3 3]\nMaterial \"diffuse\" \"rgb reflectance\" [0 0 0]\n\
             Translate 0 0 3 Shape \"sphere\" \"float radius\" 1 \"float alpha\" {alpha}\nAttributeEnd",
            options(depth),
            quad([-3.0, -3.0, 0.0], [6.0, 0.0, 0.0], [0.0, 6.0, 0.0])
        )
    };
    // E = L pi sin² for a sphere overhead; within 0.1 of the axis it falls by less than 2e-3: 1 - 1.5 r² / d².
    let e = 3.0 * PI / 9.0 * (1.0 - 1.5 * (0.02 / 3.0) / 9.0);
    for (alpha, sends) in [(1.0, 1.0), (0.25, 0.25), (0.0, 1.0)] {
        check_alpha(&format!("alpha {alpha}"), &text(alpha, 1), 1024, 0.5 / PI * e * sends);
    }
}

/// A white plane, of x, y in [-1, 1], below a lamp, by directions of the BSDF, by points of the lamp, and by both; `e` is the
/// irradiance at a point of the plane.
fn check_lamp(name: &str, lamp: &str, e: impl Fn(DVec3) -> f64) {
    for strategy in ["bsdf", "light", "mis"] {
        let options = options(1).replace(
            "\"integer maxdepth\"",
            &format!("\"string strategy\" \"{strategy}\" \"integer maxdepth\""),
        );
        let text = format!(
            "LookAt 0 0 0.5  0 0 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [-1 1 -1 1]\n{options}WorldBegin\n\
             Material \"diffuse\" \"rgb reflectance\" [1 1 1]\n{}{lamp}",
            quad([-3.0, -3.0, 0.0], [6.0, 0.0, 0.0], [0.0, 6.0, 0.0])
        );
        // Looking down with y up, x grows to the left.
        let block = |i: usize| {
            let (x, y) = (1.0 - (i % 2) as f64, 1.0 - (i / 2) as f64);
            mean_over([x - 1.0, x], [y - 1.0, y], |x, y| e(DVec3::new(x, y, 0.0)) / PI)
        };
        let expected = grey((0..4).map(block));
        check(&format!("{name}, {strategy}"), &text, 1024, [4, 4], &JUDGE, |_| {
            expected.clone()
        });
    }
}

/// A lamp of six fields, every other one half as solid; it hangs askew, so that each part of the plane sees others.
#[test]
fn a_lamp_with_a_checkerboard_for_alpha_lights_by_fields() {
    let (corner, a, b) = (
        DVec3::new(-1.0, -1.2, 0.8),
        DVec3::new(0.0, 2.0, 0.4),
        DVec3::new(1.8, 0.0, 0.2),
    );
    let shape = quad(corner.to_array(), a.to_array(), b.to_array());
    let lamp = format!(
        "Texture \"fields\" \"float\" \"checkerboard\" \"float uscale\" 3 \"float vscale\" 2 \"float tex1\" 1 \"float tex2\" 0.25\n\
         AreaLightSource \"diffuse\" \"rgb L\" [3 3 3]\nMaterial \"diffuse\" \"rgb reflectance\" [0 0 0]\n{}",
        shape.replace("\"trianglemesh\"", "\"trianglemesh\" \"texture alpha\" \"fields\"")
    );
    check_lamp("a checkerboard", &lamp, |p| {
        let fields = (0..6).map(|i| {
            let (row, column) = (i % 3, i / 3);
            let at = |r: usize, c: usize| corner + a * (r as f64 / 3.0) + b * (c as f64 / 2.0);
            let field = [
                at(row, column),
                at(row + 1, column),
                at(row + 1, column + 1),
                at(row, column + 1),
            ];
            let alpha = if (row + column) % 2 == 0 { 1.0 } else { 0.25 };
            3.0 * alpha * polygon_irradiance(p, DVec3::Z, &field)
        });
        fields.sum()
    });
}

/// A ball that fades towards its south pole; the other is turned to the plane, a little aslant. A ray that passes it in front meets the dark inside.
#[test]
fn a_ball_with_a_ramp_for_alpha_lights_by_latitude() {
    let lamp = "Texture \"ramp\" \"float\" \"bilerp\" \"float v00\" 0.3 \"float v10\" 0.3 \"float v01\" 1 \"float v11\" 1\n\
                AreaLightSource \"diffuse\" \"rgb L\" [3 3 3]\nMaterial \"diffuse\" \"rgb reflectance\" [0 0 0]\n\
                Translate 0.3 -0.2 1.6 Rotate 140 1 0 0\nShape \"sphere\" \"float radius\" 0.95 \"texture alpha\" \"ramp\"";
    const STEPS: usize = 48;
    let (center, radius) = (DVec3::new(0.3, -0.2, 1.6), 0.95);
    let turn = glam::DMat3::from_rotation_x(140.0_f64.to_radians());
    // Uniform over the cone of directions in which the ball is seen.
    check_lamp("a ramp on a ball", lamp, |p| {
        let to_center = center - p;
        let (axis, distance) = (to_center.normalize(), to_center.length());
        let widest = 1.0 - (1.0 - (radius / distance).powi(2)).sqrt();
        let (s, t) = axis.any_orthonormal_pair();
        let mut sum = 0.0;
        for i in 0..STEPS * STEPS {
            let cos = 1.0 - widest * ((i % STEPS) as f64 + 0.5) / STEPS as f64;
            let (sin_phi, cos_phi) = (2.0 * PI * ((i / STEPS) as f64 + 0.5) / STEPS as f64).sin_cos();
            let sin = (1.0 - cos * cos).sqrt();
            let w = s * (sin * cos_phi) + t * (sin * sin_phi) + axis * cos;
            let far = distance * cos - (radius * radius - (distance * sin).powi(2)).max(0.0).sqrt();
            let outward = turn.transpose() * (p + w * far - center) / radius;
            let v = 1.0 - outward.z.clamp(-1.0, 1.0).acos() / PI;
            sum += 3.0 * (0.3 + 0.7 * v) * w.z;
        }
        sum / (STEPS * STEPS) as f64 * 2.0 * PI * widest
    });
}
