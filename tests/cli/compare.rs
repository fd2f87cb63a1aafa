//! `lucerna compare`.

use serde_json::Value;

use crate::Sandbox;

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
