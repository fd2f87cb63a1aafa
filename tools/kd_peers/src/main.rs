//! The photon map's k-d tree beside kiddo's immutable one: builds, and k nearest points within a radius and within any.
//!
//! Photons lie on the walls of a box and on a sphere, some of them crowded in caustics. Queries are what the pixels of a picture of
//! the box show, row by row or shuffled. Competitors take turns; figures are the median of the rounds, and the least, in time of
//! the processor, so that what else the machine does matters little; for two threads by the clock on the wall. That both find the same
//! is checked by sums of squared distances.
//!
//! `cargo run --release [-- photons]...`, by default 100000, 1000000 and 10000000; `ROUNDS=n` for other than 5 rounds; `CUBE=1` for
//! points and queries all over a cube instead.

mod photons;

use std::num::NonZero;
use std::time::Instant;

use cpu_time::ProcessTime;
use kiddo::SquaredEuclidean;
use kiddo::immutable::float::kdtree::ImmutableKdTree;
use lucerna::integrator::{KdTree, Nearest};
use lucerna::math::Vec3;

const K: usize = 50;
/// Points within the bounded searches' radius, for the median query.
const WITHIN: usize = 300;
const QUERIES: usize = 10_000;

type Kiddo<const B: usize> = ImmutableKdTree<f32, u32, 3, B>;

/// A way to answer queries: gives the sum of squared distances found.
struct Competitor<'a> {
    name: &'static str,
    run: Box<dyn FnMut(&[Vec3], f32) -> f64 + 'a>,
}

fn main() {
    let counts: Vec<usize> = std::env::args().skip(1).filter_map(|word| word.parse().ok()).collect();
    let counts = if counts.is_empty() {
        vec![100_000, 1_000_000, 10_000_000]
    } else {
        counts
    };
    let rounds = std::env::var("ROUNDS").ok().and_then(|n| n.parse().ok()).unwrap_or(5);
    for count in counts {
        compare(count, rounds);
    }
}

fn compare(count: usize, rounds: usize) {
    let in_cube = std::env::var_os("CUBE").is_some();
    let points = if in_cube {
        photons::in_cube(count, 1)
    } else {
        photons::on_surfaces(count)
    };
    let arrays: Vec<[f32; 3]> = points.iter().map(|p| p.to_array()).collect();
    println!("\n{count} photons, median and least of {rounds} rounds");
    compare_builds(&points, &arrays, rounds);

    let tree = KdTree::build(&points);
    let kiddo_32 = Kiddo::<32>::new_from_slice(&arrays);
    let rendered = if in_cube {
        photons::in_cube(QUERIES, 3)
    } else {
        photons::seen_by_pixels()
    };
    let radius = radius_that_holds(&tree, &rendered, WITHIN);
    let shuffled = photons::shuffled(&rendered);
    // Neighbouring rows in the middle of the picture, and as many queries from everywhere.
    let rows = &rendered[rendered.len() / 2..][..QUERIES.min(rendered.len() / 2)];
    let orders = [("render order", rows), ("random order", &shuffled[..rows.len()])];
    for (order, queries) in orders.into_iter().skip(usize::from(in_cube)) {
        for (bound, radius) in [("within r", radius), ("unbounded", f32::INFINITY)] {
            let mut competitors = [
                lucerna(&tree),
                lucerna_batch(&tree),
                kiddo("kiddo, leaves of 32", &kiddo_32),
            ];
            println!("  {order}, {K} nearest {bound}: ns a query");
            print_times(&mut competitors, queries, radius, rounds);
        }
    }
}

fn print_times(competitors: &mut [Competitor], queries: &[Vec3], radius: f32, rounds: usize) {
    let mut times = vec![Vec::new(); competitors.len()];
    let mut sums = vec![0.0; competitors.len()];
    for _ in 0..rounds {
        for (competitor, (times, sum)) in competitors.iter_mut().zip(times.iter_mut().zip(&mut sums)) {
            let start = ProcessTime::now();
            *sum = (competitor.run)(queries, radius);
            times.push(start.elapsed().as_secs_f64() / queries.len() as f64 * 1e9);
        }
    }
    for (competitor, (times, sum)) in competitors.iter().zip(times.into_iter().zip(&sums)) {
        println!(
            "    {:<24} {:8.0} {:8.0}",
            competitor.name,
            median(times.clone()),
            least(&times)
        );
        assert!(
            (sum / sums[0] - 1.0).abs() < 1e-5,
            "{} finds other points",
            competitor.name
        );
    }
}

