//! The ways of `path` against one another.

use lucerna::accel::Backend;
use lucerna::desc::{Heuristic, Strategy};
use lucerna::integrator::{Integrator, PathIntegrator};
use lucerna::spectrum::ColorMode;

use crate::common::render::Built;
use crate::stage::{LIGHTS, MATERIALS, build, integrator, means, runs};

/// The path tracer of a scene, changed.
fn changed(built: &Built, change: impl FnOnce(&mut PathIntegrator)) -> Integrator {
    match integrator(built) {
        Integrator::Path(mut path) => {
            change(&mut path);
            Integrator::Path(path)
        }
        Integrator::Kajiya(_) => panic!("not a path tracer"),
    }
}

#[test]
fn each_strategy_alone_is_right_where_it_finds_all_light() {
    for (material, light) in [(0, 0), (4, 1), (7, 2), (1, 1), (2, 0)] {
        let built = build(
            MATERIALS[material].1,
            LIGHTS[light].1,
            Backend::default(),
            ColorMode::Rgb,
        );
        let reference = runs(&built, integrator(&built), 64, 1);
        let ways: [(&str, Integrator); 5] = [
            ("bsdf", changed(&built, |path| path.strategy = Strategy::Bsdf)),
            ("light", changed(&built, |path| path.strategy = Strategy::Light)),
            ("balance", changed(&built, |path| path.heuristic = Heuristic::Balance)),
            ("split", changed(&built, |path| path.splitting = 4)),
            (
                "split, bsdf",
                changed(&built, |path| {
                    path.strategy = Strategy::Bsdf;
                    path.splitting = 3;
                }),
            ),
        ];
        for (way, integrator) in ways {
            let spp = if way.contains("bsdf") { 256 } else { 64 };
            let report = means().against_runs(&runs(&built, integrator, spp, 101), &reference);
            let name = format!("{} under {}, {way}", MATERIALS[material].0, LIGHTS[light].0);
            println!("{name}: {report}");
            report.assert_agrees(&name);
            report.assert_power(&name, f64::INFINITY, 0.02);
        }
    }
}

#[test]
fn lights_without_extent_are_not_found_by_directions() {
    let built = build(MATERIALS[0].1, LIGHTS[3].1, Backend::default(), ColorMode::Rgb);
    let bsdf = changed(&built, |path| path.strategy = Strategy::Bsdf);
    assert!(runs(&built, bsdf, 4, 1).iter().flatten().all(|&v| v == 0.0));
}

#[test]
fn splitting_lowers_the_noise() {
    let built = build(MATERIALS[0].1, LIGHTS[0].1, Backend::default(), ColorMode::Rgb);
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
