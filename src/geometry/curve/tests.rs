use super::*;

fn segment() -> CurveSegment {
    CurveSegment {
        points: [
            Vec3::new(-1.0, 0.0, 0.0),
            Vec3::new(-0.3, 0.8, 0.2),
            Vec3::new(0.4, -0.6, -0.3),
            Vec3::new(1.0, 0.2, 0.1),
        ],
        widths: [0.2, 0.05],
        normals: [Vec3::Z, Vec3::new(0.0, 0.6, 0.8)],
    }
}

fn set(kind: CurveKind, depth: u32) -> CurveSet {
    CurveSet::new(vec![segment()], kind, depth, DAffine3::IDENTITY).unwrap()
}

/// All that a ray meets of a set, nearest first.
fn nearest(set: &CurveSet, origin: DVec3, direction: DVec3) -> Option<(usize, f64)> {
    (0..set.primitive_count())
        .filter_map(|i| set.intersect(i, origin, direction).from(0.0).map(|t| (i, t)))
        .min_by(|a, b| a.1.total_cmp(&b.1))
}

#[test]
fn rays_meet_what_is_within_half_the_width_of_the_axis() {
    let points = segment().points.map(Vec3::as_dvec3);
    let direction = DVec3::new(0.1, -0.2, -3.0);
    for kind in [CurveKind::Flat, CurveKind::Cylinder] {
        for depth in [0, 3] {
            let set = set(kind, depth);
            for i in 1..39 {
                // Not where parts meet: of what goes through the end of a part rounding decides.
                let u = (f64::from(i) + 0.37) / 40.0;
                let axis = bezier::point(&points, u);
                let across = direction.cross(bezier::derivative(&points, u)).normalize();
                let half = 0.5 * width_at(&segment(), u);
                for (share, is_met) in [(-1.1, false), (-0.85, true), (0.0, true), (0.85, true), (1.1, false)] {
                    let target = axis + across * (half * share);
                    let found = nearest(&set, target - 2.0 * direction, direction);
                    assert_eq!(found.is_some(), is_met, "{kind:?} {depth} {u} {share}");
                    let Some((part, t)) = found else { continue };
                    assert!((t - 2.0).abs() < 0.01, "{t}");
                    let surface = set.surface(part, target - 2.0 * direction, direction, 0.0);
                    // Flat within a twentieth of the greatest width, so that coordinates are off by as much of the width here.
                    let v = f64::from(surface.uv.y);
                    let off = 0.05 * 0.2 / (2.0 * half);
                    assert!(
                        (v - (0.5 + 0.5 * share)).abs() < off || (v - (0.5 - 0.5 * share)).abs() < off,
                        "{kind:?} {depth} {u} {share}: {v}"
                    );
                    assert!((f64::from(surface.uv.x) - u).abs() < 0.05);
                    assert!(
                        surface
                            .dpdu
                            .as_dvec3()
                            .normalize()
                            .dot(bezier::derivative(&points, u).normalize())
                            > 0.99
                    );
                    assert!(surface.ng.dot(surface.dpdu.as_dvec3()).abs() < 1e-6);
                }
            }
        }
    }
}

#[test]
fn parts_are_the_whole() {
    let (whole, parts) = (set(CurveKind::Flat, 0), set(CurveKind::Flat, 4));
    let mut hits = 0;
    for i in 0..4000 {
        let a = f64::from(i) * 0.37;
        let target = DVec3::new((1.7 * a).sin(), 0.3 * (2.3 * a).cos(), 0.0);
        let direction = DVec3::new(0.3 * a.cos(), 0.3 * a.sin(), -1.0);
        let [a, b] = [&whole, &parts].map(|set| nearest(set, target - 3.0 * direction, direction).map(|(_, t)| t));
        // They are divided in other places: at the rim they may differ.
        hits += usize::from(a.is_some());
        if let (Some(a), Some(b)) = (a, b) {
            assert!((a - b).abs() < 0.02);
        }
    }
    assert!(hits > 200);
}

#[test]
fn ribbons_turn_with_their_normals() {
    let set = set(CurveKind::Ribbon, 2);
    // At the start the normal is z: seen along y its edge is met only within what the turning leaves.
    let p = bezier::point(&segment().points.map(Vec3::as_dvec3), 0.05);
    let wide = p + DVec3::new(0.0, 0.0, 0.05);
    assert!(nearest(&set, p + DVec3::Z * 2.0, DVec3::NEG_Z).is_some());
    assert!(nearest(&set, wide + DVec3::Y * 2.0, DVec3::NEG_Y).is_none());
    let surface = set.surface(0, p + DVec3::Z * 2.0, DVec3::NEG_Z, 0.0);
    assert!(surface.ng.z.abs() > 0.95);
}