fn lucerna(tree: &KdTree) -> Competitor<'_> {
    let mut found = Nearest::new();
    let run = move |queries: &[Vec3], radius: f32| {
        let mut sum = 0.0;
        for p in queries {
            tree.nearest(*p, K, radius, |_| true, &mut found);
            sum += found.distances_squared().iter().map(|d| f64::from(*d)).sum::<f64>();
        }
        sum
    };
    Competitor {
        name: "lucerna",
        run: Box::new(run),
    }
}

fn lucerna_batch(tree: &KdTree) -> Competitor<'_> {
    let mut found = Nearest::new();
    let run = move |queries: &[Vec3], radius: f32| {
        let mut sum = 0.0;
        tree.nearest_batch(
            queries,
            K,
            radius,
            |_, _| true,
            &mut found,
            |_, found| {
                sum += found.distances_squared().iter().map(|d| f64::from(*d)).sum::<f64>();
            },
        );
        sum
    };
    Competitor {
        name: "lucerna, one batch",
        run: Box::new(run),
    }
}

fn kiddo<'a, const B: usize>(name: &'static str, tree: &'a Kiddo<B>) -> Competitor<'a> {
    let k = NonZero::new(K).expect("not 0");
    let run = move |queries: &[Vec3], radius: f32| {
        let mut sum = 0.0;
        for p in queries {
            let found = tree.nearest_n_within::<SquaredEuclidean>(&p.to_array(), radius * radius, k, false);
            sum += found.iter().map(|point| f64::from(point.distance)).sum::<f64>();
        }
        sum
    };
    Competitor {
        name,
        run: Box::new(run),
    }
}

fn compare_builds(points: &[Vec3], arrays: &[[f32; 3]], rounds: usize) {
    let pool = |threads| {
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("a pool of threads")
    };
    let (one, two) = (pool(1), pool(2));
    let mut builds: [(&str, Box<dyn Fn() -> usize>, bool, Vec<f64>); 3] = [
        (
            "lucerna, 1 thread",
            Box::new(|| one.install(|| KdTree::build(points)).len()),
            false,
            Vec::new(),
        ),
        (
            "kiddo, leaves of 32",
            Box::new(|| Kiddo::<32>::new_from_slice(arrays).size()),
            false,
            Vec::new(),
        ),
        (
            "lucerna, 2 threads",
            Box::new(|| two.install(|| KdTree::build(points)).len()),
            true,
            Vec::new(),
        ),
    ];
    for _ in 0..rounds {
        for (_, build, by_the_clock, times) in &mut builds {
            let (start, cpu) = (Instant::now(), ProcessTime::now());
            assert_eq!(build(), points.len());
            let elapsed = if *by_the_clock { start.elapsed() } else { cpu.elapsed() };
            times.push(elapsed.as_secs_f64() * 1e3);
        }
    }
    println!("  build: ms");
    for (name, _, _, times) in builds {
        println!("    {name:<24} {:8.1} {:8.1}", median(times.clone()), least(&times));
    }
}

/// The median over queries of the distance of the `count`-th point.
fn radius_that_holds(tree: &KdTree, queries: &[Vec3], count: usize) -> f32 {
    let mut found = Nearest::new();
    let radii = queries.iter().step_by(101).map(|p| {
        tree.nearest(*p, count, f32::INFINITY, |_| true, &mut found);
        f64::from(found.radius_squared().sqrt())
    });
    median(radii.collect()) as f32
}

fn least(numbers: &[f64]) -> f64 {
    numbers.iter().copied().fold(f64::INFINITY, f64::min)
}

fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers[numbers.len() / 2]
}
