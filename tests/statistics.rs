//! The statistics of `tests/common` on made-up data: right data pass, wrong data fail, at the rates they promise.

mod common;

use common::chi2::Chi2;
use common::covering::Covering;
use common::means::Means;
use common::random::Random;
use common::reference::{Reference, Report, Rule, Runs, compare};

#[test]
fn chi2_passes_the_right_density_and_fails_others() {
    // x uniform, y with density 2 y.
    let sample = |u: [f32; 4]| Some([f64::from(u[0]), f64::from(u[1]).sqrt()]);
    let test = Chi2::new([[0.0, 1.0]; 2]);
    test.run(sample, |[_, y]| 2.0 * y).assert_ok("the right density");
    assert!(test.run(sample, |_| 1.0).problem().is_some(), "another density");
    // 400,000 samples notice a wave of 2 %: chi² grows by n 0.02² / 2 = 80 with 45 as the deviation of 1023.
    let wave = |[x, y]: [f64; 2]| 2.0 * y * (1.0 + 0.04 * (x * std::f64::consts::TAU).sin());
    assert!(
        test.run(sample, wave).problem().is_some(),
        "a density 4 % off in places"
    );
    // Constant factors: too much is an error by itself, too little is missed failures.
    let too_much = test.run(sample, |[_, y]| 2.04 * y).problem().expect("must fail");
    assert!(too_much.contains("integrates to 1.02"), "{too_much}");
    assert!(
        test.run(sample, |[_, y]| 1.96 * y).problem().is_some(),
        "2 % too little"
    );
}

#[test]
fn chi2_counts_failures_and_impossible_samples() {
    let test = Chi2::new([[0.0, 1.0]; 2]);
    let half = |u: [f32; 4]| (u[2] < 0.5).then_some([f64::from(u[0]), f64::from(u[1])]);
    test.run(half, |_| 0.5)
        .assert_ok("half of the samples fail, and the density says so");
    assert!(
        test.run(half, |_| 1.0).problem().is_some(),
        "failures that the density hides"
    );
    let strays = |u: [f32; 4]| Some([f64::from(u[0]) * 1.001, f64::from(u[1])]);
    assert!(test.run(strays, |_| 1.0).impossible > 100, "samples outside the domain");
}

#[test]
fn chi2_integrates_narrow_peaks() {
    // A normal of deviation 0.002, inside one of the cells of 0.03.
    let (centre, sigma) = (0.512, 0.002);
    let density = |t: f64| (-0.5 * ((t - centre) / sigma).powi(2)).exp() / (sigma * std::f64::consts::TAU.sqrt());
    let mut random = Random::new(9);
    let report = Chi2::new([[0.0, 1.0]; 2]).run(
        |_| Some([(); 2].map(|()| centre + sigma * random.normal())),
        |[x, y]| density(x) * density(y),
    );
    report.assert_ok("a narrow peak");
    assert!((report.mass - 1.0).abs() < 1e-6, "{}", report.mass);
}

#[test]
fn chi2_rejects_at_the_promised_rate() {
    // 400 right tests at 5 %: 20 rejections, give or take 4.4. 1e-4 two-sided is 3.9 deviations.
    let rejected = (0..400).filter(|&seed| {
        let test = Chi2 {
            samples: 4000,
            bins: [8, 8],
            seed,
            significance: 0.05,
            ..Chi2::new([[0.0, 1.0]; 2])
        };
        let sample = |u: [f32; 4]| Some([f64::from(u[0]), f64::from(u[1]).sqrt()]);
        test.run(sample, |[_, y]| 2.0 * y).problem().is_some()
    });
    let rejected = rejected.count();
    assert!((3..=37).contains(&rejected), "{rejected} of 400");
}

/// 16 runs of 64 blocks around 1 with the relative noise 1 % each, blocks multiplied by `factor`.
fn noisy_runs(seed: u64, factor: impl Fn(usize) -> f64) -> Vec<Vec<f64>> {
    let mut random = Random::new(seed);
    (0..16)
        .map(|_| {
            (0..64)
                .map(|block| factor(block) * (1.0 + 0.01 * random.normal()))
                .collect()
        })
        .collect()
}

