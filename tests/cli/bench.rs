//! `lucerna bench`: what it measures, writes and refuses.

use serde_json::Value;

use crate::Sandbox;

/// As few rays and turns as there can be.
const SHORT: [&str; 5] = ["--count", "2000", "--turns", "1", "--quiet"];

fn bench(sandbox: &Sandbox, arguments: &[&str]) -> Value {
    let mut all = vec!["bench", "--json", "report.json"];
    all.extend(arguments);
    all.extend(SHORT);
    sandbox.lucerna(&all).expect(0);
    serde_json::from_slice(&std::fs::read(sandbox.path("report.json")).unwrap()).unwrap()
}

fn kinds(report: &Value) -> Vec<&str> {
    let streams = report["cases"][0]["streams"].as_array().unwrap();
    streams.iter().map(|stream| stream["kind"].as_str().unwrap()).collect()
}

/// Of every contender in every stream: its rate is positive and within its spread, and what it answers is what the others do, but for
/// as many rays in a thousand.
fn check_results(report: &Value, in_a_thousand: u64) {
    for stream in report["cases"][0]["streams"].as_array().unwrap() {
        let rays = stream["rays"].as_u64().unwrap();
        let results = stream["results"].as_array().unwrap();
        assert!(rays > 0 && !results.is_empty());
        for result in results {
            let number = |key: &str| result[key].as_f64().unwrap();
            assert!(number("least") > 0.0 && number("least") <= number("most"), "{result}");
            let difference = &result["difference"];
            let count: u64 = ["missed", "extra", "other"]
                .iter()
                .map(|key| difference[key].as_u64().unwrap())
                .sum();
            assert!(count * 1000 <= rays * in_a_thousand, "{result}");
            if result["family"] == "bvh" {
                assert_eq!((count, &difference["wrong"]), (0, &Value::from(0)), "{result}");
            }
        }
    }
}

#[test]
fn a_scene_is_measured_by_every_kind_of_its_rays() {
    let sandbox = Sandbox::new();
    let page = ["ball.pbrt", "--html", "page.html"];
    let report = bench(&sandbox, &page);
    assert_eq!(kinds(&report), ["camera", "bounce 1", "shadow", "photon"]);
    assert_eq!(report["cases"][0]["instanced_primitives"], 1);
    check_results(&report, 0);
    for key in ["processor", "system", "compiler", "embree", "load"] {
        assert!(!report["machine"][key].as_str().unwrap().is_empty(), "{key}");
    }
    let html = std::fs::read_to_string(sandbox.path("page.html")).unwrap();
    assert_eq!(html.matches("<svg").count(), html.matches("</svg>").count());
    assert!(html.matches("<svg").count() >= 3);
    assert!(!html.contains("NaN") && !html.contains("inf\"") && !html.contains("http-equiv"));
    // Nothing is loaded from elsewhere; the one address is the name of the language of drawings.
    assert_eq!(
        html.matches("http").count(),
        html.matches("http://www.w3.org/2000/svg").count()
    );
}

#[test]
fn every_way_of_every_quality_agrees_about_a_soup() {
    let sandbox = Sandbox::new();
    let report = bench(&sandbox, &["--synthetic", "soup:2000", "--all", "--threads", "1,2"]);
    assert_eq!(
        kinds(&report),
        ["camera", "bounce 1", "bounce 2", "bounce 3+", "shadow", "photon"]
    );
    check_results(&report, 2);
    let builds = report["cases"][0]["builds"].as_array().unwrap();
    let of_bvh = |build: &&Value| build["family"] == "bvh";
    assert_eq!(builds.iter().filter(of_bvh).count(), 3);
    let results = report["cases"][0]["streams"][0]["results"].as_array().unwrap();
    let on_two = results.iter().filter(|result| result["threads"] == 2);
    assert_eq!(on_two.count(), builds.len());
}

