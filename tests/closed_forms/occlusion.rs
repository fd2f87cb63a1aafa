//! Ambient occlusion: what of the sky a floor sees beside a wall.

use super::common::render::Judge;
use super::{check, grey, quad};

/// A floor from x = 0 on, seen from above, x to the right as far as 2; a wall of height 1, long in z, at x = 0; nothing emits.
fn corner(integrator: &str) -> String {
    format!(
        "LookAt 1 3 0  1 0 0  0 0 1
        Camera \"orthographic\" \"float screenwindow\" [-1 1 -1 1]
        Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8 PixelFilter \"box\" Sampler \"sobol\"
        Integrator \"ambientocclusion\" {integrator} WorldBegin Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n{}{}",
        quad([0.0, 0.0, -1e4], [0.0, 0.0, 2e4], [10.0, 0.0, 0.0]),
        quad([0.0, 0.0, -1e4], [0.0, 1.0, 0.0], [0.0, 0.0, 2e4])
    )
}

/// Blocks are columns of pixels.
const COLUMNS: Judge = Judge { power: (0.03, 0.005) };

/// From the distance x, a wall of height h that has no ends takes half of 1 - x / sqrt(x² + h²).
#[test]
fn a_floor_beside_a_wall_sees_its_share_of_the_sky() {
    let mean = |a: f64, b: f64| 0.5 + 0.5 * ((b * b + 1.0).sqrt() - (a * a + 1.0).sqrt()) / (b - a);
    let expected = grey((0..8).map(|i| mean(0.25 * f64::from(i), 0.25 * f64::from(i + 1))));
    for sampling in [
        "\"bool cossample\" true",
        "\"bool cossample\" false \"float maxdistance\" 1e6",
    ] {
        check(sampling, &corner(sampling), 1024, [1, 8], &COLUMNS, |_| {
            expected.clone()
        });
    }
    // What is farther away than 0.1 does not count. From x the wall is nearer in the part of the disk under the hemisphere that is beyond
    // x / 0.1: (acos c - c sqrt(1 - c²)) / pi, on average over c in [0, 1] two thirds of one over pi.
    let near = corner("\"float maxdistance\" 0.1");
    let first = 1.0 - 2.0 / (3.0 * std::f64::consts::PI) * 0.1 / 0.25;
    let all = grey((0..8).map(|i| if i == 0 { first } else { 1.0 }));
    check("near", &near, 256, [1, 8], &COLUMNS, |_| all.clone());
}
