//! Renders as wholes: the same bits for any number of threads, crop and split of the samples; the same picture from either
//! backend and either sampler; nothing dropped.

mod common;

use std::path::{Path, PathBuf};

use common::means::{Estimate, FEWEST_RUNS, Means};
use common::render::{Built, MODES, blocks, combinations, parse};
use lucerna::accel::Backend;
use lucerna::desc::{IntegratorKind, ParseOptions, SceneDesc, load};
use lucerna::film::PixelRect;
use lucerna::geometry::Shape;
use lucerna::integrator::{Integrator, Silent};
use lucerna::sampling::SamplerKind;
use lucerna::scene::{View, ViewOverrides};
use lucerna::spectrum::ColorMode;

/// 150 x 100 pixels, so that tiles and packets end in the middle; a lens, motion of each kind, glass, metal, every light. `filter`
/// is a `PixelFilter` directive.
fn everything(filter: &str) -> String {
    format!(
        "LookAt 0 1.5 -6  0 0.8 0  0 1 0
        Camera \"perspective\" \"float fov\" 45 \"float lensradius\" 0.1 \"float focaldistance\" 6
        Film \"rgb\" \"integer xresolution\" 150 \"integer yresolution\" 100
        {filter}
        Sampler \"sobol\" \"integer pixelsamples\" 4
        Integrator \"path\" \"integer maxdepth\" 8
        WorldBegin
        LightSource \"infinite\" \"rgb L\" [0.2 0.25 0.3]
        LightSource \"distant\" \"point3 from\" [1 2 -1] \"point3 to\" [0 0 0] \"rgb L\" [0.5 0.5 0.4]
        LightSource \"point\" \"point3 from\" [-2 3 -1] \"rgb I\" [4 3 2]
        AttributeBegin
            AreaLightSource \"diffuse\" \"rgb L\" [5 5 6]
            Translate 1 3 0.5
            Shape \"sphere\" \"float radius\" 0.3
        AttributeEnd
        Material \"diffuse\" \"rgb reflectance\" [0.6 0.5 0.4]
        Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [-8 0 -8  -8 0 8  8 0 8  8 0 -8]
        AttributeBegin
            Material \"dielectric\" \"float eta\" 1.5
            Translate -1 0.8 -0.5
            Shape \"sphere\" \"float radius\" 0.8
        AttributeEnd
        AttributeBegin
            Material \"conductor\" \"float roughness\" 0.05
            ActiveTransform EndTime
            Translate 0.2 0.3 0
            ActiveTransform All
            Translate 0.9 0.6 0
            Shape \"sphere\" \"float radius\" 0.6
        AttributeEnd
        ObjectBegin \"fin\"
            Material \"dielectric\" \"spectrum eta\" \"glass-BK7\" \"float roughness\" 0.1
            Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point3 P\" [0 0 0  0.7 0 0.2  0 1 0.4]
                \"point3 P1\" [0 0 0  0.7 0.1 0.2  0.2 1 0.4]
        ObjectEnd
        Translate 0.2 0.1 -2
        ObjectInstance \"fin\"
        ActiveTransform EndTime
        Rotate 20 0 1 0
        ActiveTransform All
        Translate -0.8 0 0.3
        ObjectInstance \"fin\""
    )
}

/// The scene files of the repository.
fn scene_files() -> Vec<PathBuf> {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let entries = std::fs::read_dir(&directory).expect("the scenes");
    let files = entries.map(|entry| entry.expect("an entry").path());
    let mut files: Vec<_> = files
        .filter(|path| path.extension().is_some_and(|e| e == "pbrt"))
        .collect();
    files.sort();
    assert!(files.len() >= 6, "{files:?}");
    files
}

fn bits(picture: &[f32]) -> Vec<u32> {
    picture.iter().map(|v| v.to_bits()).collect()
}

/// How many pixels differ in any bit.
fn different_pixels(a: &[f32], b: &[f32]) -> usize {
    assert_eq!(a.len(), b.len());
    let pairs = a.chunks_exact(3).zip(b.chunks_exact(3));
    pairs.filter(|(a, b)| bits(a) != bits(b)).count()
}

fn with_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.expect("threads").install(work)
}

#[test]
fn pictures_have_the_same_bits_for_any_number_of_threads() {
    let desc = parse(&everything("PixelFilter \"mitchell\""));
    for (backend, color) in combinations() {
        let picture = |threads| {
            with_threads(threads, || {
                let built = Built::new(desc.clone(), backend, color);
                built.picture(&built.view(0, &ViewOverrides::default()))
            })
        };
        let one = picture(1);
        for threads in [2, 5] {
            assert_eq!(
                different_pixels(&one, &picture(threads)),
                0,
                "{backend}, {color:?}, {threads} threads"
            );
        }
    }
}

