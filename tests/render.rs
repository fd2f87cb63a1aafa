//! What a picture depends on: scene, options and seed, and nothing else.

mod common;

use std::path::Path;

use common::means::{FEWEST_RUNS, Means};
use common::render::{Built, blocks, combinations, parse};
use lucerna::accel::Backend;
use lucerna::desc::{self, ParseOptions};
use lucerna::film::PixelRect;
use lucerna::integrator::{Integrator, Silent};
use lucerna::sampling::SamplerKind;
use lucerna::scene::ViewOverrides;
use lucerna::spectrum::ColorMode;

/// A scene with everything that could tell apart what must be the same: edges and vertices in view, glass, a lens, motion, a
/// filter with negative lobes, a resolution that is no multiple of anything.
const SCENE: &str = "
Film \"rgb\" \"integer xresolution\" 75 \"integer yresolution\" 49
PixelFilter \"mitchell\"
Sampler \"sobol\" \"integer pixelsamples\" 8
Integrator \"path\" \"integer maxdepth\" 8
LookAt 3 2.5 -5  0 0.7 0  0 1 0
Camera \"perspective\" \"float fov\" 40 \"float lensradius\" 0.05 \"float focaldistance\" 5
WorldBegin
LightSource \"infinite\" \"rgb L\" [ 0.2 0.3 0.5 ]
AttributeBegin
    AreaLightSource \"diffuse\" \"rgb L\" [ 20 18 15 ]
    Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 0 2 3 ] \"point3 P\" [ -1 4 -1  1 4 -1  1 4 1  -1 4 1 ]
AttributeEnd
Material \"diffuse\" \"rgb reflectance\" [ 0.6 0.5 0.4 ]
Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 0 2 3 ] \"point3 P\" [ -5 0 -5  -5 0 5  5 0 5  5 0 -5 ]
ObjectBegin \"pyramid\"
    Shape \"trianglemesh\" \"integer indices\" [ 0 1 4  1 2 4  2 3 4  3 0 4 ]
        \"point3 P\" [ -0.5 0 -0.5  0.5 0 -0.5  0.5 0 0.5  -0.5 0 0.5  0 1 0 ]
ObjectEnd
AttributeBegin
    Translate -1.2 0.01 0
    ObjectInstance \"pyramid\"
    ActiveTransform EndTime Rotate 40 0 1 0 Translate 0.3 0.2 0 ActiveTransform All
    ObjectInstance \"pyramid\"
AttributeEnd
AttributeBegin
    Translate 0.9 0.6 -0.4
    Material \"dielectric\" \"spectrum eta\" \"glass-BK7\"
    Shape \"sphere\" \"float radius\" 0.6
AttributeEnd
AttributeBegin
    Translate 0.5 0.5 1.5
    Material \"conductor\" \"float roughness\" 0.2
    Shape \"sphere\" \"float radius\" 0.5
AttributeEnd
";

/// The picture on so many threads.
fn on_threads(threads: usize, built: &Built, overrides: &ViewOverrides) -> Vec<f32> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .expect("threads");
    pool.install(|| built.picture(&built.view(0, overrides)))
}

#[test]
fn the_number_of_threads_does_not_change_a_bit() {
    for (backend, color) in combinations() {
        let built = Built::new(parse(SCENE), backend, color);
        for sampler in [SamplerKind::Sobol, SamplerKind::Independent] {
            let overrides = ViewOverrides {
                sampler: Some(sampler),
                ..ViewOverrides::default()
            };
            let one = on_threads(1, &built, &overrides);
            assert!(one.iter().any(|&v| v > 0.0));
            for threads in [2, 5] {
                assert!(
                    on_threads(threads, &built, &overrides) == one,
                    "{backend} {color:?} {sampler:?}, {threads} threads"
                );
            }
        }
    }
}

