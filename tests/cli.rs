//! The program as scripts see it: exit codes, files, streams.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use lucerna::image_io::{Window, read, read_exr};
use serde_json::Value;
use tempfile::TempDir;

/// A working directory with a small scene.
struct Sandbox {
    directory: TempDir,
}

const SCENE: &str = "\
Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 16
Camera \"perspective\" \"float fov\" 60
Sampler \"sobol\" \"integer pixelsamples\" 4
WorldBegin
LightSource \"point\" \"point3 from\" [ 1 1 0 ]
Translate 0 0 4
Shape \"sphere\"
";

impl Sandbox {
    fn new() -> Self {
        let sandbox = Self {
            directory: tempfile::tempdir().expect("a directory for a test"),
        };
        sandbox.write("ball.pbrt", SCENE);
        sandbox
    }

    fn path(&self, name: &str) -> PathBuf {
        self.directory.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path(name), text).expect("a file of a test");
    }

    /// Runs the program here.
    fn lucerna(&self, arguments: &[&str]) -> Run {
        let output = Command::new(env!("CARGO_BIN_EXE_lucerna"))
            .args(arguments)
            .current_dir(self.directory.path())
            .output()
            .expect("the program runs");
        Run(output)
    }

    /// Everything here but scenes, sorted.
    fn files(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.directory.path()).expect("the sandbox is there");
        let names = entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned());
        let mut names: Vec<_> = names
            .filter(|name| Path::new(name).extension().is_none_or(|e| e != "pbrt"))
            .collect();
        names.sort();
        names
    }
}

/// What a run of the program left.
struct Run(Output);

impl Run {
    fn stdout(&self) -> String {
        String::from_utf8_lossy(&self.0.stdout).into_owned()
    }

    fn stderr(&self) -> String {
        String::from_utf8_lossy(&self.0.stderr).into_owned()
    }

    /// Panics unless the exit code is `code`.
    #[track_caller]
    fn expect(self, code: i32) -> Self {
        assert_eq!(
            self.0.status.code(),
            Some(code),
            "stdout:\n{}\nstderr:\n{}",
            self.stdout(),
            self.stderr()
        );
        self
    }

    /// Panics unless standard error holds `text`.
    #[track_caller]
    fn says(self, text: &str) -> Self {
        assert!(self.stderr().contains(text), "`{text}` is not in:\n{}", self.stderr());
        self
    }
}

#[test]
fn help_and_version_are_for_standard_output() {
    let sandbox = Sandbox::new();
    let version = sandbox.lucerna(&["--version"]).expect(0).stdout();
    assert!(
        version.starts_with(&format!("lucerna {} (Embree: ", env!("CARGO_PKG_VERSION"))),
        "{version}"
    );
    for command in ["render", "info", "compare"] {
        assert!(
            sandbox
                .lucerna(&[command, "--help"])
                .expect(0)
                .stdout()
                .contains("Usage: lucerna")
        );
    }
    let help = sandbox.lucerna(&["render", "--help"]).expect(0).stdout();
    for option in [
        "--output",
        "--spp",
        "--seed",
        "--threads",
        "--backend",
        "--resolution",
        "--crop",
        "--color",
    ] {
        assert!(help.contains(option), "{option} is not in the help");
    }
}

#[test]
fn bad_usage_is_code_2_and_leaves_nothing() {
    let sandbox = Sandbox::new();
    let cases: &[(&[&str], &str)] = &[
        (&["render"], "<SCENE>"),
        (&["render", "ball.pbrt", "--frobnicate"], "--frobnicate"),
        (&["render", "ball.pbrt", "-o", "ball.jpg"], ".exr or .png"),
        (
            &["render", "ball.pbrt", "-o", "{view}.png"],
            "unknown placeholder {view}",
        ),
        (
            &["render", "ball.pbrt", "ball.pbrt", "-o", "x.png"],
            "put {scene} into its name",
        ),
        (
            &["render", "ball.pbrt", "--integrator", "magic"],
            "unknown integrator `magic`",
        ),
        (&["render", "ball.pbrt", "--backend", "magic"], "magic"),
        (&["render", "ball.pbrt", "--spp", "0"], "0"),
        (&["render", "ball.pbrt", "--threads", "0"], "0"),
        (&["render", "ball.pbrt", "--resolution", "24"], "width x height"),
        (&["render", "ball.pbrt", "--crop", "4,4,4,8"], "crop is empty"),
        (&["render", "ball.pbrt", "--crop", "0,0,25,16"], "24x16"),
        (&["render", "ball.pbrt", "--sample", "4"], "there is no sample 4"),
        (&["render", "ball.txt"], ".pbrt"),
    ];
    for (arguments, text) in cases {
        sandbox.lucerna(arguments).expect(2).says(text);
    }
    assert_eq!(sandbox.files(), [] as [&str; 0]);
}

