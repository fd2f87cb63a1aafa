//! What is written and read again, or said in another format, is the same picture.

use std::path::Path;

use lucerna::accel::Backend;
use lucerna::desc::{ParseOptions, SceneDesc, load};
use lucerna::integrator::Integrator;
use lucerna::scene::ViewOverrides;
use lucerna::spectrum::ColorMode;

use crate::common;
use crate::common::render::{Built, parse};
use crate::everything;

/// A scene of Mitsuba's with round curves of both kinds, and a mesh with attributes of vertices and triangles.
fn curves_and_attributes(folder: &Path) -> SceneDesc {
    let side = 16;
    let mut ply = format!(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\nproperty uchar r\n\
         property uchar g\nproperty uchar b\nproperty float heat_0\nelement face {}\nproperty list uchar int vertex_indices\n\
         property float glow_x\nproperty float glow_y\nproperty float glow_z\nend_header\n",
        side * side,
        2 * (side - 1) * (side - 1)
    );
    for i in 0..side * side {
        let (x, y) = (i % side, i / side);
        let [u, v] = [x, y].map(|k| f64::from(k) / 4.0 - 2.0);
        ply += &format!(
            "{u} {v} {} {} {} 99 {}\n",
            (u * v).sin() / 3.0,
            16 * x,
            16 * y,
            f64::from(i % 7) / 6.0
        );
    }
    for i in 0..(side - 1) * (side - 1) {
        let a = i % (side - 1) + i / (side - 1) * side;
        let (b, c, d) = (a + 1, a + side, a + side + 1);
        ply += &format!("3 {a} {b} {d} .{} .2 .9\n3 {a} {d} {c} .7 .{} .1\n", i % 9, i % 5);
    }
    let spline = "-2 -1 2 .3\n-1 1 2 .2\n0 -1 2 .3\n1 1 2 .1\n2 -1 2 .2\n\n-2 2 1 .1\n0 1 1 .2\n1 2 1 .1\n2 0 1 .1\n";
    let texture = |slot: &str, name: &str| {
        format!(
            r#"<texture type="mesh_attribute" name="{slot}"><string name="name" value="{name}"/><float name="scale" value=".9"/></texture>"#
        )
    };
    let shape = |kind: &str, file: &str, bsdf: &str| {
        format!(r#"<shape type="{kind}"><string name="filename" value="{file}"/>{bsdf}</shape>"#)
    };
    let diffuse = |name: &str| format!(r#"<bsdf type="diffuse">{}</bsdf>"#, texture("reflectance", name));
    let xml = format!(
        r#"<scene version="3.0.0"><sensor type="perspective"><float name="fov" value="50"/><transform name="to_world">
        <lookat origin="0,0,7" target="0,0,0" up="0,1,0"/></transform></sensor><emitter type="constant"/>{}{}{}{}</scene>"#,
        shape(
            "ply",
            "mesh.ply",
            &format!(
                r#"<bsdf type="mask">{}{}</bsdf>"#,
                texture("opacity", "vertex_heat"),
                diffuse("vertex_color")
            )
        ),
        shape(
            "ply",
            "mesh.ply",
            &format!(
                r#"<transform name="to_world"><translate z="-1"/></transform>{}"#,
                diffuse("face_glow")
            )
        ),
        shape("bsplinecurve", "spline.txt", r#"<bsdf type="plastic"/>"#),
        shape(
            "linearcurve",
            "spline.txt",
            r#"<transform name="to_world"><translate y="1"/></transform>"#
        ),
    );
    for (name, content) in [("mesh.ply", ply.as_str()), ("spline.txt", spline), ("scene.xml", &xml)] {
        std::fs::write(folder.join(name), content).expect("a file");
    }
    load(&folder.join("scene.xml"), &ParseOptions::default()).unwrap_or_else(|e| panic!("{e}"))
}

/// A scene that is written to a file and read again gives the same picture, bit by bit.
#[test]
fn a_written_scene_gives_the_same_bits() {
    let folder = tempfile::TempDir::new().expect("a folder");
    let file = folder.path().join("again.pbrt");
    let everything = everything("PixelFilter \"mitchell\" \"float xradius\" 1.7");
    let fog = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/fog.pbrt")).expect("a scene");
    let mitsuba = {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/seeds/mitsuba/materials.xml");
        load(&path, &ParseOptions::default()).unwrap_or_else(|e| panic!("{e}"))
    };
    let curves = curves_and_attributes(folder.path());
    for desc in [parse(&everything), parse(&fog), mitsuba, curves] {
        lucerna::desc::pbrt::write(&desc, &file).unwrap_or_else(|e| panic!("{e}"));
        let again = load(&file, &ParseOptions::default()).unwrap_or_else(|e| panic!("{e}"));
        let overrides = ViewOverrides {
            resolution: Some([75, 50]),
            spp: Some(2),
            ..ViewOverrides::default()
        };
        let built = Built::new(desc, Backend::Bvh, ColorMode::Spectral);
        // As the program builds it.
        let taken = Built::taking_shapes(again, Backend::Bvh, ColorMode::Spectral);
        let [picture, other] = [built, taken].map(|built| built.picture(&built.view(0, &overrides)));
        assert!(picture.iter().any(|&v| v > 0.0) && picture == other);
    }
}

/// A scene of pbrt-v3 is the same picture as what pbrt-v4 has for it.
#[test]
fn the_cornell_box_of_pbrt_v3_is_the_same_picture() {
    let Some(scenes) = common::shared("scenes") else { return };
    let [old, new] = ["scene.pbrt", "scene-v4.pbrt"].map(|name| {
        let desc = load(&scenes.join("cornell-box").join(name), &ParseOptions::default());
        let built = Built::new(desc.expect("a scene"), Backend::default(), ColorMode::Spectral);
        let overrides = ViewOverrides {
            resolution: Some([48, 48]),
            spp: Some(4),
            ..ViewOverrides::default()
        };
        // The files ask for other depths.
        let integrator = Integrator::from_desc(&built.desc.integrator).with_max_depth(Some(5));
        built.picture_with(&built.view(0, &overrides), integrator).0
    });
    assert_eq!(old, new);
    assert!(old.iter().any(|&value| value > 1.0));
}
