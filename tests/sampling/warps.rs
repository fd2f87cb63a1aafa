//! Warps and distributions against what they promise.

use std::f64::consts::PI;

use super::common::chi2::Chi2;
use super::common::random::Random;
use glam::{Vec2, Vec3};
use lucerna::sampling::{PiecewiseConstant1D, SolidAnglePdf, warp};

/// How many chi-squared tests of warps there are here.
const WARPS: usize = 21;

fn first_two(u: [f32; 4]) -> Vec2 {
    Vec2::new(u[0], u[1])
}

#[test]
fn disk_and_triangle_have_their_density() {
    // By azimuth and squared radius, whose area element is half of d phi d(r^2).
    let disk = Chi2::new([[-PI, PI], [0.0, 1.0]]).of(WARPS).run(
        |u| {
            let p = warp::sample_uniform_disk(first_two(u)).as_dvec2();
            Some([p.y.atan2(p.x), p.length_squared()])
        },
        |_| 0.5 * f64::from(warp::uniform_disk_pdf()),
    );
    disk.assert_ok("uniform disk");
    let triangle = Chi2::new([[0.0, 1.0]; 2]).of(WARPS).run(
        |u| {
            let b = warp::sample_uniform_triangle(first_two(u));
            assert!((b.element_sum() - 1.0).abs() < 1e-6 && b.min_element() >= 0.0);
            Some([b.x, b.y].map(f64::from))
        },
        |[b0, b1]| f64::from(b0 + b1 <= 1.0) * f64::from(warp::uniform_triangle_pdf()),
    );
    triangle.assert_ok("uniform triangle");
}