#[test]
fn a_scene_tells_all_its_errors_with_their_places() {
    let sandbox = Sandbox::new();
    sandbox.write(
        "bad.pbrt",
        "Camera \"perspective\" \"float fov\" 200\nWorldBegin\nMaterail \"diffuse\"\nShape \"sphre\"\n",
    );
    sandbox
        .lucerna(&["render", "bad.pbrt"])
        .expect(2)
        .says("bad.pbrt:1:34: error: `fov` is 200")
        .says("bad.pbrt:3:1: error: unknown directive `Materail`")
        .says("did you mean `Material`?")
        .says("bad.pbrt:4:7: error")
        .says("did you mean `sphere`?");
    assert_eq!(sandbox.files(), [] as [&str; 0]);
}

#[test]
fn files_that_cannot_be_read_or_written_are_code_1() {
    let sandbox = Sandbox::new();
    sandbox
        .lucerna(&["render", "missing.pbrt"])
        .expect(1)
        .says("cannot read missing.pbrt");
    sandbox
        .lucerna(&["render", "ball.pbrt", "-o", "no/where.png"])
        .expect(1)
        .says("there is no directory no");
    sandbox
        .lucerna(&["compare", "missing.png", "missing.png"])
        .expect(1)
        .says("cannot read missing.png");
}

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
fn statistics_have_every_promised_key() {
    let sandbox = Sandbox::new();
    sandbox
        .lucerna(&[
            "render",
            "ball.pbrt",
            "-o",
            "b.exr",
            "--stats",
            "s.json",
            "--threads",
            "1",
            "--backend",
            "bvh",
            "--seed",
            "7",
        ])
        .expect(0);
    let s: Value = serde_json::from_slice(&std::fs::read(sandbox.path("s.json")).unwrap()).unwrap();
    let keys = [
        "wall_seconds",
        "render_seconds",
        "load_seconds",
        "build_seconds",
        "spp",
        "camera_rays",
        "rays",
        "shadow_rays",
        "rays_per_second",
        "peak_memory_bytes",
        "backend",
        "backend_version",
        "threads",
        "seed",
        "dropped_samples",
    ];
    for key in keys {
        assert!(s[key].is_string() || s[key].is_number(), "{key} is missing: {s}");
    }
    assert_eq!(
        (s["spp"].as_u64(), s["threads"].as_u64(), s["seed"].as_u64()),
        (Some(4), Some(1), Some(7))
    );
    assert_eq!(s["camera_rays"].as_u64(), Some(24 * 16 * 4));
    assert_eq!(
        (s["backend"].as_str(), s["dropped_samples"].as_u64()),
        (Some("bvh"), Some(0))
    );
}

#[test]
fn json_lines_tell_progress_results_and_errors() {
    let sandbox = Sandbox::new();
    sandbox.write("bad.pbrt", "WorldBegin\nNonsense\n");
    let run = sandbox
        .lucerna(&["render", "ball.pbrt", "bad.pbrt", "-o", "{scene}.png", "--json"])
        .expect(2);
    let lines: Vec<Value> = run
        .stdout()
        .lines()
        .map(|line| serde_json::from_str(line).expect(line))
        .collect();
    let events: Vec<_> = lines
        .iter()
        .map(|line| line["event"].as_str().expect("an event"))
        .collect();
    assert_eq!(events.first(), Some(&"progress"));
    assert_eq!(events[events.len() - 2..], ["result", "error"]);
    let last_progress = lines
        .iter()
        .rfind(|line| line["event"] == "progress")
        .expect("progress");
    assert_eq!(last_progress["done"].as_f64(), Some(1.0));
    assert!(last_progress["seconds_left"].is_number());
    assert_eq!(lines[lines.len() - 2]["output"], "ball.png");
    assert!(
        lines[lines.len() - 1]["message"]
            .as_str()
            .is_some_and(|m| m.contains("unknown directive"))
    );
    assert!(
        lines
            .iter()
            .all(|line| line["scene"].is_string() && line["camera"].is_string())
    );
}

