//! Paths that are taken to their next events together have the bits of those taken one by one.

use lucerna::accel::Backend;
use lucerna::desc::Heuristic;
use lucerna::integrator::{Fault, Integrator};
use lucerna::scene::ViewOverrides;

use crate::common::render::{Built, MODES, parse};
use crate::lamps::LAMPS;

/// Spheres at rest: seen from outside, sunk into the floor, around it all and turned inwards; and planes beside them.
const SPHERES: &str = r#"
    AttributeBegin AreaLightSource "diffuse" "rgb L" [9 8 7] Translate -1.2 2.2 -0.5 Shape "sphere" "float radius" 0.3 AttributeEnd
    AttributeBegin AreaLightSource "diffuse" "blackbody L" 3200 "float power" 20 "bool twosided" true
        Translate 1.5 0.2 0.5 Shape "sphere" "float radius" 0.7 AttributeEnd
    AttributeBegin AreaLightSource "diffuse" "rgb L" [0.3 0.3 0.4] ReverseOrientation Shape "sphere" "float radius" 30 AttributeEnd
    AttributeBegin AreaLightSource "diffuse" "rgb L" [2 2 3] Translate 0 3.5 0 Rotate 90 1 0 0 Shape "disk" "float radius" 0.5 AttributeEnd
    AttributeBegin AreaLightSource "diffuse" "rgb L" [2 2.2 2.4]
        Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-1 4.5 -1  1 4.5 -1  1 4.5 1  -1 4.5 1] AttributeEnd"#;

/// Lambertian triangles, plain, with normals, with a picture, moving, black, with holes; spheres, with holes.
const LAMBERTIAN: [&str; 6] = [
    r#""diffuse" "texture reflectance" "bricks""#,
    r#""diffuse" "rgb reflectance" [0.9 0.7 0.6]"#,
    r#""diffuse" "rgb reflectance" [0.3 0.8 0.3]"#,
    r#""diffuse" "rgb reflectance" [0 0 0]"#,
    r#""diffuse""#,
    r#""dielectric""#,
];

/// Conductors, rough and smooth, of both distributions and both kinds of masking, alike along both tangents and not, tinted and not, by
/// textures.
const CONDUCTORS: [&str; 6] = [
    r#""conductor" "texture roughness" "bumps""#,
    r#""conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k" "float roughness" 0.3"#,
    r#""conductor" "float uroughness" 0.01 "float vroughness" 0.3"#,
    r#""conductor" "string distribution" "beckmann" "float uroughness" 0.3 "float vroughness" 0.02 "string masking" "separable""#,
    r#""tinted" "string material" "beckmann" "texture reflectance" "bricks""#,
    r#""tinted" "string material" "mirror" "rgb reflectance" [0.9 0.5 0.7]"#,
];

/// A room of what is taken together, with a glass sphere among them, or another of the last material.
fn scene(lights: &str, motion: &str, light_sampler: &str, materials: [&str; 6]) -> String {
    let [floor, wall, first, second, ball, last] = materials;
    format!(
        r#"LookAt 0 1.6 -5.5  0 0.8 0  0 1 0
        Camera "perspective" "float fov" 40 "float lensradius" 0.05 "float focaldistance" 5
        Film "rgb" "integer xresolution" 37 "integer yresolution" 23
        Sampler "sobol" "integer pixelsamples" 8
        Integrator "path" "integer maxdepth" 12 "string lightsampler" "{light_sampler}"
        WorldBegin
        {lights}
        Texture "bricks" "spectrum" "imagemap" "string filename" "../scenes/parts/bricks.png" "float uscale" 3
        Texture "bumps" "float" "imagemap" "string filename" "../scenes/parts/bricks.png" "float scale" 0.5
        MakeNamedMaterial "beckmann" "string type" "conductor" "string distribution" "beckmann" "float roughness" 0.1
        MakeNamedMaterial "mirror" "string type" "conductor"
        AttributeBegin
            Material {floor}
            Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-9 0 -5  -9 0 9  9 0 9  9 0 -5]
                "point2 uv" [0 0 0 1 1 1 1 0]
        AttributeEnd
        AttributeBegin
            Material {wall}
            Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-9 0 2  -9 6 2  9 6 2  9 0 2]
                "normal N" [0.2 0 -1  0 0.3 -1  -0.2 0 -1  0 -0.3 -1]
        AttributeEnd
        AttributeBegin
            {motion}
            Material {first}
            Shape "trianglemesh" "integer indices" [0 1 2] "point3 P" [-3 0 -1  -1 0 -1  -2 2 0]
            Material {second}
            Shape "trianglemesh" "integer indices" [0 1 2] "point3 P" [1 0 -1  3 0 -1  2 2 0]
            Material {last} Translate 0 0.7 -1 Shape "sphere" "float radius" 0.6
            Material {ball} Translate 0 1.3 0 Shape "sphere" "float radius" 0.6
            Shape "sphere" "float radius" 0.8 "float alpha" 0.4
            Shape "trianglemesh" "integer indices" [0 1 2] "point3 P" [-1 1 -0.7  1 1 -0.7  0 2 -0.7] "float alpha" 0.5
        AttributeEnd"#
    )
}

#[test]
fn paths_taken_together_are_those_taken_one_by_one() {
    let motions = ["", "ActiveTransform EndTime Translate 0.2 0.1 0.1 ActiveTransform All"];
    let spheres = ("spheres at rest", SPHERES.to_owned());
    let lamps = LAMPS.iter().zip(motions.iter().cycle());
    let lights = lamps.map(|(lamp, motion)| (lamp.name, lamp.text(motion)));
    for (i, (lights_name, lights)) in lights.chain([spheres]).enumerate() {
        let light_sampler = ["bvh", "power", "uniform"][i % 3];
        for (name, materials) in [("Lambertian", LAMBERTIAN), ("conductors", CONDUCTORS)] {
            let text = scene(&lights, motions[i % 2], light_sampler, materials);
            for color in MODES {
                let name = format!("{name} under {lights_name} in {color:?}");
                same_both_ways(&Built::new(parse(&text), Backend::Bvh, color), &name);
            }
        }
    }
}

/// The picture of `built` is the same whether paths are taken together or one by one, with either heuristic; most are taken together.
fn same_both_ways(built: &Built, name: &str) {
    let view = built.view(0, &ViewOverrides::default());
    for heuristic in [Heuristic::Power, Heuristic::Balance] {
        let Integrator::Path(mut path) = Integrator::from_desc(&built.desc.integrator) else {
            panic!("not a path tracer");
        };
        path.heuristic = heuristic;
        let (together, stats) = built.picture_with(&view, Integrator::Path(path));
        path.fault = Fault::OneByOne;
        let (one_by_one, other) = built.picture_with(&view, Integrator::Path(path));
        let name = format!("{name}, {heuristic:?}");
        assert!(together.iter().sum::<f32>() > 0.0, "{name} is black");
        let rays = |stats: &lucerna::integrator::RenderStats| (stats.bounce_rays, stats.shadow_rays);
        assert_eq!(rays(&stats), rays(&other), "{name}");
        assert!(
            stats.events_together > stats.bounce_rays / 2 && other.events_together == 0,
            "{name}"
        );
        let different = together.iter().zip(&one_by_one).filter(|(a, b)| a != b).count();
        assert_eq!(different, 0, "{name}: so many of {}", together.len());
    }
}
