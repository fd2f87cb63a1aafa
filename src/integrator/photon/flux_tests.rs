//! The flux that photons bring to surfaces, over all of them, in rooms where it is known.

use std::f64::consts::PI;
use std::path::Path;

use super::guide::EmissionGuide;
use super::shoot::{PhotonNumbers, Stand, Until, learn_caustics, moment_of, shoot};
use super::tracer::{Keep, PhotonTracer};
use crate::desc::{ParseOptions, pbrt};
use crate::integrator::RenderStats;
use crate::scene::{Scene, SceneOptions, View, ViewOverrides};
use crate::spectrum::ColorMode;

/// A closed box of side 2 that reflects a half, with something in it.
fn room(inside: &str) -> (Scene, View) {
    let text = format!(
        "WorldBegin {inside}
        Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]
        Shape \"trianglemesh\"
            \"integer indices\" [0 2 6 0 6 4  1 5 7 1 7 3  0 4 5 0 5 1  2 3 7 2 7 6  0 1 3 0 3 2  4 6 7 4 7 5]
            \"point3 P\" [-1 -1 -1  1 -1 -1  -1 1 -1  1 1 -1  -1 -1 1  1 -1 1  -1 1 1  1 1 1]"
    );
    let desc = pbrt::parse_str(text.as_bytes(), Path::new("room.pbrt"), &ParseOptions::default()).expect("a scene");
    let options = SceneOptions {
        color: ColorMode::Rgb,
        ..SceneOptions::default()
    };
    let scene = Scene::build(&desc, &options).expect("a scene");
    let view = View::build(&desc, &desc.views[0], ColorMode::Rgb, &ViewOverrides::default()).expect("a view");
    (scene, view)
}

/// The flux of the green lane that 16 passes bring: its mean, and the standard deviation of that.
fn flux(inside: &str, keep: Keep, max_depth: Option<u32>, until: Until, is_guided: bool) -> (f64, f64) {
    let (scene, view) = room(inside);
    let film = view.film();
    let stand = Stand {
        scene: &scene,
        view: &view,
        film: &film,
    };
    let mut stats = RenderStats::default();
    let guide: Option<EmissionGuide> =
        is_guided.then(|| learn_caustics(stand, max_depth, 1 << 18, &mut stats).expect("caustics"));
    let tracer = PhotonTracer {
        keep,
        max_depth,
        guide: guide.as_ref(),
    };
    let mut of_pass = |pass| {
        let numbers = PhotonNumbers::new(1, keep, pass);
        let shot = shoot(stand, &tracer, numbers, moment_of(1, pass), until, &mut stats);
        let power: f64 = shot.photons.iter().map(|photon| f64::from(photon.power().0[1])).sum();
        power / shot.emitted as f64
    };
    let fluxes: Vec<f64> = (0..16).map(&mut of_pass).collect();
    let mean = fluxes.iter().sum::<f64>() / 16.0;
    let variance = fluxes.iter().map(|flux| (flux - mean).powi(2)).sum::<f64>() / 15.0;
    (mean, (variance / 16.0).sqrt())
}

/// The deviation must be small enough to see 1.5 percent.
#[track_caller]
fn assert_flux((mean, deviation): (f64, f64), expected: f64, name: &str) {
    println!("{name}: {mean} +- {deviation}, expected {expected}");
    assert!(deviation < 3e-3 * expected, "{name}: {deviation}");
    // Up to 5e-4 are the rounding of powers and the photon path that is left out at the end.
    let far = (mean - expected).abs();
    assert!(
        far < 4.0 * deviation + 5e-4 * expected,
        "{name}: {mean} instead of {expected}"
    );
}

const POINT: &str = r#"LightSource "point" "point3 from" [0.1 -0.2 0.3] "rgb I" [1 1 1]"#;
/// All of its light enters the glass; where paths have any length all of it leaves that.
const IN_GLASS: &str = r#"LightSource "point" "point3 from" [0.1 -0.2 0.3] "rgb I" [1 1 1]
    AttributeBegin Material "dielectric" "float eta" 1.5 Shape "sphere" "float radius" 0.7 AttributeEnd"#;
/// A lossless mirror that a part of the light meets.
const MIRROR: &str = r#"LightSource "point" "point3 from" [0.1 -0.2 0.9] "rgb I" [1 1 1]
    AttributeBegin Material "conductor" "rgb reflectance" [1 1 1] Shape "sphere" "float radius" 0.4 AttributeEnd"#;

#[test]
fn a_closed_box_keeps_the_emitted_power_times_the_series_of_its_albedo() {
    let power = 4.0 * PI;
    let of = |inside, keep, depth, until| flux(inside, keep, depth, until, false);
    for until in [Until::Emitted(30_000), Until::Stored(60_000)] {
        let (all, indirect) = (
            of(POINT, Keep::All, None, until),
            of(IN_GLASS, Keep::Indirect, None, until),
        );
        assert_flux(all, power / (1.0 - 0.5), "all");
        assert_flux(indirect, power * 0.5 / (1.0 - 0.5), "indirect, in glass");
    }
    let short = of(POINT, Keep::All, Some(3), Until::Emitted(30_000));
    assert_flux(short, power * (1.0 + 0.5 + 0.25), "all to depth 3");
}

#[test]
fn caustic_photons_bring_the_same_flux_wherever_they_are_aimed() {
    // The part of the sphere of directions that the ball fills, seen from the light at a distance d.
    let d = (0.1_f64.powi(2) + 0.2_f64.powi(2) + 0.9_f64.powi(2)).sqrt();
    let part = 0.5 * (1.0 - (1.0 - (0.4 / d).powi(2)).sqrt());
    for is_guided in [false, true] {
        let name = if is_guided { "aimed" } else { "not aimed" };
        let caustic = |inside| flux(inside, Keep::Caustic, None, Until::Emitted(30_000), is_guided);
        assert_flux(caustic(IN_GLASS), 4.0 * PI, &format!("in glass, {name}"));
        assert_flux(caustic(MIRROR), 4.0 * PI * part, &format!("mirror, {name}"));
    }
}
