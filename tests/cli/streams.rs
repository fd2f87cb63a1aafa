//! What `lucerna render` tells: statistics, JSON lines, progress, silence.

use serde_json::Value;

use crate::{Run, Sandbox};

/// The events of a run with `--json`.
fn events(run: &Run) -> Vec<Value> {
    let text = run.stdout();
    text.lines()
        .map(|line| serde_json::from_str(line).expect(line))
        .collect()
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
    let lines = events(&run);
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
fn a_profile_says_where_the_time_went() {
    let sandbox = Sandbox::new();
    let profile = ["--profile", "--stats", "s.json", "--threads", "2"];
    let run = sandbox.lucerna(&[&["render", "ball.pbrt", "-o", "b.exr"], &profile[..]].concat());
    run.expect(0);
    let s: Value = serde_json::from_slice(&std::fs::read(sandbox.path("s.json")).unwrap()).unwrap();
    let stages = s["profile"]["thread_seconds"].as_array().unwrap();
    let share: f64 = stages.iter().map(|stage| stage["share"].as_f64().unwrap()).sum();
    assert!((share - 1.0).abs() < 1e-6, "{share}");
    let rays: u64 = stages.iter().map(|stage| stage["rays"].as_u64().unwrap()).sum();
    assert_eq!(Some(rays), s["rays"].as_u64());
    let fastest = s["profile"]["fastest"].as_array().unwrap();
    let kinds: Vec<_> = fastest
        .iter()
        .map(|fastest| fastest["kind"].as_str().unwrap())
        .collect();
    assert_eq!(kinds, ["camera", "bounce", "shadow"]);
    assert!(fastest.iter().all(|fastest| fastest["mrays"].as_f64().unwrap() > 0.0));
    // Without it, nothing is said.
    sandbox
        .lucerna(&["render", "ball.pbrt", "-o", "c.exr", "--stats", "t.json"])
        .expect(0);
    let t: Value = serde_json::from_slice(&std::fs::read(sandbox.path("t.json")).unwrap()).unwrap();
    assert!(t.get("profile").is_none());
}

#[test]
fn renders_from_one_side_have_progress_and_statistics() {
    let sandbox = Sandbox::new();
    let strategies = ["--integrator", "bdpt", "--strategies", "out", "--json"];
    let arguments = [&["render", "ball.pbrt"], &strategies[..]].concat();
    let lines = events(&sandbox.lucerna(&arguments).expect(0));
    let mut layers: Vec<_> = lines
        .iter()
        .filter(|line| line["event"] == "progress" && line["done"] == 1.0)
        .map(|line| line["layer"].as_str())
        .collect();
    layers.dedup();
    assert_eq!(layers, [None, Some("eye-only"), Some("light-only")]);
    let sides = &lines.last().expect("a result")["one_sided"];
    for (side, layer, integrator) in [(0, "eye-only", "path"), (1, "light-only", "lightpath")] {
        let side = &sides[side];
        assert_eq!(
            (&side["layer"], &side["integrator"]),
            (&layer.into(), &integrator.into())
        );
        assert!(side["rays"].as_u64() > Some(0), "{side}");
        assert_eq!(side["dropped_samples"], 0);
    }
}
