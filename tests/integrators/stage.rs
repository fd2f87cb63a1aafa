//! Small scenes of one material and one light each: a ball on a floor before the camera.

use lucerna::accel::Backend;
use lucerna::integrator::Integrator;
use lucerna::scene::ViewOverrides;
use lucerna::spectrum::ColorMode;

use crate::common::means::{FEWEST_RUNS, Means};
use crate::common::render::{Built, blocks, parse};
use crate::common::sidak;
use crate::surfaces;

/// Lights, by name. None is so small that directions drawn without knowing of it would hardly meet it.
const LIGHTS: [(&str, &str); 7] = [
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
fn scene(material: &str, light: &str) -> String {
    let light = LIGHTS
        .iter()
        .find(|(name, _)| *name == light)
        .unwrap_or_else(|| panic!("there is no light `{light}`"))
        .1;
    let material = surfaces::material(material);
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
        {material}
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

/// The scene of a material and a light, by their names, built.
pub fn build(material: &str, light: &str) -> Built {
    Built::new(parse(&scene(material, light)), Backend::default(), ColorMode::Rgb)
}

/// The integrator of a scene.
pub fn integrator(built: &Built) -> Integrator {
    Integrator::from_desc(&built.desc.integrator)
}

/// Comparisons of this program with itself: all of them together fail by chance once in a hundred selections of seeds.
pub const COMPARISONS: usize = 92;

/// How runs of two integrators are compared.
pub fn means() -> Means {
    Means {
        significance: sidak(0.01, COMPARISONS),
        ..Means::default()
    }
}
