//! What a light looks like: its colour in both modes, the side it emits on, the units of its parameters, the imaging ratio.

use lucerna::spectrum::{ColorMode, Outside, Spectrum, SpectrumRole};

use super::common::render::expected_rgb;
use super::{check_uniform, options, quad};

/// An emitter that fills the view, described by the parameters `light` of an `AreaLightSource`.
fn emitter(light: &str, film: &str, camera: &str, orientation: &str) -> String {
    let options = options(1).replace("Film \"rgb\"", &format!("Film \"rgb\" {film}"));
    format!(
        "Camera \"perspective\" \"float fov\" 30 {camera}\n{options}WorldBegin\n\
         AreaLightSource \"diffuse\" {light}\nMaterial \"diffuse\" \"rgb reflectance\" [0 0 0]\n{orientation}\n{}",
        // Faces -z, towards the camera.
        quad([-5.0, -5.0, 5.0], [0.0, 10.0, 0.0], [10.0, 0.0, 0.0])
    )
}

#[test]
fn an_rgb_light_has_its_rgb_in_both_modes() {
    for rgb in [[1.0, 1.0, 1.0], [4.0, 1.0, 0.25], [0.1, 0.8, 3.0], [12.0; 3]] {
        let [r, g, b] = rgb;
        let light = format!("\"rgb L\" [{r} {g} {b}]");
        check_uniform(&light, &emitter(&light, "", "", ""), 64, |_| rgb);
    }
}

#[test]
fn other_spectra_have_their_colour_at_luminance_one() {
    let samples = [(400.0, 0.5), (500.0, 8.0), (600.0, 15.6), (700.0, 18.4)];
    for (light, spectrum) in [
        ("\"blackbody L\" 3500", Spectrum::blackbody(3500.0)),
        (
            "\"spectrum L\" \"stdillum-A\"",
            Spectrum::named("stdillum-A").expect("a standard illuminant"),
        ),
        (
            "\"spectrum L\" [400 0.5 500 8 600 15.6 700 18.4]",
            Spectrum::tabulated(samples.to_vec(), Outside::Zero),
        ),
        ("", Spectrum::illuminant_d65()),
    ] {
        let photometric = f64::from(spectrum.photometric());
        let spectra = [(spectrum, SpectrumRole::Emission)];
        let expected = |mode| expected_rgb(mode, &spectra, |v| v[0] / photometric);
        let [r, g, b] = expected(ColorMode::Spectral);
        assert!(
            (0.2126 * r + 0.7152 * g + 0.0722 * b - 1.0).abs() < 1e-3,
            "{light}: {r} {g} {b}"
        );
        check_uniform(light, &emitter(light, "", "", ""), 256, expected);
    }
}

#[test]
fn light_comes_from_the_side_of_the_normal_or_from_both() {
    let light = "\"rgb L\" [2 2 2]";
    let cases = [
        ("front", "", "", 2.0),
        ("reversed", "", "ReverseOrientation", 0.0),
        ("two-sided", "\"bool twosided\" true", "ReverseOrientation", 2.0),
        // The quad is the same, its vertices are mirrored; pbrt keeps the normal of the untransformed shape.
        ("mirrored", "", "Scale -1 1 1", 2.0),
        ("mirrored and reversed", "", "Scale -1 1 1\nReverseOrientation", 0.0),
    ];
    for (name, sides, orientation, expected) in cases {
        let text = emitter(&format!("{light} {sides}"), "", "", orientation);
        check_uniform(name, &text, 64, |_| [expected; 3]);
    }
}

#[test]
fn scale_and_power_set_the_radiance() {
    check_uniform(
        "scale",
        &emitter("\"rgb L\" [1 2 0.5] \"float scale\" 3", "", "", ""),
        64,
        |_| [3.0, 6.0, 1.5],
    );
    // The area of each of the two triangles is 50: radiance of unit luminance is power / (pi 50), twice that area if two-sided.
    let power = std::f64::consts::PI * 50.0 * 3.0;
    let light = format!("\"rgb L\" [1 1 1] \"float power\" {power}");
    check_uniform("power", &emitter(&light, "", "", ""), 64, |_| [3.0; 3]);
    let light = format!("{light} \"bool twosided\" true \"float scale\" 2");
    check_uniform("power of both sides", &emitter(&light, "", "", ""), 64, |_| [3.0; 3]);
}

#[test]
fn the_sensor_scales_by_exposure_time_and_iso() {
    let light = "\"rgb L\" [1 2 0.5]";
    let shutter = "\"float shutteropen\" 0.25 \"float shutterclose\" 0.75";
    for (film, camera, ratio) in [
        ("\"float iso\" 400", "", 4.0),
        ("", shutter, 0.5),
        ("\"float iso\" 50", shutter, 0.25),
    ] {
        check_uniform(
            &format!("{film} {camera}"),
            &emitter(light, film, camera, ""),
            64,
            |_| [ratio, 2.0 * ratio, 0.5 * ratio],
        );
    }
}
