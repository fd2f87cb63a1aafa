//! Tubes against distances, and against Mitsuba.

use super::*;

fn straight(ends: [Vec3; 2], radii: [f32; 2]) -> TubeSet {
    let piece = TubePiece {
        ends,
        radii,
        along: [0.0, 1.0],
        tangents: None,
        is_joined: false,
    };
    TubeSet::new(vec![piece], DAffine3::IDENTITY).unwrap()
}

/// What a march along the line says, by the distance to the hull of two balls: the least over the balls between them.
fn marched(tube: &TubeSet, origin: DVec3, direction: DVec3) -> Option<f64> {
    let hull = Hull::new(&tube.pieces[0]);
    let distance = |p: DVec3| {
        let at = |f: f64| (p - hull.center(f)).length() - hull.radius(f);
        (0..=4000)
            .map(|i| at(f64::from(i) / 4000.0))
            .fold(f64::INFINITY, f64::min)
    };
    let mut t = 0.0;
    for _ in 0..2000 {
        let left = distance(origin + direction * t);
        if left < 1e-7 {
            return Some(t);
        }
        t += left;
        if t > 20.0 {
            return None;
        }
    }
    // It grazes.
    None
}

#[test]
fn lines_come_in_where_the_distance_to_the_hull_is_none() {
    let mut state = 1_u32;
    let mut random = || {
        state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
        f64::from(state >> 8) / f64::from(1 << 24) - 0.5
    };
    let mut vector = || DVec3::new(random(), random(), random());
    let mut hits = 0;
    for case in 0..300 {
        let ends = [vector(), vector()].map(DVec3::as_vec3);
        // Balls inside each other are among them.
        let radii = [
            0.02 + 0.5 * (case % 7) as f32 / 7.0,
            0.02 + 0.5 * (case % 5) as f32 / 5.0,
        ];
        let tube = straight(ends, radii);
        let origin = vector().normalize() * 4.0;
        let direction = (0.5 * vector() - origin).normalize();
        let expected = marched(&tube, origin, direction);
        let found = tube.intersect(0, origin, direction).iter().next();
        match (found, expected) {
            (Some(t), Some(expected)) => {
                hits += 1;
                assert!((t - expected).abs() < 2e-3, "case {case}: {t}, not {expected}");
                let surface = tube.surface(0, origin, direction);
                assert!((surface.p - (origin + direction * t)).length() < 1e-9);
                assert!(surface.ng.dot(direction) <= 1e-9);
            }
            (None, None) => {}
            // Only a graze may be seen by one of them.
            (found, expected) => {
                let t = found.or(expected).unwrap();
                let surface = tube.surface(0, origin, direction);
                let cos = surface.ng.dot(direction).abs();
                assert!(cos < 0.05, "case {case}: one of them sees none at {t}, cosine {cos}");
            }
        }
    }
    assert!(hits > 100, "{hits}");
}

#[test]
fn nothing_is_seen_from_inside_or_through_an_open_end() {
    let closed = straight([Vec3::ZERO, Vec3::X], [0.25, 0.25]);
    assert!(
        closed
            .intersect(0, DVec3::new(-2.0, 0.0, 0.0), DVec3::X)
            .iter()
            .eq([1.75])
    );
    // Behind the origin: the ray began inside.
    let from_inside = closed.intersect(0, DVec3::new(0.5, 0.0, 0.0), DVec3::X);
    assert!(from_inside.iter().all(|t| t < 0.0));
    let piece = TubePiece {
        tangents: Some([Vec3::X; 2]),
        ..closed.pieces[0]
    };
    let open = TubeSet::new(vec![piece], DAffine3::IDENTITY).unwrap();
    assert!(
        open.intersect(0, DVec3::new(-2.0, 0.1, 0.0), DVec3::X)
            .iter()
            .next()
            .is_none()
    );
    let side = open.intersect(0, DVec3::new(0.5, 2.0, 0.0), DVec3::NEG_Y);
    assert!(side.iter().eq([1.75]));
}

/// Points, normals and texture coordinates that Mitsuba 3.9.1 gives for the first piece of a curve of three.
#[test]
fn surfaces_are_those_of_mitsuba() {
    let mut tube = straight([Vec3::ZERO, Vec3::new(1.0, 0.2, 0.1)], [0.3, 0.2]);
    tube.pieces[0].along = [0.0, 1.0 / 3.0];
    for (origin, direction, t, normal, uv) in [
        (
            DVec3::new(0.5, 0.05, 5.0),
            DVec3::NEG_Z,
            4.70484,
            DVec3::new(0.040_159, -0.191_165, 0.980_736),
            Vec2::new(0.281_44, 1.0 - 0.163_307),
        ),
        (
            DVec3::new(0.5, 5.0, 0.0),
            DVec3::NEG_Y,
            4.65433,
            DVec3::new(-0.074_135, 0.975_124, -0.208_896),
            Vec2::new(0.964_612, 1.0 - 0.172_799),
        ),
    ] {
        let surface = tube.surface(0, origin, direction);
        assert!((surface.p - (origin + direction * t)).length() < 1e-5);
        // Embree interpolates the normal along the cone, with single precision.
        assert!((surface.ng - normal).length() < 0.02, "{} {normal}", surface.ng);
        assert!((surface.uv - uv).length() < 2e-3, "{} {uv}", surface.uv);
    }
}

/// The ball at a joint is that of the piece before; whatever can be seen of it is met there.
#[test]
fn a_joint_is_of_one_piece_and_closed() {
    let ends = [Vec3::ZERO, Vec3::new(1.0, 0.2, 0.0), Vec3::new(0.6, 1.1, 0.3)];
    let radii = [0.3, 0.2, 0.25];
    let piece = |i: usize, is_joined| TubePiece {
        ends: [ends[i], ends[i + 1]],
        radii: [radii[i], radii[i + 1]],
        along: [0.0, 1.0],
        tangents: None,
        is_joined,
    };
    let set = |is_joined| TubeSet::new(vec![piece(0, false), piece(1, is_joined)], DAffine3::IDENTITY).unwrap();
    let (joined, apart) = (set(true), set(false));
    let nearest = |tubes: &TubeSet, origin, direction| {
        let all = (0..2).filter_map(|i| tubes.intersect(i, origin, direction).iter().next());
        all.min_by(f64::total_cmp)
    };
    let mut on_the_ball = 0;
    for i in 0..5000 {
        let a = 2.4 * f64::from(i);
        let from = DVec3::new(a.sin(), a.cos(), (0.37 * a).sin()).normalize() * 3.0;
        let target = ends[1].as_dvec3() + 0.25 * DVec3::new((1.7 * a).sin(), (2.3 * a).cos(), (0.9 * a).sin());
        let direction = (target - from).normalize();
        let [t, expected] = [&joined, &apart].map(|tubes| nearest(tubes, from, direction));
        match (t, expected) {
            (Some(t), Some(expected)) => {
                assert!((t - expected).abs() < 1e-9);
                let to_ball = (from + direction * t).distance(ends[1].as_dvec3()) - f64::from(radii[1]);
                on_the_ball += usize::from(to_ball.abs() < 1e-9);
            }
            (t, expected) => assert_eq!(t, expected),
        }
    }
    assert!(on_the_ball > 100, "{on_the_ball}");
}
