use super::*;
use crate::math::DQuat;
use std::f64::consts::PI;

fn place() -> DAffine3 {
    DAffine3::from_scale_rotation_translation(
        DVec3::new(2.0, 0.5, -1.5),
        DQuat::from_rotation_x(0.7) * DQuat::from_rotation_z(0.4),
        DVec3::new(1.0, -2.0, 3.0),
    )
}

fn all() -> Vec<Quadric> {
    let z = [-0.5, 0.75];
    [
        (QuadricKind::Sphere { radius: 1.0, z }, 2.0),
        (
            QuadricKind::Sphere {
                radius: 1.0,
                z: [-1.0, 1.0],
            },
            TAU,
        ),
        (QuadricKind::Cylinder { radius: 0.5, z }, 4.0),
        (QuadricKind::Cylinder { radius: 0.5, z }, TAU),
        (
            QuadricKind::Disk {
                height: 0.25,
                radius: 1.5,
                inner_radius: 0.5,
            },
            5.0,
        ),
        (
            QuadricKind::Disk {
                height: 0.0,
                radius: 1.0,
                inner_radius: 0.0,
            },
            TAU,
        ),
    ]
    .into_iter()
    .map(|(kind, phi_max)| Quadric::new(kind, phi_max, place()).unwrap())
    .collect()
}

#[test]
fn sampled_points_are_met_and_have_the_same_surface() {
    for quadric in all() {
        for i in 0..400 {
            let u = Vec2::new((i % 20) as f32 + 0.5, (i / 20) as f32 + 0.5) / 20.0;
            let sample = quadric.sample(u);
            let direction = DVec3::new(0.3, -0.8, 0.55);
            let origin = sample.p - direction * 7.0;
            let hits = quadric.intersect(origin, direction);
            assert!(hits.iter().any(|t| (t - 7.0).abs() < 1e-9), "{quadric:?} {u} {hits:?}");
            let surface = quadric.surface(origin, direction, 7.0 - 1e-9);
            assert!((surface.p - sample.p).length() < 1e-9);
            assert!(surface.ng.dot(sample.ng) > 1.0 - 1e-9);
            assert!((surface.uv - sample.uv).length() < 1e-5);
            assert!((quadric.pdf(surface.p) / sample.pdf - 1.0).abs() < 1e-9);
            // The cross product of the derivatives is along the normal, but for a transform that mirrors.
            let cross = surface.dpdu.cross(surface.dpdv).as_dvec3().normalize();
            assert!(cross.dot(surface.ng) < -1.0 + 1e-5, "{quadric:?}");
        }
    }
}

#[test]
fn areas_are_the_known_ones() {
    let scale = DAffine3::from_scale(DVec3::splat(2.0));
    let area = |kind, phi_max| Quadric::new(kind, phi_max, scale).unwrap().area() / 4.0;
    let disk = QuadricKind::Disk {
        height: 3.0,
        radius: 2.0,
        inner_radius: 1.0,
    };
    assert!((area(disk, PI) / (1.5 * PI) - 1.0).abs() < 1e-12);
    let cylinder = QuadricKind::Cylinder {
        radius: 0.5,
        z: [-1.0, 2.0],
    };
    assert!((area(cylinder, TAU) / (3.0 * PI) - 1.0).abs() < 1e-12);
    let sphere = QuadricKind::Sphere {
        radius: 1.0,
        z: [0.0, 1.0],
    };
    assert!((area(sphere, TAU) / TAU - 1.0).abs() < 1e-12);
}

#[test]
fn boxes_hold_the_surface_and_touch_it() {
    for quadric in all() {
        let bounds = quadric.bounds();
        let mut seen = Bounds3::EMPTY;
        for i in 0..10_000 {
            let p = quadric
                .sample(Vec2::new((i % 100) as f32, (i / 100) as f32) / 99.0)
                .p
                .as_vec3();
            assert!(p.cmpge(bounds.min).all() && p.cmple(bounds.max).all(), "{quadric:?}");
            seen = seen.grow(p);
        }
        if quadric.phi_max >= TAU {
            assert!((seen.extent() / bounds.extent()).min_element() > 0.99, "{quadric:?}");
        }
    }
}

#[test]
fn what_is_no_surface_is_refused() {
    let new = |kind, phi| Quadric::new(kind, phi, DAffine3::IDENTITY);
    let cylinder = |radius, z| QuadricKind::Cylinder { radius, z };
    assert!(new(cylinder(1.0, [0.0, 1.0]), TAU).is_some());
    for (kind, phi) in [
        (cylinder(0.0, [0.0, 1.0]), TAU),
        (cylinder(1.0, [1.0, 1.0]), TAU),
        (cylinder(1.0, [0.0, f64::NAN]), TAU),
        (cylinder(1.0, [0.0, f64::INFINITY]), TAU),
        (cylinder(1.0, [0.0, 1.0]), 0.0),
        (cylinder(1.0, [0.0, 1.0]), 7.0),
        (
            QuadricKind::Sphere {
                radius: 1.0,
                z: [-2.0, 0.0],
            },
            TAU,
        ),
        (
            QuadricKind::Disk {
                height: 0.0,
                radius: 1.0,
                inner_radius: 1.0,
            },
            TAU,
        ),
    ] {
        assert!(new(kind, phi).is_none(), "{kind:?} {phi}");
    }
    let flat = DAffine3::from_scale(DVec3::new(1.0, 1.0, 0.0));
    assert!(Quadric::new(cylinder(1.0, [0.0, 1.0]), TAU, flat).is_none());
}
