//! Light stays on its side of walls, and does not go around corners.

use lucerna::integrator::Integrator;
use lucerna::spectrum::ColorMode;

use crate::common::render::{Built, parse, usual_combinations};
use crate::{build, film, photon, quad, sppm};
use lucerna::scene::ViewOverrides;

const RADIUS: f32 = 0.2;

fn both() -> [Integrator; 2] {
    let two_pass = photon(None, |p| {
        p.caustic_photons = Some(20_000);
        p.global_photons = Some(20_000);
        p.max_distance = Some(RADIUS);
        p.passes = 4;
        p.final_gather_samples = 8;
    });
    [two_pass, sppm(None, 40_000, RADIUS)]
}

fn picture(built: &Built, integrator: Integrator) -> Vec<f32> {
    let overrides = ViewOverrides {
        spp: Some(4),
        ..ViewOverrides::default()
    };
    let (picture, stats) = built.picture_with(&built.view(0, &overrides), integrator);
    assert_eq!(stats.dropped_samples, 0, "dropped: {:?}", stats.dropped);
    assert!(
        stats.global_photons.stored > 1000 && stats.caustic_photons.stored > 1000,
        "{stats:?}"
    );
    picture
}

/// A lamp, a ball of glass and a white plate on the side x < 0 of a wall across a floor from `floor_from` to `floor_to`. What passes
/// over the wall rises, and is gone.
fn divided(camera: &str, wall: &str, [floor_from, floor_to]: [f64; 2]) -> String {
    format!(
        "{camera}{}WorldBegin\nLightSource \"point\" \"point3 from\" [-1 0 1.5] \"rgb I\" [3 3 3]\n\
         AttributeBegin Material \"dielectric\" Translate -0.6 0 0.6 Shape \"sphere\" \"float radius\" 0.3 AttributeEnd\n\
         Material \"diffuse\" \"rgb reflectance\" [0.8 0.8 0.8]\n{}{}{wall}",
        film([16, 16]),
        quad([-2.0, -2.0, 0.0], [0.0, 0.0, 2.0], [0.0, 4.0, 0.0]),
        quad(
            [floor_from, -2.0, 0.0],
            [floor_to - floor_from, 0.0, 0.0],
            [0.0, 4.0, 0.0]
        ),
    )
}

fn mean(picture: &[f32]) -> f32 {
    picture.iter().sum::<f32>() / picture.len() as f32
}

fn wall(x: f64) -> String {
    quad([x, -2.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 2.0])
}

fn camera_at(eye: &str, at: &str, up: &str, window: &str) -> String {
    format!("LookAt {eye}  {at}  {up}\nCamera \"orthographic\" \"float screenwindow\" [{window}]\n")
}

#[test]
fn the_back_of_a_lit_wall_is_black() {
    let behind = camera_at("3 0 1", "0 0 1", "0 0 1", "-0.8 0.8 -0.8 0.8");
    let front = camera_at("-0.2 0 1", "0 0 1", "0 0 1", "-0.8 0.8 -0.8 0.8");
    for (backend, color) in usual_combinations("wall") {
        for sheets in [
            wall(0.0),
            wall(0.0) + &wall(1e-3),
            wall(0.0) + &wall(1e-4) + &wall(2e-4),
        ] {
            let built = |camera: &str| {
                // The floor ends at the wall: else its own dark side would have photons of the lit one, see below.
                Built::new(parse(&divided(camera, &sheets, [-2.0, 0.0])), backend, color)
            };
            assert!(mean(&picture(&built(&front), both()[0])) > 0.1);
            for integrator in both() {
                let back = picture(&built(&behind), integrator);
                assert!(
                    back.iter().all(|&v| v == 0.0),
                    "{}, {backend}, {color:?}",
                    integrator.name()
                );
            }
        }
    }
}

/// A circle on the floor may reach under the wall: there is light on the dark side within a radius, and next to none beyond.
#[test]
fn light_under_a_wall_reaches_as_far_as_a_radius() {
    // Columns of a tenth of the radius, from the wall on.
    let width = 1.6 * f64::from(RADIUS);
    let half = 0.5 * width;
    let above = |x: f64| {
        let window = format!("{} {half} {} {half}", -half, -half);
        let camera = camera_at(&format!("{x} 0 1.9"), &format!("{x} 0 0"), "0 1 0", &window);
        build(&divided(&camera, &wall(0.0), [-2.0, 2.0]), ColorMode::Rgb)
    };
    let [built, bright] = [half, -half].map(above);
    for integrator in both() {
        let lit = mean(&picture(&bright, integrator));
        let picture = picture(&built, integrator);
        let mut columns = [0.0_f32; 16];
        for (i, pixel) in picture.chunks_exact(3).enumerate() {
            // Seen from above with +y up, +x is to the left.
            columns[15 - i % 16] += pixel[1] / 16.0;
        }
        println!("{}: {columns:?}", integrator.name());
        // In `photon` the strip is a faint lamp for the wall, and that for the floor.
        let allowed = match integrator {
            Integrator::Sppm(_) => 0.0,
            _ => 2e-3 * lit,
        };
        assert!(
            columns[10..].iter().all(|&v| v <= allowed),
            "{}: {columns:?}",
            integrator.name()
        );
        assert!(
            columns[0] > 0.0,
            "{}: nothing at the wall: {columns:?}",
            integrator.name()
        );
    }
}

/// Edges of a right angle and flat ones: a roof whose one side a low lamp shines on. The other side, and the top of a block, see nothing
/// that light comes from.
#[test]
fn light_does_not_go_around_an_edge() {
    let lamp = "LightSource \"point\" \"point3 from\" [-1.5 0 0.2] \"rgb I\" [3 3 3]\n\
        AttributeBegin Material \"dielectric\" Translate -1.2 0 0.2 Shape \"sphere\" \"float radius\" 0.1 AttributeEnd\n\
        Material \"diffuse\" \"rgb reflectance\" [0.8 0.8 0.8]\n";
    let ground = quad([-3.0, -1.0, -0.5], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]);
    let block = quad([0.0, -1.0, -1.0], [0.0, 0.0, 2.0], [0.0, 2.0, 0.0])
        + &quad([0.0, -1.0, 1.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]);
    // The lit side rises towards +x, the other falls by twenty degrees.
    let roof = quad([-1.0, -1.0, 0.6], [1.0, 0.0, 0.4], [0.0, 2.0, 0.0])
        + &quad([0.0, -1.0, 1.0], [2.0, 0.0, -0.73], [0.0, 2.0, 0.0]);
    for (name, solid) in [("block", block), ("roof", roof)] {
        for (backend, color) in usual_combinations(name) {
            let seen = camera_at("0.4 0 3", "0.4 0 0", "0 1 0", "-0.39 0.39 -0.39 0.39");
            let text = format!("{seen}{}WorldBegin\n{lamp}{ground}{solid}", film([16, 16]));
            let built = Built::new(parse(&text), backend, color);
            for integrator in both() {
                let dark = picture(&built, integrator);
                assert!(
                    dark.iter().all(|&v| v == 0.0),
                    "{name}, {}, {backend}, {color:?}",
                    integrator.name()
                );
            }
        }
    }
}
