//! What is particular to bidirectional path tracing and light tracing; that they agree with the oracle is in `covering.rs`.

use lucerna::accel::Backend;
use lucerna::desc::PixelRect;
use lucerna::integrator::Integrator;
use lucerna::scene::ViewOverrides;
use lucerna::spectrum::ColorMode;

use crate::common::means::Means;
use crate::common::render::{Built, parse, usual_combinations};
use crate::stage::{build, integrator, means, runs};

/// A room with a lamp, a mirror and glass, seen through a filter that reaches far, with a lens.
pub fn room(integrator: &str, lamp: &str) -> String {
    format!(
        r#"LookAt 0 1 -3.2  0 1 0  0 1 0
        Camera "perspective" "float fov" 50 "float lensradius" 0.02 "float focaldistance" 3.2
        Film "rgb" "integer xresolution" 72 "integer yresolution" 44
        PixelFilter "mitchell" "float xradius" 2 "float yradius" 2
        Integrator "{integrator}" "integer maxdepth" 5
        WorldBegin
        {lamp}
        Material "diffuse" "rgb reflectance" [0.6 0.6 0.5]
        Shape "trianglemesh" "integer indices" [0 1 2 0 2 3  4 6 5 4 7 6  0 3 7 0 7 4  1 5 6 1 6 2  3 2 6 3 6 7]
            "point3 P" [-1.5 0 -1.5  1.5 0 -1.5  1.5 0 1.5  -1.5 0 1.5  -1.5 2 -1.5  1.5 2 -1.5  1.5 2 1.5  -1.5 2 1.5]
        AttributeBegin Material "dielectric" "float eta" 1.5 Translate 0.5 0.5 -0.3 Shape "sphere" "float radius" 0.4 AttributeEnd
        AttributeBegin Material "conductor" Translate -0.6 0.5 0.4 Shape "sphere" "float radius" 0.45 AttributeEnd"#
    )
}

pub const PANEL: &str = r#"AttributeBegin AreaLightSource "diffuse" "rgb L" [6 5 4]
    Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-0.4 1.99 -0.4  0.4 1.99 -0.4  0.4 1.99 0.4  -0.4 1.99 0.4] AttributeEnd"#;

fn picture(built: &Built, overrides: &ViewOverrides, threads: usize) -> Vec<u32> {
    let view = built.view(0, overrides);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .expect("threads");
    let (picture, stats) = pool.install(|| built.picture_with(&view, integrator(built)));
    assert_eq!(stats.dropped_samples, 0, "dropped: {:?}", stats.dropped);
    picture.into_iter().map(f32::to_bits).collect()
}

#[test]
fn a_crop_is_the_crop_of_the_whole_and_threads_change_nothing() {
    for (backend, color) in usual_combinations("crop") {
        for name in ["bdpt", "lightpath"] {
            let built = Built::new(parse(&room(name, PANEL)), backend, color);
            let whole_view = ViewOverrides {
                spp: Some(3),
                ..ViewOverrides::default()
            };
            let whole = picture(&built, &whole_view, 1);
            assert_eq!(whole, picture(&built, &whole_view, 3), "{name}, {backend}, {color:?}");
            // The second starts at the corner: what falls on it comes from beyond the picture too.
            for [x0, y0, x1, y1] in [[29, 13, 51, 37], [0, 0, 7, 5], [63, 40, 72, 44]] {
                let crop = ViewOverrides {
                    crop: Some(PixelRect { x0, y0, x1, y1 }),
                    ..whole_view
                };
                let rows = (y0..y1).flat_map(|y| {
                    let row = 3 * (y * 72) as usize;
                    whole[row + 3 * x0 as usize..row + 3 * x1 as usize].to_vec()
                });
                let expected: Vec<u32> = rows.collect();
                assert_eq!(picture(&built, &crop, 2), expected, "{name}, {backend}, {color:?}");
            }
        }
    }
}

#[test]
fn the_light_tracer_is_right_where_it_finds_all_light() {
    for (material, light) in [
        ("Oren-Nayar", "area"),
        ("Oren-Nayar", "point"),
        ("rough metal", "sky"),
        ("normal map", "sphere"),
        ("principled", "distant"),
    ] {
        let built = build(material, light);
        let reference = runs(&built, integrator(&built), 128, 101);
        let light_tracer = integrator(&built).named("lightpath");
        let report = means().against_runs(&runs(&built, light_tracer, 1024, 1), &reference);
        let name = format!("{material} under {light}");
        println!("{name}: {report}");
        report.assert_agrees(&name);
        report.assert_power(&name, f64::INFINITY, 0.02);
    }
}

/// A white ball, of chalk, glass or frosted glass, under a white sky cannot be seen.
#[test]
fn a_white_furnace_under_an_environment_is_white() {
    for material in [
        r#""diffuse" "rgb reflectance" [1 1 1]"#,
        r#""dielectric" "float eta" 1.5"#,
        r#""diffusetransmission" "rgb reflectance" [0.5 0.5 0.5] "rgb transmittance" [0.5 0.5 0.5]"#,
        r#""dielectric" "float eta" 1.5 "float roughness" 0.4 "bool multiplescattering" true"#,
    ] {
        // The noisiest once only.
        let is_noisy = material.contains("roughness");
        for (backend, color) in usual_combinations(material).take(if is_noisy { 1 } else { usize::MAX }) {
            let text = format!(
                r#"LookAt 0 0 -4  0 0 0  0 1 0
                Camera "perspective" "float fov" 40
                Film "rgb" "integer xresolution" 16 "integer yresolution" 16
                Integrator "bdpt" "integer maxdepth" 100
                WorldBegin
                LightSource "infinite" "rgb L" [1 1 1]
                Material {material}
                Shape "sphere" "float radius" 1"#
            );
            let built = Built::new(parse(&text), backend, color);
            let spp = if is_noisy { 1024 } else { 256 };
            let runs = built.runs(spp, [16, 16]);
            let grey = match color {
                ColorMode::Rgb => [1.0; 3],
                ColorMode::Spectral => {
                    // What the sky itself is, without the ball.
                    let sky = parse(text.split("Material").next().unwrap_or_default());
                    let sky = Built::new(sky, backend, color).runs(256, [16, 16]);
                    [0, 1, 2].map(|c| sky.iter().map(|run| run[c]).sum::<f64>() / sky.len() as f64)
                }
            };
            // Where nothing is left to chance single precision is.
            let judge = Means { slack: 1e-6, ..means() };
            let report = judge.against_exact(&runs, &grey);
            let name = format!("{material}, {backend}, {color:?}");
            println!("{name}: {report}");
            report.assert_agrees(&name);
            report.assert_power(&name, f64::INFINITY, 0.005);
        }
    }
}

