//! Cameras: the film position fixes the point in focus, the lens is filled evenly, time is uniform over the shutter. Pixel filters:
//! weighted samples have the filter's moments and shares.

use std::f64::consts::PI;

use glam::{DVec3, Vec2};
use lucerna::camera::{Camera, CameraSample, CameraSpec, Projection};
use lucerna::desc::{ApertureDesc, MeasureDesc};
use lucerna::film::{FilterKind, PixelFilter};
use lucerna::math::{AnimatedTransform, DAffine3};

use super::common::chi2::Chi2;
use super::common::means::{FEWEST_RUNS, Means};
use super::common::random::Random;
use super::first_two;

const LENS: f64 = 0.4;
const FOCUS: f64 = 7.0;

fn spec(projection: Projection) -> CameraSpec {
    CameraSpec {
        projection,
        screen_window: [-1.5, 1.5, -1.0, 1.0],
        resolution: [30, 20],
        lens_radius: LENS,
        focal_distance: FOCUS,
        aperture: ApertureDesc::Round,
        measure: MeasureDesc::Radiance,
        shutter: [0.25, 0.75],
        world_from_camera: AnimatedTransform::fixed(placement()).expect("invertible"),
    }
}

fn placement() -> DAffine3 {
    DAffine3::from_translation(DVec3::new(3.0, -2.0, 1.0))
        * DAffine3::from_axis_angle(DVec3::new(1.0, 2.0, 2.0) / 3.0, 0.8)
}

const PROJECTIONS: [Projection; 3] = [
    Projection::Perspective {
        fov: 50.0,
        near_clip: 0.0,
    },
    Projection::Perspective {
        fov: 50.0,
        near_clip: 1.5,
    },
    Projection::Orthographic,
];

/// Origin and direction in the space of the camera, whose z is 1.
fn local_ray(camera: &Camera, sample: &CameraSample) -> (DVec3, DVec3) {
    let ray = camera.sample_ray(sample);
    assert!((ray.direction.length() - 1.0).abs() < 1e-6);
    let inverse = placement().inverse();
    let direction = inverse.transform_vector3(ray.direction.as_dvec3());
    (inverse.transform_point3(ray.origin.as_dvec3()), direction / direction.z)
}

#[test]
fn rays_fill_the_lens_evenly_and_meet_in_the_plane_of_focus() {
    for projection in PROJECTIONS {
        let camera = Camera::new(&spec(projection));
        let film = Vec2::new(21.3, 4.9);
        // Where the film position is imaged: 30 pixels over [-1.5, 1.5], 20 over [1, -1].
        let screen = DVec3::new(-1.5 + 0.1 * 21.3, 1.0 - 0.1 * 4.9, 0.0);
        let (tan, near) = match projection {
            Projection::Perspective { fov, near_clip } => ((0.5 * fov).to_radians().tan(), near_clip),
            Projection::Orthographic => (0.0, 0.0),
        };
        let (pinhole, focus) = if tan > 0.0 {
            (DVec3::ZERO, screen * tan * FOCUS + DVec3::Z * FOCUS)
        } else {
            (screen, screen + DVec3::Z * FOCUS)
        };
        let report = Chi2::new([[-PI, PI], [0.0, 1.0]]).of(PROJECTIONS.len()).run(
            |u| {
                let sample = CameraSample {
                    film,
                    lens: first_two(u),
                    time: u[2],
                };
                let (origin, direction) = local_ray(&camera, &sample);
                assert!((origin.z - near).abs() < 1e-5, "{projection:?}: {origin}");
                let at_focus = origin + direction * (FOCUS - origin.z);
                assert!(
                    (at_focus - focus).length() < 1e-4,
                    "{projection:?}: {at_focus}, {focus}"
                );
                let on_lens = (origin - direction * origin.z - pinhole) / LENS;
                Some([on_lens.y.atan2(on_lens.x), on_lens.x.powi(2) + on_lens.y.powi(2)])
            },
            // The area element is half of d phi d(r²).
            |_| 0.5 / PI,
        );
        report.assert_ok(&format!("{projection:?}"));
    }
}

