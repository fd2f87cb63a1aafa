//! Photon mapping, in two passes and progressive: the flux of photons, the terms that paths are sorted into, bias against radius, light
//! that only photons find, and all that `path` can do as well. Scenes are such that density estimation is exact where they are looked
//! at, or its bias is worked out, or it is below the stated slack.

#[path = "../common/mod.rs"]
mod common;
#[expect(dead_code, reason = "photons meet lights without extent as well")]
#[path = "../integrators/lamps.rs"]
mod lamps;

mod convergence;
mod dispersion;
mod flux;
mod identity;
mod leaks;
mod lights;
mod motion;
mod slabs;
mod surfaces;
mod terms;

use common::effort;
use common::means::{FEWEST_RUNS, Means};
use common::render::{Built, blocks};
use lucerna::accel::Backend;
use lucerna::desc::{PhotonDesc, SppmDesc};
use lucerna::integrator::{Integrator, Limits, PhotonIntegrator, SppmIntegrator};
use lucerna::scene::ViewOverrides;
use lucerna::spectrum::ColorMode;

/// The two-pass renderer, with its parameters changed.
fn photon(max_depth: Option<u32>, change: impl FnOnce(&mut PhotonDesc)) -> Integrator {
    let mut parameters = PhotonDesc::default();
    change(&mut parameters);
    Integrator::Photon(PhotonIntegrator {
        max_depth,
        parameters,
        shown: None,
    })
}

/// The progressive renderer with so many photons a pass and this first radius.
fn sppm(max_depth: Option<u32>, photons: u32, radius: f32) -> Integrator {
    let parameters = SppmDesc {
        photons: Some(photons),
        radius: Some(radius),
        ..SppmDesc::default()
    };
    Integrator::Sppm(SppmIntegrator {
        max_depth,
        parameters,
        limits: Limits::default(),
    })
}

/// A scene on the first backend.
#[track_caller]
fn build(text: &str, color: ColorMode) -> Built {
    Built::new(common::render::parse(text), Backend::default(), color)
}

/// 16 renders of the first view with seeds from `first_seed` on: the means of blocks of pixels. The full tier has eight times as
/// many samples.
#[track_caller]
fn runs(built: &Built, integrator: Integrator, spp: u32, first_seed: u64, block: [usize; 2]) -> Vec<Vec<f64>> {
    let run = |seed| {
        let overrides = ViewOverrides {
            seed,
            spp: Some(spp * effort(8) as u32),
            ..ViewOverrides::default()
        };
        let view = built.view(0, &overrides);
        let (picture, stats) = built.picture_with(&view, integrator);
        assert_eq!(stats.dropped_samples, 0, "dropped: {:?}", stats.dropped);
        blocks(&picture, view.resolution[0] as usize, block)
    };
    (first_seed..first_seed + FEWEST_RUNS as u64).map(run).collect()
}

/// How runs are compared: an agreement fails by chance once in ten thousand, and what is off by less than `slack` agrees.
fn means(slack: f64) -> Means {
    Means {
        significance: 1e-4,
        slack,
    }
}

/// Holds runs against others, block by block and together, and asserts that an error of `power` in the whole is noticed.
#[track_caller]
fn assert_agree(name: &str, ours: &[Vec<f64>], reference: &[Vec<f64>], slack: f64, power: f64) {
    let report = means(slack).against_runs(ours, reference);
    println!("{name}: {report}");
    report.assert_agrees(name);
    report.assert_power(name, f64::INFINITY, power);
}

/// Holds runs against what is known exactly.
#[track_caller]
fn assert_exact(name: &str, ours: &[Vec<f64>], expected: &[f64], slack: f64, power: f64) {
    let report = means(slack).against_exact(ours, expected);
    println!("{name}: {report}");
    report.assert_agrees(name);
    report.assert_power(name, f64::INFINITY, power);
}

/// A parallelogram from `corner` along two edges; its normal is the cross product of these.
fn quad(corner: [f64; 3], a: [f64; 3], b: [f64; 3]) -> String {
    let point = |s: f64, t: f64| {
        let at = |i: usize| corner[i] + s * a[i] + t * b[i];
        format!("{} {} {}", at(0), at(1), at(2))
    };
    let [p, q, r, s] = [point(0.0, 0.0), point(1.0, 0.0), point(1.0, 1.0), point(0.0, 1.0)];
    format!("Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [{p}  {q}  {r}  {s}]\n")
}

/// A film with a box filter.
fn film([width, height]: [usize; 2]) -> String {
    format!(
        "Film \"rgb\" \"integer xresolution\" {width} \"integer yresolution\" {height}\nPixelFilter \"box\"\n\
         Sampler \"sobol\"\nIntegrator \"path\"\n"
    )
}
