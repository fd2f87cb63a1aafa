//! Scenes written as pbrt files and read again: the same, number for number.

use std::path::Path;

use lucerna::desc::{ParseOptions, SceneDesc, load, pbrt};
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
        "Camera \"perspective\" \"float shutterclose\" .5 Film \"image\" \"float scale\" 3 WorldBegin Material \"plastic\"
            Shape \"sphere\" LightSource \"infinite\" \"blackbody L\" [4000 2]",
    ] {
        check(text, &crate::scene(text));
    }
}
