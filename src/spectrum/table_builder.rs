//! The table of sigmoid polynomials over the colours of a space: Jakob and Hanika 2019, section 4.3. That of sRGB is made by the build
//! script, those of wider spaces when an image is in one.
//!
//! Axes: which component is the largest, its value (closer nodes near 0 and 1), and the other two over it. The layout, innermost
//! first: three coefficients, the next component, the one after, the largest, which one that is.

use super::ColorSpace;
use super::rgb2spec::{approach, follow, response};
use glam::DVec3;
use std::thread;

/// Finds the polynomial of a colour from that of one nearby.
type Search = fn(response: &[(f64, DVec3)], goal: DVec3, near: DVec3) -> DVec3;

/// All coefficients, for `SIZE` nodes along each axis, in a space all of whose colours reflectances have.
pub fn exact<const SIZE: usize>(space: ColorSpace) -> Vec<f32> {
    coefficients::<SIZE>(space, follow)
}

/// All coefficients in any space; what no reflectance has is approached.
pub fn approximate<const SIZE: usize>(space: ColorSpace) -> Vec<f32> {
    coefficients::<SIZE>(space, approach)
}

fn coefficients<const SIZE: usize>(space: ColorSpace, search: Search) -> Vec<f32> {
    // 5 nm are fine enough: what is lost is less than between the nodes.
    let response = coarse_response(space, 5);
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let slices: Vec<(usize, usize)> = (0..3 * SIZE).map(|i| (i / SIZE, i % SIZE)).collect();
    let mut table = vec![0.0; 3 * SIZE * SIZE * SIZE * 3];
    thread::scope(|scope| {
        let workers: Vec<_> = (0..threads)
            .map(|worker| {
                let (slices, response) = (&slices, &response);
                scope.spawn(move || -> Vec<_> {
                    let own = slices.iter().skip(worker).step_by(threads);
                    own.map(|&slice| (slice, solve_slice::<SIZE>(response, slice, search)))
                        .collect()
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
fn coarse_response(space: ColorSpace, step: usize) -> Vec<(f64, DVec3)> {
    let bin = |bin: &[(f64, DVec3)]| {
        let middle = bin.iter().map(|entry| entry.0).sum::<f64>() / bin.len() as f64;
        (middle, bin.iter().map(|entry| entry.1).sum())
    };
    response(space).chunks(step).map(bin).collect()
}

/// The solutions for one largest component and one value of the component after the next, by z and then x.
fn solve_slice<const SIZE: usize>(
    response: &[(f64, DVec3)],
    (largest, y): (usize, usize),
    search: Search,
) -> Vec<DVec3> {
    // Solutions are followed from the least saturated colour of the slice on, at a node of the largest component that is neither dark
    // nor bright, and from there up and down.
    let middle = SIZE / 2;
    let fraction = |i: usize| i as f64 / (SIZE - 1) as f64;
    let mut slice = vec![DVec3::ZERO; SIZE * SIZE];
    let mut first = DVec3::ZERO;
    for x in (0..SIZE).rev() {
        let colour = |z: usize| {
            let brightest = node(fraction(z));
            let mut rgb = [0.0; 3];
            rgb[largest] = brightest;
            rgb[(largest + 1) % 3] = brightest * fraction(x);
            rgb[(largest + 2) % 3] = brightest * fraction(y);
            DVec3::from(rgb)
        };
        first = search(response, colour(middle), first);
        slice[middle * SIZE + x] = first;
        let mut follow = |nodes: &mut dyn Iterator<Item = usize>| {
            let mut last = first;
            for z in nodes {
                last = search(response, colour(z), last);
                slice[z * SIZE + x] = last;
            }
        };
        follow(&mut (middle + 1..SIZE));
        follow(&mut (0..middle).rev());
    }
    slice
}

/// The value of the largest component at a node, by its place from 0 to 1. Black has no polynomial: what is nearly so stands for it.
fn node(place: f64) -> f64 {
    let smooth = |t: f64| t * t * (3.0 - 2.0 * t);
    smooth(smooth(place)).max(1e-8)
}
