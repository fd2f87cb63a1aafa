//! `lucerna info`.

use serde_json::Value;

use crate::Sandbox;

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