#[test]
fn the_normal_of_a_cylinder_is_that_of_its_place() {
    let straight = CurveSegment {
        points: [0.0, 1.0, 2.0, 3.0].map(|x| Vec3::new(x, 0.0, 0.0)),
        widths: [0.5; 2],
        normals: [Vec3::Z; 2],
    };
    let set = CurveSet::new(vec![straight], CurveKind::Cylinder, 0, DAffine3::IDENTITY).unwrap();
    for y in [-0.2, -0.1, 0.0, 0.15] {
        let surface = set.surface(0, DVec3::new(1.2, y, 4.0), DVec3::NEG_Z, 0.0);
        let angle = (y / 0.25) * FRAC_PI_2;
        // pbrt's angle is proportional to the distance from the axis. Up to the sign of the whole.
        let expected = DVec3::new(0.0, angle.sin(), angle.cos());
        assert!(
            surface.ng.dot(expected).abs() > 1.0 - 1e-6,
            "{y}: {} {expected}",
            surface.ng
        );
        assert!((f64::from(surface.dpdu.x) - 3.0).abs() < 1e-6);
        assert!((f64::from(surface.uv.x) - 0.4).abs() < 1e-6);
    }
}

#[test]
fn boxes_hold_what_is_met() {
    let place = DAffine3::from_scale_rotation_translation(
        DVec3::new(2.0, 0.5, 1.0),
        DQuat::from_rotation_y(0.7),
        DVec3::new(1.0, 2.0, 3.0),
    );
    let set = CurveSet::new(vec![segment()], CurveKind::Flat, 3, place).unwrap();
    let mut hits = 0;
    for i in 0..20_000 {
        let a = f64::from(i) * 0.73;
        let target = place.transform_point3(DVec3::new((1.7 * a).sin(), 0.4 * (2.3 * a).cos(), 0.0));
        let direction = DVec3::new(a.cos(), a.sin(), (0.3 * a).cos());
        for part in 0..set.primitive_count() {
            let origin = target - 3.0 * direction;
            for t in set.intersect(part, origin, direction).iter() {
                let p = (origin + direction * t).as_vec3();
                let bounds = set.primitive_bounds(part).expand(1e-5);
                assert!(p.cmpge(bounds.min).all() && p.cmple(bounds.max).all());
                hits += 1;
            }
        }
    }
    assert!(hits > 1000);
}

/// What a backend's own curves are made from: the axis and half the width, at every primitive.
#[test]
fn facing_curves_are_the_same_curves() {
    let place = DAffine3::from_scale_rotation_translation(
        DVec3::new(-2.0, 2.0, 2.0),
        DQuat::from_rotation_y(0.7),
        DVec3::new(1.0, 2.0, 3.0),
    );
    let set = CurveSet::new(vec![segment(); 2], CurveKind::Flat, 3, place).unwrap();
    let facing = set.facing().unwrap();
    assert_eq!(facing.first.len(), set.primitive_count());
    assert_eq!(facing.points.len(), 2 * 25);
    assert!((facing.largest_radius - 0.2).abs() < 1e-6);
    for (primitive, &first) in facing.first.iter().enumerate() {
        let control: [[f32; 4]; 4] = std::array::from_fn(|i| facing.points[first as usize + i]);
        let points = control.map(|[x, y, z, _]| DVec3::new(x.into(), y.into(), z.into()));
        let radii = control.map(|[.., r]| DVec3::X * f64::from(r));
        let (segment, [u0, u1]) = set.part(primitive);
        for w in [0.0, 0.3, 1.0] {
            let u = u0 + (u1 - u0) * w;
            let axis = place.transform_point3(bezier::point(&segment.points.map(Vec3::as_dvec3), u));
            assert!(bezier::point(&points, w).distance(axis) < 1e-5);
            assert!((bezier::point(&radii, w).x - width_at(segment, u)).abs() < 1e-6);
        }
        // Straight steps stay as near to it as is said.
        let steps = f64::from(facing.steps);
        let middle = bezier::point(&points, 0.5 / steps);
        let chord = 0.5 * (points[0] + bezier::point(&points, 1.0 / steps));
        assert!(chord.distance(middle) < 0.5 * set.facing_error(primitive) + 1e-6);
    }
}

#[test]
fn not_all_curves_face_the_ray_in_the_world() {
    let of = |kind, place| CurveSet::new(vec![segment()], kind, 2, place).unwrap().facing();
    let uneven = DAffine3::from_scale(DVec3::new(1.0, 1.01, 1.0));
    assert!(of(CurveKind::Cylinder, DAffine3::IDENTITY).is_some());
    assert!(of(CurveKind::Ribbon, DAffine3::IDENTITY).is_none());
    assert!(of(CurveKind::Flat, uneven).is_none());
    let thin = CurveSegment {
        widths: [1e-4; 2],
        ..segment()
    };
    let bent = CurveSet::new(vec![thin], CurveKind::Flat, 0, DAffine3::IDENTITY).unwrap();
    assert!(bent.facing().is_none(), "it takes more straight steps than there are");
}
