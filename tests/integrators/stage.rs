//! Small scenes of one material and one light each: a ball on a floor before the camera.

use lucerna::accel::Backend;
use lucerna::integrator::Integrator;
use lucerna::scene::ViewOverrides;
use lucerna::spectrum::ColorMode;

use crate::common::means::{FEWEST_RUNS, Means};
use crate::common::render::{Built, blocks, parse};
use crate::common::sidak;

/// Materials of the ball, by name.
pub const MATERIALS: [(&str, &str); 14] = [
    ("diffuse", r#""diffuse" "rgb reflectance" [0.7 0.5 0.3]"#),
    (
        "Oren-Nayar",
        r#""diffuse" "rgb reflectance" [0.7 0.5 0.3] "float roughness" 0.8"#,
    ),
    (
        "diffuse transmission",
        r#""diffusetransmission" "rgb reflectance" [0.4 0.2 0.1] "rgb transmittance" [0.3 0.3 0.5]"#,
    ),
    ("mirror", r#""conductor" "rgb reflectance" [0.9 0.8 0.7]"#),
    ("rough metal", r#""conductor" "float roughness" 0.3"#),
    (
        "anisotropic metal",
        r#""conductor" "float uroughness" 0.5 "float vroughness" 0.15"#,
    ),
    ("glass", r#""dielectric" "float eta" 1.5"#),
    ("rough glass", r#""dielectric" "float eta" 1.5 "float roughness" 0.25"#),
    ("thin glass", r#""thindielectric" "float eta" 1.5"#),
    (
        "smooth coat",
        r#""coateddiffuse" "rgb reflectance" [0.6 0.4 0.2] "float roughness" 0"#,
    ),
    (
        "rough coat",
        r#""coateddiffuse" "rgb reflectance" [0.6 0.4 0.2] "float roughness" 0.3"#,
    ),
    (
        "coated metal",
        r#""coatedconductor" "float conductor.roughness" 0.2 "float interface.roughness" 0.2"#,
    ),
    (
        "metal of many bounces",
        r#""conductor" "float roughness" 0.6 "bool multiplescattering" true"#,
    ),
    (
        "principled",
        r#""principled" "rgb base_color" [0.7 0.5 0.3] "float metallic" 0.3 "float roughness" 0.4 "float clearcoat" 0.8
           "float spec_trans" 0.2"#,
    ),
];

/// Lights, by name. None is so small that directions drawn without knowing of it would hardly meet it.
pub const LIGHTS: [(&str, &str); 8] = [
    (
        "area",
        r#"AttributeBegin AreaLightSource "diffuse" "rgb L" [2 2.2 2.4]
           Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-2 3 -2  2 3 -2  2 3 2  -2 3 2] AttributeEnd"#,
    ),
    (
        "sphere",
        r#"AttributeBegin AreaLightSource "diffuse" "rgb L" [3 2.8 2.6] Translate -2 2.2 -0.5
           Shape "sphere" "float radius" 1 AttributeEnd"#,
    ),
    ("sky", r#"LightSource "infinite" "rgb L" [0.6 0.7 0.9]"#),
    (
        "point",
        r#"LightSource "point" "point3 from" [-1.5 3 -2] "rgb I" [9 8 7]"#,
    ),
    (
        "spot",
        r#"LightSource "spot" "point3 from" [-1.5 4 -2] "point3 to" [0 0 0] "float coneangle" 40 "rgb I" [16 15 14]"#,
    ),
    (
        "distant",
        r#"LightSource "distant" "point3 from" [1 2 -1] "point3 to" [0 0 0] "rgb L" [1.5 1.4 1.2]"#,
    ),
    (
        "two",
        r#"LightSource "point" "point3 from" [-1.5 3 -2] "rgb I" [5 4 3]
           LightSource "infinite" "rgb L" [0.3 0.35 0.4]"#,
    ),
    (
        "inside",
        r#"AttributeBegin AreaLightSource "diffuse" "rgb L" [3 2.8 2.6] Material "diffuse" Translate 0 0.9 0
           Shape "sphere" "float radius" 0.5 AttributeEnd"#,
    ),
];

/// A scene of a material and a light.
pub fn scene(material: &str, light: &str) -> String {
    format!(
        r#"LookAt 0 1.4 -5  0 0.7 0  0 1 0
        Camera "perspective" "float fov" 32
        Film "rgb" "integer xresolution" 24 "integer yresolution" 16
        PixelFilter "box"
        Integrator "path" "integer maxdepth" 3
        WorldBegin
        {light}
        AttributeBegin
            Material "diffuse" "rgb reflectance" [0.5 0.55 0.6]
            Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-4 0 -3  -4 0 4  4 0 4  4 0 -3]
        AttributeEnd
        Material {material}
        Translate 0 0.9 0
        Shape "sphere" "float radius" 0.9"#
    )
}

/// 16 renders by an integrator: the means of blocks of 8 x 8 pixels.
pub fn runs(built: &Built, integrator: Integrator, spp: u32, first_seed: u64) -> Vec<Vec<f64>> {
    let run = |seed| {
        let overrides = ViewOverrides {
            seed,
            spp: Some(spp),
            ..ViewOverrides::default()
        };
        let view = built.view(0, &overrides);
        let (picture, stats) = built.picture_with(&view, integrator);
        assert_eq!(stats.dropped_samples, 0, "dropped: {:?}", stats.dropped);
        blocks(&picture, view.resolution[0] as usize, [8, 8])
    };
    (first_seed..first_seed + FEWEST_RUNS as u64).map(run).collect()
}

/// The scene of a material and a light, built.
pub fn build(material: &str, light: &str, backend: Backend, color: ColorMode) -> Built {
    Built::new(parse(&scene(material, light)), backend, color)
}

/// The integrator of a scene.
pub fn integrator(built: &Built) -> Integrator {
    Integrator::from_desc(&built.desc.integrator)
}

/// Comparisons of this program with itself: all of them together fail by chance once in a hundred selections of seeds.
pub const COMPARISONS: usize = 80;

/// How runs of two integrators are compared.
pub fn means() -> Means {
    Means {
        significance: sidak(0.01, COMPARISONS),
        ..Means::default()
    }
}