#[test]
fn a_crop_has_the_pixels_of_the_whole() {
    let crops = [
        [0, 0, 1, 1],
        [63, 63, 65, 65],
        [17, 5, 90, 77],
        [149, 99, 150, 100],
        [3, 64, 67, 66],
        [0, 41, 150, 42],
        [127, 0, 129, 100],
    ];
    let filters = [
        "PixelFilter \"box\"",
        "PixelFilter \"gaussian\" \"float xradius\" 2.5",
        "PixelFilter \"sinc\"",
    ];
    for (filter, color) in filters
        .into_iter()
        .zip([ColorMode::Rgb, ColorMode::Spectral, ColorMode::Spectral])
    {
        let desc = parse(&everything(filter));
        for &backend in Backend::AVAILABLE {
            let built = Built::new(desc.clone(), backend, color);
            let whole = built.picture(&built.view(0, &ViewOverrides::default()));
            for [x0, y0, x1, y1] in crops {
                let overrides = ViewOverrides {
                    crop: Some(PixelRect { x0, y0, x1, y1 }),
                    ..ViewOverrides::default()
                };
                let crop = built.picture(&built.view(0, &overrides));
                let part: Vec<f32> = (y0..y1)
                    .flat_map(|y| &whole[3 * (150 * y + x0) as usize..3 * (150 * y + x1) as usize])
                    .copied()
                    .collect();
                let different = different_pixels(&crop, &part);
                assert_eq!(different, 0, "{backend}, {filter}, {:?}", [x0, y0, x1, y1]);
            }
        }
    }
}

#[test]
fn ranges_of_samples_add_up() {
    let desc = parse(&everything("PixelFilter \"gaussian\""));
    for (backend, color) in combinations() {
        for sampler in [SamplerKind::Sobol, SamplerKind::Independent] {
            let built = Built::new(desc.clone(), backend, color);
            let overrides = ViewOverrides {
                spp: Some(16),
                resolution: Some([70, 30]),
                sampler: Some(sampler),
                ..ViewOverrides::default()
            };
            let view = built.view(0, &overrides);
            let whole = built.picture(&view);
            for splits in [&[0, 8, 16][..], &[0, 1, 2, 13, 16]] {
                let film = view.film();
                // The last range first: no order is promised.
                for range in splits.windows(2).rev() {
                    let part = View {
                        samples: range[0]..range[1],
                        ..view.clone()
                    };
                    let integrator = Integrator::from_desc(&built.desc.integrator);
                    integrator.render(&built.scene, &part, &film, &Silent);
                }
                let different = different_pixels(&whole, &film.develop());
                assert_eq!(different, 0, "{backend}, {color:?}, {sampler:?}, {splits:?}");
            }
        }
    }
}

#[test]
fn seeds_give_other_noise() {
    let desc = parse(&everything("PixelFilter \"box\""));
    for (backend, color) in combinations() {
        let built = Built::new(desc.clone(), backend, color);
        let picture = |seed| {
            let overrides = ViewOverrides {
                seed,
                resolution: Some([64, 48]),
                ..ViewOverrides::default()
            };
            built.picture(&built.view(0, &overrides))
        };
        let (a, b) = (picture(1), picture(2));
        // In rgb mode the sky, which is half of the picture, has no noise.
        assert!(different_pixels(&a, &b) > 64 * 48 / 2, "{backend}, {color:?}");
        assert_eq!(different_pixels(&a, &picture(1)), 0, "{backend}, {color:?}");
    }
}

/// 16 pictures of 32 x 24 pixels in blocks of 8 x 8.
fn runs(built: &Built, sampler: SamplerKind, spp: u32, first_seed: u64) -> Vec<Vec<f64>> {
    let run = |seed| {
        let overrides = ViewOverrides {
            seed,
            spp: Some(spp),
            sampler: Some(sampler),
            resolution: Some([32, 24]),
            ..ViewOverrides::default()
        };
        blocks(&built.picture(&built.view(0, &overrides)), 32, [8, 8])
    };
    (first_seed..first_seed + FEWEST_RUNS as u64).map(run).collect()
}

