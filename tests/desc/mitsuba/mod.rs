//! Mitsuba's XML.

mod bad_input;
mod files;
mod media;
mod plugins;

use std::path::Path;

use lucerna::desc::{ParseOptions, SceneDesc, mitsuba};
use lucerna::error::{Diagnostic, Error};

use super::STRICT;

/// A sensor, as every scene needs one.
const SENSOR: &str = r#"<sensor type="perspective"><float name="fov" value="40"/></sensor>"#;

fn read(text: &str, options: &ParseOptions) -> Result<SceneDesc, Vec<Diagnostic>> {
    mitsuba::parse_str(text.as_bytes(), Path::new("scene.xml"), options).map_err(|e| match e {
        Error::Scene(diagnostics) => diagnostics,
        other => panic!("expected Error::Scene, found {other:?}"),
    })
}

/// A whole file around what is in the scene.
pub(super) fn file(content: &str) -> String {
    format!("<scene version=\"3.0.0\">{SENSOR}\n{content}</scene>")
}

/// The scene with this content; it must be without errors.
fn scene(content: &str) -> SceneDesc {
    read(&file(content), &STRICT).unwrap_or_else(|e| panic!("{}", Error::Scene(e)))
}
