//! Shading normals: photons are as dense as the cosine to the geometric normal says, light counts by that to the shading normal.

use lucerna::integrator::Integrator;
use lucerna::spectrum::ColorMode;

use crate::common::full_tier;
use crate::{assert_agree, build, film, photon, quad, runs, sppm};

/// A floor before a wall, a lamp that shines on the wall and, from the side, on the floor.
fn scene(floor: &str) -> String {
    format!(
        "LookAt 0 2 -1.2  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\n{}WorldBegin\n\
         AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [4 4 4]\nMaterial \"diffuse\" \"rgb reflectance\" [0 0 0]\n{}AttributeEnd\n\
         Material \"diffuse\" \"rgb reflectance\" [0.8 0.8 0.8]\n{}{floor}",
        film([8, 8]),
        quad([-2.0, 0.5, -1.5], [0.0, 1.5, 0.0], [0.0, 0.0, 3.0]),
        quad([2.0, 0.0, -1.5], [0.0, 0.0, 3.0], [0.0, 2.5, 0.0]),
    )
}

/// Flat, so that circles hold as many photons as they should, with normals that lean apart at the corners.
const LEANING: &str = r#"Material "diffuse" "rgb reflectance" [0.7 0.6 0.5]
    Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-2 0 -1.5  -2 0 1.5  2 0 1.5  2 0 -1.5]
        "normal N" [-0.7 1 -0.4  -0.5 1 0.6  0.8 1 0.3  0.4 1 -0.7]"#;

const BUMPS: &str = r#"Texture "dents" "float" "wrinkled" Texture "heights" "float" "scale" "texture tex" "dents" "float scale" 0.2
    Material "diffuse" "rgb reflectance" [0.7 0.6 0.5] "texture displacement" "heights"
    Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-2 0 -1.5  -2 0 1.5  2 0 1.5  2 0 -1.5]
        "point2 uv" [0 0  0 3  4 3  4 0]"#;

const GLOSSY: &str = r#"Material "coateddiffuse" "rgb reflectance" [0.7 0.6 0.5] "float roughness" 0.4
    Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-2 0 -1.5  -2 0 1.5  2 0 1.5  2 0 -1.5]
        "normal N" [-0.5 1 -0.4  -0.5 1 0.4  0.5 1 0.3  0.4 1 -0.5]"#;

#[test]
fn bent_normals_are_what_path_sees() {
    let depth = Some(3);
    for (name, floor) in [("leaning", LEANING), ("bumps", BUMPS), ("glossy", GLOSSY)] {
        if name != "leaning" && !full_tier() {
            continue;
        }
        let built = build(&scene(floor), ColorMode::Rgb);
        let path = Integrator::from_desc(&built.desc.integrator).with_max_depth(depth);
        let reference = runs(&built, path, 192, 101, [8, 8]);
        let two_pass = photon(depth, |p| {
            p.global_photons = Some(10_000);
            p.max_distance = Some(0.1);
            p.passes = 8;
            p.final_gather_samples = 4;
        });
        for (integrator, spp) in [(two_pass, 16), (sppm(depth, 10_000, 0.1), 24)] {
            let ours = runs(&built, integrator, spp, 1, [8, 8]);
            assert_agree(
                &format!("{name} by {}", integrator.name()),
                &ours,
                &reference,
                0.01,
                0.08,
            );
        }
    }
}
