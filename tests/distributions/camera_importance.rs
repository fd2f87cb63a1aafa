//! Cameras as receivers: connections lead back to the film position and the lens point that camera rays come from, importance
//! integrates to what a pixel measures, and the densities of camera rays are those that camera rays have.

use std::f64::consts::PI;

use glam::{DMat3, DVec2, DVec3, Vec2};
use lucerna::camera::{Camera, CameraConnection, CameraDensity, CameraSample, CameraSpec, Projection, RasterDomain};
use lucerna::desc::{ApertureDesc, MeasureDesc};
use lucerna::math::{AnimatedTransform, DAffine3};

use super::common::chi2::Chi2;
use super::common::means::{FEWEST_RUNS, Means};
use super::common::random::Random;
use super::first_two;

const RESOLUTION: [u32; 2] = [6, 4];
const FILTER_RADIUS: Vec2 = Vec2::new(1.5, 1.0);
/// The grown raster, in whole pixels from corner to corner.
const GROWN: [f64; 2] = [8.0, 5.0];
const LENS: f64 = 0.4;
const FOCUS: f64 = 7.0;
const NEAR: f64 = 1.5;
const FOV: f64 = 70.0;

fn domain() -> RasterDomain {
    RasterDomain::new(RESOLUTION, FILTER_RADIUS)
}

/// A rotation and a translation; then with skew, scale and a mirror; then a motion.
fn placements() -> [AnimatedTransform; 3] {
    let moved = |angle: f64, by: DVec3| {
        DAffine3::from_translation(by) * DAffine3::from_axis_angle(DVec3::new(1.0, 2.0, 2.0) / 3.0, angle)
    };
    let rigid = moved(0.8, DVec3::new(3.0, -2.0, 1.0));
    let skew = DMat3::from_cols(
        DVec3::new(-1.3, 0.1, 0.0),
        DVec3::new(0.4, 0.9, -0.2),
        DVec3::new(0.2, -0.3, 1.6),
    );
    let end = moved(2.1, DVec3::new(-4.0, 0.5, 2.0)) * DAffine3::from_scale(DVec3::new(1.0, 2.0, 0.7));
    [
        AnimatedTransform::fixed(rigid),
        AnimatedTransform::fixed(rigid * DAffine3::from_mat3(skew)),
        AnimatedTransform::new(rigid, end),
    ]
    .map(|t| t.expect("invertible"))
}

/// One of every combination of projection, lens and measure.
fn specs() -> Vec<CameraSpec> {
    let projections = [
        Projection::Perspective {
            fov: FOV,
            near_clip: 0.0,
        },
        Projection::Perspective {
            fov: FOV,
            near_clip: NEAR,
        },
        Projection::Orthographic,
    ];
    let blades = ApertureDesc::Polygon {
        blades: 5,
        rotation: 20.0,
    };
    let lenses = [(0.0, ApertureDesc::Round), (LENS, ApertureDesc::Round), (LENS, blades)];
    let mut specs = Vec::new();
    for projection in projections {
        for (lens_radius, aperture) in lenses {
            for measure in [MeasureDesc::Radiance, MeasureDesc::Irradiance] {
                specs.push(CameraSpec {
                    projection,
                    screen_window: [-1.5, 1.5, -1.0, 1.0],
                    resolution: RESOLUTION,
                    lens_radius,
                    focal_distance: FOCUS,
                    aperture,
                    measure,
                    shutter: [0.25, 0.75],
                    world_from_camera: AnimatedTransform::identity(),
                });
            }
        }
    }
    specs
}

/// All cameras at all placements.
fn cameras() -> impl Iterator<Item = (CameraSpec, Camera)> {
    placements().into_iter().flat_map(|world_from_camera| {
        specs().into_iter().map(move |spec| {
            let spec = CameraSpec {
                world_from_camera: world_from_camera.clone(),
                ..spec
            };
            let camera = Camera::new(&spec);
            (spec, camera)
        })
    })
}

/// A position of the grown raster.
fn grown(u: [f32; 2]) -> Vec2 {
    let [min, max] = domain().corners();
    min + Vec2::from(u) * (max - min)
}

/// A part in 10^5: single precision, and some operations.
fn close(a: f32, b: f32) -> bool {
    (a - b).abs() <= 1e-5 * a.abs().max(b.abs())
}

