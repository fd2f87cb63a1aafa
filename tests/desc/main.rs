//! Scene descriptions: what pbrt and Mitsuba files and meshes become, what is said about bad ones.

mod bad_input;
mod bare;
mod files;
mod lenses;
mod lights;
mod materials;
mod media;
mod mitsuba;
mod obj;
mod options;
mod ply;
mod shapes;
mod tables;
mod v3;
mod world;
mod written;

use std::path::{Path, PathBuf};

use lucerna::desc::{ParseOptions, SceneDesc, pbrt};
use lucerna::error::{Diagnostic, Error, Severity};

const STRICT: ParseOptions = ParseOptions {
    lenient: false,
    defines: Vec::new(),
};
const LENIENT: ParseOptions = ParseOptions {
    lenient: true,
    defines: Vec::new(),
};

fn read(text: &str, options: &ParseOptions) -> Result<SceneDesc, Vec<Diagnostic>> {
    pbrt::parse_str(text.as_bytes(), Path::new("scene.pbrt"), options).map_err(|e| match e {
        Error::Scene(diagnostics) => diagnostics,
        other => panic!("expected Error::Scene, found {other:?}"),
    })
}

/// The scene that a text describes; it must be without errors.
fn scene(text: &str) -> SceneDesc {
    read(text, &STRICT).unwrap_or_else(|e| panic!("{}", Error::Scene(e)))
}

/// The scene that `world` describes after `WorldBegin`.
fn world(text: &str) -> SceneDesc {
    scene(&format!("WorldBegin\n{text}"))
}

/// The errors in a text; there must be some.
fn errors(text: &str) -> Vec<Diagnostic> {
    let errors = read(text, &STRICT)
        .err()
        .unwrap_or_else(|| panic!("no error in {text}"));
    assert!(!errors.is_empty() && errors.iter().all(|d| d.severity == Severity::Error));
    errors
}

/// A file of the data that is shared by those who work on Lucerna. Where they are missing, tests are skipped and say so; in CI
/// they fail.
fn shared(path: &str) -> Option<PathBuf> {
    let root = std::env::var_os("LUCERNA_SHARED").map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared"),
        PathBuf::from,
    );
    let file = root.join(path);
    if file.exists() {
        return Some(file);
    }
    let message = format!("{} is missing", file.display());
    assert!(std::env::var_os("CI").is_none_or(|ci| ci != "true"), "{message}");
    println!("skipped: {message}");
    None
}
