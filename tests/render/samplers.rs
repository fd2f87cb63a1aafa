//! How points and lights are chosen does not change what is expected.

use lucerna::accel::Backend;
use lucerna::sampling::SamplerKind;
use lucerna::scene::ViewOverrides;

use crate::common::means::{Estimate, FEWEST_RUNS, Means};
use crate::common::render::{Built, MODES, blocks, parse};
use crate::everything;

/// 16 pictures of 32 x 24 pixels in blocks of 8 x 8.
fn runs(built: &Built, sampler: SamplerKind, spp: u32, first_seed: u64) -> Vec<Vec<f64>> {
    let run = |seed| {
        let overrides = ViewOverrides {
            seed,
            spp: Some(spp),
            sampler: Some(sampler),
            resolution: Some([32, 24]),
            ..ViewOverrides::default()
        };
        blocks(&built.picture(&built.view(0, &overrides)), 32, [8, 8])
    };
    (first_seed..first_seed + FEWEST_RUNS as u64).map(run).collect()
}

#[test]
fn samplers_agree_in_the_mean() {
    let desc = parse(&everything("PixelFilter \"gaussian\""));
    for color in MODES {
        let built = Built::new(desc.clone(), Backend::default(), color);
        let sobol = runs(&built, SamplerKind::Sobol, 64, 1);
        let independent = runs(&built, SamplerKind::Independent, 64, 101);
        let report = Means::default().against_runs(&sobol, &independent);
        report.assert_agrees(&format!("{color:?}"));
        report.assert_power(&format!("{color:?}"), 0.3, 0.01);
        // Darker by 1 %: noticed.
        let darker: Vec<Vec<f64>> = sobol.iter().map(|run| run.iter().map(|v| 0.99 * v).collect()).collect();
        assert!(!Means::default().against_runs(&darker, &independent).agrees());
        // Even points are less noisy: that is what they are for.
        let noise = |runs: &[Vec<f64>]| -> f64 {
            let block = |i: usize| Estimate::of(runs.iter().map(|run| run[i])).variance;
            (0..runs[0].len()).map(block).sum()
        };
        let (even, random) = (noise(&sobol), noise(&independent));
        println!("{color:?}: {even:.2e} and {random:.2e}");
        assert!(even < 0.6 * random, "{color:?}: {even} and {random}");
    }
}

/// A room with lamps of every kind, large and small, many and few; a wall of glass and one of metal, so that both strategies of
/// multiple importance sampling matter.
fn many_lamps(sampler: &str) -> String {
    let mut lamps = String::new();
    for i in 0..60 {
        let (x, y) = (f64::from(i % 10) * 0.6 - 2.7, f64::from(i / 10) * 0.6 - 1.5);
        let l = 1.0 + f64::from(i * 7 % 11);
        let z = 0.6 + 0.9 * f64::from(i % 3);
        lamps += &format!(
            "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [{l} {l} {}] \"bool twosided\" {} Translate {x} {y} {z} \
             Rotate {} 1 0.3 0 Shape \"trianglemesh\" \"point3 P\" [0 0 0  0.12 0 0  0 0.12 0] AttributeEnd\n",
            0.5 * l,
            i % 4 == 0,
            37 * i,
        );
    }
    format!(
        "LookAt 0 -5 1.5  0 0 1  0 0 1
        Camera \"perspective\" \"float fov\" 60
        Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 32
        PixelFilter \"box\"
        Integrator \"path\" \"integer maxdepth\" 3 \"string lightsampler\" \"{sampler}\"
        WorldBegin
        LightSource \"infinite\" \"rgb L\" [0.02 0.02 0.03]
        LightSource \"distant\" \"point3 from\" [1 -2 3] \"rgb L\" [0.1 0.1 0.1]
        LightSource \"point\" \"point3 from\" [-2 -1 1] \"rgb I\" [0.2 0.3 0.2]
        LightSource \"spot\" \"point3 from\" [2 -2 3] \"point3 to\" [0 0 0] \"float conedeltaangle\" 0 \"rgb I\" [2 1 1]
        {lamps}
        AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [3 2 2] Translate -1 1 0.5 Shape \"sphere\" \"float radius\" 0.2
        AttributeEnd
        Material \"diffuse\" \"rgb reflectance\" [0.6 0.5 0.4]
        Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [-4 -4 0  4 -4 0  4 4 0  -4 4 0]
        Material \"conductor\" \"float roughness\" 0.3
        Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [-4 3 0  4 3 0  4 3 4  -4 3 4]
        Material \"dielectric\" \"float roughness\" 0.3
        Translate 1 -1 0.7 Shape \"sphere\" \"float radius\" 0.5"
    )
}

/// How a light is chosen does not change the expectation: the hierarchy against all alike, and against power.
#[test]
fn light_samplers_give_the_same_picture() {
    let runs = |sampler: &str, mode| {
        let built = Built::new(parse(&many_lamps(sampler)), Backend::default(), mode);
        built.runs(256, [8, 8])
    };
    for mode in MODES {
        let by_tree = runs("bvh", mode);
        for other in ["uniform", "power"] {
            let report = Means::default().against_runs(&by_tree, &runs(other, mode));
            report.assert_agrees(&format!("bvh and {other}, {mode:?}"));
            report.assert_power(other, 0.15, 0.01);
        }
    }
}
