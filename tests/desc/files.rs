//! Scenes of several files: `Include`, `Import`, compressed files, spectra and meshes in files, the hash over all.

use std::fs;
use std::io::Write;
use std::path::Path;

use flate2::{Compression, write::GzEncoder};
use glam::DVec3;
use lucerna::Error;
use lucerna::desc::{MaterialKind, SceneDesc, SensorDesc, ShapeKind, SpectrumValue, Textured, load};
use tempfile::TempDir;

use crate::STRICT;

const TRIANGLE: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                        element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

/// A directory with these files; a name that ends in `.gz` is compressed.
fn directory(files: &[(&str, &str)]) -> TempDir {
    let directory = tempfile::tempdir().expect("a temporary directory");
    for (name, text) in files {
        let path = directory.path().join(name);
        fs::create_dir_all(path.parent().expect("a parent")).expect("a directory");
        let mut content = text.as_bytes().to_vec();
        if name.ends_with(".gz") {
            let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
            encoder.write_all(&content).expect("in memory");
            content = encoder.finish().expect("in memory");
        }
        fs::write(path, content).expect("a file");
    }
    directory
}

fn open(directory: &TempDir, name: &str) -> Result<SceneDesc, Error> {
    load(&directory.path().join(name), &STRICT)
}

fn scene(files: &[(&str, &str)]) -> SceneDesc {
    open(&directory(files), files[0].0).unwrap_or_else(|e| panic!("{e}"))
}

