//! Curves that are Embree's own primitives.

use super::tests::{build, flat, hit, placed, trace, triangle};
use crate::accel::Accel;
use crate::geometry::{CurveKind, CurveSegment, CurveSet, Geometry, Opacity, Ray, Shape};
use crate::math::{AnimatedTransform, DAffine3, DQuat, DVec3, Vec3};

/// A strip along x, from -1 to 1, of this width.
fn strip(width: f32, kind: CurveKind) -> Geometry {
    let segment = CurveSegment {
        points: [-1.0, -0.3, 0.3, 1.0].map(|x| Vec3::X * x),
        widths: [width; 2],
        normals: [Vec3::Z; 2],
    };
    Geometry::opaque(Shape::Curves(
        CurveSet::new(vec![segment], kind, 0, DAffine3::IDENTITY).unwrap(),
    ))
}

fn up(x: f32, below: f32) -> Ray {
    Ray::new(Vec3::new(x, 0.01, -below), Vec3::Z, 0.0)
}

/// Embree leaves out curves within their width of a ray's origin: the floor under a strip had no shadow.
#[test]
fn a_strip_close_above_is_met() {
    let scene = build(&flat([strip(0.5, CurveKind::Flat), triangle(&[5.0])]));
    assert!(scene.built.scenes.curves.is_some());
    for below in [1e-3, 0.1, 0.3, 0.49, 0.6, 4.0] {
        let (found, t) = trace(&scene, &up(0.3, below), None).unwrap();
        assert_eq!(found, hit(0, 0, None));
        assert!((t - below).abs() < 1e-5, "{below}: {t}");
    }
    // What is behind is not met, nor what is beyond the end.
    let beyond = Ray::new(Vec3::new(0.3, 0.01, 1e-3), Vec3::Z, 0.0);
    assert_eq!(trace(&scene, &beyond, None).unwrap().0, hit(1, 0, None));
    let short = Ray {
        tfar: 0.29,
        ..up(0.3, 0.3)
    };
    assert_eq!(trace(&scene, &short, None), None);
    let none = Ray {
        tnear: 1.0,
        tfar: 0.999_999_9,
        ..up(0.3, 1.0)
    };
    assert_eq!(trace(&scene, &none, None), None);
}

/// Through instances that make it wider, at rest and in motion, and by directions of any length.
#[test]
fn strips_in_instances_are_met() {
    let large = DAffine3::from_scale(DVec3::new(30.0, 20.0, 10.0));
    let turn = DAffine3::from_rotation_translation(DQuat::from_rotation_z(1.0), DVec3::ZERO) * large;
    for place in [
        AnimatedTransform::fixed(large).unwrap(),
        AnimatedTransform::new(large, turn).unwrap(),
    ] {
        let scene = build(&placed(strip(0.5, CurveKind::Cylinder), [place]));
        assert!(scene.built.scenes.curves.is_some());
        for (below, length) in [(0.01, 1.0), (2.0, 1e-3), (4.0, 1e4), (9.0, 1.0)] {
            let ray = Ray::new(Vec3::new(0.3, 0.01, -below), Vec3::Z * length, 0.5);
            let (found, t) = trace(&scene, &ray, None).unwrap();
            assert_eq!(found, hit(1, 0, Some(0)));
            assert!(
                (t * length - below).abs() < 1e-3 * below + 1e-4,
                "{below} {length}: {t}"
            );
        }
    }
}

/// What Embree cannot say as we do is left to our test.
#[test]
fn some_curves_stay_ours() {
    let filtered = Geometry {
        opacity: Opacity::Filtered,
        ..strip(0.1, CurveKind::Flat)
    };
    for ours in [filtered, strip(0.1, CurveKind::Ribbon), strip(0.0, CurveKind::Ribbon)] {
        assert!(build(&flat([ours])).built.scenes.curves.is_none());
    }
    // Among thin ones, rays would start too far back for these.
    let both = build(&flat([strip(1e-4, CurveKind::Flat), strip(1.0, CurveKind::Flat)]));
    assert!(both.built.scenes.curves.is_some());
    for x in [0.3, -0.7] {
        assert_eq!(trace(&both, &up(x, 0.2), None).unwrap().0, hit(1, 0, None));
    }
    assert!(both.info().memory > 0);
}
