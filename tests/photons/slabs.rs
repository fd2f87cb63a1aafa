//! Light that has passed glass, seen through glass: from a direction or a point, so that neither `path` nor `bdpt` finds it. What flat
//! glass lets through at each wavelength is known by Fresnel's equations.

use std::f64::consts::FRAC_1_PI;

use lucerna::desc::{Term, Terms};
use lucerna::integrator::Integrator;
use lucerna::scene::ViewOverrides;
use lucerna::spectrum::{ColorMode, Outside, Spectrum, SpectrumRole};

use crate::common::full_tier;
use crate::common::render::{MODES, expected_rgb};
use crate::{assert_agree, assert_exact, build, film, photon, quad, runs, sppm};

/// What light does not lose at one surface of index `n`, where its angle to the normal in air has this cosine.
pub fn through(n: f64, cos: f64) -> f64 {
    let cos_in = (1.0 - (1.0 - cos * cos) / (n * n)).sqrt();
    let parallel = (n * cos - cos_in) / (n * cos + cos_in);
    let perpendicular = (cos - n * cos_in) / (cos + n * cos_in);
    1.0 - 0.5 * (parallel * parallel + perpendicular * perpendicular)
}

/// A glass: its parameter, and its index.
#[derive(Clone)]
pub struct Glass {
    pub text: String,
    pub eta: Spectrum,
}

impl Glass {
    pub fn plain() -> Self {
        Self {
            text: "\"float eta\" 1.5".to_owned(),
            eta: Spectrum::constant(1.5),
        }
    }

    /// Its index falls evenly from 300 to 900 nm.
    pub fn dispersive(from: f32, to: f32) -> Self {
        Self {
            text: format!("\"spectrum eta\" [300 {from} 900 {to}]"),
            eta: Spectrum::tabulated(vec![(300.0, from), (900.0, to)], Outside::Zero),
        }
    }

    fn catalogue(name: &str) -> Self {
        Self {
            text: format!("\"spectrum eta\" \"{name}\""),
            eta: Spectrum::named(name).expect("a glass"),
        }
    }
}

const LIGHT_ANGLE: f64 = 35.0;
const CAMERA_ANGLE: f64 = 40.0;
const TRANSMITTANCE: f64 = 0.5;
const LAMP: [f32; 3] = [2.0, 2.0, 2.0];

/// A sheet that lets light pass diffusely, panes of glass above and below it.
fn sheet() -> String {
    let t = TRANSMITTANCE;
    format!(
        "Material \"diffusetransmission\" \"rgb reflectance\" [0 0 0] \"rgb transmittance\" [{t} {t} {t}]\n{}",
        quad([-1.0, -1.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0])
    )
}

fn pane(glass: &Glass, bottom: f64, top: f64) -> String {
    let (upper, lower) = (
        quad([-1.6, -1.6, top], [3.2, 0.0, 0.0], [0.0, 3.2, 0.0]),
        quad([-1.6, -1.6, bottom], [0.0, 3.2, 0.0], [3.2, 0.0, 0.0]),
    );
    format!("Material \"dielectric\" {}\n{upper}{lower}", glass.text)
}

/// A distant light above both panes and the sheet, the camera below.
fn slabs(of_light: &Glass, of_camera: &Glass) -> String {
    let (lx, lz) = LIGHT_ANGLE.to_radians().sin_cos();
    let (cx, cz) = CAMERA_ANGLE.to_radians().sin_cos();
    format!(
        "LookAt {cx} 0 {}  0 0 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [-0.6 0.6 -0.6 0.6]\n{}WorldBegin\n\
         LightSource \"distant\" \"point3 from\" [{lx} 0 {lz}] \"point3 to\" [0 0 0] \"rgb L\" [2 2 2]\n{}{}{}",
        -cz,
        film([8, 8]),
        pane(of_light, 0.2, 0.3),
        pane(of_camera, -0.3, -0.2),
        sheet()
    )
}

