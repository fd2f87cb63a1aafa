//! Every scene of the repository by both backends, and pictures of a few pixels.

use lucerna::accel::Backend;
use lucerna::desc::{IntegratorKind, ParseOptions, load};
use lucerna::geometry::Shape;
use lucerna::scene::ViewOverrides;

use crate::common::render::{Built, MODES, combinations, parse};
use crate::{different_pixels, everything, scene_files};

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
