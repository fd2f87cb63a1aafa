//! How evenly the points of each sampler lie: in a pixel, and of blue noise over pixels.

use std::f64::consts::TAU;

use lucerna::sampling::{SampleStream, Sampler, SamplerKind, Strata};

/// A number as an integer of 24 bits, which it is exactly.
fn bits(u: f32) -> u32 {
    (u * 16_777_216.0) as u32
}

/// The points of a group of one pixel, as integers of 24 bits.
fn net_points(kind: SamplerKind, pixel: i32, group: u32, indices: std::ops::Range<u32>) -> Vec<[u32; 4]> {
    let sampler = Sampler::new(kind, 11, 1 << 20);
    indices
        .map(|i| sampler.start(pixel, 1, i).draw4(group).map(bits))
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
    let places = [(0, 0), (5, 1), (-8, 17)];
    for kind in [SamplerKind::Sobol, SamplerKind::ZSobol] {
        for (k, (pixel, group)) in (0..=10).flat_map(|k| places.map(|place| (k, place))) {
            let n = 1 << k;
            // The first 2^k samples, and the next 2^k.
            for indices in [0..n, n..2 * n] {
                assert_net(&net_points(kind, pixel, group, indices), k, &format!("{kind:?}"));
            }
        }
    }
}

/// Asserts that 2^k points have one in each elementary interval of the first pair, and in each slice of the other dimensions.
#[track_caller]
fn assert_net(points: &[[u32; 4]], k: u32, name: &str) {
    for a in 0..=k {
        let even = is_even(points, [a, k - a, 0, 0]);
        assert!(even, "{name}: first pair, 2^{k} points, {a} digits");
    }
    for d in 2..4 {
        let mut splits = [0; 4];
        splits[d] = k;
        assert!(is_even(points, splits), "{name}: dimension {d}, 2^{k} points");
    }
}

#[test]
fn sobol_groups_are_nets_in_four_dimensions() {
    // The degrees of the four polynomials, less one, sum to t = 3 (Sobol 1967): every elementary interval of volume 2^(3-m)
    // holds 8 of 2^m points.
    let m = 9;
    for kind in [SamplerKind::Sobol, SamplerKind::ZSobol] {
        assert_net_of_four(&net_points(kind, 3, 2, 0..1 << m), m);
    }
}

fn assert_net_of_four(points: &[[u32; 4]], m: u32) {
    for a in 0..=m - 3 {
        for b in 0..=m - 3 - a {
            for c in 0..=m - 3 - a - b {
                let splits = [a, b, c, m - 3 - a - b - c];
                assert!(is_even(points, splits), "{splits:?}");
            }
        }
    }
}

#[test]
fn z_sobol_blocks_of_pixels_are_nets() {
    // Blocks of 2^l x 2^l pixels at multiples of their size, with 2^k samples in each pixel; in any tile.
    for (k, l) in [(0, 1), (0, 3), (2, 2), (3, 2), (0, 5)] {
        let sampler = Sampler::new(SamplerKind::ZSobol, 3, 1 << k);
        let side = 1 << l;
        for (corner, group) in [([0, 0], 0), ([3, 5], 1), ([-1, 40], 8)] {
            let [x0, y0] = corner.map(|block| block * side);
            let pixels = (0..side * side).map(|i| (x0 + i % side, y0 + i / side));
            let points: Vec<_> = pixels
                .flat_map(|(x, y)| (0..1 << k).map(move |i| (x, y, i)))
                .map(|(x, y, i)| sampler.start(x, y, i).draw4(group).map(bits))
                .collect();
            assert_net(&points, k + 2 * l as u32, &format!("block {corner:?} of {side}"));
        }
    }
}

/// Asserts that each of `count` slices of [0, 1) has one of the numbers.
#[track_caller]
fn assert_one_in_each(numbers: impl Iterator<Item = f64>, count: u32, name: &str) {
    let mut seen = vec![0; count as usize];
    for u in numbers {
        seen[(u * f64::from(count)) as usize] += 1;
    }
    assert!(seen.iter().all(|&n| n == 1), "{name}: {seen:?}");
}

fn all_of(sampler: Sampler) -> impl Iterator<Item = SampleStream> + Clone {
    (0..sampler.samples_per_pixel()).map(move |i| sampler.start(4, -7, i))
}

#[test]
fn strata_have_one_point_each() {
    // Numbers are rounded down to 24 bits: of many thousand, one would slip over a bound that is no such number.
    for (columns, rows) in [(4, 4), (8, 8), (4, 3), (7, 1), (1, 5), (1, 1), (12, 10)] {
        let jitter = true;
        let kind = SamplerKind::Stratified(Strata { columns, rows, jitter });
        let streams = all_of(Sampler::new(kind, 9, columns * rows));
        for (group, first) in [(0, 0), (0, 2), (13, 0), (13, 2)] {
            let pair = |stream: SampleStream| [0, 1].map(|d| f64::from(stream.draw4(group)[first + d]));
            let name = format!("{columns} x {rows}, group {group}, dimension {first}");
            let cells = streams.clone().map(pair).map(|[x, y]| {
                let cell = (x * f64::from(columns)) as u32 + columns * (y * f64::from(rows)) as u32;
                (f64::from(cell) + 0.5) / f64::from(columns * rows)
            });
            assert_one_in_each(cells, columns * rows, &name);
            for d in 0..2 {
                assert_one_in_each(streams.clone().map(|s| pair(s)[d]), columns * rows, &name);
            }
        }
    }
}