/// Both integrators, for light of so many scattering events.
fn both(max_depth: u32, photons: u32, radius: f32) -> [Integrator; 2] {
    let two_pass = photon(Some(max_depth), |p| {
        p.caustic_photons = Some(photons / 2);
        p.global_photons = Some(0);
        p.max_distance = Some(radius);
        p.passes = 64;
        p.final_gather_samples = 1;
    });
    [two_pass, sppm(Some(max_depth), photons, radius)]
}

/// The colour of `f` of the lamp and of the indices of some glasses.
fn color_of(mode: ColorMode, glasses: &[&Glass], f: impl Fn(f64, &[f64]) -> f64) -> [f64; 3] {
    let lamp = Spectrum::rgb_illuminant(LAMP);
    let photometric = f64::from(lamp.photometric());
    let mut spectra = vec![(lamp, SpectrumRole::Emission)];
    spectra.extend(glasses.iter().map(|glass| (glass.eta.clone(), SpectrumRole::Ior)));
    expected_rgb(mode, &spectra, |v| f(v[0] / photometric, &v[1..]))
}

fn cosine(degrees: f64) -> f64 {
    degrees.to_radians().cos()
}

/// Secondary wavelengths end with the photon, with the camera's path, with both, or with neither.
#[test]
fn a_sheet_between_panes_is_lit_and_seen_through_them() {
    let (plain, dense) = (Glass::plain(), Glass::catalogue("glass-F11"));
    let steep = Glass::dispersive(2.6, 1.2);
    let pairs = [
        (&plain, &plain),
        (&steep, &plain),
        (&plain, &steep),
        (&steep, &steep),
        (&dense, &dense),
    ];
    // In the normal tier the photon's and both at once; the camera's alone, by two passes, takes as long as these.
    let few = |mode, pair, progressive: bool| matches!((mode, pair), (ColorMode::Spectral, 1 | 3)) && progressive;
    for mode in MODES {
        for (i, (of_light, of_camera)) in pairs.into_iter().enumerate() {
            let radiance = color_of(mode, &[of_light, of_camera], |e, n| {
                let (to, from) = (cosine(LIGHT_ANGLE), cosine(CAMERA_ANGLE));
                let passed = (through(n[0], to) * through(n[1], from)).powi(2);
                e * to * passed * TRANSMITTANCE * FRAC_1_PI
            });
            for integrator in both(5, 2000, 0.15) {
                if !full_tier() && !few(mode, i, matches!(integrator, Integrator::Sppm(_))) {
                    continue;
                }
                let built = build(&slabs(of_light, of_camera), mode);
                let runs = runs(&built, integrator, 64, 1, [8, 8]);
                let name = format!("{} of pair {i}, {mode:?}", integrator.name());
                let power = if mode == ColorMode::Rgb { 0.05 } else { 0.15 };
                assert_exact(&name, &runs, &radiance, 1e-3, power);
            }
        }
    }
}

/// With one scattering event less there is nothing; and no other integrator finds any of it.
#[test]
fn what_only_photons_find_has_exactly_its_scattering_events() {
    let plain = Glass::plain();
    let built = build(&slabs(&plain, &plain), ColorMode::Rgb);
    let path = Integrator::from_desc(&built.desc.integrator).with_max_depth(Some(8));
    let is_black = |integrator: Integrator| {
        let overrides = ViewOverrides {
            spp: Some(4),
            ..ViewOverrides::default()
        };
        let (picture, _) = built.picture_with(&built.view(0, &overrides), integrator);
        picture.iter().all(|&v| v == 0.0)
    };
    assert!(is_black(path) && is_black(path.named("bdpt")));
    for integrator in both(4, 2000, 0.15) {
        assert!(is_black(integrator), "{}", integrator.name());
    }
    for integrator in both(5, 2000, 0.15) {
        for (term, is_wanted) in [(Term::Caustic, true), (Term::Indirect, false), (Term::Specular, false)] {
            let some = integrator.with_terms(Terms::NONE.with(term)).expect("terms");
            assert_eq!(is_black(some), !is_wanted, "{term:?} of {}", integrator.name());
        }
    }
}