#[test]
fn means_reject_at_the_promised_rate_and_find_injected_errors() {
    let expected = [1.0; 64];
    let test =
        |seed, factor: &dyn Fn(usize) -> f64| Means::default().against_exact(&noisy_runs(seed, factor), &expected);
    let right = (0..400).filter(|&seed| !test(seed, &|_| 1.0).agrees()).count();
    // 4 are expected; 13 or more have the probability 2e-4.
    assert!(right < 13, "{right} of 400 rejected");
    // What is found with probability 0.99 is missed in 1 of 100 on average, in 6 or more with probability 5e-4.
    let whole = (0..100).filter(|&seed| test(seed, &|_| 1.01).agrees()).count();
    assert!(
        whole < 6,
        "an error of 1 % in the whole was missed {whole} times in 100"
    );
    let one_block = |block| if block == 17 { 1.05 } else { 1.0 };
    let missed = (0..100).filter(|&seed| test(seed, &one_block).agrees()).count();
    assert!(
        missed < 6,
        "an error of 5 % in one block was missed {missed} times in 100"
    );
    let report = test(1, &one_block);
    assert_eq!(report.worst_block, 17, "{report}");
    test(2, &|_| 1.0).assert_power("noise of 1 %", 0.05, 0.01);
}

#[test]
fn means_state_the_power_they_have() {
    // In the report's own words: an error of the stated size is found in 99 of 100 cases.
    let expected = [1.0; 64];
    let detectable = |seed| {
        Means::default()
            .against_exact(&noisy_runs(seed, |_| 1.0), &expected)
            .detectable
            .1
    };
    let typical = (0..50).map(detectable).sum::<f64>() / 50.0;
    let found = (0..400).filter(|&seed| {
        let runs = noisy_runs(1000 + seed, |_| 1.0 + typical);
        let (_, _, p) = Means::default().against_exact(&runs, &expected).whole;
        p < 0.005
    });
    let found = found.count();
    assert!((385..=400).contains(&found), "{found} of 400 at {typical}");
}

#[test]
fn welch_compares_two_noisy_sides() {
    let test = |seed: u64, factor: f64| {
        Means::default().against_runs(&noisy_runs(2 * seed, |_| factor), &noisy_runs(2 * seed + 1, |_| 1.0))
    };
    let right = (0..400).filter(|&seed| !test(seed, 1.0).agrees()).count();
    assert!(right < 13, "{right} of 400 rejected");
    let missed = (0..100).filter(|&seed| test(seed, 1.01).agrees()).count();
    assert!(missed < 6, "{missed} of 100 missed");
}

#[test]
fn means_reject_nan_and_exact_differences() {
    let expected = [1.0; 64];
    let judge = |runs: &[Vec<f64>]| Means::default().against_exact(runs, &expected).agrees();
    assert!(judge(&vec![vec![1.0; 64]; 16]), "no noise and no difference");
    assert!(!judge(&vec![vec![1.0 + 1e-9; 64]; 16]), "no noise and a difference");
    let mut runs = noisy_runs(1, |_| 1.0);
    runs[3][5] = f64::NAN;
    assert!(!judge(&runs), "NaN");
    let slack = Means {
        slack: 0.005,
        ..Means::default()
    };
    assert!(slack.against_exact(&noisy_runs(4, |_| 1.003), &expected).agrees());
    assert!(!slack.against_exact(&noisy_runs(4, |_| 1.01), &expected).agrees());
}

const WIDTH: usize = 96;
const HEIGHT: usize = 64;

/// A picture with a gradient, in three colours.
fn truth(pixel: usize, channel: usize) -> f64 {
    let (x, y) = (pixel % WIDTH, pixel / WIDTH);
    [0.5, 0.2, 1.5][channel] * (1.0 + x as f64 / 30.0) * (1.0 + (y as f64 / 7.0).sin().powi(2))
}

/// A reference whose pixels have 1 % noise and say so, and 16 runs of ours with 4 % each, multiplied by `factor`: both block
/// means have a deviation of 0.25 %.
fn picture(seed: u64, noise: f64, factor: impl Fn(usize, usize) -> f64) -> (Runs, Reference) {
    let mut random = Random::new(seed);
    let mut noisy = |noise: f64, factor: &dyn Fn(usize, usize) -> f64| -> Vec<f32> {
        let values = (0..WIDTH * HEIGHT * 3).map(|i| {
            let value = truth(i / 3, i % 3) * factor(i / 3, i % 3);
            (value * (1.0 + noise * random.normal())) as f32
        });
        values.collect()
    };
    let reference = Reference {
        width: WIDTH,
        height: HEIGHT,
        mean: noisy(0.01, &|_, _| 1.0),
        variance: (0..WIDTH * HEIGHT * 3)
            .map(|i| (0.01 * truth(i / 3, i % 3)).powi(2) as f32)
            .collect(),
    };
    let mut runs = Runs::new(WIDTH, HEIGHT);
    for _ in 0..16 {
        runs.add(&noisy(noise, &factor));
    }
    (runs, reference)
}

fn judge(seed: u64, factor: impl Fn(usize, usize) -> f64) -> Report {
    let (runs, reference) = picture(seed, 0.04, factor);
    compare(&runs, &reference, &Rule::default())
}

