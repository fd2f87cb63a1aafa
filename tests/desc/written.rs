//! Scenes written as pbrt files and read again: the same, number for number.

use std::path::Path;

use lucerna::desc::{ParseOptions, SceneDesc, ShapeKind, load, pbrt};
use tempfile::TempDir;

use super::STRICT;

/// What a description says, without where it says it, what stands in which file, and materials' names that a file has to make up.
fn meaning(desc: &SceneDesc) -> String {
    let text = format!("{desc:#?}");
    let mut lines = Vec::new();
    let mut skipped = None;
    for line in text.lines() {
        let depth = line.len() - line.trim_start().len();
        match skipped {
            // Until the bracket at the depth of what is skipped.
            Some(at) if depth > at => continue,
            Some(_) => skipped = None,
            None => {
                let key = line.trim_start();
                let is_place = [
                    "span: ",
                    "sources: ",
                    "hash: ",
                    "path: ",
                    "warnings: ",
                    "name: Some",
                    "name: None",
                    "chromaticities: ",
                ];
                if is_place.iter().any(|place| key.starts_with(place)) {
                    skipped = key.ends_with(['{', '[', '(']).then_some(depth);
                    continue;
                }
                lines.push(line.to_owned());
            }
        }
    }
    lines.join("\n")
}

/// The description after a trip through a file.
fn there_and_back(desc: &SceneDesc) -> SceneDesc {
    let folder = TempDir::new().expect("a folder");
    let file = folder.path().join("again.pbrt");
    pbrt::write(desc, &file).unwrap_or_else(|e| panic!("{e}"));
    load(&file, &STRICT).unwrap_or_else(|e| panic!("{e}"))
}

fn check(name: &str, desc: &SceneDesc) {
    let again = there_and_back(desc);
    let (a, b) = (meaning(desc), meaning(&again));
    if let Some((a, b)) = a.lines().zip(b.lines()).find(|(a, b)| a != b) {
        panic!("{name}: {a}\nbecomes {b}");
    }
    assert_eq!(a.len(), b.len(), "{name}");
}

#[test]
fn every_scene_is_the_same_again() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let mut scenes: Vec<_> = std::fs::read_dir(&folder)
        .expect("scenes")
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|extension| extension == "pbrt"))
        .collect();
    scenes.sort();
    assert!(scenes.len() > 10);
    for path in scenes {
        let desc = load(&path, &ParseOptions::default()).unwrap_or_else(|e| panic!("{e}"));
        check(&path.display().to_string(), &desc);
    }
}

/// What no scene of ours has.
#[test]
fn rarer_things_are_the_same_again() {
    for text in [
        "Integrator \"ambientocclusion\" \"bool cossample\" false \"float maxdistance\" 2 WorldBegin",
        "Integrator \"ambientocclusion\" WorldBegin",
        "Film \"gbuffer\" \"string coordinatesystem\" \"world\" Camera \"spherical\" WorldBegin",
        "Film \"spectral\" \"float lambdamin\" 400.5 \"integer nbuckets\" 7 Camera \"perspective\" WorldBegin",
        "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb sigma_t\" [1 2 3] \"rgb albedo\" [.5 .2 .1] WorldBegin
            MediumInterface \"m\" \"\" Shape \"sphere\"",
        "WorldBegin Shape \"disk\" \"bool radialuv\" true Shape \"disk\"",
        "WorldBegin Material \"hair\" \"rgb sigma_a\" [3 2 1] \"float beta_n\" .4 Shape \"sphere\"",
        "WorldBegin Material \"hair\" \"float pheomelanin\" .4 Shape \"sphere\"",
        "WorldBegin Material \"hair\" \"rgb color\" [.3 .2 .1] \"float alpha\" 3 \"float eta\" 1.4 Shape \"sphere\"",
        include_str!("../seeds/pbrt/attributes.pbrt"),
        "Camera \"perspective\" \"float shutterclose\" .5 Film \"image\" \"float scale\" 3 WorldBegin Material \"plastic\"
            Shape \"sphere\" LightSource \"infinite\" \"blackbody L\" [4000 2]",
    ] {
        check(text, &crate::scene(text));
    }
}