/// A point light in the middle of a ball of glass, over the sheet, which is seen head on through a pane.
fn ball(glass: &Glass, height: f64) -> String {
    format!(
        "LookAt 0 0 -1  0 0 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [-0.5 0.5 -0.5 0.5]\n{}WorldBegin\n\
         AttributeBegin Translate 0 0 {height}\nLightSource \"point\" \"rgb I\" [2 2 2]\nMaterial \"dielectric\" {}\n\
         Shape \"sphere\" \"float radius\" 0.3 AttributeEnd\n{}{}",
        film([8, 8]),
        glass.text,
        pane(glass, -0.3, -0.2),
        sheet()
    )
}

/// What is lit by a point at height h through a surface of which the circle of a pixel sees the mean.
fn lit_by_point(h: f64, [x0, x1]: [f64; 2], [y0, y1]: [f64; 2]) -> f64 {
    const STEPS: usize = 32;
    let at = |a: f64, b: f64, i: usize| a + (b - a) * (i as f64 + 0.5) / STEPS as f64;
    let values = (0..STEPS * STEPS).map(|i| {
        let (x, y) = (at(x0, x1, i % STEPS), at(y0, y1, i / STEPS));
        h * (h * h + x * x + y * y).powf(-1.5)
    });
    values.sum::<f64>() / (STEPS * STEPS) as f64
}

#[test]
fn a_point_light_in_glass_is_seen_through_glass() {
    const H: f64 = 0.6;
    for (mode, glass, which) in [
        (ColorMode::Rgb, Glass::plain(), 0),
        (ColorMode::Spectral, Glass::dispersive(2.6, 1.2), 1),
    ] {
        if mode == ColorMode::Rgb && !full_tier() {
            continue;
        }
        let built = build(&ball(&glass, H), mode);
        let block = |i: usize| {
            let [x, y] = [i % 4, i / 4].map(|k| [-0.5 + 0.25 * k as f64, -0.25 + 0.25 * k as f64]);
            let lit = lit_by_point(H, x, y);
            color_of(mode, &[&glass], |e, n| {
                e * through(n[0], 1.0).powi(3) * lit * TRANSMITTANCE * FRAC_1_PI
            })
        };
        let expected: Vec<f64> = (0..16).flat_map(block).collect();
        let integrator = both(4, 4000, 0.05)[which];
        let runs = runs(&built, integrator, 64, 1, [2, 2]);
        let name = format!("{} of {}, {mode:?}", integrator.name(), glass.text);
        // The circles blur by 3/4 of 0.35 r² / h², 0.4 % of the brightest, at most.
        let power = if mode == ColorMode::Rgb { 0.05 } else { 0.15 };
        assert_exact(&name, &runs, &expected, 4e-3, power);
    }
}

/// Under a lamp so large that `path` finds it through both panes, by chance alone, all three see the same.
#[test]
fn under_a_large_lamp_the_light_is_what_path_finds() {
    let glass = Glass::plain();
    let lamp = format!(
        "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [2 2 2]\n{}AttributeEnd\n",
        quad([-2.0, -2.0, 1.2], [0.0, 4.0, 0.0], [4.0, 0.0, 0.0])
    );
    let text = slabs(&glass, &glass);
    let (head, tail) = (text.find("LightSource").unwrap(), text.find("Material").unwrap());
    let built = build(&format!("{}{lamp}{}", &text[..head], &text[tail..]), ColorMode::Rgb);
    let path = Integrator::from_desc(&built.desc.integrator).with_max_depth(Some(5));
    let reference = runs(&built, path, 128, 101, [4, 4]);
    assert!(reference.iter().flatten().all(|&v| v > 0.0));
    for integrator in both(5, 2000, 0.1) {
        let ours = runs(&built, integrator, 64, 1, [4, 4]);
        let name = format!("{} under a large lamp", integrator.name());
        assert_agree(&name, &ours, &reference, 5e-3, 0.05);
    }
}
