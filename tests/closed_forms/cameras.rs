//! Where things are in a picture, and how sharp: projections, the near plane, the lens.

use std::f64::consts::PI;

use super::common::render::Judge;
use super::common::{effort, full_tier};
use super::{check, grey, mean_along, options, quad};

/// An emitter of radiance 1 on both sides.
fn lamp(shape: &str) -> String {
    format!(
        "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"bool twosided\" true\n\
         Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n{shape}AttributeEnd\n"
    )
}

/// The share of [a, b] inside of [from, to].
fn overlap([a, b]: [f64; 2], [from, to]: [f64; 2]) -> f64 {
    (b.min(to) - a.max(from)).max(0.0) / (b - a)
}

/// The interval of pixel `i` of 8 where coordinates run from `from` to `to`, in order.
fn pixel(i: usize, from: f64, to: f64) -> [f64; 2] {
    let at = |i: usize| from + (to - from) * i as f64 / 8.0;
    let (a, b) = (at(i), at(i + 1));
    [a.min(b), a.max(b)]
}

/// The share of each pixel that a lamp over [x0, x1] x [y0, y1] covers, where the picture shows `window` = [left, right, bottom,
/// top].
fn covered(window: [f64; 4], x: [f64; 2], y: [f64; 2]) -> Vec<f64> {
    let [left, right, bottom, top] = window;
    grey((0..64).map(|i| overlap(pixel(i % 8, left, right), x) * overlap(pixel(i / 8, top, bottom), y)))
}

/// Edges leave pixels that are partly covered: a block is a pixel, and an eighth of one is noticed; a twentieth in the full tier.
fn edges() -> Judge {
    let block = if full_tier() { 0.05 } else { 0.13 };
    Judge { power: (block, 0.005) }
}

/// Samples a pixel, so many in the usual tier.
fn spp(usual: u32) -> u32 {
    usual * effort(4) as u32
}

#[test]
fn a_perspective_camera_sees_what_its_angle_says() {
    // The default camera looks along +z, x to the right, y up; at depth 4 and 60 degrees it sees 4 tan 30 to each side.
    let side = 4.0 * (PI / 6.0).tan();
    let lamp = lamp(&quad([0.25, -1.0, 4.0], [1.2, 0.0, 0.0], [0.0, 2.6, 0.0]));
    let (x, y) = ([0.25, 1.45], [-1.0, 1.6]);
    for (camera, window) in [
        ("\"float fov\" 60", [-side, side, -side, side]),
        (
            "\"float fov\" 60 \"float frameaspectratio\" 2",
            [-2.0 * side, 2.0 * side, -side, side],
        ),
        (
            "\"float fov\" 60 \"float screenwindow\" [-0.2 0.8 -0.5 1]",
            [-0.2 * side, 0.8 * side, -0.5 * side, side],
        ),
    ] {
        let text = format!("Camera \"perspective\" {camera}\n{}WorldBegin\n{lamp}", options(0));
        check(camera, &text, spp(1024), [1, 1], &edges(), |_| covered(window, x, y));
    }
    // From the other side, x runs the other way.
    let text = format!(
        "LookAt 0 0 8  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 60\n{}WorldBegin\n{lamp}",
        options(0)
    );
    let window = [side, -side, -side, side];
    check("from behind", &text, spp(1024), [1, 1], &edges(), |_| {
        covered(window, x, y)
    });
}

#[test]
fn an_orthographic_camera_sees_its_screen_window() {
    let lamp = lamp(&quad([0.3, -1.0, 4.0], [1.2, 0.0, 0.0], [0.0, 2.65, 0.0]));
    for (camera, window) in [
        ("", [-1.0, 1.0, -1.0, 1.0]),
        ("\"float screenwindow\" [-1 2.2 -2 2]", [-1.0, 2.2, -2.0, 2.0]),
    ] {
        let text = format!("Camera \"orthographic\" {camera}\n{}WorldBegin\n{lamp}", options(0));
        check(camera, &text, spp(1024), [1, 1], &edges(), |_| {
            covered(window, [0.3, 1.5], [-1.0, 1.65])
        });
    }
}

#[test]
fn rays_start_on_the_near_plane() {
    let lamps = lamp(&quad([-20.0, -20.0, 5.0], [40.0, 0.0, 0.0], [0.0, 40.0, 0.0]));
    let screen = "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n".to_owned()
        + &quad([0.0, -20.0, 2.0], [40.0, 0.0, 0.0], [0.0, 40.0, 0.0]);
    for (near, right) in [(0.0, 0.0), (1.99, 0.0), (2.01, 1.0), (4.99, 1.0)] {
        let text = format!(
            "Camera \"perspective\" \"float fov\" 100 \"float nearclip\" {near}\n{}WorldBegin\n{lamps}{screen}",
            options(0)
        );
        let expected = grey((0..64).map(|i| if i % 8 < 4 { 1.0 } else { right }));
        check(
            &format!("near plane at {near}"),
            &text,
            spp(256),
            [1, 1],
            &edges(),
            |_| expected.clone(),
        );
    }
}

/// A lamp over all x > EDGE at depth Z, through a lens that is focused elsewhere: a pixel sees it through a segment of the lens.
#[test]
fn a_lens_blurs_what_is_out_of_focus() {
    const EDGE: f64 = 0.1;
    const Z: f64 = 3.0;
    let lamp = lamp(&quad([EDGE, -50.0, Z], [100.0, 0.0, 0.0], [0.0, 100.0, 0.0]));
    for (radius, focus) in [(0.8, 6.0), (0.3, 1.0), (0.8, 3.0), (1.5, 1e6)] {
        let circle = radius * (1.0 - Z / focus).abs();
        // The share of a disk of radius `circle` beyond a chord at distance s of its centre.
        let beyond = |s: f64| {
            let s = if circle == 0.0 { s * f64::INFINITY } else { s / circle };
            let s = s.clamp(-1.0, 1.0);
            (s.acos() - s * (1.0 - s * s).sqrt()) / PI
        };
        let column = |i: usize| mean_along(pixel(i, -Z, Z), |x| beyond(EDGE - x));
        let expected = grey((0..8).map(column));
        let text = format!(
            "Camera \"perspective\" \"float fov\" 90 \"float lensradius\" {radius} \"float focaldistance\" {focus}\n\
             {}WorldBegin\n{lamp}",
            options(0)
        );
        let name = format!("lens of {radius} focused at {focus}");
        check(&name, &text, spp(512), [1, 8], &edges(), |_| expected.clone());
        // Parallel rays: the same circle of confusion.
        let text = format!(
            "Camera \"orthographic\" \"float screenwindow\" [-{Z} {Z} -{Z} {Z}] \"float lensradius\" {radius}\n\
             \"float focaldistance\" {focus}\n{}WorldBegin\n{lamp}",
            options(0)
        );
        check(
            &format!("orthographic {name}"),
            &text,
            spp(512),
            [1, 8],
            &edges(),
            |_| expected.clone(),
        );
    }
}
