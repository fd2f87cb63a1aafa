//! What every sampler promises: uniform numbers, independent where they should be, estimates that are right and get better.

use std::f64::consts::PI;

use super::common::chi2::Chi2;
use super::common::means::Means;
use lucerna::sampling::{Sampler, SamplerKind, Strata};

/// Eight by eight strata.
const STRATA: Strata = Strata {
    columns: 8,
    rows: 8,
    jitter: true,
};

const KINDS: [SamplerKind; 5] = [
    SamplerKind::Independent,
    SamplerKind::Stratified(STRATA),
    SamplerKind::Halton,
    SamplerKind::Sobol,
    SamplerKind::ZSobol,
];

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
            if kind == SamplerKind::ZSobol && name.starts_with("neighbours") {
                // These keep away from each other.
                continue;
            }
            let mut next = 0;
            let report = Chi2::new([[0.0, 1.0]; 2]).of(KINDS.len() * PAIRS.len()).run(
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

/// The estimates of the integral of a smooth function over the unit square, one by each of `runs` seeds.
fn estimates(kind: SamplerKind, samples: u32, runs: u64) -> Vec<f64> {
    let f = |[x, y]: [f32; 2]| (f64::from(x) * PI).sin() * (-f64::from(y)).exp();
    (0..runs)
        .map(|run| {
            let sampler = Sampler::new(kind, run, samples);
            (0..samples).map(|i| f(sampler.start(7, 4, i).draw2(0))).sum::<f64>() / f64::from(samples)
        })
        .collect()
}

#[test]
fn all_are_unbiased_and_converge_at_their_rates() {
    let exact = 2.0 / PI * (1.0 - (-1.0_f64).exp());
    let error = |values: &[f64]| {
        let squares: f64 = values.iter().map(|v| (v - exact).powi(2)).sum();
        (squares / values.len() as f64).sqrt()
    };
    // Sixteen times the samples: the error of independent ones falls by 4; that of strata by 16, as each point is bound to its
    // cell of two dimensions; that of scrambled nets by some 64 where functions are smooth (Owen 1997). 1024 is no power of 3, so
    // that Halton's points are in between. 256 estimates know each error to 5 %, their quotient to 7 %.
    let rates = [(3.2, 5.0), (13.0, 40.0), (12.0, 80.0), (40.0, 100.0), (40.0, 100.0)];
    let mut independent = f64::NAN;
    for (kind, (least, most)) in KINDS.into_iter().zip(rates) {
        let [few, many] = [64, 1024].map(|samples| {
            let values = estimates(kind, samples, 256);
            let runs: Vec<Vec<f64>> = values.iter().map(|&v| vec![v]).collect();
            Means::default()
                .against_exact(&runs, &[exact])
                .assert_agrees(&format!("{kind:?} {samples}"));
            error(&values)
        });
        println!("{kind:?}: {few:e} {many:e}");
        assert!((least..most).contains(&(few / many)), "{kind:?}: {few} to {many}");
        if kind == SamplerKind::Independent {
            independent = many;
        } else {
            assert!(many < independent / 10.0, "{kind:?}: {many}, independent {independent}");
        }
    }
}

/// The function of the numbers of groups that paths have: products over several groups, whose samples must not be paired alike.
#[test]
fn groups_are_paired_at_random() {
    // The mean of a product of four numbers with mean 0: any fixed pairing of samples between groups would leave a part.
    for kind in KINDS {
        let runs: Vec<Vec<f64>> = (0..256)
            .map(|run| {
                let sampler = Sampler::new(kind, run, 64);
                let product = |i| {
                    let stream = sampler.start(3, 9, i);
                    let centred = |group| f64::from(stream.draw1(group)) - 0.5;
                    144.0 * centred(2) * centred(3) * (centred(4) + centred(5))
                };
                vec![(0..64).map(product).sum::<f64>() / 64.0]
            })
            .collect();
        Means::default()
            .against_exact(&runs, &[0.0])
            .assert_agrees(&format!("{kind:?}"));
    }
}