#[test]
fn the_grown_raster_is_what_pixels_see() {
    let [min, max] = domain().corners();
    assert_eq!((min, max), (Vec2::new(-1.0, -0.5), Vec2::new(7.0, 4.5)));
    assert_eq!((max - min).as_dvec2(), DVec2::from(GROWN));
    for (film, seen) in [
        (Vec2::new(-0.99, 4.49), true),
        (Vec2::new(-1.01, 0.0), false),
        (Vec2::new(3.0, 4.51), false),
        (Vec2::new(f32::NAN, 0.0), false),
    ] {
        assert_eq!(domain().contains(film), seen, "{film}");
    }
}

#[test]
fn connections_retrace_camera_rays() {
    let mut random = Random::new(1);
    for (spec, camera) in cameras() {
        for _ in 0..500 {
            let [x, y, lens_x, lens_y] = random.unit4();
            let sample = CameraSample {
                film: grown([x, y]),
                lens: Vec2::new(lens_x, lens_y),
                time: random.unit(),
            };
            let ray = camera.sample_ray(&sample);
            assert_eq!(ray.time, camera.scene_time(sample.time));
            let t = 0.5 + 20.0 * random.unit();
            let p = ray.origin + ray.direction * t;
            let found = camera.sample_wi(p, ray.time, sample.lens, &domain());
            // Rounding may put a position just outside of the raster.
            let Some(connection) = found else {
                let [min, max] = domain().corners();
                let inside = (sample.film - min).min(max - sample.film).min_element();
                assert!(inside < 1e-3, "{spec:?}: {sample:?} is lost");
                continue;
            };
            assert!(
                (connection.ray.film - sample.film).length() < 1e-3,
                "{spec:?}: {connection:?}"
            );
            assert!(
                (connection.end - ray.origin).length() < 1e-4,
                "{spec:?}: {connection:?}"
            );
            assert!(
                (connection.wi + ray.direction).length() < 1e-5,
                "{spec:?}: {connection:?}"
            );
            // The lens lies on the ray's line, in its own plane.
            let to_lens = connection.lens - p;
            assert!(
                (to_lens.normalize() - connection.wi).length() < 1e-4,
                "{spec:?}: {connection:?}"
            );
            let origin = spec.world_from_camera.at(ray.time).translation.as_vec3();
            assert!((connection.lens - origin).dot(connection.normal).abs() < 1e-4);
            assert!(connection.normal.dot(ray.direction) > 0.0);
            assert!(close(connection.ray.importance, camera.importance(&sample)));
            agrees_with_itself(&camera, &connection, p, ray.time);
        }
    }
}

/// The relations between what a connection and a ray say.
fn agrees_with_itself(camera: &Camera, connection: &CameraConnection, p: glam::Vec3, time: f32) {
    let ray = camera.pdf_we(p, -connection.wi, time).expect("in front of the camera");
    let same = &connection.ray;
    assert!((ray.film - same.film).length() < 1e-3);
    for (a, b) in [
        (ray.we, same.we),
        (ray.arrival.0, same.arrival.0),
        (ray.importance, same.importance),
    ] {
        assert!((a / b - 1.0).abs() < 1e-4, "{ray:?} is not {same:?}");
    }
    // Only the densities that are there: for each, W_e cos / d² = I p(o) p(w) / d² as in the module's head.
    let cos = connection.normal.dot(-connection.wi);
    let distance_squared = p.distance_squared(connection.lens);
    let (p_a, p_w) = (ray.position, ray.direction);
    let expected = match (p_a, p_w) {
        (CameraDensity::Continuous(a), CameraDensity::Continuous(w)) => a.0 * w.0,
        (CameraDensity::Continuous(a), CameraDensity::Delta) => a.0,
        (CameraDensity::Delta, CameraDensity::Continuous(w)) => w.0,
        (CameraDensity::Delta, CameraDensity::Delta) => panic!("no measure at all"),
    };
    assert!((ray.we * cos / (ray.importance * expected) - 1.0).abs() < 1e-3);
    match (connection.density, p_a, p_w) {
        // A lens: the literal quotient of importance and density.
        (CameraDensity::Continuous(density), ..) => {
            assert!((same.we / density.0 / connection.weight() - 1.0).abs() < 1e-3);
        }
        // A pinhole: a point that receives, seen over a distance.
        (CameraDensity::Delta, CameraDensity::Delta, _) => {
            assert!((same.we * cos / distance_squared / connection.weight() - 1.0).abs() < 1e-3);
        }
        // Parallel rays.
        (CameraDensity::Delta, ..) => assert!(close(same.we, connection.weight())),
    }
}