/// The only error.
fn error(files: &[(&str, &str)]) -> (String, usize, String) {
    match open(&directory(files), files[0].0) {
        Err(Error::Scene(errors)) if errors.len() == 1 => {
            let name = errors[0].path.file_name().unwrap_or_default();
            (
                name.to_string_lossy().into_owned(),
                errors[0].line,
                errors[0].message.clone(),
            )
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn include_goes_on_where_it_stands() {
    let scene = scene(&[
        ("main.pbrt", "WorldBegin Include \"parts/a.pbrt\" Shape \"sphere\""),
        ("parts/a.pbrt", "Translate 1 0 0 Include \"b.pbrt.gz\""),
        ("parts/b.pbrt.gz", "Translate 0 1 0"),
    ]);
    assert_eq!(
        scene.shapes[0].world_from_object.start.translation,
        DVec3::new(1.0, 1.0, 0.0)
    );
}

#[test]
fn import_leaves_the_graphics_state_alone() {
    let scene = scene(&[
        (
            "main.pbrt",
            "WorldBegin Translate 1 0 0 Import \"a.pbrt\" Shape \"sphere\" NamedMaterial \"m\" Shape \"sphere\"",
        ),
        (
            "a.pbrt",
            "Translate 0 1 0 ReverseOrientation MakeNamedMaterial \"m\" \"string type\" \"conductor\" NamedMaterial \"m\" Shape \"sphere\"",
        ),
    ]);
    let places: Vec<DVec3> = scene
        .shapes
        .iter()
        .map(|s| s.world_from_object.start.translation)
        .collect();
    assert_eq!(places, [DVec3::new(1.0, 1.0, 0.0), DVec3::X, DVec3::X]);
    let reversed: Vec<bool> = scene.shapes.iter().map(|s| s.reverse_orientation).collect();
    assert_eq!(reversed, [true, false, false]);
    let materials: Vec<u32> = scene.shapes.iter().map(|s| s.material.0).collect();
    assert_eq!(materials, [1, 0, 1]);
}

#[test]
fn errors_name_the_file_they_are_in() {
    let found = error(&[
        ("main.pbrt", "WorldBegin\nInclude \"a.pbrt\""),
        ("a.pbrt", "\n\nShape \"cube\""),
    ]);
    assert_eq!(found, ("a.pbrt".to_owned(), 3, "unknown shape `cube`".to_owned()));
    let (name, line, message) = error(&[("main.pbrt", "WorldBegin\n\nInclude \"nothing.pbrt\"")]);
    assert_eq!((name.as_str(), line), ("main.pbrt", 3));
    assert!(message.starts_with("cannot read"), "{message}");
    let (name, line, message) = error(&[
        ("main.pbrt", "WorldBegin Import \"a.pbrt\" Shape \"sphere\""),
        ("a.pbrt", "\nAttributeBegin"),
    ]);
    assert_eq!((name.as_str(), line), ("a.pbrt", 2));
    assert!(message.contains("`AttributeEnd`"), "{message}");
    let (name, _, message) = error(&[
        ("main.pbrt", "WorldBegin AttributeBegin Import \"a.pbrt\" AttributeEnd"),
        ("a.pbrt", "AttributeEnd"),
    ]);
    assert_eq!(name, "a.pbrt");
    assert!(message.contains("nothing has been begun in this file"), "{message}");
}

#[test]
fn files_that_include_themselves_are_refused() {
    let (name, _, message) = error(&[
        ("main.pbrt", "WorldBegin Include \"a.pbrt\""),
        ("a.pbrt", "Include \"./a.pbrt\" Shape \"sphere\""),
    ]);
    assert_eq!(name, "a.pbrt");
    assert!(message.contains("includes itself"), "{message}");
    let chain: Vec<(String, String)> = (0..100)
        .map(|i| {
            (
                format!("{i}.pbrt"),
                format!("{} Include \"{}.pbrt\"", if i == 0 { "WorldBegin" } else { "" }, i + 1),
            )
        })
        .collect();
    let chain: Vec<(&str, &str)> = chain.iter().map(|(a, b)| (a.as_str(), b.as_str())).collect();
    let (name, _, message) = error(&chain);
    assert_eq!(name, "63.pbrt");
    assert!(message.contains("more than 64 files"), "{message}");
}

/// Each of 40 files includes the next one twice: no cycle, but more than 10^12 files.
#[test]
fn files_that_include_one_another_without_end_are_refused() {
    let chain: Vec<(String, String)> = (0..40)
        .map(|i| {
            let start = if i == 0 { "WorldBegin" } else { "" };
            let next = format!("Include \"{}.pbrt\"", i + 1);
            (format!("{i}.pbrt"), format!("{start}\n{next}\n{next}"))
        })
        .chain([("40.pbrt".to_owned(), "Translate 1 0 0".to_owned())])
        .collect();
    let chain: Vec<(&str, &str)> = chain.iter().map(|(a, b)| (a.as_str(), b.as_str())).collect();
    let Err(Error::Scene(errors)) = open(&directory(&chain), "0.pbrt") else {
        panic!("no error")
    };
    assert!(errors[0].message.contains("again and again"), "{}", errors[0]);
    assert!(errors[0].line >= 1 && errors.len() <= 50);
}

#[test]
fn triangles_without_area_are_told_of_with_their_mesh() {
    let flat = "\"point3 P\" [0 0 0  1 1 1  2 2 2  0 1 0] \"integer indices\" [0 1 2  0 1 3  1 1 3]";
    let moving = "\"point3 P\" [0 0 0 1 0 0 2 0 0] \"point3 P1\" [0 0 0 1 0 0 0 1 0]";
    let text =
        format!("WorldBegin\nShape \"sphere\"\n  Shape \"trianglemesh\" {flat}\nShape \"trianglemesh\" {moving}");
    let scene = scene(&[("main.pbrt", &text)]);
    let [warning] = &scene.warnings[..] else {
        panic!("{:?}", scene.warnings)
    };
    assert_eq!((warning.line, warning.column), (3, 9));
    assert_eq!(
        warning.message,
        "2 of the 3 triangles of this mesh have no area: nothing meets them"
    );
}

#[test]
fn spectra_come_from_files() {
    let main = "WorldBegin Material \"diffuse\" \"spectrum reflectance\" \"grey.spd\"";
    let found = scene(&[
        ("main.pbrt", main),
        ("grey.spd", "# nm, value\n400 0.25\n700 0.5 # end\n"),
    ]);
    let MaterialKind::Diffuse {
        reflectance: Textured::Value(reflectance),
        ..
    } = &found.materials[1].kind
    else {
        panic!()
    };
    assert_eq!(
        reflectance.value,
        SpectrumValue::Samples(vec![(400.0, 0.25), (700.0, 0.5)])
    );
    let (_, _, message) = error(&[("main.pbrt", main), ("grey.spd", "400 0.25\n700 x")]);
    assert!(message.contains("line 2"), "{message}");
    let (_, line, message) = error(&[("main.pbrt", main), ("grey.spd", "400 0.25 700 2")]);
    assert_eq!(line, 1);
    assert!(message.contains("between 0 and 1"), "{message}");
}

#[test]
fn a_mesh_file_is_read_once_and_shared() {
    let scene = scene(&[
        (
            "main.pbrt",
            "WorldBegin Shape \"plymesh\" \"string filename\" \"m/t.ply\" Translate 1 0 0 Shape \"plymesh\" \"string filename\" \"m/t.ply\"
             Shape \"plymesh\" \"string filename\" \"m/u.ply.gz\"",
        ),
        ("m/t.ply", TRIANGLE),
        ("m/u.ply.gz", TRIANGLE),
    ]);
    let mesh = |i: usize| match &scene.shapes[i].kind {
        ShapeKind::TriangleMesh(mesh) => mesh,
        other => panic!("{other:?}"),
    };
    assert!(std::sync::Arc::ptr_eq(mesh(0), mesh(1)));
    assert_eq!(mesh(2).positions, mesh(0).positions);
    assert_eq!(mesh(2).indices, [[0, 1, 2]]);
}

#[test]
fn errors_of_meshes_are_in_file_order() {
    let text = "WorldBegin\nShape \"plymesh\" \"string filename\" \"a.ply\"\nShape \"plymesh\" \"string filename\" \"b.ply\"\nShape \"cube\"";
    let files = directory(&[("main.pbrt", text), ("a.ply", "ply\nformat"), ("b.ply", "not")]);
    let Err(Error::Scene(errors)) = open(&files, "main.pbrt") else {
        panic!()
    };
    let lines: Vec<usize> = errors.iter().map(|e| e.line).collect();
    assert_eq!(lines, [2, 3, 4]);
    assert!(errors[1].message.contains("not a PLY file"), "{}", errors[1]);
    assert_eq!(errors[1].column, 35);
}

#[test]
fn the_hash_is_of_all_files() {
    let main = "WorldBegin Include \"a.pbrt\" Shape \"plymesh\" \"string filename\" \"t.ply\"";
    let hash = |a: &str, ply: &str| scene(&[("main.pbrt", main), ("a.pbrt", a), ("t.ply", ply)]).hash;
    let reference = hash("", TRIANGLE);
    assert_eq!(reference, hash("", TRIANGLE));
    assert_ne!(reference, hash(" ", TRIANGLE));
    assert_ne!(reference, hash("", &TRIANGLE.replace("1 0 0", "2 0 0")));
}

#[test]
fn what_is_no_scene_file_is_refused() {
    assert!(matches!(load(Path::new("scene.txt"), &STRICT), Err(Error::Usage(_))));
    assert!(matches!(
        load(Path::new("no/such.pbrt"), &STRICT),
        Err(Error::Io { .. })
    ));
    let files = directory(&[("a.pbrt", "W\u{0}orldBegin")]);
    fs::write(files.path().join("b.pbrt"), b"\xff\xfeW\0o\0").expect("a file");
    fs::write(files.path().join("c.pbrt.gz"), b"WorldBegin").expect("a file");
    assert!(matches!(open(&files, "a.pbrt"), Err(Error::Scene(_))));
    let Err(Error::Scene(errors)) = open(&files, "b.pbrt") else {
        panic!()
    };
    assert!(errors[0].message.contains("UTF-16"), "{}", errors[0]);
    assert!(matches!(open(&files, "c.pbrt.gz"), Err(Error::Io { .. })));
}

#[test]
fn sensors_may_be_files() {
    let film = "Film \"rgb\" \"string sensor\" \"curves.csv\" WorldBegin Shape \"sphere\"";
    let curves = "# wavelength, r, g, b\n400, 0, 0.1, 0.9\n500 0 1 .2\n\n600,1,0.3,0 # red\n";
    let read = scene(&[("a.pbrt", film), ("curves.csv", curves)]);
    let rows = vec![[400.0, 0.0, 0.1, 0.9], [500.0, 0.0, 1.0, 0.2], [600.0, 1.0, 0.3, 0.0]];
    assert_eq!(read.views[0].film.sensor, SensorDesc::Curves(rows));
    let plain = scene(&[("a.pbrt", &film.replace("curves.csv", "sony_ilce_9"))]);
    assert_eq!(plain.views[0].film.sensor, SensorDesc::Named("sony_ilce_9".to_owned()));
    for (curves, problem) in [
        (
            "400 0 0 1\n500 0 x 1",
            "line 2 has something that is not a finite number",
        ),
        ("400 0 0 1\n500 0 1", "line 2 must have four numbers"),
        ("400 0 0 1\n400 0 1 0", "line 2 must have a greater wavelength"),
        ("400 0 0 1", "two lines at least"),
    ] {
        let (_, line, message) = error(&[("a.pbrt", film), ("curves.csv", curves)]);
        assert!(line == 1 && message.contains(problem), "{curves}: {message}");
    }
}