/// What is too long for the scene itself stands in a PLY file, attributes too.
#[test]
fn attributes_of_large_meshes_are_the_same_again() {
    let triangles = 300;
    let list =
        |count: usize, factor: f64| -> String { (0..count).map(|i| format!("{} ", i as f64 * factor)).collect() };
    let indices: String = (0..triangles).map(|i| format!("{i} {} {} ", i + 1, i + 2)).collect();
    let vertices = triangles + 2;
    let points: String = (0..vertices).map(|i| format!("{i} {} {} ", i % 2, i % 3)).collect();
    let text = format!(
        "WorldBegin Texture \"a\" \"spectrum\" \"meshattribute\" \"string name\" \"vertex_color\"
        Texture \"b\" \"float\" \"meshattribute\" \"string name\" \"face_texture_u\" \"float scale\" -.3
        Material \"diffuse\" \"texture reflectance\" \"a\" \"texture roughness\" \"b\"
        Shape \"trianglemesh\" \"point3 P\" [{points}] \"integer indices\" [{indices}]
        \"rgb vertex_color\" [{}] \"float vertex_heat_r\" [{}] \"float face_texture_u\" [{}] \"rgb face_u\" [{}]",
        list(3 * vertices, 0.001),
        list(vertices, -0.7),
        list(triangles, 1e-30),
        list(3 * triangles, 3e7),
    );
    let desc = crate::scene(&text);
    let ShapeKind::TriangleMesh(mesh) = &desc.shapes[0].kind else {
        panic!("a mesh")
    };
    assert_eq!(mesh.attributes.len(), 4);
    let folder = TempDir::new().expect("a folder");
    let notes = pbrt::write(&desc, &folder.path().join("a.pbrt")).unwrap_or_else(|e| panic!("{e}"));
    assert!(folder.path().join("a-parts/mesh-1.ply").exists());
    assert!(notes.iter().any(|note| note.contains("meshattribute")), "{notes:?}");
    check("attributes", &desc);
}

/// Mitsuba's scenes, with all that pbrt-v4 has no word for.
#[test]
fn scenes_of_mitsuba_are_the_same_again() {
    let image = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/seeds/png/rgb8.png");
    let ball = |bsdf: &str| format!("<shape type=\"sphere\">{bsdf}</shape>");
    let texture = |content: &str| {
        ball(&format!(
            "<bsdf type=\"diffuse\"><texture type=\"bitmap\" name=\"reflectance\"><string name=\"filename\" value=\"{image}\"/>{content}</texture></bsdf>"
        ))
    };
    let mut scenes = vec![
        texture(r#"<string name="wrap_mode" value="mirror"/><string name="filter_type" value="nearest"/>"#),
        texture(r#"<string name="wrap_mode" value="clamp"/><transform name="to_uv"><scale x="3" y="2"/><rotate z="1" angle="30"/></transform>"#),
        r#"<emitter type="spot"><float name="cutoff_angle" value="25.5"/><float name="beam_width" value="7"/></emitter>"#.to_owned(),
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/seeds/mitsuba/materials.xml")).expect("a scene"),
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/seeds/mitsuba/scene.xml")).expect("a scene"),
    ];
    for bsdf in [
        r#"<bsdf type="diffuse"/>"#,
        r#"<bsdf type="twosided"><bsdf type="diffuse"/><bsdf type="plastic"/></bsdf>"#,
        r#"<emitter type="directionalarea"/>"#,
        r#"<bsdf type="roughplastic"><float name="alpha" value=".3"/><boolean name="nonlinear" value="true"/></bsdf>"#,
        r#"<bsdf type="conductor"/>"#,
        r#"<bsdf type="roughconductor"><string name="material" value="Au"/><string name="distribution" value="ggx"/></bsdf>"#,
        r#"<bsdf type="dielectric"><rgb name="specular_transmittance" value=".9, 1, .8"/></bsdf>"#,
        r#"<bsdf type="thindielectric"><rgb name="specular_reflectance" value=".9, 1, .8"/></bsdf>"#,
        r#"<bsdf type="roughdielectric"><float name="alpha_u" value=".1"/><float name="alpha_v" value=".4"/></bsdf>"#,
        r#"<bsdf type="principled"><float name="metallic" value=".4"/><float name="spec_trans" value=".5"/></bsdf>"#,
        r#"<bsdf type="mask"><float name="opacity" value=".4"/><bsdf type="plastic"/></bsdf>"#,
        r#"<bsdf type="bumpmap"><texture type="checkerboard" name="b"/><bsdf type="blendbsdf"><float name="weight" value=".3"/>
           <bsdf type="diffuse"/><bsdf type="conductor"/></bsdf></bsdf>"#,
        r#"<bsdf type="bumpmap"><texture type="checkerboard" name="b"/><bsdf type="twosided"><bsdf type="diffuse"/><bsdf type="plastic"/></bsdf></bsdf>"#,
    ] {
        scenes.push(ball(bsdf));
    }
    for scene in scenes {
        let text = if scene.contains("<scene") {
            scene
        } else {
            crate::mitsuba::file(&scene)
        };
        let read = lucerna::desc::mitsuba::parse_str(text.as_bytes(), Path::new("scene.xml"), &STRICT);
        check(&text, &read.unwrap_or_else(|e| panic!("{e}")));
    }
}
