//! Files that a scene names: includes, meshes, and what is wrong with them.

use std::io::Write;

use lucerna::desc::{ClassedTexture, ParseOptions, ShapeKind, TextureKind, load, serialized};
use lucerna::error::Error;

use super::super::STRICT;
use super::file;

/// A directory with these files.
fn directory(files: &[(&str, &str)]) -> tempfile::TempDir {
    let directory = tempfile::tempdir().expect("a directory");
    for (name, content) in files {
        std::fs::write(directory.path().join(name), content).expect("a file");
    }
    directory
}

fn error_of(files: &[(&str, &str)]) -> String {
    let directory = directory(files);
    match load(&directory.path().join("scene.xml"), &STRICT) {
        Err(Error::Scene(diagnostics)) => diagnostics[0].to_string(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn included_files_share_parameters_and_ids() {
    let main = file(
        r#"<default name="size" value="3"/><include filename="part.xml"/><shape type="cube"><ref id="white"/></shape>"#,
    );
    let part = r#"<scene version="3.0.0"><bsdf type="diffuse" id="white"/><shape type="sphere"><float name="radius" value="$size"/></shape></scene>"#;
    let directory = directory(&[("scene.xml", &main), ("part.xml", part)]);
    let scene = load(&directory.path().join("scene.xml"), &STRICT).unwrap_or_else(|e| panic!("{e}"));
    assert!(matches!(scene.shapes[0].kind, ShapeKind::Sphere { radius: 3.0 }));
    assert_eq!(scene.shapes.len(), 2);
}

#[test]
fn includes_cannot_go_round() {
    let main = file(r#"<include filename="part.xml"/>"#);
    let part = r#"<scene version="3.0.0"><include filename="scene.xml"/></scene>"#;
    let message = error_of(&[("scene.xml", &main), ("part.xml", part)]);
    assert!(
        message.contains("part.xml:1:") && message.contains("includes itself"),
        "{message}"
    );
}

#[test]
fn errors_in_included_files_name_them() {
    let main = file(r#"<include filename="part.xml"/>"#);
    let part = "<scene version=\"3.0.0\">\n<shape type=\"spere\"/></scene>";
    let message = error_of(&[("scene.xml", &main), ("part.xml", part)]);
    assert!(message.contains("part.xml:2:14: error"), "{message}");
}

#[test]
fn meshes_get_smooth_normals_unless_they_are_not_wanted() {
    let obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";
    let main = file(
        r#"<shape type="obj"><string name="filename" value="m.obj"/></shape>
        <shape type="obj"><string name="filename" value="m.obj"/><boolean name="face_normals" value="true"/></shape>
        <shape type="obj"><string name="filename" value="m.obj"/><boolean name="flip_tex_coords" value="false"/></shape>"#,
    );
    let directory = directory(&[("scene.xml", &main), ("m.obj", obj)]);
    let scene = load(&directory.path().join("scene.xml"), &ParseOptions::default()).unwrap_or_else(|e| panic!("{e}"));
    let mesh = |i: usize| match &scene.shapes[i].kind {
        ShapeKind::TriangleMesh(mesh) => mesh,
        _ => panic!("a mesh"),
    };
    assert_eq!(mesh(0).normals, [glam::Vec3::Z; 4]);
    assert!(mesh(1).normals.is_empty());
    // Mitsuba turns v of OBJ files round, and this program turns it back.
    assert_eq!((mesh(0).uvs[3].y, mesh(2).uvs[3].y), (1.0, 0.0));
    let message = error_of(&[("scene.xml", &main), ("m.obj", "v 0 0 0\nf 1 2 3\n")]);
    assert!(message.contains("m.obj:2:5: there is no vertex 2"), "{message}");
}

/// Two meshes in one file of version 4, one of single and one of double precision.
fn two_serialized() -> Vec<u8> {
    let mesh = |double: bool, z: f64| {
        let mut raw = Vec::new();
        raw.extend(if double { 0x2000_u32 } else { 0x1001 }.to_le_bytes());
        raw.extend(b"name\0");
        raw.extend(3_u64.to_le_bytes());
        raw.extend(1_u64.to_le_bytes());
        let mut number = |v: f64| {
            if double {
                raw.extend(v.to_le_bytes());
            } else {
                raw.extend((v as f32).to_le_bytes());
            }
        };
        [0.0, 0.0, z, 1.0, 0.0, z, 0.0, 1.0, z]
            .into_iter()
            .for_each(&mut number);
        if !double {
            [0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0]
                .into_iter()
                .for_each(&mut number);
        }
        raw.extend([0_u32, 1, 2].iter().flat_map(|v| v.to_le_bytes()));
        let mut content = vec![0x1c, 0x04, 4, 0];
        let mut encoder = flate2::write::ZlibEncoder::new(&mut content, flate2::Compression::default());
        encoder.write_all(&raw).expect("memory");
        encoder.finish().expect("memory");
        content
    };
    let (mut content, second) = (mesh(false, 5.0), mesh(true, 7.0));
    let offsets = [0, content.len() as u64];
    content.extend(second);
    content.extend(offsets.iter().flat_map(|v| v.to_le_bytes()));
    content.extend(2_u32.to_le_bytes());
    content
}

#[test]
fn serialized_meshes_are_read_by_their_number() {
    let content = two_serialized();
    let [first, second] = [0, 1].map(|i| serialized::parse(&content, i).unwrap_or_else(|e| panic!("{e}")).mesh);
    assert_eq!((first.positions[2].z, second.positions[2].z), (5.0, 7.0));
    assert_eq!((first.normals.len(), second.normals.len()), (3, 0));
    assert_eq!(first.indices, [[0, 1, 2]]);
    assert!(serialized::parse(&content, 2).is_err());
    // No cut and no damage makes it panic.
    for end in 0..content.len() {
        drop(serialized::parse(&content[..end], 0));
    }
    for at in 0..content.len() {
        let mut damaged = content.clone();
        damaged[at] ^= 0xff;
        drop(serialized::parse(&damaged, 1));
    }
}

/// Found by fuzzing: the sum of such a place and the length of a header overflowed.
#[test]
fn a_serialized_mesh_at_the_end_of_all_numbers_is_refused() {
    let mut content = two_serialized();
    let at = content.len() - 20;
    content[at..at + 8].fill(0xff);
    content[at + 8..at + 16].fill(0xff);
    for index in 0..2 {
        let problem = serialized::parse(&content, index).expect_err("a mesh");
        assert!(problem.contains("index of the file is damaged"), "{problem}");
    }
}

const COLORED: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
    property float r\nproperty float g\nproperty float b\nproperty float heat_0\nelement face 1\n\
    property list uchar int vertex_indices\nend_header\n0 0 0 1 0 0 .1\n1 0 0 0 1 0 .2\n0 1 0 0 0 1 .3\n3 0 1 2\n";

/// A scene of a shape, the reflectance of which is an attribute and the opacity another.
fn with_attributes(shape: &str, color: &str, number: &str) -> String {
    let texture = |slot: &str, name: &str| {
        format!(r#"<texture type="mesh_attribute" name="{slot}"><string name="name" value="{name}"/></texture>"#)
    };
    let (opacity, reflectance) = (texture("opacity", number), texture("reflectance", color));
    file(&format!(
        r#"{shape}<bsdf type="mask">{opacity}<bsdf type="diffuse">{reflectance}</bsdf></bsdf></shape>"#
    ))
}

const COLORED_SHAPE: &str = r#"<shape type="ply"><string name="filename" value="c.ply"/>"#;

#[test]
fn attributes_of_meshes_are_textures() {
    let text = with_attributes(COLORED_SHAPE, "vertex_color", "vertex_heat");
    let directory = directory(&[("scene.xml", &text), ("c.ply", COLORED)]);
    let scene = load(&directory.path().join("scene.xml"), &STRICT).unwrap_or_else(|e| panic!("{e}"));
    let textures = scene.textures.iter().map(|texture| match &texture.kind {
        ClassedTexture::Float(TextureKind::MeshAttribute { name, scale }) => ("number", name.as_str(), *scale),
        ClassedTexture::Spectrum(TextureKind::MeshAttribute { name, scale }) => ("color", name.as_str(), *scale),
        other => panic!("{other:?}"),
    });
    let textures: Vec<_> = textures.collect();
    assert_eq!(textures.len(), 2);
    assert!(textures.contains(&("number", "vertex_heat", 1.0)) && textures.contains(&("color", "vertex_color", 1.0)));
    let ShapeKind::TriangleMesh(mesh) = &scene.shapes[0].kind else {
        panic!("a mesh")
    };
    let names: Vec<_> = mesh
        .attributes
        .iter()
        .map(|attribute| attribute.name.as_str())
        .collect();
    assert_eq!(names, ["vertex_color", "vertex_heat"]);
}

#[test]
fn attributes_that_are_not_there_are_named() {
    for (shape, color, number, message) in [
        (
            COLORED_SHAPE,
            "vertex_colour",
            "vertex_heat",
            "it has `vertex_color`, `vertex_heat`",
        ),
        ("<shape type=\"sphere\">", "vertex_color", "vertex_color", "it has none"),
        (COLORED_SHAPE, "vertex_color", "vertex_color", "asks for a number"),
        (COLORED_SHAPE, "vertex_color", "heat", "begin with `vertex_` or `face_`"),
    ] {
        let text = with_attributes(shape, color, number);
        let error = error_of(&[("scene.xml", &text), ("c.ply", COLORED)]);
        assert!(error.contains(message), "{error}");
    }
}