#[test]
fn what_no_pixel_sees_is_not_connected() {
    let lens = Vec2::new(0.3, 0.8);
    for (spec, camera) in cameras() {
        let place = spec.world_from_camera.at(0.5);
        let connect = |x: f64, y: f64, z: f64| {
            let p = place.transform_point3(DVec3::new(x, y, z)).as_vec3();
            camera.sample_wi(p, 0.5, lens, &domain())
        };
        assert!(connect(0.0, 0.0, 5.0).is_some(), "{spec:?}");
        assert!(connect(0.0, 0.0, -5.0).is_none(), "{spec:?}");
        assert!(connect(40.0, 0.0, 5.0).is_none(), "{spec:?}");
        assert!(connect(0.0, -40.0, 5.0).is_none(), "{spec:?}");
        let near = match spec.projection {
            Projection::Perspective { near_clip, .. } => near_clip,
            Projection::Orthographic => 0.0,
        };
        assert!(connect(0.0, 0.0, near - 0.01).is_none(), "{spec:?}");
        assert!(connect(0.0, 0.0, near + 0.1).is_some() || near == 0.0, "{spec:?}");
        let p = place.transform_point3(DVec3::new(0.0, 0.0, 5.0)).as_vec3();
        let back = place.transform_vector3(-DVec3::Z).normalize().as_vec3();
        assert!(camera.pdf_we(p, -back, 0.5).is_some() && camera.pdf_we(p, back, 0.5).is_none());
    }
}

/// What a pixel measures of radiance 1, for every unit square of the grown raster: the mean of `importance`, which is tested against
/// closed forms elsewhere, by the midpoint rule.
fn measured(camera: &Camera, spec: &CameraSpec) -> Vec<f64> {
    const STEPS: usize = 8;
    let middle = |i: usize| (i as f32 + 0.5) / STEPS as f32;
    // As many for each of five sides.
    let lens_steps = if spec.lens_radius > 0.0 { 20 } else { 1 };
    let [columns, rows] = GROWN.map(|size| size as usize);
    let [min, _] = domain().corners();
    let mean = |cell: usize| {
        let corner = min + Vec2::new((cell % columns) as f32, (cell / columns) as f32);
        let mut sum = 0.0;
        for i in 0..STEPS * STEPS {
            for j in 0..lens_steps * lens_steps {
                let lens = Vec2::new((j % lens_steps) as f32, (j / lens_steps) as f32) + 0.5;
                sum += f64::from(camera.importance(&CameraSample {
                    film: corner + Vec2::new(middle(i % STEPS), middle(i / STEPS)),
                    lens: lens / lens_steps as f32,
                    time: 0.5,
                }));
            }
        }
        sum / (STEPS * STEPS * lens_steps * lens_steps) as f64
    };
    (0..columns * rows).map(mean).collect()
}

/// A point of the plane z = 4 + 0.2 x - 0.1 y, and its change with two parameters: the slopes x / z and y / z, which spread points
/// over pixels evenly in perspective, or x and y.
fn on_plane(perspective: bool, x: f64, y: f64) -> [DVec3; 3] {
    if !perspective {
        let p = DVec3::new(x, y, 4.0 + 0.2 * x - 0.1 * y);
        return [p, DVec3::new(1.0, 0.0, 0.2), DVec3::new(0.0, 1.0, -0.1)];
    }
    let direction = DVec3::new(x, y, 1.0);
    let z = 4.0 / (1.0 - 0.2 * x + 0.1 * y);
    let [dz_dx, dz_dy] = [0.05 * z * z, -0.025 * z * z];
    [
        direction * z,
        DVec3::X * z + direction * dz_dx,
        DVec3::Y * z + direction * dz_dy,
    ]
}

