//! Compiled into the build script only. The table of sigmoid polynomials over sRGB: Jakob and Hanika 2019, section 4.3.
//!
//! Axes: which component is the largest, its value (closer nodes near 0 and 1), and the other two over it. The layout, innermost
//! first: three coefficients, the next component, the one after, the largest, which one that is.

use super::ColorSpace;
use super::rgb2spec::{newton, response, solve_with};
use glam::DVec3;
use std::thread;

/// Nodes along each axis.
const SIZE: usize = 64;
/// The node from which the solutions along the largest component are followed, up and down: neither dark nor bright.
const MIDDLE: usize = 32;

/// All coefficients.
pub fn coefficients() -> Vec<f32> {
    // 5 nm are fine enough: what is lost is less than between the nodes.
    let response = coarse_response(5);
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let slices: Vec<(usize, usize)> = (0..3 * SIZE).map(|i| (i / SIZE, i % SIZE)).collect();
    let mut table = vec![0.0; 3 * SIZE * SIZE * SIZE * 3];
    thread::scope(|scope| {
        let workers: Vec<_> = (0..threads)
            .map(|worker| {
                let (slices, response) = (&slices, &response);
                scope.spawn(move || -> Vec<_> {
                    let own = slices.iter().skip(worker).step_by(threads);
                    own.map(|&slice| (slice, solve_slice(response, slice))).collect()
                })
            })
            .collect();
        for worker in workers {
            for ((largest, y), slice) in worker.join().expect("no colour panics") {
                for (i, solution) in slice.iter().enumerate() {
                    let (z, x) = (i / SIZE, i % SIZE);
                    let at = (((largest * SIZE + z) * SIZE + y) * SIZE + x) * 3;
                    for (entry, c) in table[at..at + 3].iter_mut().zip(solution.to_array()) {
                        *entry = c as f32;
                    }
                }
            }
        }
    });
    table
}

/// The response in steps of `step` nm.
fn coarse_response(step: usize) -> Vec<(f64, DVec3)> {
    let bin = |bin: &[(f64, DVec3)]| {
        let middle = bin.iter().map(|entry| entry.0).sum::<f64>() / bin.len() as f64;
        (middle, bin.iter().map(|entry| entry.1).sum())
    };
    response(ColorSpace::Srgb).chunks(step).map(bin).collect()
}

/// The solutions for one largest component and one value of the component after the next, by z and then x.
fn solve_slice(response: &[(f64, DVec3)], (largest, y): (usize, usize)) -> Vec<DVec3> {
    let mut slice = vec![DVec3::ZERO; SIZE * SIZE];
    for x in 0..SIZE {
        let colour = |z: usize| {
            let brightest = node(z);
            let mut rgb = [0.0; 3];
            rgb[largest] = brightest;
            rgb[(largest + 1) % 3] = brightest * fraction(x);
            rgb[(largest + 2) % 3] = brightest * fraction(y);
            DVec3::from(rgb)
        };
        let first = solve_with(response, colour(MIDDLE));
        slice[MIDDLE * SIZE + x] = first;
        let mut follow = |nodes: &mut dyn Iterator<Item = usize>| {
            let mut last = first;
            for z in nodes {
                let goal = colour(z);
                last = newton(response, goal, last).unwrap_or_else(|| solve_with(response, goal));
                slice[z * SIZE + x] = last;
            }
        };
        follow(&mut (MIDDLE + 1..SIZE));
        follow(&mut (0..MIDDLE).rev());
    }
    slice
}

fn fraction(i: usize) -> f64 {
    i as f64 / (SIZE - 1) as f64
}

/// The value of the largest component at a node. Black has no polynomial: what is nearly so stands for it.
fn node(z: usize) -> f64 {
    let smooth = |t: f64| t * t * (3.0 - 2.0 * t);
    smooth(smooth(fraction(z))).max(1e-8)
}
