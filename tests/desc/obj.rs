//! OBJ meshes: every form of a corner, materials, and bad files.

use std::path::Path;

use glam::{Vec2, Vec3};
use lucerna::desc::obj::{self, ObjFile, ObjPart};
use lucerna::error::{Diagnostic, Error};

fn read(text: &str) -> ObjFile {
    obj::parse(text.as_bytes(), Path::new("mesh.obj")).unwrap_or_else(|e| panic!("{e}"))
}

fn errors(text: &[u8]) -> Vec<Diagnostic> {
    match obj::parse(text, Path::new("mesh.obj")) {
        Err(Error::Scene(diagnostics)) => diagnostics,
        other => panic!("expected errors, found {other:?}"),
    }
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

#[test]
fn corners_have_every_form() {
    for (faces, indices) in [
        ("f 1 2 3 4", vec![[0, 1, 2], [0, 2, 3]]),
        ("f -4 -3 -2 -1", vec![[0, 1, 2], [0, 2, 3]]),
        ("f 1 2 3\nf +4 1 3", vec![[0, 1, 2], [3, 0, 2]]),
        ("f 1 \\\n2 3 \\\r\n 4 # a square\r\n", vec![[0, 1, 2], [0, 2, 3]]),
    ] {
        let file = read(&format!("{SQUARE}{faces}"));
        assert_eq!(file.mesh.indices, indices, "{faces}");
        assert_eq!(file.mesh.positions[2], Vec3::new(1.0, 1.0, 0.0));
        assert!(file.mesh.normals.is_empty() && file.mesh.uvs.is_empty());
    }
    let attributes = "vt .5\nvt .25 .75 0\nvn 0 0 2\nvn 0 1 0\n";
    let file = read(&format!("{SQUARE}{attributes}f 1/1/1 2/2/-1 3//2\nf 1/1/1 3//2 4/-1\n"));
    assert_eq!(file.mesh.indices, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(
        file.mesh.uvs,
        [
            Vec2::new(0.5, 0.0),
            Vec2::new(0.25, 0.75),
            Vec2::ZERO,
            Vec2::new(0.25, 0.75)
        ]
    );
    assert_eq!(file.mesh.normals, [Vec3::Z * 2.0, Vec3::Y, Vec3::Y, Vec3::ZERO]);
}

#[test]
fn corners_that_differ_are_vertices_of_their_own() {
    let file = read(&format!(
        "{SQUARE}vn 0 0 1\nvn 0 0 -1\nf 1//1 2//1 3//1\nf 3//2 2//2 1//2\nf 1//1 3//1 4//1"
    ));
    assert_eq!(file.mesh.positions.len(), 7);
    assert_eq!(file.mesh.indices, [[0, 1, 2], [3, 4, 5], [0, 2, 6]]);
    assert_eq!(file.mesh.positions[5], file.mesh.positions[0]);
}

#[test]
fn what_says_nothing_about_faces_is_passed_over() {
    let text = format!(
        "\u{feff}# made by hand\nmtllib a b.mtl\no thing\ng one two\ns off\n{SQUARE}v 2 2 2 1 .5 0 0\n\nvt 0 0\nl 1 2\np 1\n\
         vp 1 2\nshrink 3\nshrink 4\nf 1 2 3"
    );
    let file = read(&text);
    assert_eq!(file.mesh.positions.len(), 3);
    assert_eq!(file.libraries[0].name, "a b.mtl");
    let [warning] = &file.warnings[..] else {
        panic!("{:?}", file.warnings);
    };
    assert_eq!((warning.line, warning.column), (16, 1));
    assert!(warning.message.contains("`shrink`"), "{warning}");
}

#[test]
fn faces_are_divided_by_material() {
    let text = format!(
        "{SQUARE}f 1 2 3\nusemtl red  wine\nf 1 3 4\nf 2 3 4\nusemtl b#1\nf 1 2 4\nusemtl red  wine\nf 4 2 1\nusemtl unused"
    );
    let file = read(&text);
    let names: Vec<_> = file
        .materials
        .iter()
        .map(|m| (m.name.as_str(), m.place.line, m.place.column))
        .collect();
    assert_eq!(names, [("red  wine", 6, 8), ("b#1", 9, 8), ("unused", 13, 8)]);
    let part = |material, triangles| ObjPart { material, triangles };
    assert_eq!(
        file.parts,
        [
            part(None, 0..1),
            part(Some(0), 1..3),
            part(Some(1), 3..4),
            part(Some(0), 4..5)
        ]
    );
    let whole = file.mesh.clone();
    let corners = |mesh: &lucerna::desc::MeshDesc, i: usize| mesh.indices[i].map(|v| mesh.positions[v as usize]);
    let meshes = file.into_meshes();
    let counts: Vec<_> = meshes
        .iter()
        .map(|(m, mesh)| (*m, mesh.positions.len(), mesh.indices.len()))
        .collect();
    assert_eq!(counts, [(None, 3, 1), (Some(0), 4, 3), (Some(1), 3, 1)]);
    assert_eq!(corners(&meshes[1].1, 2), corners(&whole, 4));
    assert_eq!(corners(&meshes[2].1, 0), corners(&whole, 3));
}

#[test]
fn bad_files_are_refused_with_the_place() {
    let face = format!("{SQUARE}vt 0 0\nvn 0 0 1\nf 1/1/1 2 3");
    for (from, to, place, message) in [
        ("f 1/1/1 2 3", "", (1, 1), "there are no faces"),
        ("v 1 1 0", "v 1 1", (3, 1), "a vertex has 3 coordinates, found 2"),
        ("v 1 1 0", "v 1 x1 0", (3, 5), "expected a number, found `x1`"),
        ("v 1 1 0", "v 1 1 nan", (3, 7), "32-bit floating point"),
        ("v 1 1 0", "v 1 1e39 0", (3, 5), "32-bit floating point"),
        ("vn 0 0 1", "vn 0 0", (6, 1), "a normal has 3"),
        ("vt 0 0", "vt", (5, 1), "a texture coordinate has 2"),
        ("vt 0 0", "vt 0 inf", (5, 6), "32-bit floating point"),
        ("2 3", "2", (7, 1), "at least 3 corners, found 2"),
        ("2 3", "2 5", (7, 11), "there is no vertex 5: up to here there are 4"),
        ("2 3", "2 -5", (7, 11), "there is no vertex -5"),
        ("2 3", "0 3", (7, 9), "0 is no index"),
        ("1/1/1", "1/2/1", (7, 5), "there is no texture coordinate 2"),
        ("1/1/1", "1//2", (7, 6), "there is no normal 2"),
        ("1/1/1", "1/1/1/1", (7, 3), "expected a corner"),
        ("1/1/1", "/1/1", (7, 3), "expected a corner"),
        ("1/1/1", "1.5", (7, 3), "expected a corner"),
        ("2 3", "2 99999999999999999999", (7, 11), "expected a corner"),
        ("vt 0 0", "cstype bezier", (5, 1), "free-form"),
    ] {
        let text = face.replacen(from, to, 1);
        let error = &errors(text.as_bytes())[0];
        assert!(error.message.contains(message), "{to}: {error}");
        assert_eq!((error.line, error.column), place, "{to}: {error}");
    }
    assert_eq!(errors("v 1\n".repeat(1000).as_bytes()).len(), 50);
}

#[test]
fn a_file_may_be_compressed_and_must_exist() {
    use std::io::Write;
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("mesh.obj.gz");
    let mut encoder = flate2::write::GzEncoder::new(std::fs::File::create(&path).unwrap(), flate2::Compression::fast());
    encoder.write_all(format!("{SQUARE}f 1 2 3").as_bytes()).unwrap();
    encoder.finish().unwrap();
    let file = obj::load(&path).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(file.mesh.indices.len(), 1);
    assert_eq!(file.hash, blake3::hash(format!("{SQUARE}f 1 2 3").as_bytes()));
    assert!(matches!(
        obj::load(&directory.path().join("none.obj")),
        Err(Error::Io { .. })
    ));
}