#[test]
fn time_is_uniform_over_the_shutter() {
    for (shutter, seen) in [
        ([0.25, 0.75], [0.25, 0.75]),
        ([-0.5, 0.5], [0.0, 0.5]),
        ([0.0, 2.0], [0.0, 1.0]),
    ] {
        let camera = Camera::new(&CameraSpec {
            shutter,
            ..spec(PROJECTIONS[0])
        });
        let test = Chi2 {
            bins: [64, 1],
            samples: 100_000,
            ..Chi2::new([[-0.5, 2.0], [0.0, 1.0]]).of(3)
        };
        let report = test.run(
            |u| {
                let ray = camera.sample_ray(&CameraSample {
                    film: Vec2::ZERO,
                    lens: first_two(u),
                    time: u[2],
                });
                let time = f64::from(ray.time);
                assert!((0.0..=1.0).contains(&time) && (seen[0]..=seen[1]).contains(&time));
                // What scene time clamps stands still: put back where the shutter was.
                let unclamped = shutter[0] + f64::from(u[2]) * (shutter[1] - shutter[0]);
                assert!((unclamped.clamp(0.0, 1.0) - time).abs() < 1e-6);
                Some([unclamped, 0.5])
            },
            |[t, _]| f64::from((shutter[0]..shutter[1]).contains(&t)) / (shutter[1] - shutter[0]),
        );
        report.assert_ok(&format!("{shutter:?}"));
    }
}

/// The share of each cell of the support, and the square of the distance, that weighted samples have.
#[test]
fn filter_samples_have_the_filters_shares() {
    const CELLS: usize = 10;
    const SAMPLES: usize = 16_384;
    let kinds = [
        (FilterKind::Box, [0.5, 0.5]),
        (FilterKind::Triangle, [2.0, 1.0]),
        (FilterKind::Gaussian { sigma: 0.5 }, [1.5, 1.5]),
        (
            FilterKind::Mitchell {
                b: 1.0 / 3.0,
                c: 1.0 / 3.0,
            },
            [2.0, 1.3],
        ),
        (FilterKind::LanczosSinc { tau: 3.0 }, [4.0, 3.0]),
        (FilterKind::BlackmanHarris, [2.0, 2.5]),
    ];
    for (kind, radius) in kinds {
        let filter = PixelFilter::new(kind, radius).expect("a filter");
        assert_eq!(filter.radius().to_array(), radius.map(|r| r as f32));
        // Of each axis: the integral over a cell, by the midpoint rule.
        let shares = |axis: usize| {
            let r = radius[axis];
            let cell = |i: usize| -> f64 {
                let steps = 1000;
                let at = |j: usize| r * (2.0 * (i as f64 + (j as f64 + 0.5) / f64::from(steps)) / CELLS as f64 - 1.0);
                (0..steps as usize).map(|j| kind.evaluate(at(j), r)).sum()
            };
            let cells: Vec<f64> = (0..CELLS).map(cell).collect();
            let sum: f64 = cells.iter().sum();
            cells.into_iter().map(|c| c / sum).collect::<Vec<_>>()
        };
        let (x, y) = (shares(0), shares(1));
        let expected: Vec<f64> = (0..CELLS * CELLS).map(|i| x[i % CELLS] * y[i / CELLS]).collect();
        let run = |seed: usize| {
            let mut random = Random::new(seed as u64);
            let mut sums = vec![0.0; CELLS * CELLS];
            for _ in 0..SAMPLES {
                let sample = filter.sample(first_two(random.unit4()));
                let cell = |axis: usize| {
                    let t = 0.5 * (f64::from(sample.offset[axis]) / radius[axis] + 1.0);
                    assert!((-1e-6..=1.0 + 1e-6).contains(&t), "{kind:?}: {}", sample.offset);
                    ((t * CELLS as f64) as usize).min(CELLS - 1)
                };
                sums[cell(1) * CELLS + cell(0)] += f64::from(sample.weight) / SAMPLES as f64;
            }
            sums
        };
        let runs: Vec<_> = (1..=FEWEST_RUNS).map(run).collect();
        let means = Means {
            slack: 1e-3,
            significance: 0.01 / 6.0,
        };
        // Where next to nothing is expected, sixteen runs without a sample say nothing.
        let kept = |values: &[f64]| -> Vec<f64> {
            let pairs = values.iter().zip(&expected);
            pairs.filter(|(_, e)| e.abs() > 1e-4).map(|(v, _)| *v).collect()
        };
        let total: f64 = runs.iter().flatten().sum::<f64>() / FEWEST_RUNS as f64;
        let runs: Vec<_> = runs.iter().map(|run| kept(run)).collect();
        let expected = kept(&expected);
        means
            .against_exact(&runs, &expected)
            .assert_agrees(&format!("{kind:?}"));
        // The weights average to 1, so that an even picture stays as bright as it is.
        assert!((total - 1.0).abs() < 5e-3, "{kind:?}: {total}");
        // A filter that is 15 % lower in its highest cell is told apart.
        let highest = expected.iter().copied().fold(0.0, f64::max);
        let other: Vec<f64> = expected
            .iter()
            .map(|&e| if e == highest { 0.85 * e } else { e })
            .collect();
        assert!(!means.against_exact(&runs, &other).agrees(), "{kind:?}");
    }
}