#[test]
fn samplers_agree_in_the_mean() {
    let desc = parse(&everything("PixelFilter \"gaussian\""));
    for color in MODES {
        let built = Built::new(desc.clone(), Backend::default(), color);
        let sobol = runs(&built, SamplerKind::Sobol, 64, 1);
        let independent = runs(&built, SamplerKind::Independent, 64, 101);
        let report = Means::default().against_runs(&sobol, &independent);
        report.assert_agrees(&format!("{color:?}"));
        report.assert_power(&format!("{color:?}"), 0.3, 0.01);
        // Darker by 1 %: noticed.
        let darker: Vec<Vec<f64>> = sobol.iter().map(|run| run.iter().map(|v| 0.99 * v).collect()).collect();
        assert!(!Means::default().against_runs(&darker, &independent).agrees());
        // Even points are less noisy: that is what they are for.
        let noise = |runs: &[Vec<f64>]| -> f64 {
            let block = |i: usize| Estimate::of(runs.iter().map(|run| run[i])).variance;
            (0..runs[0].len()).map(block).sum()
        };
        let (even, random) = (noise(&sobol), noise(&independent));
        println!("{color:?}: {even:.2e} and {random:.2e}");
        assert!(even < 0.6 * random, "{color:?}: {even} and {random}");
    }
}

/// By how many of its standard deviations the sum of the differences between pictures of the same numbers is off zero.
fn paired_z(a: &[f32], b: &[f32]) -> f64 {
    let pixel = |p: &[f32]| p.iter().map(|&v| f64::from(v)).sum::<f64>();
    let differences = a
        .chunks_exact(3)
        .zip(b.chunks_exact(3))
        .map(|(a, b)| pixel(a) - pixel(b));
    let (sum, squares) = differences.fold((0.0, 0.0), |(sum, squares), d| (sum + d, squares + d * d));
    if squares == 0.0 { 0.0 } else { sum / squares.sqrt() }
}

/// Every scene of the repository renders without a dropped sample, to finite values that are not black; and both backends give
/// the same picture: the same rays meet the same surfaces but for ties at edges, and whatever follows one of these.
#[test]
fn backends_agree_on_every_scene() {
    for path in scene_files() {
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        let mut desc = load(&path, &ParseOptions::default()).unwrap_or_else(|e| panic!("{e}"));
        if let IntegratorKind::Photon(parameters) = &mut desc.integrator.kind {
            // As many as a picture of this size needs.
            (parameters.caustic_photons, parameters.global_photons) = (Some(10_000), Some(5_000));
        }
        for color in MODES {
            let mut has_curves = false;
            let pictures: Vec<Vec<f32>> = Backend::AVAILABLE
                .iter()
                .map(|&backend| {
                    let built = Built::new(desc.clone(), backend, color);
                    let geometries = built.scene.world().geometries();
                    has_curves = geometries.iter().any(|g| matches!(g.shape, Shape::Curves(_)));
                    let overrides = ViewOverrides {
                        resolution: Some([64, 48]),
                        spp: Some(16),
                        ..ViewOverrides::default()
                    };
                    let picture = built.picture(&built.view(0, &overrides));
                    assert!(picture.iter().all(|v| v.is_finite()), "{name}, {backend}, {color:?}");
                    assert!(
                        picture.iter().any(|&v| v > 0.0),
                        "{name}, {backend}, {color:?} is black"
                    );
                    picture
                })
                .collect();
            for other in &pictures[1..] {
                let pairs = pictures[0].chunks_exact(3).zip(other.chunks_exact(3));
                let apart = |(a, b): &(&[f32], &[f32])| {
                    let close = |(a, b): (&f32, &f32)| (a - b).abs() <= 1e-4 * a.abs().max(b.abs()) + 1e-6;
                    !a.iter().zip(*b).all(close)
                };
                let apart = pairs.filter(apart).count();
                let sum = |picture: &[f32]| picture.iter().map(|&v| f64::from(v)).sum::<f64>();
                let mean = sum(&pictures[0]) / sum(other) - 1.0;
                println!(
                    "{name}, {color:?}: {} bits, {apart} pixels of {}, mean {mean:+.2e}",
                    different_pixels(&pictures[0], other),
                    64 * 48
                );
                if has_curves {
                    // Embree's own curves are straight pieces within a tenth of the width of ours: some samples near edges differ,
                    // the picture in its noise only.
                    let z = paired_z(&pictures[0], other);
                    println!("z of the difference {z:+.2}");
                    assert!(apart * 5 <= 64 * 48, "{name}, {color:?}: {apart} pixels differ");
                    assert!(
                        z.abs() < 4.0 && mean.abs() < 5e-3,
                        "{name}, {color:?}: {mean:+.2e}, z {z}"
                    );
                    continue;
                }
                // A photon that follows a tie is seen, or missed, by some thirty pixels: all within three of where it lands.
                let of_one = match desc.integrator.kind {
                    IntegratorKind::Photon(_) | IntegratorKind::Sppm(_) => 2 * 30, // Where it lands on either backend.
                    _ => 1,
                };
                assert!(
                    apart * 500 <= of_one * 64 * 48,
                    "{name}, {color:?}: {apart} pixels differ"
                );
                assert!(mean.abs() < 1e-3, "{name}, {color:?}: the means differ by {mean}");
            }
        }
    }
}

