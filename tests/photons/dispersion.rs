//! A caustic of many colours: a wedge of glass bends a distant light by its wavelength, onto a sheet that is seen from below.

use lucerna::desc::{Term, Terms};
use lucerna::spectrum::{ColorMode, Spectrum, SpectrumRole};

use crate::common::full_tier;
use crate::common::render::expected_rgb;
use crate::slabs::{Glass, through};
use crate::{assert_exact, build, film, photon, quad, runs};

/// Inclination of the lower side of the wedge, whose height is BOTTOM on the axis.
const DEGREES: f64 = 20.0;
const BOTTOM: f64 = 0.8;
/// Where the wedge begins, and the half width of what is seen.
const EDGE: f64 = 0.15;
const WINDOW: f64 = 0.1;
const RADIUS: f64 = 0.02;

/// By how much a ray that leaves at x = EDGE lands to the left, the share that passes, and how much denser light is than it was.
fn bent(n: f64) -> (f64, f64, f64) {
    let (sin, cos) = DEGREES.to_radians().sin_cos();
    let out = (n * sin).asin();
    let tan = (out - DEGREES.to_radians()).tan();
    let passed = through(n, 1.0) * through(n, out.cos());
    let slope = sin / cos;
    ((BOTTOM + slope * EDGE) * tan, passed, 1.0 / (1.0 - slope * tan))
}

fn scene(glass: &Glass) -> String {
    let slope = DEGREES.to_radians().tan();
    let (size, low) = (0.5, BOTTOM + slope * EDGE);
    let top = quad([EDGE, -0.5, 1.1], [size, 0.0, 0.0], [0.0, 1.0, 0.0]);
    let bottom = quad([EDGE, -0.5, low], [0.0, 1.0, 0.0], [size, 0.0, size * slope]);
    format!(
        "LookAt 0 0 -1  0 0 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [-{WINDOW} {WINDOW} -{WINDOW} {WINDOW}]\n{}WorldBegin\n\
         LightSource \"distant\" \"point3 from\" [0 0 1] \"point3 to\" [0 0 0] \"rgb L\" [2 2 2]\n\
         AttributeBegin Material \"dielectric\" {}\n{top}{bottom}AttributeEnd\n\
         Material \"diffusetransmission\" \"rgb reflectance\" [0 0 0] \"rgb transmittance\" [1 1 1]\n{}",
        film([8, 8]),
        glass.text,
        quad([-0.2, -0.2, 0.0], [0.4, 0.0, 0.0], [0.0, 0.4, 0.0]),
    )
}

/// The part of a column that lies to the right of an edge, blurred by circles: the share of the cone filter to the right of it.
fn lit(from: f64, to: f64, edge: f64) -> f64 {
    const STEPS: usize = 32;
    let at = |i: usize| {
        let x = from + (to - from) * (i as f64 + 0.5) / STEPS as f64;
        share_beyond((edge - x) / RADIUS)
    };
    (0..STEPS).map(at).sum::<f64>() / STEPS as f64
}

/// The share of the cone filter over the unit disk at x > t.
fn share_beyond(t: f64) -> f64 {
    const STEPS: usize = 64;
    let k = 1.1;
    let norm = 1.0 / (1.0 - 2.0 / (3.0 * k));
    let at = |i: usize| {
        let s = (i as f64 + 0.5) / STEPS as f64;
        let part = (t / s).clamp(-1.0, 1.0).acos() / std::f64::consts::PI;
        2.0 * s * norm * (1.0 - s / k) * part
    };
    (0..STEPS).map(at).sum::<f64>() / STEPS as f64
}

#[test]
fn a_wedge_spreads_the_wavelengths() {
    let glass = Glass::dispersive(1.75, 1.15);
    let lamp = Spectrum::rgb_illuminant([2.0; 3]);
    let photometric = f64::from(lamp.photometric());
    let spectra = [(lamp, SpectrumRole::Emission), (glass.eta.clone(), SpectrumRole::Ior)];
    let terms = Terms::NONE.with(Term::Caustic);
    for mode in [ColorMode::Rgb, ColorMode::Spectral] {
        if mode == ColorMode::Rgb && !full_tier() {
            continue;
        }
        let column = |i: usize| {
            let [from, to] = [i, i + 1].map(|i| WINDOW * (0.25 * i as f64 - 1.0));
            expected_rgb(mode, &spectra, |v| {
                let (shift, passed, denser) = bent(v[1]);
                v[0] / photometric * passed * denser * std::f64::consts::FRAC_1_PI * lit(from, to, EDGE - shift)
            })
        };
        let expected: Vec<f64> = (0..8).flat_map(column).collect();
        let built = build(&scene(&glass), mode);
        let two_pass = photon(Some(3), |p| {
            p.caustic_photons = Some(400);
            p.global_photons = Some(0);
            p.used = 100_000;
            p.max_distance = Some(RADIUS as f32);
            p.passes = 64;
            p.final_gather_samples = 1;
            p.terms = terms;
        });
        let runs = runs(&built, two_pass, 64, 1, [1, 8]);
        assert_exact(&format!("wedge, {mode:?}"), &runs, &expected, 5e-3, 0.15);
    }
}
