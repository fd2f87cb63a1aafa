//! What photon mapping tells: light that others do not find, rounded samples, limits, maps.

use lucerna::image_io::read_exr;
use serde_json::Value;

use crate::{SCENE, Sandbox};

/// The ball is of glass and cuts through a disk, under a point light.
fn glass(passes: u32) -> Sandbox {
    let sandbox = Sandbox::new();
    let glass = "Shape \"disk\" \"float radius\" 3 Material \"dielectric\"\nShape \"sphere\"";
    let scene = SCENE.replace("Shape \"sphere\"", glass);
    let integrator = format!("Integrator \"photon\" \"integer passes\" {passes}\n");
    sandbox.write("glass.pbrt", &(integrator + &scene));
    sandbox
}

/// A render, and its statistics.
fn render(sandbox: &Sandbox, arguments: &[&str]) -> (String, Value) {
    let usual = ["render", "glass.pbrt", "-o", "g.exr", "--stats", "s.json"];
    let run = sandbox.lucerna(&[&usual, arguments].concat()).expect(0);
    let statistics = std::fs::read(sandbox.path("s.json")).expect("statistics");
    (run.stderr(), serde_json::from_slice(&statistics).expect("JSON"))
}

#[test]
fn light_that_cannot_be_found_is_warned_of_with_who_finds_it() {
    let sandbox = glass(1);
    for (name, is_blind) in [("path", true), ("bdpt", true), ("photon", false), ("sppm", false)] {
        let (said, _) = render(&sandbox, &["--integrator", name, "--spp", "1"]);
        let warning = format!("warning: `{name}` cannot find the light of a light without extent");
        assert_eq!(said.contains(&warning), is_blind, "{said}");
        assert_eq!(said.contains("`sppm` and `photon` find it"), is_blind, "{said}");
    }
    let (said, _) = render(&sandbox, &["--integrator", "path", "--spp", "1", "-q"]);
    assert!(said.is_empty(), "{said}");
    sandbox
        .lucerna(&["render", "ball.pbrt", "-o", "b.exr"])
        .expect(0)
        .stderr()
        .lines()
        .for_each(|line| assert!(!line.contains("cannot find"), "{line}"));
}

#[test]
fn samples_are_rounded_up_to_passes() {
    let sandbox = glass(16);
    let (said, statistics) = render(&sandbox, &["--terms", "direct", "--spp", "20"]);
    assert!(
        said.contains("32 samples a pixel instead of 20: a multiple of 16 passes"),
        "{said}"
    );
    assert_eq!(statistics["spp"], 32);
}

#[test]
fn automatic_numbers_of_photons_are_reported() {
    let (_, statistics) = render(&glass(1), &[]);
    let photons = &statistics["photons"];
    assert_eq!(photons["caustic_stored"], 200_000, "{photons}");
    assert_eq!(photons["global_stored"], 50_000, "{photons}");
}

#[test]
fn a_progressive_render_ends_at_the_first_limit() {
    let sandbox = glass(1);
    let samples = |limit: &[&str]| {
        let usual = ["--integrator", "sppm", "--spp", "12"];
        let (_, statistics) = render(&sandbox, &[&usual, limit].concat());
        statistics["spp"].as_u64()
    };
    assert_eq!(samples(&[]), Some(12));
    // Before eight passes the error cannot be told.
    assert_eq!(samples(&["--noise", "1e6"]), Some(8));
    assert_eq!(samples(&["--noise", "1e-6"]), Some(12));
    assert_eq!(samples(&["--time", "1e-6"]), Some(1));
    assert_eq!(samples(&["--time", "1e-6", "--noise", "1e6"]), Some(1));
}

#[test]
fn maps_are_shown_in_false_colors() {
    let sandbox = glass(1);
    let show = |map: &str| {
        render(&sandbox, &["--photon-map", map]);
        let (image, _) = read_exr(&sandbox.path("g.exr")).expect("a picture");
        image.data().to_vec()
    };
    let [caustic, global] = ["caustic", "global"].map(show);
    assert_ne!(caustic, global);
    for map in [caustic, global] {
        let is_colored = |pixel: &&[f32]| pixel[0] != pixel[1] || pixel[1] != pixel[2];
        assert!(map.chunks_exact(3).filter(is_colored).count() > 50);
    }
}
