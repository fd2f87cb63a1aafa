//! Arguments, good and bad, and files that are not there.

use crate::{SCENE, Sandbox};

#[test]
fn help_and_version_are_for_standard_output() {
    let sandbox = Sandbox::new();
    let version = sandbox.lucerna(&["--version"]).expect(0).stdout();
    assert!(
        version.starts_with(&format!("lucerna {} (Embree: ", env!("CARGO_PKG_VERSION"))),
        "{version}"
    );
    for (command, text) in [
        ("render", "Several scenes, and several cameras"),
        ("info", "Usage: lucerna info"),
        ("compare", "Prints one JSON object"),
        ("convert", "The file, read back, is the same scene"),
        ("list", "The scene reader goes by the same tables"),
        ("bench", "Records what a render of each scene asks"),
    ] {
        let help = sandbox.lucerna(&[command, "--help"]).expect(0).stdout();
        let words: Vec<_> = help.split_whitespace().collect();
        assert!(words.join(" ").contains(text), "{help}");
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
            "invalid value 'magic' for '--integrator <NAME>'",
        ),
        (&["render", "ball.pbrt", "--backend", "magic"], "magic"),
        (
            &["render", "ball.pbrt", "--compact", "--not-robust"],
            "cannot be used with",
        ),
        (
            &["render", "ball.pbrt", "--threads", "5000"],
            "expected a whole number from 1 to 4096",
        ),
        (&["render", "ball.pbrt", "--spp", "0"], "expected a whole number from 1"),
        (
            &["render", "ball.pbrt", "--spp", "-1"],
            "expected a whole number from 1",
        ),
        (
            &["render", "ball.pbrt", "--sample", "1.5"],
            "expected a whole number from 0",
        ),
        (
            &["render", "ball.pbrt", "-D", "spp=4"],
            "ball.pbrt: parameters like spp are for scenes of Mitsuba",
        ),
        (
            &["convert", "ball.pbrt", "./ball.pbrt"],
            "./ball.pbrt: the scene is read from this file",
        ),
        (&["render", "ball.pbrt", "--threads", "0"], "0"),
        (&["render", "ball.pbrt", "--resolution", "24"], "width x height"),
        (&["render", "ball.pbrt", "--crop", "4,4,4,8"], "crop is empty"),
        (&["render", "ball.pbrt", "--crop", "0,0,25,16"], "24x16"),
        (&["render", "ball.pbrt", "--sample", "4"], "there is no sample 4"),
        (&["render", "ball.txt"], ".pbrt"),
        (
            &["render", "ball.pbrt", "--strategies", "out"],
            "--strategies is for the integrator `bdpt`: `path` has no strategies (s, t)",
        ),
        (
            &[
                "render",
                "ball.pbrt",
                "--integrator",
                "lightpath",
                "--strategies",
                "out",
            ],
            "`lightpath` has no strategies",
        ),
        (
            &["render", "ball.pbrt", "--strategies", "out", "--strategies-depth", "11"],
            "11",
        ),
        (&["render", "ball.pbrt", "--strategies-depth", "3"], "--strategies"),
        (
            &["render", "ball.pbrt", "--terms", "direct"],
            "--terms is for the integrators `photon` and `sppm`: `path` does not take light apart",
        ),
        (
            &[
                "render",
                "ball.pbrt",
                "--integrator",
                "photon",
                "--terms",
                "direct,shiny",
            ],
            "shiny",
        ),
        (
            &["render", "ball.pbrt", "--integrator", "sppm", "--terms", ""],
            "--terms",
        ),
        (
            &["render", "ball.pbrt", "--integrator", "sppm", "--strategy", "light"],
            "`sppm` has no strategies",
        ),
        (
            &[
                "render",
                "ball.pbrt",
                "--integrator",
                "bdpt",
                "--strategies",
                "out",
                "--resolution",
                "16384x16384",
            ],
            "GiB of memory, and there are",
        ),
    ];
    for (arguments, text) in cases {
        sandbox.lucerna(arguments).expect(2).says(text);
    }
    assert_eq!(sandbox.files(), [] as [&str; 0]);
    assert_eq!(std::fs::read_to_string(sandbox.path("ball.pbrt")).unwrap(), SCENE);
}

#[test]
fn files_that_are_not_there_are_code_1() {
    let sandbox = Sandbox::new();
    for scene in ["no.pbrt", "no.xml", "no.ply", "no.obj"] {
        let run = sandbox.lucerna(&["render", scene]).expect(1);
        run.says(&format!("lucerna: cannot read {scene}: No such file"));
    }
    for arguments in [
        ["render", "ball.pbrt", "-o", "no/x.png"],
        ["convert", "ball.pbrt", "no/x.pbrt", "--lenient"],
    ] {
        let run = sandbox.lucerna(&arguments).expect(1);
        run.says("there is no directory no\n");
    }
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
fn what_becomes_too_much_is_refused() {
    let sandbox = Sandbox::new();
    let film = "Film \"rgb\" \"integer xresolution\" 1000000 \"integer yresolution\" 1000000";
    sandbox.write("vast.pbrt", &format!("{film} WorldBegin Shape \"sphere\""));
    sandbox
        .lucerna(&["render", "vast.pbrt"])
        .expect(2)
        .says("a smaller --resolution or --crop takes less");
    sandbox.write(
        "much.pbrt",
        "WorldBegin\n  Shape \"loopsubdiv\" \"integer levels\" 20\n\"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 2]\n",
    );
    sandbox
        .lucerna(&["render", "much.pbrt"])
        .expect(2)
        .says("much.pbrt:2:9: error: this shape would become more than");
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