#[test]
fn tiny_pictures_are_rendered() {
    let desc = parse(&everything("PixelFilter \"triangle\""));
    for (backend, color) in combinations() {
        let built = Built::new(desc.clone(), backend, color);
        for resolution in [[1, 1], [1, 70], [65, 1], [5, 3]] {
            let overrides = ViewOverrides {
                resolution: Some(resolution),
                spp: Some(3),
                ..ViewOverrides::default()
            };
            let picture = built.picture(&built.view(0, &overrides));
            assert_eq!(picture.len(), 3 * (resolution[0] * resolution[1]) as usize);
            assert!(picture.iter().all(|v| v.is_finite()));
        }
    }
}

/// A room with lamps of every kind, large and small, many and few; a wall of glass and one of metal, so that both strategies of
/// multiple importance sampling matter.
fn many_lamps(sampler: &str) -> String {
    let mut lamps = String::new();
    for i in 0..60 {
        let (x, y) = (f64::from(i % 10) * 0.6 - 2.7, f64::from(i / 10) * 0.6 - 1.5);
        let l = 1.0 + f64::from(i * 7 % 11);
        let z = 0.6 + 0.9 * f64::from(i % 3);
        lamps += &format!(
            "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [{l} {l} {}] \"bool twosided\" {} Translate {x} {y} {z} \
             Rotate {} 1 0.3 0 Shape \"trianglemesh\" \"point3 P\" [0 0 0  0.12 0 0  0 0.12 0] AttributeEnd\n",
            0.5 * l,
            i % 4 == 0,
            37 * i,
        );
    }
    format!(
        "LookAt 0 -5 1.5  0 0 1  0 0 1
        Camera \"perspective\" \"float fov\" 60
        Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 32
        PixelFilter \"box\"
        Integrator \"path\" \"integer maxdepth\" 3 \"string lightsampler\" \"{sampler}\"
        WorldBegin
        LightSource \"infinite\" \"rgb L\" [0.02 0.02 0.03]
        LightSource \"distant\" \"point3 from\" [1 -2 3] \"rgb L\" [0.1 0.1 0.1]
        LightSource \"point\" \"point3 from\" [-2 -1 1] \"rgb I\" [0.2 0.3 0.2]
        LightSource \"spot\" \"point3 from\" [2 -2 3] \"point3 to\" [0 0 0] \"float conedeltaangle\" 0 \"rgb I\" [2 1 1]
        {lamps}
        AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [3 2 2] Translate -1 1 0.5 Shape \"sphere\" \"float radius\" 0.2
        AttributeEnd
        Material \"diffuse\" \"rgb reflectance\" [0.6 0.5 0.4]
        Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [-4 -4 0  4 -4 0  4 4 0  -4 4 0]
        Material \"conductor\" \"float roughness\" 0.3
        Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [-4 3 0  4 3 0  4 3 4  -4 3 4]
        Material \"dielectric\" \"float roughness\" 0.3
        Translate 1 -1 0.7 Shape \"sphere\" \"float radius\" 0.5"
    )
}

/// How a light is chosen does not change the expectation: the hierarchy against all alike, and against power.
#[test]
fn light_samplers_give_the_same_picture() {
    let runs = |sampler: &str, mode| {
        let built = Built::new(parse(&many_lamps(sampler)), Backend::default(), mode);
        built.runs(256, [8, 8])
    };
    for mode in MODES {
        let by_tree = runs("bvh", mode);
        for other in ["uniform", "power"] {
            let report = Means::default().against_runs(&by_tree, &runs(other, mode));
            report.assert_agrees(&format!("bvh and {other}, {mode:?}"));
            report.assert_power(other, 0.15, 0.01);
        }
    }
}

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
