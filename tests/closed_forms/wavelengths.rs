//! What depends on wavelength: the angle at which a prism bends light, and that nothing does where everything is grey.

use lucerna::accel::Backend;
use lucerna::spectrum::{ColorMode, ColorSpace, Outside, Spectrum, SpectrumRole, cie};

use super::common::means::Means;
use super::common::render::{Built, Judge, expected_rgb, parse};
use super::{check, options, quad};

/// Parallel rays along +z enter a wedge of glass head on at z = 1 and leave it through a plane that is inclined by 30 degrees, through
/// z = 1.2 on the axis, towards a lamp over x > EDGE at z = Z.
const INCLINATION: f64 = 30.0;
const Z: f64 = 2.2;
const WINDOW: f64 = 0.1;

/// tan of the angle by which an index bends the rays, by Snell's law at the inclined plane, and the share of light that both planes
/// let through, by Fresnel's equations.
fn bend(n: f64) -> (f64, f64) {
    let (sin, cos) = INCLINATION.to_radians().sin_cos();
    let sin_out = n * sin;
    let cos_out = (1.0 - sin_out * sin_out).sqrt();
    let parallel = (cos - n * cos_out) / (cos + n * cos_out);
    let perpendicular = (n * cos - cos_out) / (n * cos + cos_out);
    let head_on = (n - 1.0) / (n + 1.0);
    let through = (1.0 - head_on * head_on) * (1.0 - 0.5 * (parallel * parallel + perpendicular * perpendicular));
    ((sin_out.asin() - INCLINATION.to_radians()).tan(), through)
}

/// The x beyond which a ray that starts there meets the lamp, if its edge is where a ray of index `n_edge` on the axis goes.
fn first_lit(n: f64, n_edge: f64) -> f64 {
    let (tan, _) = bend(n);
    let (tan_edge, _) = bend(n_edge);
    // From z = 1.2 - tan(inclination) x on, towards -x.
    (Z - 1.2) * (tan - tan_edge) / (1.0 - INCLINATION.to_radians().tan() * tan)
}

fn prism(glass: &str, n_edge: f64, lamp: &str) -> String {
    let slope = INCLINATION.to_radians().tan();
    let edge = -(Z - 1.2) * bend(n_edge).0;
    // Normals point out of the glass.
    let enter = quad([-5.0, -5.0, 1.0], [0.0, 10.0, 0.0], [10.0, 0.0, 0.0]);
    let leave = quad([-0.5, -5.0, 1.2 + 0.5 * slope], [1.0, 0.0, -slope], [0.0, 10.0, 0.0]);
    let screen = quad([edge, -50.0, Z], [100.0, 0.0, 0.0], [0.0, 100.0, 0.0]);
    format!(
        "ColorSpace \"aces2065-1\"\nCamera \"orthographic\" \"float screenwindow\" [-{WINDOW} {WINDOW} -{WINDOW} {WINDOW}]\n{}WorldBegin\n\
         AttributeBegin\nMaterial \"dielectric\" \"spectrum eta\" \"{glass}\"\n{enter}{leave}AttributeEnd\n\
         AreaLightSource \"diffuse\" \"spectrum L\" [{lamp}] \"bool twosided\" true\n\
         Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n{screen}",
        options(2)
    )
}

/// Three lamps, 20 nm wide: by column of the picture, with the index of Sellmeier's equation at each nm.
#[test]
fn a_prism_bends_each_wavelength_by_snells_law() {
    const GLASS: &str = "sellmeier-N-SF11";
    let glass = Spectrum::named(GLASS).expect("known");
    for center in [450.0_f32, 550.0, 650.0] {
        let points = vec![
            (center - 10.5, 0.0),
            (center - 10.0, 1.0),
            (center + 10.0, 1.0),
            (center + 10.5, 0.0),
        ];
        let lamp: Vec<String> = points.iter().map(|(nm, value)| format!("{nm} {value}")).collect();
        let spectrum = Spectrum::tabulated(points, Outside::Zero);
        let scale = 1.0 / f64::from(spectrum.photometric());

        let n = f64::from(glass.value(center));
        let text = prism(GLASS, n, &lamp.join(" "));
        let spectra = [(spectrum, SpectrumRole::Emission), (glass.clone(), SpectrumRole::Ior)];
        let expected = |mode| {
            let column = |i: usize| {
                let [from, to] = [i, i + 1].map(|i| -WINDOW + 0.25 * WINDOW * i as f64);
                let srgb = expected_rgb(mode, &spectra, |v| {
                    let lit = (to - first_lit(v[1], n).max(from)).max(0.0) / (to - from);
                    scale * v[0] * bend(v[1]).1 * lit
                });
                // A space in which no such light has a negative channel.
                ColorSpace::Aces2065.xyz_to_rgb(cie::srgb_to_xyz(srgb))
            };
            (0..8).flat_map(column).collect()
        };
        // The faint channels of a narrow lamp are noisy, column by column. Together 3 % is an error of 0.001 in the index.
        let judge = Judge { power: (0.6, 0.03) };
        check(&format!("{center} nm"), &text, 2048, [1, 8], &judge, expected);
    }
}

/// Grey walls, a grey mirror, glass without dispersion, lamps of the film's white: nothing has a colour, so both modes have the same
/// expectation, channel by channel.
#[test]
fn a_neutral_scene_is_the_same_in_rgb() {
    let text = format!(
        "LookAt 0 1 -4  0 0.6 0  0 1 0\nCamera \"perspective\" \"float fov\" 50\n{}WorldBegin\n\
         LightSource \"infinite\" \"rgb L\" [0.2 0.2 0.2]\n\
         AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [5 5 5]\n{}AttributeEnd\n\
         Material \"diffuse\" \"rgb reflectance\" [0.6 0.6 0.6]\n{}\
         Material \"conductor\" \"rgb reflectance\" [0.8 0.8 0.8] \"float roughness\" 0.3\n\
         AttributeBegin\nTranslate -0.8 0.6 0\nShape \"sphere\" \"float radius\" 0.6\nAttributeEnd\n\
         Material \"dielectric\" \"float roughness\" 0.4\n\
         AttributeBegin\nTranslate 0.8 0.6 0\nShape \"sphere\" \"float radius\" 0.6\nAttributeEnd\n",
        options(6),
        quad([-1.0, 3.0, -1.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0]),
        quad([-9.0, 0.0, -9.0], [0.0, 0.0, 18.0], [18.0, 0.0, 0.0]),
    );
    let means = Means {
        significance: 0.01,
        slack: 1e-3,
    };
    let desc = parse(&text);
    let [rgb, spectral] = [ColorMode::Rgb, ColorMode::Spectral].map(|mode| {
        let backend = Backend::AVAILABLE[0];
        Built::new(desc.clone(), backend, mode).runs(256, [4, 4])
    });
    let report = means.against_runs(&rgb, &spectral);
    report.assert_agrees("neutral");
    report.assert_power("neutral", 0.1, 0.03);
}
