//! `lucerna render`: which pictures it writes, and what is in them.

use lucerna::image_io::{Window, read, read_exr};
use serde_json::Value;

use crate::{SCENE, Sandbox};

#[test]
fn without_a_name_the_output_is_the_films_or_the_scenes() {
    let sandbox = Sandbox::new();
    sandbox.lucerna(&["render", "ball.pbrt", "--quiet"]).expect(0);
    sandbox.write(
        "named.pbrt",
        &SCENE.replace("\"rgb\"", "\"rgb\" \"string filename\" \"film.png\""),
    );
    sandbox.lucerna(&["render", "named.pbrt", "--quiet"]).expect(0);
    assert_eq!(sandbox.files(), ["ball.exr", "film.png"]);
}

#[test]
fn one_bad_scene_does_not_stop_the_others() {
    let sandbox = Sandbox::new();
    sandbox.write("bad.pbrt", "WorldBegin\nNonsense\n");
    sandbox.write("cube.pbrt", SCENE);
    let run = sandbox.lucerna(&[
        "render",
        "bad.pbrt",
        "ball.pbrt",
        "missing.pbrt",
        "cube.pbrt",
        "-o",
        "{scene}.png",
        "--quiet",
    ]);
    run.expect(2)
        .says("unknown directive `Nonsense`")
        .says("cannot read missing.pbrt");
    assert_eq!(sandbox.files(), ["ball.png", "cube.png"]);
}

#[test]
fn every_camera_of_a_scene_has_its_picture() {
    let sandbox = Sandbox::new();
    let camera = "Camera \"perspective\" \"float fov\" 60";
    let two = format!("{camera} \"string name\" \"left\"\n{camera} \"string name\" \"right\"");
    sandbox.write("two.pbrt", &SCENE.replace(camera, &two));
    sandbox
        .lucerna(&["render", "two.pbrt", "-o", "one.png"])
        .expect(2)
        .says("two pictures would be written to this file");
    assert_eq!(sandbox.files(), [] as [&str; 0]);
    sandbox
        .lucerna(&["render", "two.pbrt", "-o", "{scene}-{camera}.png", "--stats", "s.json"])
        .expect(0);
    assert_eq!(sandbox.files(), ["s.json", "two-left.png", "two-right.png"]);
    let statistics: Value = serde_json::from_slice(&std::fs::read(sandbox.path("s.json")).unwrap()).unwrap();
    assert_eq!(statistics.as_array().map(Vec::len), Some(2));
}

#[test]
fn a_crop_is_a_data_window_of_the_same_pixels() {
    let sandbox = Sandbox::new();
    sandbox
        .lucerna(&["render", "ball.pbrt", "-o", "whole.exr", "-q"])
        .expect(0);
    sandbox
        .lucerna(&["render", "ball.pbrt", "-o", "crop.exr", "-q", "--crop", "5,3,18,9"])
        .expect(0);
    let whole = read(&sandbox.path("whole.exr")).expect("readable");
    let (crop, metadata) = read_exr(&sandbox.path("crop.exr")).expect("readable");
    assert_eq!(
        crop.data_window(),
        Window {
            x0: 5,
            y0: 3,
            x1: 18,
            y1: 9
        }
    );
    assert_eq!(crop.display_window(), Window::of_size(24, 16));
    for y in 0..crop.height() {
        for x in 0..crop.width() {
            assert_eq!(
                crop.pixel(x, y),
                whole.pixel(x + 5, y + 3),
                "pixel {x}, {y} of the crop"
            );
        }
    }
    let metadata = metadata.expect("Lucerna's own attributes");
    assert_eq!(
        (metadata.spp, metadata.seed, metadata.integrator.as_str()),
        (4, 0, "path")
    );
    assert_eq!(metadata.scene_hash.len(), 64);
}

#[test]
fn samplers_and_integrators_are_chosen_by_the_names_listed() {
    let sandbox = Sandbox::new();
    for (what, option) in [("samplers", "--sampler"), ("integrators", "--integrator")] {
        let json: Value =
            serde_json::from_str(&sandbox.lucerna(&["list", what, "--json"]).expect(0).stdout()).expect("JSON");
        let mut images = Vec::new();
        for entry in json.as_array().expect("an array") {
            let name = entry["name"].as_str().expect("a name");
            // Twelve samples: no power of two, and strata of four by three.
            sandbox
                .lucerna(&["render", "ball.pbrt", "-o", "a.exr", "--spp", "12", "-q", option, name])
                .expect(0);
            let (image, _) = read_exr(&sandbox.path("a.exr")).expect("an image");
            assert!(image.data().iter().all(|v| v.is_finite()), "{name}");
            images.push(image.data().to_vec());
        }
        for (i, image) in images.iter().enumerate() {
            assert!(images[..i].iter().all(|other| other != image), "{what} {i}");
        }
    }
}

