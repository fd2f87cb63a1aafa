//! Samplers, warps and distributions against what they promise.

mod common;

use std::f64::consts::PI;

use common::chi2::Chi2;
use common::means::Means;
use common::random::Random;
use glam::{Vec2, Vec3};
use lucerna::sampling::{PiecewiseConstant1D, Sampler, SamplerKind, SolidAnglePdf, warp};

/// How many chi-squared tests of warps there are here.
const WARPS: usize = 17;

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
        for (a, b) in [(1.0, 3.0), (2.0, 0.0), (0.0, 0.5), (1.0, 1.0)] {
            let back = warp::invert_linear(warp::sample_linear(u.x, a, b), a, b);
            assert!((back - u.x).abs() < TOLERANCE, "linear {a} {b}: {} and {back}", u.x);
        }
        let back = warp::invert_tent(warp::sample_tent(u.x, 2.0), 2.0);
        assert!((back - u.x).abs() < TOLERANCE, "tent: {} and {back}", u.x);
    }
}

const KINDS: [SamplerKind; 2] = [SamplerKind::Independent, SamplerKind::Sobol];

/// Pairs of numbers that must be independent of each other, by what differs between them. Each gets `i` and gives one pair
/// of a sample `i` of a family.
type Pair = (&'static str, fn(Sampler, u32) -> [f32; 2]);

const PAIRS: [Pair; 8] = [
    ("two dimensions", |s, i| {
        s.start(i as i32 % 640, i as i32 / 640, 0).draw2(0)
    }),
    ("the last two dimensions", |s, i| {
        let [_, _, a, b] = s.start(i as i32 % 640, i as i32 / 640, 5).draw4(3);
        [a, b]
    }),
    ("neighbours in x", |s, i| {
        let x = 2 * (i % 640) as i32;
        [x, x + 1].map(|x| s.start(x, i as i32 / 640, 3).draw1(1))
    }),
    ("neighbours in y", |s, i| {
        let y = 2 * (i / 640) as i32;
        [y, y + 1].map(|y| s.start(i as i32 % 640 - 320, y - 320, 3).draw4(1)[2])
    }),
    ("two groups", |s, i| {
        let stream = s.start(i as i32 % 640, i as i32 / 640, 2);
        [stream.draw1(6), stream.draw1(7)]
    }),
    ("stream and branch", |s, i| {
        let stream = s.start(i as i32 % 640, i as i32 / 640, 2);
        [stream.draw1(6), stream.branch(0).draw1(6)]
    }),
    ("two branches", |s, i| {
        let stream = s.start(i as i32 % 640, i as i32 / 640, 2);
        [stream.branch(4).draw1(0), stream.branch(5).draw1(0)]
    }),
    ("two seeds", |s, i| {
        let other = Sampler::new(s.kind(), s.seed() + 1, s.samples_per_pixel());
        [s, other].map(|s| s.start(i as i32 % 640, i as i32 / 640, 1).draw1(0))
    }),
];

#[test]
fn what_should_be_independent_is_uniform_over_the_square() {
    for kind in KINDS {
        for (name, pair) in PAIRS {
            let mut next = 0;
            let report = Chi2::new([[0.0, 1.0]; 2]).of(2 * PAIRS.len()).run(
                |_| {
                    next += 1;
                    let pair = pair(Sampler::new(kind, 42, 64), next - 1);
                    assert!(pair.iter().all(|u| (0.0..1.0).contains(u)));
                    Some(pair.map(f64::from))
                },
                |_| 1.0,
            );
            report.assert_ok(&format!("{kind:?}, {name}"));
        }
    }
}

#[test]
fn independent_samples_of_one_pixel_are_uniform() {
    let sampler = Sampler::new(SamplerKind::Independent, 0, u32::MAX);
    let mut next = 0;
    let consecutive = |_| {
        next += 2;
        Some([next - 2, next - 1].map(|i| f64::from(sampler.start(7, 9, i).draw1(0))))
    };
    Chi2::new([[0.0, 1.0]; 2])
        .run(consecutive, |_| 1.0)
        .assert_ok("consecutive samples");
}

/// The points of a Sobol group of one pixel, as integers of 24 bits.
fn sobol_points(pixel: i32, group: u32, indices: std::ops::Range<u32>) -> Vec<[u32; 4]> {
    let sampler = Sampler::new(SamplerKind::Sobol, 11, 1 << 20);
    indices
        .map(|i| {
            sampler
                .start(pixel, 1, i)
                .draw4(group)
                .map(|u| (u * 16_777_216.0) as u32)
        })
        .collect()
}

/// Whether each elementary interval with `splits[d]` binary digits in dimension d holds the same number of the points.
fn is_even(points: &[[u32; 4]], splits: [u32; 4]) -> bool {
    let cells = 1 << splits.iter().sum::<u32>();
    let mut counts = vec![0_usize; cells];
    for point in points {
        let cell = (0..4).fold(0, |cell, d| cell << splits[d] | point[d] >> (24 - splits[d]));
        counts[cell as usize] += 1;
    }
    counts.iter().all(|&c| c == points.len() / cells)
}

#[test]
fn sobol_prefixes_fill_each_elementary_interval_once() {
    for k in 0..=10 {
        for (pixel, group) in [(0, 0), (5, 1), (-8, 17)] {
            let n = 1 << k;
            // The first 2^k samples, and the next 2^k.
            for points in [sobol_points(pixel, group, 0..n), sobol_points(pixel, group, n..2 * n)] {
                for a in 0..=k {
                    assert!(
                        is_even(&points, [a, k - a, 0, 0]),
                        "first pair, 2^{k} points, {a} digits"
                    );
                }
                for d in 2..4 {
                    let mut splits = [0; 4];
                    splits[d] = k;
                    assert!(is_even(&points, splits), "dimension {d}, 2^{k} points");
                }
            }
        }
    }
}

#[test]
fn sobol_groups_are_nets_in_four_dimensions() {
    // The degrees of the four polynomials, less one, sum to t = 3 (Sobol 1967): every elementary interval of volume 2^(3-m)
    // holds 8 of 2^m points.
    let m = 9;
    let points = sobol_points(3, 2, 0..1 << m);
    for a in 0..=m - 3 {
        for b in 0..=m - 3 - a {
            for c in 0..=m - 3 - a - b {
                let splits = [a, b, c, m - 3 - a - b - c];
                assert!(is_even(&points, splits), "{splits:?}");
            }
        }
    }
}

/// The estimates of the integral of a smooth function over the unit square in each of `runs` pixels.
fn estimates(kind: SamplerKind, samples: u32, runs: i32) -> Vec<f64> {
    let sampler = Sampler::new(kind, 5, samples);
    let f = |[x, y]: [f32; 2]| (f64::from(x) * PI).sin() * (-f64::from(y)).exp();
    (0..runs)
        .map(|run| (0..samples).map(|i| f(sampler.start(run, 0, i).draw2(4))).sum::<f64>() / f64::from(samples))
        .collect()
}

#[test]
fn sobol_is_unbiased_and_converges_faster() {
    let exact = 2.0 / PI * (1.0 - (-1.0_f64).exp());
    let error = |values: &[f64]| {
        let squares: f64 = values.iter().map(|v| (v - exact).powi(2)).sum();
        (squares / values.len() as f64).sqrt()
    };
    let mut errors = Vec::new();
    for kind in KINDS {
        for samples in [64, 1024] {
            let values = estimates(kind, samples, 256);
            let runs: Vec<Vec<f64>> = values.iter().map(|&v| vec![v]).collect();
            Means::default()
                .against_exact(&runs, &[exact])
                .assert_agrees(&format!("{kind:?} {samples}"));
            errors.push(error(&values));
        }
    }
    // Sixteen times the samples: the error falls by 4 for independent ones, by about 64 for scrambled nets and smooth
    // functions (Owen 1997). 256 estimates know each error to 5 %.
    let [independent_64, independent_1024, sobol_64, sobol_1024] = errors[..] else {
        unreachable!("four errors")
    };
    let ratio = independent_64 / independent_1024;
    assert!((3.2..5.0).contains(&ratio), "independent: {ratio}");
    assert!(sobol_64 / sobol_1024 > 40.0, "sobol: {sobol_64} to {sobol_1024}");
    assert!(sobol_1024 < independent_1024 / 50.0);
}

#[test]
fn a_density_over_area_seen_from_a_point_integrates_to_one() {
    // A unit square at height 0.5 over the point: directions uniform over the sphere, p_w where they hit it.
    let report = common::means::Estimate::of((0..64).map(|seed| {
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
