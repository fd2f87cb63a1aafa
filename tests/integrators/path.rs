//! What the ways of `path` do beside giving the right mean.

use lucerna::desc::Strategy;
use lucerna::integrator::{Integrator, PathIntegrator};

use crate::common::render::Built;
use crate::stage::{build, integrator, runs};

/// The path tracer of a scene, changed.
fn changed(built: &Built, change: impl FnOnce(&mut PathIntegrator)) -> Integrator {
    match integrator(built) {
        Integrator::Path(mut path) => {
            change(&mut path);
            Integrator::Path(path)
        }
        _ => panic!("not a path tracer"),
    }
}

#[test]
fn lights_without_extent_are_not_found_by_directions() {
    let built = build("Oren-Nayar", "point");
    let bsdf = changed(&built, |path| path.strategy = Strategy::Bsdf);
    assert!(runs(&built, bsdf, 4, 1).iter().flatten().all(|&v| v == 0.0));
}

#[test]
fn splitting_lowers_the_noise() {
    let built = build("Oren-Nayar", "area");
    let noise = |integrator| {
        let runs = runs(&built, integrator, 16, 1);
        let variance = |block: usize| {
            let mean = runs.iter().map(|run| run[block]).sum::<f64>() / runs.len() as f64;
            runs.iter().map(|run| (run[block] - mean).powi(2)).sum::<f64>()
        };
        (0..runs[0].len()).map(variance).sum::<f64>()
    };
    let (whole, split) = (
        noise(integrator(&built)),
        noise(changed(&built, |path| path.splitting = 8)),
    );
    assert!(split < 0.7 * whole, "{split} and {whole}");
}
