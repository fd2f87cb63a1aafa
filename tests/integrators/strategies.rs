//! The layers of single strategies (s, t): together they are the picture, and each alone finds what all together find.

use lucerna::accel::Backend;
use lucerna::film::Film;
use lucerna::integrator::{Pyramid, Silent, StrategyLayer};
use lucerna::scene::ViewOverrides;
use lucerna::spectrum::ColorMode;

use crate::bdpt::{PANEL, room};
use crate::common::means::FEWEST_RUNS;
use crate::common::render::{Built, blocks, parse, usual_combinations};
use crate::stage::{integrator, means};

/// The picture, and its layers.
fn render(built: &Built, edges: u32, spp: u32, seed: u64) -> (Vec<f32>, Vec<(StrategyLayer, Vec<f32>)>) {
    let overrides = ViewOverrides {
        spp: Some(spp),
        seed,
        ..ViewOverrides::default()
    };
    let view = built.view(0, &overrides);
    let pyramid = Pyramid::new(edges).expect("a pyramid");
    let film = integrator(built)
        .film_of_strategies(&view, pyramid)
        .expect("strategies");
    let stats = integrator(built).render(&built.scene, &view, &film, &Silent);
    assert_eq!(stats.dropped_samples, 0, "dropped: {:?}", stats.dropped);
    let pictures = film.layers().iter().map(Film::develop);
    (film.develop(), pyramid.layers().into_iter().zip(pictures).collect())
}

fn is_weighted(layer: StrategyLayer) -> bool {
    matches!(
        layer,
        StrategyLayer::Strategy { weighted: true, .. } | StrategyLayer::Longer
    )
}

#[test]
fn weighted_layers_add_up_to_the_picture() {
    let sky = r#"LightSource "infinite" "rgb L" [0.3 0.4 0.5]
        LightSource "spot" "point3 from" [0 1.8 -1] "point3 to" [0 0 0] "rgb I" [2 2 2]"#;
    for (backend, color) in usual_combinations("layers") {
        for lamp in [PANEL, sky] {
            let built = Built::new(parse(&room("bdpt", lamp)), backend, color);
            let overrides = ViewOverrides {
                spp: Some(4),
                seed: 7,
                ..ViewOverrides::default()
            };
            let plain = built.picture(&built.view(0, &overrides));
            let (picture, layers) = render(&built, 3, 4, 7);
            let bits = |picture: &[f32]| picture.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(&plain), bits(&picture), "layers change the picture");
            for (i, &value) in picture.iter().enumerate() {
                let parts = layers.iter().filter(|(layer, _)| is_weighted(*layer));
                let parts: Vec<f64> = parts.map(|(_, part)| f64::from(part[i])).collect();
                let (sum, size): (f64, f64) = (parts.iter().sum(), parts.iter().map(|part| part.abs()).sum());
                // A sample adds some thirty contributions up in single precision, of which the sensor takes differences.
                let far = (sum - f64::from(value)).abs();
                assert!(far <= 2e-5 * size + 1e-6, "value {i}: {value}, and {sum} by layers");
            }
            let longer = &layers.last().expect("layers").1;
            assert!(longer.iter().any(|&v| v > 0.0), "no longer paths");
        }
    }
}

/// A lamp between a floor and a ceiling: no two points that light goes between are close, so that every strategy has a bounded variance.
fn planes(camera: &str, floor: &str) -> String {
    format!(
        r#"LookAt 0 0.8 -2.6  0 1.1 0  0 1 0
    Camera "perspective" "float fov" 60 {camera}
    Film "rgb" "integer xresolution" 24 "integer yresolution" 16
    PixelFilter "box"
    Integrator "bdpt" "integer maxdepth" 3
    WorldBegin
    AttributeBegin
        AreaLightSource "diffuse" "rgb L" [6 5 4]
        Material "diffuse" "rgb reflectance" [0 0 0]
        Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-1 1.9 -1  1 1.9 -1  1 1.9 1  -1 1.9 1]
    AttributeEnd
    Material "diffuse" "rgb reflectance" [0.9 0.85 0.8]
    Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-3 2.2 -3  3 2.2 -3  3 2.2 3  -3 2.2 3]
    {floor}
    Shape "trianglemesh" "integer indices" [0 2 1 0 3 2] "point3 P" [-3 0 -3  3 0 -3  3 0 3  -3 0 3]"#
    )
}

#[test]
fn every_strategy_alone_finds_the_light_of_its_path_length() {
    each_alone(&planes("", ""), 4);
}

/// Through a lens, over a floor that shines and whose normals were bent.
#[test]
fn every_strategy_alone_finds_glossy_light_through_a_lens() {
    let scene = planes(
        r#""float lensradius" 0.05 "float focaldistance" 2"#,
        r#"Texture "waves" "float" "fbm" "integer octaves" 1 "float roughness" 0.5
        Texture "low" "float" "scale" "texture tex" "waves" "float scale" 0.05
        Material "conductor" "rgb reflectance" [0.9 0.8 0.7] "float roughness" 0.5 "texture displacement" "low""#,
    );
    each_alone(&scene, 3);
}

fn each_alone(scene: &str, most_edges: u32) {
    const SPP: u32 = 512;
    let built = Built::new(parse(scene), Backend::default(), ColorMode::Rgb);
    let runs = |first_seed: u64| {
        let seeds = first_seed..first_seed + FEWEST_RUNS as u64;
        seeds
            .map(|seed| render(&built, most_edges, SPP, seed).1)
            .collect::<Vec<_>>()
    };
    let [alone, together] = [1, 101].map(runs);
    let reduced = |picture: &[f32]| blocks(picture, 24, [8, 8]);
    for edges in 2..=most_edges {
        let reference = together.iter().map(|layers| {
            let mut sum = vec![0.0; 24 * 16 * 3];
            for (layer, picture) in layers {
                if matches!(layer, StrategyLayer::Strategy { s, t, weighted: true } if s + t == edges + 1) {
                    sum.iter_mut().zip(picture).for_each(|(sum, value)| *sum += value);
                }
            }
            reduced(&sum)
        });
        let reference: Vec<_> = reference.collect();
        for s in 0..=edges {
            let t = edges + 1 - s;
            let wanted = StrategyLayer::Strategy { s, t, weighted: false };
            let found = alone.iter().map(|layers| {
                let layer = layers.iter().find(|(layer, _)| *layer == wanted);
                reduced(&layer.expect("the layer").1)
            });
            let found: Vec<_> = found.collect();
            let report = means().against_runs(&found, &reference);
            let name = format!("s = {s}, t = {t}");
            println!("{name}: {report}");
            report.assert_agrees(&name);
            // Long paths that meet a lamp by themselves are few; a wrong density or cosine is off by more than this.
            report.assert_power(&name, f64::INFINITY, if edges == 2 { 0.02 } else { 0.12 });
        }
    }
}

#[test]
fn only_all_strategies_can_be_told_apart() {
    let built = Built::new(parse(&planes("", "")), Backend::default(), ColorMode::Rgb);
    let view = built.view(0, &ViewOverrides::default());
    let pyramid = Pyramid::new(2).expect("a pyramid");
    for name in ["path", "kajiya", "lightpath"] {
        let integrator = integrator(&built).named(name);
        assert!(integrator.film_of_strategies(&view, pyramid).is_none(), "{name}");
    }
}