/// Points of a surface of radiance 1 that fills the picture are connected to the camera.
#[test]
fn importance_integrates_to_what_a_pixel_measures() {
    const SAMPLES: usize = 200_000;
    // What a pixel measures is a matter of camera space: one placement tells.
    let first = &placements()[0];
    let of_interest = |spec: &CameraSpec| spec.measure == MeasureDesc::Radiance || spec.world_from_camera == *first;
    let count = cameras().filter(|(spec, _)| of_interest(spec)).count();
    for (i, (spec, camera)) in cameras().filter(|(spec, _)| of_interest(spec)).enumerate() {
        let time = camera.scene_time(0.5);
        let place = spec.world_from_camera.at(time);
        let perspective = spec.projection != Projection::Orthographic;
        // Enough for the grown raster and the lens, with some margin.
        let half = if perspective {
            DVec2::new(1.6, 1.1)
        } else {
            DVec2::new(2.25, 1.5)
        };
        let [columns, rows] = GROWN.map(|size| size as usize);
        let run = |seed: usize| {
            let mut random = Random::new((seed * count + i) as u64);
            let mut cells = vec![0.0; columns * rows];
            let strata = (SAMPLES as f64).sqrt() as usize;
            for stratum in 0..strata * strata {
                let u = random.unit4().map(f64::from);
                let x = half.x * (2.0 * ((stratum % strata) as f64 + u[0]) / strata as f64 - 1.0);
                let y = half.y * (2.0 * ((stratum / strata) as f64 + u[1]) / strata as f64 - 1.0);
                let [p, dx, dy] = on_plane(perspective, x, y);
                let p = place.transform_point3(p);
                let area_element = place.transform_vector3(dx).cross(place.transform_vector3(dy));
                let lens = Vec2::new(u[2] as f32, u[3] as f32);
                let Some(connection) = camera.sample_wi(p.as_vec3(), time, lens, &domain()) else {
                    continue;
                };
                let cell = (connection.ray.film - domain().corners()[0]).as_uvec2();
                let facing = area_element.dot(connection.wi.as_dvec3()).abs();
                let share = 4.0 * half.x * half.y / (strata * strata) as f64;
                cells[cell.y as usize * columns + cell.x as usize] += f64::from(connection.weight()) * facing * share;
            }
            cells
        };
        let runs: Vec<_> = (1..=FEWEST_RUNS).map(run).collect();
        let means = Means {
            significance: 0.01 / count as f64,
            // The quadrature of what is expected.
            slack: 1e-3,
        };
        let expected = measured(&camera, &spec);
        let report = means.against_exact(&runs, &expected);
        report.assert_agrees(&format!("{spec:?}"));
        let (block, whole) = report.detectable;
        assert!(block < 0.05 && whole < 0.005, "{spec:?}: {block} {whole}");
    }
}

/// Directions of camera rays through one point of the lens, over the grown raster, against the density that they are said to have.
#[test]
fn directions_of_a_perspective_camera_have_their_density() {
    let perspective = || cameras().filter(|(spec, _)| matches!(spec.projection, Projection::Perspective { .. }));
    let count = perspective().count();
    for (spec, camera) in perspective() {
        let time = 0.6;
        let lens = Vec2::new(0.1, 0.7);
        let place = spec.world_from_camera.at(camera.scene_time(time));
        let sample = |u: Vec2| CameraSample {
            film: grown(u.to_array()),
            lens,
            time,
        };
        let origin = camera.sample_wi(
            camera.sample_ray(&sample(Vec2::splat(0.5))).at_depth(3.0),
            camera.scene_time(time),
            lens,
            &domain(),
        );
        let origin = origin.expect("the middle of the picture").lens;
        let shape = match spec.aperture {
            ApertureDesc::Round => PI,
            ApertureDesc::Polygon { blades, .. } => 0.5 * f64::from(blades) * (2.0 * PI / f64::from(blades)).sin(),
        };
        let axes = [DVec3::X, DVec3::Y].map(|axis| place.transform_vector3(axis * spec.lens_radius));
        let lens_area = shape * axes[0].cross(axes[1]).length();
        // By slopes in camera space, so that the raster is a rectangle: one more Jacobian, but not the one in question.
        let [x, y] = [0.0, 1.0].map(|u| slopes(&place, camera.sample_ray(&sample(Vec2::splat(u))).direction));
        let [left, right] = [x[0].min(y[0]), x[0].max(y[0])];
        let [bottom, top] = [x[1].min(y[1]), x[1].max(y[1])];
        let pixels = GROWN[0] * GROWN[1];
        let report = Chi2 {
            samples: 100_000,
            ..Chi2::new([[left, right], [bottom, top]]).of(count)
        }
        .run(
            |u| Some(slopes(&place, camera.sample_ray(&sample(first_two(u))).direction)),
            |slope| {
                let (w, jacobian) = solid_angle(&place, slope);
                let p = origin + 10.0 * w;
                let ray = camera.pdf_we(p, w, camera.scene_time(time)).expect("in front");
                let CameraDensity::Continuous(density) = ray.direction else {
                    panic!("a delta direction");
                };
                // The lens is filled evenly, by another test.
                match ray.position {
                    CameraDensity::Continuous(p) => assert!((f64::from(p.0) * lens_area - 1.0).abs() < 1e-4),
                    CameraDensity::Delta => assert_eq!(lens_area, 0.0),
                }
                f64::from(density.0) * jacobian / pixels
            },
        );
        assert!((report.mass - 1.0).abs() < 1e-4, "{spec:?}: {}", report.mass);
        report.assert_ok(&format!("{spec:?}"));
    }
}

