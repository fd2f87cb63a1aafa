//! The oracle against closed forms, for each of its parameters.

use lucerna::accel::Backend;
use lucerna::desc::{Distribution, Termination};
use lucerna::integrator::{Integrator, KajiyaIntegrator};
use lucerna::spectrum::ColorMode;

use crate::common::render::{Built, Judge, parse};
use crate::stage::{build, means, runs};

const ORACLE: KajiyaIntegrator = KajiyaIntegrator {
    max_depth: Some(3),
    termination: Termination::Constant(0.2),
    branching: 1,
    distribution: Distribution::Bsdf,
};

#[test]
fn a_closed_box_has_its_closed_form_for_any_parameters() {
    // Inside a sphere that emits 1 and reflects 1/2, everything has the radiance 1 / (1 - 1/2). The variance is finite while the
    // square of 1/2 is less than 1 - alpha.
    let text = r#"Camera "perspective" "float fov" 90
        Film "rgb" "integer xresolution" 16 "integer yresolution" 16
        PixelFilter "box"
        WorldBegin
        ReverseOrientation
        AreaLightSource "diffuse" "float scale" 1 "rgb L" [1 1 1] "bool twosided" true
        Material "diffuse" "rgb reflectance" [0.5 0.5 0.5]
        Translate 0.2 0.1 0
        Shape "sphere" "float radius" 1"#;
    let terminations = [
        Termination::Constant(0.5),
        Termination::Constant(0.25),
        Termination::Constant(0.65),
        Termination::Albedo,
    ];
    let distributions = [Distribution::Uniform, Distribution::Cosine, Distribution::Bsdf];
    let built = Built::new(parse(text), Backend::default(), ColorMode::Rgb);
    for (i, termination) in terminations.into_iter().enumerate() {
        for (k, distribution) in distributions.into_iter().enumerate() {
            let kajiya = KajiyaIntegrator {
                // Where one in three goes on, two may be sent without end.
                branching: if i == 2 { 1 + k as u32 % 2 } else { 1 },
                termination,
                distribution,
                max_depth: None,
            };
            let runs = runs(&built, Integrator::Kajiya(kajiya), 384, 1);
            let expected = vec![2.0; runs[0].len()];
            let judge = Judge { power: (0.1, 0.02) };
            judge.assert_agrees(&format!("{kajiya:?}"), &runs, &expected);
        }
    }
}

#[test]
fn distributions_and_branches_agree() {
    for (material, light) in [
        ("diffuse transmission", "sky"),
        ("rough metal", "two"),
        ("smooth coat", "two"),
    ] {
        let built = build(material, light);
        let reference = runs(&built, Integrator::Kajiya(ORACLE), 256, 1);
        for (distribution, branching) in [
            (Distribution::Uniform, 1),
            (Distribution::Cosine, 3),
            (Distribution::Bsdf, 4),
        ] {
            let kajiya = KajiyaIntegrator {
                distribution,
                branching,
                termination: Termination::Albedo,
                ..ORACLE
            };
            let spp = 256 / branching;
            let report = means().against_runs(&runs(&built, Integrator::Kajiya(kajiya), spp, 101), &reference);
            let name = format!("{material} under {light}, {kajiya:?}");
            println!("{name}: {report}");
            report.assert_agrees(&name);
            report.assert_power(&name, f64::INFINITY, 0.03);
        }
    }
}
