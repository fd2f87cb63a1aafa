//! The filter of cut-out geometry.

use std::panic::{AssertUnwindSafe, catch_unwind};

use super::tests::{build, down, flat, hit, placed, sphere, trace, triangle};
use crate::accel::{Accel, FilterHit, HitFilter, RayKind};
use crate::geometry::{Geometry, GeometryId, InstanceId, Opacity, PrimitiveId, Ray, RayPacket};
use crate::math::{AnimatedTransform, DAffine3, DVec3};

/// Lets through what one condition says, and checks what it is asked.
struct Only<F>(F);

impl<F: Fn(&FilterHit) -> bool + Sync> HitFilter for Only<F> {
    fn accept(&self, hit: &FilterHit) -> bool {
        (self.0)(hit)
    }
}

fn filtered(geometry: Geometry) -> Geometry {
    Geometry {
        opacity: Opacity::Filtered,
        ..geometry
    }
}

#[test]
fn a_filter_decides_about_filtered_geometry_alone() {
    let scene = build(&flat([
        filtered(triangle(&[5.0])),
        triangle(&[3.0]),
        filtered(triangle(&[1.0])),
    ]));
    let reject = Only(|_: &FilterHit| false);
    assert_eq!(trace(&scene, &down(0.25, 0.5), None), Some((hit(0, 0, None), 5.0)));
    assert_eq!(
        trace(&scene, &down(0.25, 0.5), Some(&reject)),
        Some((hit(1, 0, None), 7.0))
    );
    let by_ray = Only(|hit: &FilterHit| hit.ray_id == 7);
    let with = |id| Ray { id, ..down(0.25, 0.5) };
    assert_eq!(trace(&scene, &with(7), Some(&by_ray)).unwrap().1, 5.0);
    assert_eq!(trace(&scene, &with(8), Some(&by_ray)).unwrap().1, 7.0);
}

#[test]
fn a_filter_is_told_what_was_hit() {
    let shift = AnimatedTransform::fixed(DAffine3::from_translation(DVec3::new(0.0, 0.0, 2.0))).unwrap();
    let check = Only(|hit: &FilterHit| {
        let expected = FilterHit {
            geometry: GeometryId(1),
            primitive: PrimitiveId(0),
            instance: Some(InstanceId(1)),
            u: 0.25,
            v: 0.5,
            t: 8.0,
            ray_id: 11,
        };
        if hit.instance == Some(InstanceId(1)) {
            assert_eq!(*hit, expected);
        }
        true
    });
    let far = AnimatedTransform::fixed(DAffine3::from_translation(DVec3::new(0.0, 0.0, -9.0))).unwrap();
    let scene = build(&placed(filtered(triangle(&[0.0])), [far, shift]));
    let ray = Ray {
        id: 11,
        ..down(0.25, 0.5)
    };
    assert_eq!(trace(&scene, &ray, Some(&check)), Some((hit(1, 0, Some(1)), 8.0)));
}

#[test]
fn a_filter_may_open_the_front_of_a_sphere() {
    let scene = build(&flat([filtered(sphere(DVec3::ZERO, 2.0))]));
    let back = Only(|hit: &FilterHit| hit.t > 10.0);
    assert_eq!(trace(&scene, &down(0.0, 0.0), None).unwrap().1, 8.0);
    assert_eq!(
        trace(&scene, &down(0.0, 0.0), Some(&back)),
        Some((hit(0, 0, None), 12.0))
    );
}

#[test]
fn a_panic_in_a_filter_comes_out_of_the_query() {
    let world = flat([
        filtered(triangle(&[0.0])),
        filtered(sphere(DVec3::new(5.0, 0.0, 0.0), 1.0)),
    ]);
    let scene = build(&world);
    let panics = Only(|_: &FilterHit| panic!("on purpose"));
    for (kind, x) in [(RayKind::Camera, 0.25), (RayKind::Shadow, 5.0)] {
        let mut packets = [RayPacket::EMPTY];
        packets[0].set(0, &down(x, 0.25));
        let caught = catch_unwind(AssertUnwindSafe(|| scene.occluded(kind, &mut packets, Some(&panics))));
        let payload = caught.expect_err("a panic");
        assert_eq!(payload.downcast_ref::<&str>(), Some(&"on purpose"));
    }
    // The scene is as good as before.
    assert!(trace(&scene, &down(0.25, 0.25), None).is_some());
}
