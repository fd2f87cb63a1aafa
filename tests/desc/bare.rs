//! Meshes by themselves: the stage that they are put on, and the materials of OBJ files.

use std::path::Path;

use glam::{DVec3, Vec3};
use lucerna::desc::obj::mtl;
use lucerna::desc::{LightKind, MaterialKind, MeshDesc, SceneDesc, ShapeDesc, ShapeKind, Textured, bare};
use lucerna::error::{Error, Result};

use super::STRICT;

const SQUARE: &str = "v 4 1 0\nv 6 1 0\nv 6 3 0\nv 4 3 0\nvt 0 0\n";

const LIBRARY: &str = "# colours
newmtl red wall
Kd .8 .1 .1
illum 1
newmtl gloss
Kd .2 .3 .4
Ks .5
Ns 98
newmtl mirror
illum 3
Ks .9 .9 .9
newmtl glass
illum 7
Ni 1.33
d .1
newmtl lamp
Kd 0 0 0
Ke 3 2 1
newmtl gauze
d .25
newmtl wood
Kd 0 0 0
map_Kd -s 2 2 -clamp on a picture.pfm
";

fn load(files: &[(&str, &[u8])], main: &str, env: Option<&str>) -> Result<SceneDesc> {
    let directory = tempfile::tempdir().unwrap();
    for (name, content) in files {
        std::fs::write(directory.path().join(name), content).unwrap();
    }
    let env = env.map(|env| directory.path().join(env));
    bare::load(&directory.path().join(main), env.as_deref(), &STRICT)
}

fn mesh(shape: &ShapeDesc) -> &MeshDesc {
    match &shape.kind {
        ShapeKind::TriangleMesh(mesh) => mesh,
        other => panic!("{other:?}"),
    }
}

/// The PFM file of a picture.
fn pfm(width: usize, height: usize) -> Vec<u8> {
    let mut file = format!("PF\n{width} {height}\n-1.0\n").into_bytes();
    file.extend((0..3 * width * height).flat_map(|_| 0.5_f32.to_le_bytes()));
    file
}

#[test]
fn a_mesh_stands_on_a_stage_that_its_camera_sees() {
    let scene = load(&[("m.obj", format!("{SQUARE}f 1 2 3 4").as_bytes())], "m.obj", None).unwrap();
    // The floor, the lamp, the mesh.
    assert_eq!((scene.shapes.len(), scene.lights.len()), (3, 1));
    assert!(scene.shapes[1].area_light.is_some() && scene.shapes[2].area_light.is_none());
    assert_eq!(mesh(&scene.shapes[2]).indices.len(), 2);
    let floor = scene.shapes[0].world_from_object.start.translation;
    assert_eq!(floor, DVec3::new(5.0, 1.0, 0.0));
    let camera = scene.views[0].camera.world_from_camera().start;
    // The middle of the mesh is straight ahead, above the floor, and as far as its size needs.
    let middle = camera.inverse().transform_point3(DVec3::new(5.0, 2.0, 0.0));
    assert!(
        middle.truncate().length() < 1e-4 && middle.z > 2.0 && middle.z < 10.0,
        "{middle}"
    );
    assert!(camera.translation.y > 1.0);
    // Not mirrored: what is at greater x is to the right.
    let right = camera.inverse().transform_point3(DVec3::new(5.1, 2.0, 0.0));
    assert!(right.x > 0.0);
}

#[test]
fn an_environment_takes_the_place_of_the_lamp() {
    let square = format!("{SQUARE}f 1 2 3 4");
    let files: [(&str, &[u8]); 2] = [("m.obj", square.as_bytes()), ("sky \"1\".pfm", &pfm(4, 2))];
    let scene = load(&files, "m.obj", Some("sky \"1\".pfm")).unwrap();
    assert_eq!((scene.shapes.len(), scene.lights.len()), (1, 1));
    assert!(matches!(
        &scene.lights[0].kind,
        LightKind::Infinite { image: Some(_), .. }
    ));
    // Its pole, +z, is up.
    let up = scene.lights[0].world_from_light.start.transform_vector3(DVec3::Z);
    assert!((up - DVec3::Y).length() < 1e-12);
    assert!(load(&files, "m.obj", Some("none.pfm")).is_err());
}

