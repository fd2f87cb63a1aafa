//! Spherical cameras as receivers: connections lead back to film positions of the same direction, and the densities are those of
//! camera rays.

use glam::{DMat3, DVec3, Vec2};
use lucerna::camera::{Camera, CameraDensity, CameraSample, RasterDomain};
use lucerna::math::{AnimatedTransform, DAffine3};
use lucerna::sampling::{SolidAnglePdf, SphereMap};

use super::common::random::Random;

const MAPS: [(SphereMap, [u32; 2]); 2] = [(SphereMap::EqualArea, [12, 12]), (SphereMap::LatLong, [24, 12])];

/// Filters that reach two pixels beyond a pixel's centre.
fn domain(resolution: [u32; 2]) -> RasterDomain {
    RasterDomain::new(resolution, Vec2::splat(2.0))
}

/// A rotation and a translation; then with skew, scale and a mirror.
fn placements() -> [DAffine3; 2] {
    let rigid = DAffine3::from_translation(DVec3::new(3.0, -2.0, 1.0))
        * DAffine3::from_axis_angle(DVec3::new(1.0, 2.0, 2.0) / 3.0, 0.8);
    let skew = DMat3::from_cols(
        DVec3::new(-1.3, 0.1, 0.0),
        DVec3::new(0.4, 0.9, -0.2),
        DVec3::new(0.2, -0.3, 1.6),
    );
    [rigid, rigid * DAffine3::from_mat3(skew)]
}

fn each(mut check: impl FnMut(&Camera, [u32; 2], &mut Random)) {
    let mut random = Random::new(7);
    for (map, resolution) in MAPS {
        for place in placements() {
            let motion = AnimatedTransform::fixed(place).expect("invertible");
            check(
                &Camera::spherical(map, resolution, [0.0, 1.0], &motion),
                resolution,
                &mut random,
            );
        }
    }
}

fn sample(film: Vec2) -> CameraSample {
    CameraSample {
        film,
        lens: Vec2::splat(0.5),
        time: 0.5,
    }
}

#[test]
fn connections_retrace_camera_rays() {
    each(|camera, resolution, random| {
        let domain = domain(resolution);
        let [min, max] = domain.corners();
        let mut several = 0;
        for _ in 0..2000 {
            let [x, y, u, distance] = random.unit4();
            let ray = camera.sample_ray(&sample(min + Vec2::new(x, y) * (max - min)));
            let p = ray.origin + ray.direction * (0.5 + 3.0 * distance);
            let connection = camera.sample_wi(p, 0.5, Vec2::splat(u), &domain).expect("it is seen");
            assert!((connection.wi + ray.direction).length() < 1e-5);
            assert!((connection.end - ray.origin).length() < 1e-5);
            // It may be another film position of the same direction: how many there are, the importance says.
            assert!(domain.contains(connection.ray.film));
            let there = camera.sample_ray(&sample(connection.ray.film)).direction;
            assert!((there - ray.direction).length() < 2e-3, "{} {there}", ray.direction);
            assert_eq!(camera.importance(&sample(connection.ray.film)), 1.0);
            let count = connection.ray.importance;
            assert!(count.fract() == 0.0 && (1.0..=9.0).contains(&count));
            several += u32::from(count > 1.0);
            let known = camera.pdf_we(p, ray.direction, 0.5).expect("its ray");
            assert_eq!((known.arrival, known.importance), (connection.ray.arrival, 1.0));
            assert_eq!(connection.density, CameraDensity::Delta);
        }
        assert!((20..1900).contains(&several), "{several}");
    });
}

/// The solid angle of a small square of film, by the cross product of two differences, is its area over the density.
#[test]
fn densities_are_those_of_camera_rays() {
    each(|camera, resolution, random| {
        let size = Vec2::new(resolution[0] as f32, resolution[1] as f32);
        for _ in 0..500 {
            let [x, y, ..] = random.unit4();
            // Not at the poles or the edges of faces, where differences jump.
            let film = Vec2::new(x, y).clamp(Vec2::splat(0.1), Vec2::splat(0.9)) * size;
            let at = |film: Vec2| camera.sample_ray(&sample(film)).direction.as_dvec3();
            const H: f32 = 0.02;
            let change = |step: Vec2| (at(film + step) - at(film - step)) / f64::from(2.0 * H);
            let solid_angle = change(Vec2::new(H, 0.0)).cross(change(Vec2::new(0.0, H))).length();
            let ray = camera.sample_ray(&sample(film));
            let p = ray.origin + ray.direction * 2.0;
            let known = camera.pdf_we(p, ray.direction, 0.5).expect("its ray");
            let CameraDensity::Continuous(SolidAnglePdf(density)) = known.direction else {
                panic!("a density")
            };
            let expected = 1.0 / solid_angle;
            // The square's map has creases on its diagonals and its inner square.
            let [u, v] = [(2.0 * film.x / size.x - 1.0).abs(), (2.0 * film.y / size.y - 1.0).abs()];
            let on_crease = (u - v).abs().min((u + v - 1.0).abs()).min(u).min(v) < 0.02;
            assert!(
                on_crease || (f64::from(density) / expected - 1.0).abs() < 0.01,
                "{film}: {density} and {expected}"
            );
            assert_eq!(known.we, density);
            assert!((known.arrival.0 * 4.0 / density - 1.0).abs() < 1e-4);
        }
    });
}
