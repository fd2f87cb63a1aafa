//! Mistakes that renderers are known to make: each is noticed by the comparison with the oracle, which makes none.

use lucerna::accel::Backend;
use lucerna::desc::{Distribution, Termination};
use lucerna::integrator::{Fault, Integrator, KajiyaIntegrator};
use lucerna::spectrum::ColorMode;

use crate::stage::{LIGHTS, MATERIALS, build, integrator, means, runs};

#[test]
fn each_mistake_is_noticed() {
    // (mistake, material, light): where it matters.
    let cases = [
        (Fault::MissingCosine, 0, 5),
        (Fault::WrongJacobian, 0, 0),
        (Fault::LightTwice, 0, 1),
        (Fault::EtaForgotten, 6, 7),
        (Fault::EtaForgotten, 7, 7),
        (Fault::PdfInWrongMeasure, 0, 1),
    ];
    for (fault, material, light) in cases {
        let built = build(
            MATERIALS[material].1,
            LIGHTS[light].1,
            Backend::default(),
            ColorMode::Rgb,
        );
        let oracle = KajiyaIntegrator {
            max_depth: Some(1),
            termination: Termination::Constant(0.2),
            branching: 1,
            distribution: Distribution::Bsdf,
        };
        let oracle = runs(&built, Integrator::Kajiya(oracle), 512, 101);
        let Integrator::Path(mut path) = integrator(&built).with_max_depth(Some(1)) else {
            panic!("not a path tracer");
        };
        let name = format!("{fault:?}: {} under {}", MATERIALS[material].0, LIGHTS[light].0);
        let right = means().against_runs(&runs(&built, Integrator::Path(path), 64, 1), &oracle);
        right.assert_agrees(&name);
        path.fault = fault;
        let wrong = means().against_runs(&runs(&built, Integrator::Path(path), 64, 1), &oracle);
        assert!(!wrong.agrees(), "{name} is not noticed: {wrong}");
    }
}
