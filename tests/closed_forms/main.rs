//! Pictures whose radiance is known in closed form, or as the quadrature of a model written down a second time, on every
//! backend and in both colour modes: two of these four combinations each, all of them in the full tier, which has eight times as many
//! samples. Every comparison also proves that it would notice an error (see `common::render::Judge`).

#[path = "../common/mod.rs"]
mod common;

mod cameras;
mod cutouts;
mod detectors;
mod emission;
mod enclosures;
mod interfaces;
mod irradiance;
mod layers;
mod lights;
mod media;
mod motion;
mod occlusion;
mod shapes;
mod wavelengths;

use common::effort;
use common::render::{Built, Judge, parse, usual_combinations};
use lucerna::spectrum::ColorMode;

/// Renders a scene on each backend and in each colour mode and judges each block of pixels against `expected`, by mode: r, g, b of
/// each block.
#[track_caller]
fn check(name: &str, text: &str, spp: u32, block: [usize; 2], judge: &Judge, expected: impl Fn(ColorMode) -> Vec<f64>) {
    let desc = parse(text);
    for (backend, mode) in usual_combinations(name) {
        let runs = Built::new(desc.clone(), backend, mode).runs(spp * effort(8) as u32, block);
        let name = format!("{name}, {backend}, {mode:?}");
        let report = judge.assert_agrees(&name, &runs, &expected(mode));
        println!("{name}: {report}");
    }
}

/// As [`check`] for a picture of 8 x 8 pixels of one colour.
#[track_caller]
fn check_uniform(name: &str, text: &str, spp: u32, expected: impl Fn(ColorMode) -> [f64; 3]) {
    let four_blocks = |mode| [expected(mode); 4].concat();
    check(name, text, spp, [4, 4], &Judge::USUAL, four_blocks);
}

/// A film of 8 x 8 pixels and a box filter; `integrator` is the path tracer's maximal depth.
fn options(max_depth: i32) -> String {
    format!(
        "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nPixelFilter \"box\"\nSampler \"sobol\"\n\
         Integrator \"path\" \"integer maxdepth\" {max_depth}\n"
    )
}

/// A parallelogram from `corner` along two edges; its normal is the cross product of these, its texture coordinates run along
/// them.
fn quad(corner: [f64; 3], a: [f64; 3], b: [f64; 3]) -> String {
    let point = |s: f64, t: f64| {
        let at = |i: usize| corner[i] + s * a[i] + t * b[i];
        format!("{} {} {}", at(0), at(1), at(2))
    };
    format!(
        "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point2 uv\" [0 0 1 0 1 1 0 1] \"point3 P\" [{}  {}  {}  {}]\n",
        point(0.0, 0.0),
        point(1.0, 0.0),
        point(1.0, 1.0),
        point(0.0, 1.0)
    )
}

/// The mean of `f` over a rectangle, by the midpoint rule.
fn mean_over([x0, x1]: [f64; 2], [y0, y1]: [f64; 2], f: impl Fn(f64, f64) -> f64) -> f64 {
    const STEPS: usize = 64;
    let at = |a: f64, b: f64, i: usize| a + (b - a) * (i as f64 + 0.5) / STEPS as f64;
    let points = (0..STEPS * STEPS).map(|i| f(at(x0, x1, i % STEPS), at(y0, y1, i / STEPS)));
    points.sum::<f64>() / (STEPS * STEPS) as f64
}

/// The mean of `f` over an interval, by the midpoint rule, in steps that find an edge.
fn mean_along([x0, x1]: [f64; 2], f: impl Fn(f64) -> f64) -> f64 {
    const STEPS: usize = 1 << 14;
    let points = (0..STEPS).map(|i| f(x0 + (x1 - x0) * (i as f64 + 0.5) / STEPS as f64));
    points.sum::<f64>() / STEPS as f64
}

/// Three equal channels for each value.
fn grey(values: impl IntoIterator<Item = f64>) -> Vec<f64> {
    values.into_iter().flat_map(|v| [v; 3]).collect()
}