#[test]
fn saved_rays_are_replayed() {
    let sandbox = Sandbox::new();
    let recorded = bench(
        &sandbox,
        &[
            "--synthetic",
            "instances:3000",
            "--rays",
            "i.rays",
            "--only",
            "bvh high",
        ],
    );
    let replayed = bench(&sandbox, &["--rays", "i.rays", "--only", "bvh high"]);
    assert_eq!(kinds(&recorded), kinds(&replayed));
    let numbers = |report: &Value, key: &str| -> Vec<u64> {
        let streams = report["cases"][0]["streams"].as_array().unwrap();
        streams.iter().map(|s| s[key].as_u64().unwrap()).collect()
    };
    assert_eq!(numbers(&recorded, "rays"), numbers(&replayed, "rays"));
    assert_eq!(numbers(&recorded, "waves"), numbers(&replayed, "waves"));
    assert_eq!(
        recorded["cases"][0]["instanced_primitives"],
        replayed["cases"][0]["primitives"]
    );
    check_results(&replayed, 0);
    // A sphere is not in the file: its rays are for the scene only.
    bench(&sandbox, &["ball.pbrt", "--rays", "ball.rays", "--only", "bvh high"]);
    let again = bench(&sandbox, &["ball.pbrt", "--rays", "ball.rays", "--only", "bvh high"]);
    assert_eq!(kinds(&again), ["camera", "bounce 1", "shadow", "photon"]);
    let run = sandbox.lucerna(&["bench", "--rays", "ball.rays"]);
    run.expect(2);
}

#[test]
fn damaged_files_of_rays_are_refused() {
    let sandbox = Sandbox::new();
    bench(
        &sandbox,
        &["--synthetic", "box", "--rays", "b.rays", "--only", "bvh high"],
    );
    let whole = std::fs::read(sandbox.path("b.rays")).unwrap();
    let refused = |bytes: &[u8]| {
        std::fs::write(sandbox.path("bad.rays"), bytes).unwrap();
        sandbox.lucerna(&["bench", "--rays", "bad.rays", "--quiet"]).expect(2);
    };
    for length in [0, 7, 12, 64, 300, whole.len() / 2, whole.len() - 65] {
        refused(&whole[..length]);
    }
    let mut long = whole.clone();
    long[8..16].fill(0xff);
    refused(&long);
    let text = String::from_utf8_lossy(&whole[16..400]).into_owned();
    let place = 16 + text.find("\"triangles\":").unwrap() + "\"triangles\":".len();
    let mut many = whole.clone();
    many[place] = b'9';
    refused(&many);
    // An origin that is not a number, in the first packet: behind header, triangles and the lengths of at most 16 calls.
    let header = 16 + u64::from_le_bytes(whole[8..16].try_into().unwrap()) as usize;
    let json: Value = serde_json::from_slice(&whole[16..header]).unwrap();
    let bytes = |key: &str| (12 * json[key].as_u64().unwrap() as usize).next_multiple_of(64);
    let packet = header + bytes("vertices") + bytes("triangles") + 64;
    assert!(json["streams"][0]["waves"].as_u64().unwrap() <= 16);
    let mut nan = whole.clone();
    nan[packet..packet + 32].fill(0xff);
    refused(&nan);
}

#[test]
fn what_makes_no_sense_is_refused() {
    let sandbox = Sandbox::new();
    for arguments in [
        &["bench"][..],
        &["bench", "--rays", "nothing.rays"],
        &["bench", "ball.pbrt", "ball.pbrt", "--rays", "two.rays"],
        &["bench", "--synthetic", "cloud:5"],
        &["bench", "--synthetic", "soup"],
        &["bench", "--synthetic", "soup:0"],
        &["bench", "--synthetic", "soup:1e12"],
        &["bench", "ball.pbrt", "--threads", "0"],
        &["bench", "ball.pbrt", "--pin", "none"],
        &["bench", "ball.pbrt", "--integrator", "guess"],
        &["bench", "ball.pbrt", "--only", "no such way"],
    ] {
        sandbox.lucerna(arguments).expect(2);
    }
}

#[test]
fn a_report_is_replaced_when_there_is_a_new_one() {
    let sandbox = Sandbox::new();
    sandbox.write("r.json", "old");
    sandbox
        .lucerna(&["bench", "missing.pbrt", "--json", "r.json"])
        .expect(1);
    assert_eq!(std::fs::read_to_string(sandbox.path("r.json")).unwrap(), "old");
}

#[cfg(target_os = "linux")]
#[test]
fn processors_that_are_not_there_are_refused_with_those_that_are() {
    let sandbox = Sandbox::new();
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let list = status.lines().find_map(|line| line.strip_prefix("Cpus_allowed_list:"));
    let there = format!("of those that there are: {}\n", list.unwrap().trim());
    for cpus in ["0-65535", "65535", "none"] {
        let arguments = ["bench", "ball.pbrt", "--pin", cpus];
        sandbox.lucerna(&arguments).expect(2).says(&there);
    }
}