/// Directions of an orthographic camera over its lens, and where its rays cross the plane of the lens.
#[test]
fn rays_of_an_orthographic_camera_have_their_density() {
    let parallel = || cameras().filter(|(spec, _)| spec.projection == Projection::Orthographic);
    let count = parallel().count();
    for (spec, camera) in parallel() {
        let place = spec.world_from_camera.at(0.5);
        let center = CameraSample {
            film: Vec2::new(2.0, 3.0),
            lens: Vec2::splat(0.3),
            time: 0.5,
        };
        let ray = camera.sample_ray(&center);
        let seen = camera.pdf_we(ray.at_depth(3.0), ray.direction, 0.5).expect("in front");
        // One pixel of film moves the ray by one pixel's area of the lens plane.
        let moved = |x: f32, y: f32| {
            let film = center.film + Vec2::new(x, y);
            (camera.sample_ray(&CameraSample { film, ..center }).origin - ray.origin).as_dvec3()
        };
        let CameraDensity::Continuous(position) = seen.position else {
            panic!("a delta position");
        };
        let area = moved(1.0, 0.0).cross(moved(0.0, 1.0)).length();
        assert!((f64::from(position.0) * area - 1.0).abs() < 1e-4, "{spec:?}");
        let CameraDensity::Continuous(_) = seen.direction else {
            assert_eq!(spec.lens_radius, 0.0);
            continue;
        };
        let reach = LENS / FOCUS;
        let report = Chi2 {
            samples: 100_000,
            ..Chi2::new([[-PI, PI], [0.0, 1.0]]).of(count)
        }
        .run(
            |u| {
                let lens = first_two(u);
                let [x, y] = slopes(&place, camera.sample_ray(&CameraSample { lens, ..center }).direction);
                Some([y.atan2(x), (x * x + y * y) / (reach * reach)])
            },
            |[azimuth, square]| {
                let slope = [azimuth.cos(), azimuth.sin()].map(|c| c * reach * square.sqrt());
                // Opposite to the lens point.
                if !inside(spec.aperture, azimuth + PI, square.sqrt()) {
                    return 0.0;
                }
                let (w, jacobian) = solid_angle(&place, slope);
                let ray = camera.pdf_we(ray.at_depth(3.0), w, 0.5).expect("in front");
                let CameraDensity::Continuous(density) = ray.direction else {
                    panic!("a delta direction");
                };
                // dx dy is half of d phi d(r²).
                f64::from(density.0) * jacobian * 0.5 * reach * reach
            },
        );
        assert!((report.mass - 1.0).abs() < 1e-3, "{spec:?}: {}", report.mass);
        report.assert_ok(&format!("{spec:?}"));
    }
}

/// Whether a lens of radius 1 holds the point at this angle and distance from its middle.
fn inside(aperture: ApertureDesc, angle: f64, radius: f64) -> bool {
    match aperture {
        ApertureDesc::Round => radius <= 1.0,
        ApertureDesc::Polygon { blades, rotation } => {
            let half = PI / f64::from(blades);
            let from_middle = (angle - rotation.to_radians()).rem_euclid(2.0 * half) - half;
            radius * from_middle.cos() <= half.cos()
        }
    }
}

/// A point of a ray.
trait AtDepth {
    fn at_depth(&self, t: f32) -> glam::Vec3;
}

impl AtDepth for lucerna::geometry::Ray {
    fn at_depth(&self, t: f32) -> glam::Vec3 {
        self.origin + t * self.direction
    }
}

/// x / z and y / z of a direction in camera space.
fn slopes(place: &DAffine3, w: glam::Vec3) -> [f64; 2] {
    let local = place.inverse().transform_vector3(w.as_dvec3());
    [local.x / local.z, local.y / local.z]
}

/// The unit direction of two slopes, and the solid angle of a small square of slopes, by finite differences.
fn solid_angle(place: &DAffine3, [x, y]: [f64; 2]) -> (glam::Vec3, f64) {
    let direction = |x: f64, y: f64| place.transform_vector3(DVec3::new(x, y, 1.0)).normalize();
    let step = 1e-4;
    let dx = (direction(x + step, y) - direction(x - step, y)) / (2.0 * step);
    let dy = (direction(x, y + step) - direction(x, y - step)) / (2.0 * step);
    (direction(x, y).as_vec3(), dx.cross(dy).length())
}