#[test]
fn quiet_runs_and_pipes_have_no_progress_bar() {
    let sandbox = Sandbox::new();
    let run = sandbox
        .lucerna(&["render", "ball.pbrt", "-o", "b.png", "--quiet"])
        .expect(0);
    assert_eq!((run.stdout(), run.stderr()), (String::new(), String::new()));
    let run = sandbox.lucerna(&["render", "ball.pbrt", "-o", "b.png"]).expect(0);
    assert_eq!(run.stdout(), "");
    assert!(
        !run.stderr().contains('\r') && !run.stderr().contains('\u{1b}'),
        "{:?}",
        run.stderr()
    );
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
fn compare_measures_a_from_the_reference_b() {
    let sandbox = Sandbox::new();
    for (seed, name) in [("0", "a.exr"), ("1", "b.exr")] {
        sandbox
            .lucerna(&["render", "ball.pbrt", "-o", name, "--seed", seed, "-q"])
            .expect(0);
    }
    let compare = |a: &str, b: &str| -> Value {
        serde_json::from_str(&sandbox.lucerna(&["compare", a, b]).expect(0).stdout()).expect("JSON")
    };
    let same = compare("a.exr", "a.exr");
    assert_eq!((same["mse"].as_f64(), same["flip"].as_f64()), (Some(0.0), Some(0.0)));
    let different = compare("a.exr", "b.exr");
    for key in ["mse", "relmse", "mean_a", "mean_b", "flip"] {
        assert!(different[key].as_f64().is_some_and(|v| v > 0.0), "{key}: {different}");
    }
    assert!(different["mean_difference"].is_number());
    sandbox
        .lucerna(&["render", "ball.pbrt", "-o", "small.exr", "--resolution", "12x8", "-q"])
        .expect(0);
    sandbox
        .lucerna(&["compare", "a.exr", "small.exr"])
        .expect(2)
        .says("different sizes");
}

#[test]
fn info_counts_what_is_in_a_scene() {
    let sandbox = Sandbox::new();
    let info: Value =
        serde_json::from_str(&sandbox.lucerna(&["info", "ball.pbrt", "--json"]).expect(0).stdout()).expect("JSON");
    assert_eq!(
        (info["spheres"].as_u64(), info["triangles"].as_u64()),
        (Some(1), Some(0))
    );
    assert_eq!(info["lights"][0]["kind"], "point");
    assert_eq!(info["views"][0]["resolution"], serde_json::json!([24, 16]));
    let text = sandbox.lucerna(&["info", "ball.pbrt"]).expect(0).stdout();
    assert!(text.contains("1 spheres") && text.contains("24x16"), "{text}");
}

#[test]
fn list_gives_every_parameter() {
    let sandbox = Sandbox::new();
    for what in ["materials", "lights", "textures", "samplers", "integrators"] {
        let text = sandbox.lucerna(&["list", what]).expect(0).stdout();
        let json: Value =
            serde_json::from_str(&sandbox.lucerna(&["list", what, "--json"]).expect(0).stdout()).expect("JSON");
        let entries = json.as_array().expect("an array");
        assert!(entries.len() >= 2, "{what}");
        for entry in entries {
            let [name, directive] = ["name", "directive"].map(|key| entry[key].as_str().expect("a string"));
            assert!(text.contains(&format!("{directive} \"{name}\"")), "{what} {name}");
            assert!(!entry["description"].as_str().expect("a string").is_empty());
            for parameter in entry["parameters"].as_array().expect("an array") {
                for key in ["name", "type", "range", "description"] {
                    assert!(
                        parameter[key].as_str().is_some_and(|text| !text.is_empty()),
                        "{parameter}"
                    );
                }
                assert!(parameter["default"].is_string(), "{parameter}");
                let line = format!(
                    "\"{} {}\"",
                    parameter["type"].as_str().unwrap_or_default(),
                    parameter["name"].as_str().unwrap_or_default()
                );
                assert!(text.contains(&line), "{line}");
            }
        }
    }
    let spot = sandbox.lucerna(&["list", "lights", "spot"]).expect(0).stdout();
    assert!(spot.contains("\"float coneangle\"") && spot.contains("default 30") && !spot.contains("goniometric"));
    sandbox
        .lucerna(&["list", "lights", "sopt"])
        .expect(2)
        .says("expected one of");
    sandbox.lucerna(&["list", "cameras"]).expect(2).says("possible values");
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
