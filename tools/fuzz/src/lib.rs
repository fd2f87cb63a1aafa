//! What the fuzz targets do with an input: read it, and show what is said about it.

use std::fmt::Display;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use lucerna::accel::Backend;
use lucerna::desc::{ParseOptions, SceneDesc, ShapeDesc, ShapeKind, mitsuba, obj, pbrt};
use lucerna::error::Result;
use lucerna::image_io::{self, Encoding};
use lucerna::scene::{Scene, SceneOptions, View, ViewOverrides};
use tempfile::TempDir;

/// A scene where no other file can be found.
const NOWHERE: &str = "no/such/directory/scene";

/// What is reported must be fit to be shown, too.
fn show<T, E: Display>(outcome: std::result::Result<T, E>) -> Option<T> {
    match outcome {
        Ok(value) => Some(value),
        Err(error) => {
            assert!(!error.to_string().is_empty());
            None
        }
    }
}

fn show_scene(outcome: Result<SceneDesc>) -> Option<SceneDesc> {
    let desc = show(outcome)?;
    desc.warnings.iter().for_each(|warning| drop(warning.to_string()));
    Some(desc)
}

fn options(lenient: bool) -> ParseOptions {
    ParseOptions {
        lenient,
        ..ParseOptions::default()
    }
}

/// A pbrt scene, strictly and leniently.
pub fn pbrt(text: &[u8]) {
    for lenient in [false, true] {
        show_scene(pbrt::parse_str(text, Path::new(NOWHERE), &options(lenient)));
    }
}

/// A Mitsuba scene.
pub fn mitsuba(text: &[u8]) {
    for lenient in [false, true] {
        show_scene(mitsuba::parse_str(text, Path::new(NOWHERE), &options(lenient)));
    }
}

/// A pbrt scene, made ready to be rendered.
pub fn scene(text: &[u8]) {
    let Some(desc) = show_scene(pbrt::parse_str(text, Path::new(NOWHERE), &options(true))) else {
        return;
    };
    // Surfaces that are asked to become millions of triangles do: that takes its time.
    let is_small = |shape: &ShapeDesc| match &shape.kind {
        ShapeKind::LoopSubdivision { levels, .. } => *levels <= 3,
        ShapeKind::DisplacedMesh { .. } => false,
        _ => true,
    };
    let mut shapes = desc.shapes.iter().chain(desc.objects.iter().flat_map(|object| &object.shapes));
    if !shapes.all(is_small) {
        return;
    }
    let options = SceneOptions {
        backend: Some(Backend::Bvh),
        ..SceneOptions::default()
    };
    show(Scene::build(&desc, &options));
    for view in &desc.views {
        show(View::build(&desc, view, options.color, &ViewOverrides::default()));
    }
}

/// A mesh in OBJ.
pub fn obj(text: &[u8]) {
    if let Some(file) = show(obj::parse(text, Path::new(NOWHERE))) {
        file.warnings.iter().for_each(|warning| drop(warning.to_string()));
        file.into_meshes();
    }
}

/// A library of materials.
pub fn mtl(text: &[u8]) {
    if let Some(file) = show(obj::mtl::parse(text, Path::new(NOWHERE))) {
        file.warnings.iter().for_each(|warning| drop(warning.to_string()));
    }
}

/// A file that a scene names: `scene` has its name where `FILE` stands.
pub fn named(content: &[u8], scene: &str) {
    static FILE: LazyLock<(TempDir, PathBuf)> = LazyLock::new(|| {
        let folder = TempDir::new().expect("a folder for the input");
        let file = folder.path().join("input");
        (folder, file)
    });
    let (_, file) = &*FILE;
    fs::write(file, content).expect("the input as a file");
    let text = scene.replace("FILE", &format!("\"{}\"", file.display()));
    show_scene(pbrt::parse_str(text.as_bytes(), Path::new(NOWHERE), &options(false)));
}

/// An image whose first bytes are `mark`, if it is not empty; the format is otherwise told by the name of the file.
pub fn image(content: &[u8], mark: &[u8], name: &str) {
    if content.starts_with(mark) {
        show(image_io::decode(content, Path::new(name), Encoding::Srgb));
    }
}

/// Whatever comes of it, shown.
pub fn shown<T, E: Display>(outcome: std::result::Result<T, E>) {
    show(outcome);
}