#[test]
fn directions_have_their_density() {
    let sphere = Chi2::sphere().of(WARPS);
    type Warp = (&'static str, fn(Vec2) -> Vec3, fn(Vec3) -> SolidAnglePdf);
    let cases: [Warp; 3] = [
        ("cosine hemisphere", warp::sample_cosine_hemisphere, |w| {
            warp::cosine_hemisphere_pdf(w.z)
        }),
        ("uniform hemisphere", warp::sample_uniform_hemisphere, |w| {
            SolidAnglePdf(f32::from(w.z > 0.0) * warp::uniform_hemisphere_pdf().0)
        }),
        ("uniform sphere", warp::sample_uniform_sphere, |_| {
            warp::uniform_sphere_pdf()
        }),
    ];
    for (name, sample, pdf) in cases {
        let report = sphere.run_directions(|u| Some(sample(first_two(u))), |w| pdf(w).0);
        report.assert_ok(name);
        assert!((report.mass - 1.0).abs() < 1e-5, "{name}: {}", report.mass);
    }
}

#[test]
fn phase_functions_have_their_density_and_mean_cosine() {
    for g in [0.0, 0.3, 0.9, -0.6] {
        let report = Chi2::sphere().of(WARPS).run_directions(
            |u| Some(warp::sample_henyey_greenstein(first_two(u), g)),
            |w| warp::henyey_greenstein_pdf(w.z, g).0,
        );
        report.assert_ok(&format!("Henyey-Greenstein of g {g}"));
        assert!((report.mass - 1.0).abs() < 1e-5, "{g}: {}", report.mass);
        // What g means, by quadrature of the density.
        const STEPS: usize = 1 << 16;
        let mean: f64 = (0..STEPS)
            .map(|i| {
                let cos = -1.0 + 2.0 * (i as f64 + 0.5) / STEPS as f64;
                2.0 * PI * cos * f64::from(warp::henyey_greenstein_pdf(cos as f32, g).0) * 2.0 / STEPS as f64
            })
            .sum();
        assert!((mean - f64::from(g)).abs() < 1e-5, "{g}: {mean}");
    }
}

#[test]
fn polygons_have_their_density() {
    for corners in [3, 5, 6, 64] {
        let sector = 2.0 * PI / f64::from(corners);
        // The squared distance of the side in a direction, from the middle of the nearest side on.
        let rim_squared = |phi: f64| {
            let from_middle = phi.rem_euclid(sector) - 0.5 * sector;
            ((0.5 * sector).cos() / from_middle.cos()).powi(2)
        };
        let report = Chi2::new([[-PI, PI], [0.0, 1.0]]).of(WARPS).run(
            |u| {
                let p = warp::sample_regular_polygon(first_two(u), corners).as_dvec2();
                let phi = p.y.atan2(p.x);
                let part = p.length_squared() / rim_squared(phi);
                assert!(part < 1.0 + 1e-6);
                Some([phi, part.min(1.0)])
            },
            // The area element is half of the squared distance times d phi d part.
            |[phi, _]| 0.5 * rim_squared(phi) * f64::from(warp::regular_polygon_pdf(corners)),
        );
        report.assert_ok(&format!("polygon of {corners}"));
        assert!((report.mass - 1.0).abs() < 1e-4, "{}", report.mass);
    }
}

#[test]
fn cones_have_their_density_however_narrow() {
    // Half angles of 60 degrees, the sun's 0.2666 degrees, and a ten-thousandth of that.
    for sin in [0.75_f64.sqrt(), 4.653e-3, 4.653e-7] {
        let limit = warp::one_minus_cos((sin * sin) as f32);
        // In the sine's square, which keeps its digits: d omega = d phi d(1 - cos) = d phi d(sin^2) / (2 cos).
        let report = Chi2::new([[-PI, PI], [0.0, sin * sin]]).of(WARPS).run(
            |u| {
                let w = warp::sample_uniform_cone(first_two(u), limit).as_dvec3();
                assert!((w.length() - 1.0).abs() < 1e-6);
                Some([w.y.atan2(w.x), w.x * w.x + w.y * w.y])
            },
            |[_, sin_squared]| f64::from(warp::uniform_cone_pdf(limit).0) / (2.0 * (1.0 - sin_squared).sqrt()),
        );
        report.assert_ok(&format!("cone of sine {sin}"));
        assert!((report.mass - 1.0).abs() < 1e-5);
    }
}

#[test]
fn interval_densities_hold() {
    let interval = |from: f64, to: f64| Chi2 {
        bins: [100, 1],
        ..Chi2::new([[from, to], [0.0, 1.0]]).of(WARPS)
    };
    for (a, b) in [(1.0, 3.0), (2.0, 0.0), (0.0, 0.5)] {
        interval(0.0, 1.0)
            .run(
                |u| Some([f64::from(warp::sample_linear(u[0], a, b)), 0.5]),
                |[x, _]| f64::from(warp::linear_pdf(x as f32, a, b)),
            )
            .assert_ok(&format!("linear {a} {b}"));
    }
    interval(-1.5, 1.5)
        .run(
            |u| Some([f64::from(warp::sample_tent(u[0], 1.5)), 0.5]),
            |[x, _]| f64::from(warp::tent_pdf(x as f32, 1.5)),
        )
        .assert_ok("tent");
    let values: Vec<f32> = (0..50).map(|i| (i as f32 * 0.3).sin()).collect();
    let steps = PiecewiseConstant1D::new(&values, -2.0, 2.0).expect("valid");
    interval(-2.0, 2.0)
        .run(
            |u| Some([f64::from(steps.sample(u[0]).0), 0.5]),
            |[x, _]| f64::from(steps.pdf(x as f32)),
        )
        .assert_ok("piecewise constant");
}

/// The distance of two numbers of [0, 1), whose ends meet for angles.
fn apart(a: Vec2, b: Vec2, y_is_angle: bool) -> f32 {
    let d = (a - b).abs();
    d.x.max(if y_is_angle { d.y.min(1.0 - d.y) } else { d.y })
}

#[test]
fn warps_invert() {
    // Some units in the last place of numbers up to pi, brought back to [0, 1).
    const TOLERANCE: f32 = 1e-6;
    let mut random = Random::new(3);
    let edges = [0.0, 0.5, 1.0 - f32::EPSILON / 2.0];
    let corners = (0..9).map(|i| Vec2::new(edges[i % 3], edges[i / 3]));
    let inside = (0..10_000).map(|_| first_two(random.unit4()));
    let narrow = warp::one_minus_cos(1e-12);
    for u in corners.chain(inside.collect::<Vec<_>>()) {
        let disk = warp::invert_uniform_disk(warp::sample_uniform_disk(u));
        let triangle = warp::invert_uniform_triangle(warp::sample_uniform_triangle(u));
        let cosine = warp::invert_cosine_hemisphere(warp::sample_cosine_hemisphere(u));
        for (name, back) in [("disk", disk), ("triangle", triangle), ("cosine", cosine)] {
            assert!(apart(u, back, false) < TOLERANCE, "{name}: {u} and {back}");
        }
        for corners in [3, 5, 6, 64] {
            let back = warp::invert_regular_polygon(warp::sample_regular_polygon(u, corners), corners);
            // On the ray through a corner the side is a matter of rounding; what is lost is a number's distance from the centre or from
            // the side, squared: some 1e-7 of the first becomes its root.
            let edge = (u.x * corners as f32).fract();
            if edge > 1e-3 && edge < 0.999 && u.y > 1e-3 && u.y < 0.999 {
                assert!(apart(u, back, false) < 1e-4, "polygon of {corners}: {u} and {back}");
            }
        }
        let directions = [
            (
                "hemisphere",
                warp::invert_uniform_hemisphere(warp::sample_uniform_hemisphere(u)),
            ),
            ("sphere", warp::invert_uniform_sphere(warp::sample_uniform_sphere(u))),
            (
                "cone",
                warp::invert_uniform_cone(warp::sample_uniform_cone(u, narrow), narrow),
            ),
        ];
        for (name, back) in directions {
            // At the pole itself no azimuth is left.
            let expected = if u.x == 0.0 { Vec2::new(u.x, back.y) } else { u };
            assert!(apart(expected, back, true) < TOLERANCE, "{name}: {u} and {back}");
        }
        for g in [0.0, 0.3, -0.6] {
            let back = warp::invert_henyey_greenstein(warp::sample_henyey_greenstein(u, g), g);
            // Straight on and straight back there is no azimuth, and near them little.
            let expected = if u.x < 1e-5 || u.x > 1.0 - 1e-5 {
                Vec2::new(u.x, back.y)
            } else {
                u
            };
            assert!(
                apart(expected, back, true) < 4.0 * TOLERANCE,
                "phase function {g}: {u} and {back}"
            );
        }
        for (a, b) in [(1.0, 3.0), (2.0, 0.0), (0.0, 0.5), (1.0, 1.0)] {
            let back = warp::invert_linear(warp::sample_linear(u.x, a, b), a, b);
            assert!((back - u.x).abs() < TOLERANCE, "linear {a} {b}: {} and {back}", u.x);
        }
        let back = warp::invert_tent(warp::sample_tent(u.x, 2.0), 2.0);
        assert!((back - u.x).abs() < TOLERANCE, "tent: {} and {back}", u.x);
    }
}

#[test]
fn a_density_over_area_seen_from_a_point_integrates_to_one() {
    // A unit square at height 0.5 over the point: directions uniform over the sphere, p_w where they hit it.
    let report = super::common::means::Estimate::of((0..64).map(|seed| {
        let mut random = Random::new(seed);
        let n = 10_000;
        let hits = (0..n).map(|_| {
            let w = warp::sample_uniform_sphere(Vec2::new(random.unit(), random.unit()));
            let p = w * (0.5 / w.z);
            if w.z <= 0.0 || p.x.abs() > 0.5 || p.y.abs() > 0.5 {
                return 0.0;
            }
            let pdf_w = lucerna::sampling::AreaPdf(1.0).to_solid_angle(p.length_squared(), w.z);
            f64::from(pdf_w.0 / warp::uniform_sphere_pdf().0)
        });
        hits.sum::<f64>() / f64::from(n)
    }));
    let z = (report.mean - 1.0) / report.variance.sqrt();
    assert!(z.abs() < 3.0 && report.variance.sqrt() < 0.005, "{report:?}");
}