#[test]
fn strategies_are_layers_of_one_file_and_an_overview() {
    let sandbox = Sandbox::new();
    let run = |more: &[&str]| {
        let usual = ["render", "ball.pbrt", "--integrator", "bdpt", "--quiet"];
        sandbox.lucerna(&[&usual, more].concat())
    };
    run(&["-o", "plain.exr"]).expect(0);
    run(&["--strategies", "out/of", "--strategies-depth", "2"]).expect(0);
    let file = sandbox.path("out/of/ball-strategies.exr");
    let header = &exr::meta::MetaData::read_from_file(&file, false)
        .expect("a header")
        .headers[0];
    let names = header.channels.list.iter().map(|channel| channel.name.to_string());
    let mut names: Vec<_> = names
        .filter_map(|name| Some(name.strip_suffix('R')?.to_owned()))
        .collect();
    names.sort();
    let strategies = ["s0.t2", "s0.t3", "s1.t2", "s2.t1"];
    let mut expected = ["", "eye-only.", "light-only.", "longer.weighted."]
        .map(str::to_owned)
        .to_vec();
    expected.extend(strategies.map(|name| format!("{name}.unweighted.")));
    expected.extend(strategies.map(|name| format!("{name}.weighted.")));
    expected.sort();
    assert_eq!(names, expected);
    // The picture itself is in it too, and is as it is without them.
    let data = |path: &std::path::Path| read_exr(path).expect("a picture").0.data().to_vec();
    assert_eq!(data(&file), data(&sandbox.path("plain.exr")));
    assert_eq!(data(&sandbox.path("ball.exr")), data(&sandbox.path("plain.exr")));
    // Three columns of s; a row of views, two rows of lengths in full and two weighted, and one of longer paths.
    let overview = read(&sandbox.path("out/of/ball-strategies.png")).expect("a picture");
    assert_eq!([overview.width(), overview.height()], [3 * 27 + 3, 6 * 19 + 3]);
}

/// A film that keeps more than colours writes it to EXR files, and says so where it cannot.
#[test]
fn films_write_their_layers() {
    let sandbox = Sandbox::new();
    for film in ["gbuffer", "spectral"] {
        sandbox.write(
            &format!("{film}.pbrt"),
            &SCENE.replace("Film \"rgb\"", &format!("Film \"{film}\"")),
        );
        sandbox
            .lucerna(&["render", &format!("{film}.pbrt"), "-o", &format!("{film}.exr")])
            .expect(0);
    }
    // The names of channels are in the header, in alphabetical order.
    let header = |name: &str| {
        let bytes = std::fs::read(sandbox.path(name)).expect("a picture");
        String::from_utf8_lossy(&bytes[..bytes.len().min(4096)]).into_owned()
    };
    let gbuffer = header("gbuffer.exr");
    for name in ["Albedo.R\0", "Ns.Z\0", "P.X\0", "RelativeVariance.B\0", "dzdx\0", "u\0"] {
        assert!(gbuffer.contains(name), "{name}: {gbuffer:?}");
    }
    let spectral = header("spectral.exr");
    for name in [
        "S0.374,688nm\0",
        "S0.815,312nm\0",
        "spectralLayoutVersion\0",
        "emissiveUnits\0",
    ] {
        assert!(spectral.contains(name), "{name}: {spectral:?}");
    }
    // Readers find the colours first.
    let (image, metadata) = read_exr(&sandbox.path("spectral.exr")).expect("a picture");
    assert_eq!(image.channels(), ["R", "G", "B"]);
    assert!(metadata.is_some_and(|m| m.is_spectral));
    sandbox
        .lucerna(&["render", "gbuffer.pbrt", "-o", "colors.png"])
        .expect(0)
        .says("other layers need a file .exr");
    for (options, problem) in [
        (["--integrator", "bdpt"], "by its colors only"),
        (["--color", "rgb"], "no wavelengths"),
    ] {
        let arguments = ["render", "spectral.pbrt", options[0], options[1]];
        sandbox.lucerna(&arguments).expect(2).says(problem);
    }
}