#[test]
fn ply_meshes_stand_there_too() {
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n\
               property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2";
    let scene = load(&[("m.ply", ply.as_bytes())], "m.ply", None).unwrap();
    assert_eq!(mesh(&scene.shapes[2]).positions, [Vec3::ZERO, Vec3::X, Vec3::Y]);
    let Err(Error::Scene(errors)) = load(&[("m.ply", b"ply\nformat")], "m.ply", None) else {
        panic!()
    };
    assert!(errors[0].to_string().contains("m.ply:"), "{}", errors[0]);
}

#[test]
fn libraries_become_materials() {
    let text = format!(
        "mtllib my colours.mtl\n{SQUARE}f 1 2 3\nusemtl red wall\nf 1 2 3\nusemtl gloss\nf 1 2 3\nusemtl mirror\nf 1 2 3\n\
         usemtl glass\nf 1 2 3\nusemtl lamp\nf 1 2 3\nusemtl gauze\nf 1 2 3\nusemtl wood\nf 1 2 3\nusemtl unheard of\nf 2 3 4"
    );
    let files: [(&str, &[u8]); 3] = [
        ("m.obj", text.as_bytes()),
        ("my colours.mtl", LIBRARY.as_bytes()),
        ("a picture.pfm", &pfm(2, 2)),
    ];
    let scene = load(&files, "m.obj", None).unwrap();
    let parts = &scene.shapes[2..];
    assert_eq!(parts.len(), 9);
    assert!(parts.iter().all(|part| mesh(part).indices.len() == 1));
    let kind = |i: usize| &scene.materials[parts[i].material.0 as usize].kind;
    assert!(matches!(kind(0), MaterialKind::Diffuse { .. }));
    assert!(matches!(kind(1), MaterialKind::Diffuse { .. }));
    assert!(matches!(kind(2), MaterialKind::CoatedDiffuse { .. }));
    assert!(matches!(kind(3), MaterialKind::Conductor { .. }));
    assert!(matches!(kind(4), MaterialKind::Dielectric { .. }));
    assert!(parts[5].area_light.is_some());
    assert_eq!(parts[4].alpha, Textured::Value(1.0));
    assert_eq!(parts[6].alpha, Textured::Value(0.25));
    assert_eq!(scene.images.len(), 1);
    let warnings: Vec<_> = scene.warnings.iter().map(ToString::to_string).collect();
    assert!(
        warnings
            .iter()
            .any(|w| w.contains("m.obj:22:8") && w.contains("no library")),
        "{warnings:?}"
    );
    assert!(
        warnings
            .iter()
            .any(|w| w.contains("my colours.mtl:23:8") && w.contains("options")),
        "{warnings:?}"
    );
}

#[test]
fn bad_libraries_are_refused_with_the_place() {
    for (text, place, message) in [
        ("Kd 1 1 1", (1, 1), "before any `newmtl`"),
        ("newmtl\n", (1, 1), "expected a name"),
        ("newmtl a\nKd 1 x 1", (2, 6), "expected a number"),
        ("newmtl a\nKd 1 2 1", (2, 6), "between 0 and 1"),
        ("newmtl a\nKd", (2, 1), "takes a number"),
        ("newmtl a\nNs -1", (2, 4), "0 or more"),
        ("newmtl a\nNs nan", (2, 4), "0 or more"),
        ("newmtl a\nd 1.5", (2, 3), "between 0 and 1"),
        ("newmtl a\nillum 99", (2, 7), "between 0 and 10"),
        ("newmtl a\nmap_Kd none.png", (2, 8), "there is no file none.png"),
        ("newmtl a\nmap_Kd -bm 1 none.png", (2, 14), "there is no file none.png"),
        ("newmtl a\nmap_Kd", (2, 1), "expected a file name"),
    ] {
        let Err(Error::Scene(errors)) = mtl::parse(text.as_bytes(), Path::new("x.mtl")) else {
            panic!("{text}")
        };
        assert_eq!((errors[0].line, errors[0].column), place, "{}", errors[0]);
        assert!(errors[0].message.contains(message), "{}", errors[0]);
    }
    let file = mtl::parse(b"newmtl a\nbump x.png\nKa 1 1 1\nTr .25", Path::new("x.mtl")).unwrap();
    assert_eq!(file.materials[0].opacity, 0.75);
    assert_eq!(file.warnings.len(), 1);
}