#[test]
fn the_reference_rule_passes_what_agrees() {
    for seed in 0..10 {
        let report = judge(seed, |_, _| 1.0);
        report.assert_agrees("the same picture");
        // z has the extra 0.3 % in its denominator: 0.25² + 0.25² over 0.25² + 0.25² + 0.3².
        assert!((report.rms_z - 0.762).abs() < 0.08, "{report}");
    }
}

#[test]
fn the_reference_rule_finds_injected_errors() {
    for seed in 0..10 {
        let whole = judge(seed, |_, _| 1.01).problem().expect("1 % of the whole");
        assert!(whole.contains("the means over the image differ"), "{whole}");
        let (column, row) = (9, 5);
        let in_block = |pixel: usize| pixel % WIDTH / 4 == column && pixel / WIDTH / 4 == row;
        let one = judge(seed, |pixel, _| if in_block(pixel) { 1.05 } else { 1.0 });
        assert!(one.problem().is_some(), "5 % of one block: {one}");
        assert_eq!(one.worst_z.2, (column, row), "{one}");
        // An edge: a column of pixels 4 % too dark, in one channel.
        let edge = judge(
            seed,
            |pixel, channel| if pixel % WIDTH == 50 && channel == 1 { 0.92 } else { 1.0 },
        );
        assert!(edge.problem().is_some_and(|p| p.contains("touching")), "{edge}");
        assert_eq!(edge.worst_z.1, 1, "{edge}");
    }
}

#[test]
fn the_reference_rule_refuses_what_is_too_noisy_or_broken() {
    let (runs, reference) = picture(1, 0.2, |_, _| 1.0);
    let report = compare(&runs, &reference, &Rule::default());
    assert!(report.problem().is_some_and(|p| p.contains("inconclusive")), "{report}");
    let nan = judge(1, |pixel, _| if pixel == 77 { f64::NAN } else { 1.0 });
    assert!(nan.problem().is_some(), "{nan}");
}

#[test]
fn the_reference_rule_leaves_out_what_the_mask_names() {
    let spot = |pixel: usize| pixel % WIDTH < 4 && pixel / WIDTH < 4;
    let (runs, reference) = picture(1, 0.04, |pixel, _| if spot(pixel) { 1.2 } else { 1.0 });
    let rule = Rule {
        left_out: Some((0..WIDTH * HEIGHT).map(spot).collect()),
        ..Rule::default()
    };
    assert!(compare(&runs, &reference, &Rule::default()).problem().is_some());
    let report = compare(&runs, &reference, &rule);
    report.assert_agrees("all but the spot");
    assert!((report.left_out - 1.0 / 384.0).abs() < 1e-9);
    // A larger variance factor widens z.
    let rule = Rule {
        variance_factor: 1.9,
        ..rule
    };
    assert!(compare(&runs, &reference, &rule).rms_z < report.rms_z);
}

#[test]
fn covering_arrays_cover_every_combination() {
    let anything = |_: &[Option<usize>]| true;
    // The last factor's second level does not go with the first one's third.
    let some = |row: &[Option<usize>]| !(row[0] == Some(2) && row[row.len() - 1] == Some(1));
    let cases: [(&[usize], usize); 5] = [
        (&[3, 4, 2], 1),
        (&[5, 5, 2, 3, 2, 2], 2),
        (&[9, 6, 5, 5, 3, 2, 2, 2, 2], 2),
        (&[4, 3, 3, 2, 2, 2], 3),
        (&[3, 2, 2], 3),
    ];
    for (levels, strength) in cases {
        for (i, allowed) in [&anything as &dyn Fn(&[Option<usize>]) -> bool, &some]
            .into_iter()
            .enumerate()
        {
            let covering = Covering {
                levels,
                strength,
                allowed,
            };
            let rows = covering.rows();
            let name = format!("{levels:?} by {strength}, constraint {i}: {} rows", rows.len());
            println!("{name} where {} is the fewest", covering.fewest());
            assert!(covering.missing(&rows).is_empty(), "{name}");
            for row in &rows {
                assert!(
                    row.iter().zip(levels).all(|(level, count)| level < count),
                    "{name}: {row:?}"
                );
                let row: Vec<_> = row.iter().copied().map(Some).collect();
                assert!(allowed(&row), "{name}: {row:?}");
            }
            // Greedy rows are more than the fewest, but not by much; and not one of them is there for nothing at the end.
            assert!(rows.len() as f64 <= 1.5 * covering.fewest() as f64, "{name}");
            assert!(!covering.missing(&rows[..rows.len() - 1]).is_empty(), "{name}");
            assert_eq!(rows, covering.rows(), "{name}");
        }
    }
}
