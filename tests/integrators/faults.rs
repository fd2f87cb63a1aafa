//! Mistakes that renderers are known to make: each is noticed by the comparison with the oracle, which makes none.

use lucerna::desc::{Distribution, Termination};
use lucerna::integrator::{Fault, Integrator, KajiyaIntegrator};

use crate::stage::{build, integrator, means, runs};

#[test]
fn each_mistake_is_noticed() {
    // (mistake, material, light): where it matters.
    let cases = [
        (Fault::MissingCosine, "Oren-Nayar", "distant"),
        (Fault::WrongJacobian, "Oren-Nayar", "area"),
        (Fault::LightTwice, "Oren-Nayar", "sphere"),
        (Fault::EtaForgotten, "glass", "inside"),
        (Fault::EtaForgotten, "rough glass", "inside"),
        (Fault::PdfInWrongMeasure, "Oren-Nayar", "sphere"),
    ];
    for (fault, material, light) in cases {
        let built = build(material, light);
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
        let name = format!("{fault:?}: {material} under {light}");
        let right = means().against_runs(&runs(&built, Integrator::Path(path), 64, 1), &oracle);
        right.assert_agrees(&name);
        path.fault = fault;
        let wrong = means().against_runs(&runs(&built, Integrator::Path(path), 64, 1), &oracle);
        assert!(!wrong.agrees(), "{name} is not noticed: {wrong}");
    }
}
