//! `lucerna list`.

use serde_json::Value;

use crate::Sandbox;

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
                assert!(
                    parameter["default"].is_string() && parameter["unit"].is_string(),
                    "{parameter}"
                );
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