#[test]
fn a_crop_is_the_same_pixels_of_the_whole_picture() {
    let rect = |x0, y0, x1, y1| PixelRect { x0, y0, x1, y1 };
    let crops = [
        rect(0, 0, 1, 1),
        rect(74, 48, 75, 49),
        rect(31, 31, 34, 33),
        rect(13, 7, 66, 41),
        rect(0, 17, 75, 18),
    ];
    for (backend, color) in combinations() {
        let built = Built::new(parse(SCENE), backend, color);
        let whole = built.picture(&built.view(0, &ViewOverrides::default()));
        for crop in crops {
            let view = built.view(
                0,
                &ViewOverrides {
                    crop: Some(crop),
                    ..ViewOverrides::default()
                },
            );
            let mut pixels = built.picture(&view).into_iter();
            for y in crop.y0..crop.y1 {
                for x in crop.x0..crop.x1 {
                    for c in 0..3 {
                        let expected = whole[((y * 75 + x) * 3 + c) as usize];
                        assert_eq!(
                            pixels.next(),
                            Some(expected),
                            "{backend} {color:?} {crop:?} at {x}, {y}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn samples_may_be_added_in_parts_and_in_any_order() {
    let built = Built::new(parse(SCENE), Backend::default(), ColorMode::Spectral);
    let view = built.view(0, &ViewOverrides::default());
    let whole = built.picture(&view);
    let integrator = Integrator::from_desc(&built.desc.integrator);
    let film = view.film();
    for samples in [5..8, 0..2, 2..5] {
        let mut part = view.clone();
        part.samples = samples;
        integrator.render(&built.scene, &part, &film, &Silent);
    }
    assert!(film.develop() == whole);
}

#[test]
fn seeds_give_different_pictures_of_the_same_expectation() {
    let built = Built::new(parse(SCENE), Backend::default(), ColorMode::Rgb);
    let runs = |sampler| -> Vec<Vec<f64>> {
        (0..FEWEST_RUNS as u64)
            .map(|seed| {
                let resolution = Some([48, 32]);
                let overrides = ViewOverrides {
                    seed,
                    resolution,
                    sampler: Some(sampler),
                    ..ViewOverrides::default()
                };
                blocks(&built.picture(&built.view(0, &overrides)), 48, [8, 8])
            })
            .collect()
    };
    let (sobol, independent) = (runs(SamplerKind::Sobol), runs(SamplerKind::Independent));
    assert!(sobol[0] != sobol[1] && independent[0] != independent[1]);
    let means = Means {
        significance: 0.01,
        slack: 0.0,
    };
    means
        .against_runs(&sobol, &independent)
        .assert_agrees("Sobol and independent samples");
}

/// The project's own scenes: they load without a warning, no sample is dropped, and both backends see the same.
#[test]
fn the_scenes_of_the_project_render_alike_through_every_backend() {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let mut count = 0;
    for entry in std::fs::read_dir(directory).expect("scenes/") {
        let path = entry.expect("an entry").path();
        if path.extension().is_none_or(|extension| extension != "pbrt") {
            continue;
        }
        count += 1;
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let desc = desc::load(&path, &ParseOptions::default()).unwrap_or_else(|e| panic!("{e}"));
        assert!(desc.warnings.is_empty(), "{name}: {:?}", desc.warnings);
        let overrides = ViewOverrides {
            resolution: Some([96, 72]),
            spp: Some(4),
            ..ViewOverrides::default()
        };
        let pictures: Vec<Vec<f32>> = Backend::AVAILABLE
            .iter()
            .map(|&backend| {
                let built = Built::new(desc.clone(), backend, ColorMode::Spectral);
                built.picture(&built.view(0, &overrides))
            })
            .collect();
        assert!(
            pictures[0].iter().all(|v| v.is_finite()) && pictures[0].iter().any(|&v| v > 0.0),
            "{name}"
        );
        for other in &pictures[1..] {
            // A ray that grazes an edge may take another path; few do.
            let pixels = pictures[0].chunks_exact(3).zip(other.chunks_exact(3));
            let alike = pixels.filter(|(a, b)| {
                a.iter()
                    .zip(*b)
                    .all(|(a, b)| (a - b).abs() <= 1e-4 * (a.abs() + b.abs()))
            });
            let share = alike.count() as f64 / (96.0 * 72.0);
            assert!(share > 0.99, "{name}: only {share} of the pixels are alike");
        }
    }
    assert!(count >= 6, "only {count} scenes");
}