#[test]
fn strata_without_jitter_take_the_middles() {
    let (columns, rows, jitter) = (4, 8, false);
    let kind = SamplerKind::Stratified(Strata { columns, rows, jitter });
    for stream in all_of(Sampler::new(kind, 1, 32)) {
        for u in stream.draw4(6) {
            assert_eq!((u * 32.0).fract(), 0.5);
        }
    }
}

#[test]
fn strata_follow_the_number_of_samples() {
    let sampler = Sampler::new(SamplerKind::Stratified(Strata::default()), 1, 24);
    let expected = Strata {
        columns: 6,
        rows: 4,
        jitter: true,
    };
    assert_eq!(sampler.kind(), SamplerKind::Stratified(expected));
}

#[test]
fn halton_points_are_even_in_their_bases() {
    for samples in [36, 216, 1 << 20] {
        let sampler = Sampler::new(SamplerKind::Halton, 5, samples);
        // Any 2^a 3^b consecutive points: one in each box of 2^-a by 3^-b.
        for first in [0, 36 % samples] {
            let streams = (0..36).filter(|i| first + i < samples);
            let streams: Vec<_> = streams.map(|i| sampler.start(2, 3, first + i)).collect();
            if streams.len() < 36 {
                continue;
            }
            for (a, b) in [(2, 2), (0, 2), (2, 0)] {
                let (columns, rows) = (1 << a, 3_u32.pow(b));
                let mut seen = vec![0; (columns * rows) as usize];
                for stream in &streams {
                    let [x, y] = stream.draw2(0);
                    seen[((x * columns as f32) as u32 * rows + (y * rows as f32) as u32) as usize] += 1;
                }
                assert!(seen.iter().all(|&n| n == 36 / (columns * rows)), "{seen:?}");
            }
        }
    }
    // Each dimension by itself: as many points as its base, one in each slice; also where the primes begin again.
    for (group, primes) in [
        (0, [2, 3, 5, 7]),
        (1, [11, 13, 17, 19]),
        (63, [1607, 1609, 1613, 1619]),
        (64, [2, 3, 5, 7]),
    ] {
        for (d, prime) in primes.into_iter().enumerate() {
            let sampler = Sampler::new(SamplerKind::Halton, 5, 1 << 24);
            let numbers = (0..prime).map(|i| f64::from(sampler.start(2, 3, i).draw4(group)[d]));
            assert_one_in_each(numbers, prime, &format!("group {group}, prime {prime}"));
        }
    }
}

/// Pixels along the side of the error images.
const SIDE: usize = 32;

/// The mean power of an error image at low frequencies (up to an eighth of the highest) and at high ones (from five eighths on),
/// per pixel: white noise has its variance at all of them. The mean is over 32 seeds and two smooth integrands.
fn low_and_high_power(kind: SamplerKind, samples: u32, group: u32) -> [f64; 2] {
    let (mut low, mut high) = ([0.0; 2], [0.0; 2]);
    let waves: Vec<_> = (0..SIDE).map(|i| (TAU * i as f64 / SIDE as f64).sin_cos()).collect();
    let integrands: [fn([f32; 4]) -> f64; 2] = [
        |[x, y, _, _]| f64::from(x + y).sin(),
        |[_, _, z, w]| (f64::from(z) - 0.3).powi(2) + f64::from(w),
    ];
    for seed in 0..32 {
        let sampler = Sampler::new(kind, seed, samples);
        for f in integrands {
            let pixel = |x: usize, y: usize| {
                let numbers = (0..samples).map(|i| sampler.start(x as i32, y as i32, i).draw4(group));
                numbers.map(f).sum::<f64>() / f64::from(samples)
            };
            let image: Vec<f64> = (0..SIDE * SIDE).map(|i| pixel(i % SIDE, i / SIDE)).collect();
            for (u, v) in (0..SIDE * SIDE).map(|i| (i % SIDE, i / SIDE)).skip(1) {
                let centred = |k: usize| if k > SIDE / 2 { SIDE as f64 - k as f64 } else { k as f64 };
                let radius = centred(u).hypot(centred(v)) / (SIDE / 2) as f64;
                let ring = if radius <= 0.125 {
                    &mut low
                } else if radius >= 0.625 {
                    &mut high
                } else {
                    continue;
                };
                ring[0] += power(&image, &waves, u, v);
                ring[1] += 1.0;
            }
        }
    }
    [low, high].map(|[sum, count]| sum / count)
}

/// The power of an image at (u, v) cycles per image, over its number of pixels; `waves` are sine and cosine over a turn.
fn power(image: &[f64], waves: &[(f64, f64)], u: usize, v: usize) -> f64 {
    let (mut re, mut im) = (0.0, 0.0);
    for (i, value) in image.iter().enumerate() {
        let (sin, cos) = waves[(u * (i % SIDE) + v * (i / SIDE)) % SIDE];
        re += value * cos;
        im -= value * sin;
    }
    (re * re + im * im) / image.len() as f64
}

#[test]
fn z_sobol_errors_are_blue() {
    for (samples, group) in [(1, 0), (4, 3)] {
        let [low, high] = low_and_high_power(SamplerKind::ZSobol, samples, group);
        let [white_low, white_high] = low_and_high_power(SamplerKind::Sobol, samples, group);
        println!("{samples}: zsobol {low:e} {high:e}, sobol {white_low:e} {white_high:e}");
        // Independent pixels: white. 32 x 2 x 12 terms, each exponentially distributed, know the low power to 4 %.
        assert!((white_low / white_high - 1.0).abs() < 0.2);
        assert!(low < 0.1 * high && low < 0.1 * white_low);
        // Over all frequencies the errors are no greater.
        assert!(high < 1.6 * white_high);
    }
}
