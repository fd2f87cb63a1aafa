//! Exposure of what moves while the shutter is open: a black shape before a white sky leaves of each pixel the share of time and
//! area in which it is elsewhere.

use std::f64::consts::PI;

use super::common::render::Judge;
use super::{check, grey, mean_over, options, quad};

/// The side of the picture from its centre, in scene units.
const SIDE: f64 = 2.0;
/// Blocks of 2 x 2 pixels.
const BLOCKS: usize = 4;
/// A block that is dark for most of the exposure is noisy.
const JUDGE: Judge = Judge { power: (0.1, 0.005) };

/// A scene under a white sky, seen by parallel rays along +z (x to the right, y up); `shutter` is in scene time.
fn scene(before: &str, shutter: [f64; 2], world: &str) -> String {
    let [open, close] = shutter;
    // The sensor multiplies by the exposure time.
    let sky = format!(
        "LightSource \"infinite\" \"rgb L\" [1 1 1] \"float scale\" {}",
        1.0 / (close - open)
    );
    let black = "Material \"diffuse\" \"rgb reflectance\" [0 0 0]";
    view(before, shutter, 0, &format!("{sky}\n{black}\n{world}"))
}

/// A world seen by parallel rays, with paths of `depth` scattering events.
fn view(before: &str, [open, close]: [f64; 2], depth: i32, world: &str) -> String {
    format!(
        "{before}\nCamera \"orthographic\" \"float screenwindow\" [-{SIDE} {SIDE} -{SIDE} {SIDE}] \"float shutteropen\" {open} \
         \"float shutterclose\" {close}\n{}WorldBegin\n{world}",
        options(depth)
    )
}

/// Judges a scene where the point (x, y) of the picture is black for `dark(x, y)` of the exposure.
fn check_exposure(name: &str, text: &str, dark: impl Fn(f64, f64) -> f64) {
    let size = 2.0 * SIDE / BLOCKS as f64;
    let block = |i: usize| {
        let x = -SIDE + size * (i % BLOCKS) as f64;
        let y = SIDE - size * (i / BLOCKS) as f64;
        mean_over([x, x + size], [y - size, y], |x, y| 1.0 - dark(x, y))
    };
    let expected = grey((0..BLOCKS * BLOCKS).map(block));
    check(name, text, 1024, [2, 2], &JUDGE, |_| expected.clone());
}

/// The share of [open, close] within [a, b].
fn share([open, close]: [f64; 2], [a, b]: [f64; 2]) -> f64 {
    (b.min(close) - a.max(open)).max(0.0) / (close - open)
}

/// An edge that covers all beyond x = -1 + 2 t at scene time t.
fn edge_passes(shutter: [f64; 2]) -> impl Fn(f64, f64) -> f64 {
    move |x, _| {
        // Outside of scene time nothing moves.
        let uncovered = (x + 1.0) / 2.0;
        let until = if x < -1.0 {
            f64::NEG_INFINITY
        } else if x >= 1.0 {
            f64::INFINITY
        } else {
            uncovered
        };
        share(shutter, [f64::NEG_INFINITY, until])
    }
}

const SHUTTERS: [[f64; 2]; 3] = [[0.0, 1.0], [0.25, 0.75], [-0.5, 0.5]];

#[test]
fn vertices_move_on_straight_lines() {
    let positions = |x: f64| format!("{x} -9 2  9 -9 2  9 9 2  {x} 9 2");
    for shutter in SHUTTERS {
        let mesh = format!(
            "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [{}] \"point3 P1\" [{}]",
            positions(-1.0),
            positions(1.0)
        );
        check_exposure(
            &format!("moving vertices, shutter {shutter:?}"),
            &scene("", shutter, &mesh),
            edge_passes(shutter),
        );
    }
}

#[test]
fn shapes_instances_and_cameras_move_alike() {
    let shape = quad([-1.0, -9.0, 2.0], [10.0, 0.0, 0.0], [0.0, 18.0, 0.0]);
    let moved = "ActiveTransform EndTime\nTranslate 2 0 0\nActiveTransform All\n";
    for shutter in SHUTTERS {
        let world = format!("{moved}{shape}");
        check_exposure(
            &format!("moving shape, shutter {shutter:?}"),
            &scene("", shutter, &world),
            edge_passes(shutter),
        );
        let world = format!("ObjectBegin \"o\"\n{shape}ObjectEnd\n{moved}ObjectInstance \"o\"");
        check_exposure(
            &format!("moving instance, shutter {shutter:?}"),
            &scene("", shutter, &world),
            edge_passes(shutter),
        );
        // The camera's own transform goes from the world to the camera: the world moves as the shape did.
        check_exposure(
            &format!("moving camera, shutter {shutter:?}"),
            &scene(moved, shutter, &shape),
            edge_passes(shutter),
        );
    }
}