/// Mitsuba 0.6 has bright pixels where a point light is close to a wall. Here no pixel is further from a long render of the path
/// tracer than noise explains.
#[test]
fn a_point_light_in_a_room_leaves_no_bright_pixel() {
    let lamp = r#"LightSource "point" "point3 from" [0 1.9 0] "rgb I" [1 1 1]"#;
    let text = room("bdpt", lamp)
        .replace("dielectric", "diffuse")
        .replace("conductor", "diffuse");
    let text = text.replace(r#""float eta" 1.5"#, "").replace("mitchell", "box");
    let text = text.replace(r#""float xradius" 2 "float yradius" 2"#, "");
    let built = Built::new(parse(&text), Backend::default(), ColorMode::Rgb);
    let of = |integrator: Integrator, spp| {
        let overrides = ViewOverrides {
            spp: Some(spp),
            ..ViewOverrides::default()
        };
        let view = built.view(0, &overrides);
        built.picture_with(&view, integrator).0
    };
    let reference = of(integrator(&built).named("path"), 1024);
    let ours = of(integrator(&built), 64);
    for (i, (value, expected)) in ours.iter().zip(&reference).enumerate() {
        let far = (value - expected).abs();
        assert!(
            far <= 0.35 * expected + 0.02,
            "value {i}: {value} where {expected} is expected"
        );
    }
}

/// Light subpaths bring much to little film. Were the limit for that, and not for the part of it that counts as a sample, it would take
/// most of their light.
#[test]
fn a_limit_above_all_samples_takes_nothing_from_light_paths() {
    for name in ["bdpt", "lightpath"] {
        let render = |limit: &str| {
            let resolution = r#""integer yresolution" 44"#;
            let text = room(name, PANEL).replace(resolution, &format!("{resolution} {limit}"));
            // A filter without negative weights, so that less of each sample is less in every pixel.
            let text = text.replace("mitchell", "box");
            let built = Built::new(parse(&text), Backend::default(), ColorMode::Rgb);
            let overrides = ViewOverrides {
                spp: Some(4),
                ..ViewOverrides::default()
            };
            picture(&built, &overrides, 2)
        };
        let mean = |bits: &[u32]| {
            let sum: f64 = bits.iter().map(|&bits| f64::from(f32::from_bits(bits))).sum();
            sum / bits.len() as f64
        };
        let [unlimited, high, low] = ["", "1000", "0.1"].map(|limit| match limit {
            "" => render(""),
            limit => render(&format!(r#""float maxcomponentvalue" {limit}"#)),
        });
        assert!((mean(&high) / mean(&unlimited) - 1.0).abs() < 1e-4, "{name}");
        // One that most samples exceed takes from them.
        assert!(mean(&low) < 0.9 * mean(&unlimited), "{name}");
    }
}

/// A spherical camera takes light paths as it takes camera rays, at the edges of its map too, which one direction meets twice.
#[test]
fn spherical_cameras_take_light_paths() {
    for mapping in ["equalarea", "equirectangular"] {
        let scene = |integrator: &str| {
            let width = if mapping == "equalarea" { 16 } else { 32 };
            format!(
                r#"Translate 0.2 -1 0.3 Rotate 30 1 1 0
                Camera "spherical" "string mapping" "{mapping}"
                Film "rgb" "integer xresolution" {width} "integer yresolution" 16
                PixelFilter "triangle" "float xradius" 2 "float yradius" 2
                Integrator "{integrator}" "integer maxdepth" 4
                WorldBegin
                {PANEL}
                Material "diffuse" "rgb reflectance" [0.6 0.6 0.5]
                Shape "trianglemesh" "integer indices" [0 1 2 0 2 3  4 6 5 4 7 6  0 3 7 0 7 4  1 5 6 1 6 2  3 2 6 3 6 7]
                    "point3 P" [-1.5 0 -1.5  1.5 0 -1.5  1.5 0 1.5  -1.5 0 1.5  -1.5 2 -1.5  1.5 2 -1.5  1.5 2 1.5  -1.5 2 1.5]
                LightSource "infinite" "rgb L" [.2 .2 .4]"#
            )
        };
        let runs = |integrator: &str, spp| {
            let built = Built::new(parse(&scene(integrator)), Backend::default(), ColorMode::Rgb);
            built.runs(spp, [4, 4])
        };
        let reference = runs("path", 256);
        for (integrator, spp) in [("bdpt", 64), ("lightpath", 256)] {
            let report = Means::default().against_runs(&runs(integrator, spp), &reference);
            println!("{mapping}, {integrator}: {report}");
            report.assert_agrees(&format!("{mapping}, {integrator}"));
            report.assert_power(integrator, f64::INFINITY, 0.02);
        }
    }
}