#[test]
fn scene_time_runs_over_the_transform_times() {
    let shape = quad([-1.0, -9.0, 2.0], [10.0, 0.0, 0.0], [0.0, 18.0, 0.0]);
    let world = format!("ActiveTransform EndTime\nTranslate 2 0 0\nActiveTransform All\n{shape}");
    // From 10 to 14: the shutter is open in the second quarter of the motion.
    let text = scene("TransformTimes 10 14", [11.0, 12.0], &world);
    check_exposure("transform times", &text, edge_passes([0.25, 0.5]));
}

#[test]
fn a_sphere_flies_past() {
    // From x = -1.5 to 1.5, radius 0.7: a point at height y is hidden while the centre is within sqrt(r² - y²).
    const RADIUS: f64 = 0.7;
    let world = format!(
        "ActiveTransform StartTime\nTranslate -1.5 0.3 3\nActiveTransform EndTime\nTranslate 1.5 0.3 3\nActiveTransform All\n\
         Shape \"sphere\" \"float radius\" {RADIUS}"
    );
    let shutter = [0.2, 1.0];
    check_exposure("sphere", &scene("", shutter, &world), |x, y| {
        let half = (RADIUS * RADIUS - (y - 0.3).powi(2)).max(0.0).sqrt();
        let at = |x: f64| (x + 1.5) / 3.0;
        if half == 0.0 {
            0.0
        } else {
            share(shutter, [at(x - half), at(x + half)])
        }
    });
}

#[test]
fn rotation_goes_at_a_constant_rate() {
    // A quarter of the plane, from azimuth 0 to 90 degrees, turns by 120 degrees about the line of sight.
    let wedge = quad([0.0, 0.0, 2.0], [20.0, 0.0, 0.0], [0.0, 20.0, 0.0]);
    let turn = "ActiveTransform EndTime\nRotate 120 0 0 1\nActiveTransform All\n";
    let dark = |x: f64, y: f64| {
        let azimuth = y.atan2(x) * 180.0 / PI;
        let azimuth = if azimuth < 0.0 { azimuth + 360.0 } else { azimuth };
        share([0.0, 1.0], [(azimuth - 90.0) / 120.0, azimuth / 120.0])
    };
    let world = format!("{turn}{wedge}");
    check_exposure("turning shape", &scene("", [0.0, 1.0], &world), dark);
    let world = format!("ObjectBegin \"o\"\n{wedge}ObjectEnd\n{turn}ObjectInstance \"o\"");
    check_exposure("turning instance", &scene("", [0.0, 1.0], &world), dark);
    // Scaled as well: the wedge stays the same.
    let world = format!(
        "ActiveTransform EndTime\nRotate 120 0 0 1\nScale 2 2 2\nActiveTransform All\nScale 0.5 0.5 1\n{wedge}"
    );
    check_exposure("turning and growing", &scene("", [0.0, 1.0], &world), dark);
}

/// A shutter blade behind the camera moves between a distant lamp and the wall that it lights: shadow rays have the time of their path.
#[test]
fn shadows_move_with_what_casts_them() {
    let blade = quad([-1.0, -9.0, -1.0], [10.0, 0.0, 0.0], [0.0, 18.0, 0.0]);
    let moved = "ActiveTransform EndTime\nTranslate 2 0 0\nActiveTransform All\n";
    let wall = quad([-9.0, -9.0, 2.0], [0.0, 18.0, 0.0], [18.0, 0.0, 0.0]);
    let object = format!("ObjectBegin \"o\"\n{blade}ObjectEnd\n{moved}ObjectInstance \"o\"");
    for (name, world) in [("shape", format!("{moved}{blade}")), ("instance", object)] {
        for shutter in [[0.0, 1.0], [0.25, 0.75]] {
            let lit = format!(
                "LightSource \"distant\" \"rgb L\" [1 1 1] \"point3 from\" [0 0 -1] \"point3 to\" [0 0 0] \"float scale\" {}\n\
                 Material \"diffuse\" \"rgb reflectance\" [1 1 1]\n{wall}{world}",
                PI / (shutter[1] - shutter[0])
            );
            let text = view("", shutter, 1, &lit);
            check_exposure(
                &format!("shadow of a moving {name}, {shutter:?}"),
                &text,
                edge_passes(shutter),
            );
        }
    }
}
