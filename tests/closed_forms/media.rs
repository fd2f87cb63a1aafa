//! Participating media: what is left of light, what they emit, one scattering event by quadrature, and uniform fields, which no
//! medium that loses nothing or emits what it absorbs can change.

use std::f64::consts::PI;

use lucerna::spectrum::{Spectrum, SpectrumRole};

use super::common::full_tier;
use super::common::render::{Judge, expected_rgb};
use super::{check, check_uniform, mean_along};

const SPP: u32 = 512;
const E: [f32; 3] = [0.9, 0.6, 0.3];
/// A ball of radius 1 that is only a boundary.
const BALL: &str = "Material \"interface\" Shape \"sphere\"";

fn rgb([r, g, b]: [f32; 3]) -> String {
    format!("[{r} {g} {b}]")
}

/// A medium called `m`.
fn medium(sigma_a: [f32; 3], sigma_s: [f32; 3], more: &str) -> String {
    let (sigma_a, sigma_s) = (rgb(sigma_a), rgb(sigma_s));
    format!(
        "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb sigma_a\" {sigma_a} \"rgb sigma_s\" {sigma_s} {more}\n"
    )
}

fn film(integrator: &str) -> String {
    format!(
        "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nPixelFilter \"box\"\nSampler \"sobol\"\n\
         Integrator \"path\" {integrator}\n"
    )
}

/// The radiance of an `"rgb L"` of `value`, and coefficients by their `"rgb"`, as `radiance` puts them together.
fn expected(
    mode: lucerna::spectrum::ColorMode,
    value: [f32; 3],
    coefficients: &[[f32; 3]],
    radiance: impl Fn(&[f64]) -> f64,
) -> [f64; 3] {
    let emission = Spectrum::rgb_illuminant(value);
    let photometric = f64::from(emission.photometric());
    let mut spectra = vec![(emission, SpectrumRole::Emission)];
    spectra.extend(
        coefficients
            .iter()
            .map(|&rgb| (Spectrum::rgb_unbounded(rgb), SpectrumRole::Reflectance)),
    );
    expected_rgb(mode, &spectra, |v| {
        let mut v = v.to_vec();
        v[0] /= photometric;
        radiance(&v)
    })
}

/// A room whose walls emit e and reflect 0.5 has the radiance 2 e everywhere, whatever fills it that loses nothing, or that emits what
/// it absorbs.
fn check_room(name: &str, medium: &str, integrator: &str, inside: &str, fills_room: bool) {
    // Paths through glass find lamps by chance only.
    let spp = if inside.contains("dielectric") { 3 * SPP } else { SPP };
    let around = if fills_room { "MediumInterface \"m\"" } else { "" };
    let e = rgb(E);
    let text = format!(
        "{around}\nCamera \"perspective\" \"float fov\" 100\n{}{medium}\nWorldBegin\n{inside}\n\
         AreaLightSource \"diffuse\" \"rgb L\" {e}\nMaterial \"diffuse\" \"float reflectance\" 0.5\n\
         ReverseOrientation Translate 0.3 -0.4 0.5 Shape \"sphere\" \"float radius\" 3\n",
        film(&format!("\"integer maxdepth\" -1 {integrator}"))
    )
    .replace("\"float reflectance\" 0.5", "\"rgb reflectance\" [0.5 0.5 0.5]");
    // In one block: the field is uniform, and light that is scattered over and over is noisy.
    check(name, &text, spp, [8, 8], &Judge::USUAL, |mode| {
        expected(mode, E, &[], |v| 2.0 * v[0]).to_vec()
    });
}

/// As in [`check_room`]'s box, in a ball between the camera and the wall.
fn ball_before_camera(material: &str) -> String {
    format!(
        "AttributeBegin MediumInterface \"m\" \"\" {material}\nTranslate 0.2 0.1 1.6 Shape \"sphere\" \"float radius\" 1.1 AttributeEnd"
    )
}

#[test]
fn media_that_lose_nothing_are_invisible_in_a_uniform_field() {
    let fog = |more: &str| medium([0.0; 3], [0.05, 0.15, 0.35], more);
    let ball = &ball_before_camera("Material \"interface\"");
    // What fills the room, and the ball.
    let cases = [
        ("\"float g\" 0.8", ""),
        ("\"float g\" -0.5", "\"string strategy\" \"bsdf\""),
        ("\"float g\" 0", "\"integer splitting\" 3"),
    ];
    for (i, (g, way)) in cases.into_iter().enumerate() {
        if full_tier() || i < 2 {
            check_room(&format!("fog, {g} {way}"), &fog(g), way, "", true);
        }
        if full_tier() || i == 0 {
            let dense = medium([0.0; 3], [0.3, 0.8, 2.0], g);
            check_room(&format!("a ball of fog, {g} {way}"), &dense, way, ball, false);
        }
    }
    let ball = ball_before_camera("Material \"dielectric\" \"float eta\" 1.3");
    check_room("a glass ball of fog", &fog(""), "", &ball, false);
    if full_tier() {
        // Dispersion leaves the hero alone, from the start: a quarter of the wavelengths.
        let ball = ball_before_camera("Material \"dielectric\" \"spectrum eta\" \"glass-F11\"");
        check_room("a dispersive ball of fog", &fog(""), "", &ball, false);
    }
}

#[test]
fn media_that_emit_what_they_absorb_are_invisible_in_a_uniform_field() {
    let le = format!("\"float g\" 0.3 \"rgb Le\" {}", rgb(E.map(|v| 2.0 * v)));
    let absorbing = medium([0.3, 1.0, 2.0], [0.0; 3], &le);
    let all = medium([0.3, 1.0, 2.0], [0.7, 0.4, 0.2], &le);
    let ball = ball_before_camera("Material \"interface\"");
    let nested = format!(
        "{ball} AttributeBegin MediumInterface \"\" \"m\" Material \"interface\" Translate 0.3 0.1 1.5\n\
         Shape \"sphere\" \"float radius\" 0.5 AttributeEnd"
    );
    check_room("glowing fog", &all, "", "", true);
    check_room("a hollow ball of glowing fog", &all, "", &nested, false);
    if full_tier() {
        check_room("glowing gas", &absorbing, "", "", true);
        check_room("a ball of glowing fog", &all, "", &ball, false);
    }
}

/// A camera that looks along z through the middle of whatever stands in the origin, at `background` or nothing.
fn axis_view(integrator: &str, medium: &str, world: &str) -> String {
    format!(
        "Translate 0 0 5\nCamera \"orthographic\" \"float screenwindow\" [-.001 .001 -.001 .001]\n{}{medium}\nWorldBegin\n{world}\n",
        film(integrator)
    )
}

#[test]
fn light_is_absorbed_as_beer_and_lambert_say() {
    let sigma_a = [0.2_f32, 0.7, 1.5];
    let environment = format!("LightSource \"infinite\" \"rgb L\" {}\n", rgb(E));
    let ball = format!("{environment}AttributeBegin MediumInterface \"m\" \"\" {BALL} AttributeEnd");
    // An instance that is squeezed along the view, and turned.
    let instance = format!(
        "{environment}ObjectBegin \"o\" MediumInterface \"m\" \"\" {BALL} ObjectEnd\n\
         Scale 1 1 0.5 Rotate 40 1 2 3 ObjectInstance \"o\""
    );
    for (name, world, thickness) in [("ball", &ball, 2.0), ("instance", &instance, 1.0)] {
        let text = axis_view("", &medium(sigma_a, [0.0; 3], "\"float scale\" 0.8"), world);
        check_uniform(&format!("absorption in a {name}"), &text, SPP / 8, |mode| {
            expected(mode, E, &[sigma_a], |v| v[0] * (-0.8 * thickness * v[1]).exp())
        });
    }
}

#[test]
fn emission_adds_up_along_a_ray() {
    let (sigma_a, le) = ([0.2_f32, 0.7, 1.5], [0.5_f32, 0.7, 0.2]);
    let glowing = medium(
        sigma_a,
        [0.0; 3],
        &format!("\"rgb Le\" {} \"float Lescale\" 3", rgb(le)),
    );
    let world = format!("AttributeBegin MediumInterface \"m\" \"\" {BALL} AttributeEnd");
    check_uniform("emission", &axis_view("", &glowing, &world), SPP / 8, |mode| {
        expected(mode, le, &[sigma_a], |v| 3.0 * v[0] * (1.0 - (-2.0 * v[1]).exp()))
    });
}

/// Henyey and Greenstein's phase function, written down a second time.
fn phase(cos: f64, g: f64) -> f64 {
    (1.0 - g * g) / (4.0 * PI * (1.0 + g * g - 2.0 * g * cos).powf(1.5))
}

#[test]
fn one_scattering_event_in_a_ball_under_a_uniform_sky() {
    let (sigma_a, sigma_s) = ([0.1_f32, 0.3, 0.2], [0.4_f32, 0.9, 1.8]);
    for (g, way) in [
        (0.4, ""),
        (-0.4, "\"string strategy\" \"bsdf\""),
        (0.7, ""),
        (0.4, "\"string strategy\" \"light\""),
    ]
    .into_iter()
    .take(if full_tier() { 4 } else { 1 })
    {
        let text = axis_view(
            &format!("\"integer maxdepth\" 1 {way}"),
            &medium(sigma_a, sigma_s, &format!("\"float g\" {g}")),
            &format!(
                "LightSource \"infinite\" \"rgb L\" {}\nAttributeBegin MediumInterface \"m\" \"\" {BALL} AttributeEnd",
                rgb(E)
            ),
        );
        let radiance = |v: &[f64]| {
            let sigma_t = v[1] + v[2];
            // From a point at z on the axis, how far it is out of the ball in a direction of this cosine with the axis.
            let way_out = |z: f64, cos: f64| -z * cos + (1.0 - z * z * (1.0 - cos * cos)).sqrt();
            let once = simpson(|z| {
                let arriving = simpson(|cos| 2.0 * PI * phase(cos, g) * (-sigma_t * way_out(z, cos)).exp());
                v[2] * (-sigma_t * (z + 1.0)).exp() * arriving
            });
            v[0] * ((-2.0 * sigma_t).exp() + once)
        };
        check_uniform(&format!("single scattering, g {g}, {way}"), &text, 3 * SPP, |mode| {
            expected(mode, E, &[sigma_a, sigma_s], radiance)
        });
    }
}

/// The integral of `f` from -1 to 1 by Simpson's rule.
fn simpson(f: impl Fn(f64) -> f64) -> f64 {
    const STEPS: usize = 64;
    let h = 2.0 / STEPS as f64;
    let weight = |i: usize| match i {
        0 | STEPS => 1.0,
        _ if i % 2 == 1 => 4.0,
        _ => 2.0,
    };
    (0..=STEPS).map(|i| weight(i) * f(-1.0 + h * i as f64)).sum::<f64>() * h / 3.0
}

/// A point light beside the axis in fog without end: what is scattered once towards the camera. Boundaries in the fog, with the same
/// on both sides, change nothing.
#[test]
fn a_point_light_in_fog_has_its_halo() {
    let (sigma_a, sigma_s, g) = ([0.05_f32, 0.1, 0.02], [0.1_f32, 0.2, 0.4], 0.5);
    let text = |boundaries: &str| {
        let lamp = "LightSource \"point\" \"point3 from\" [1.5 0 0] \"rgb I\" [4 3 5]";
        let medium = medium(sigma_a, sigma_s, "\"float g\" 0.5");
        let view = axis_view("\"integer maxdepth\" 1", &medium, &format!("{lamp}\n{boundaries}"));
        format!("MediumInterface \"m\"\n{view}")
    };
    let radiance = |v: &[f64]| {
        let sigma_t = v[1] + v[2];
        // The camera is at z = -5; beyond 60 nothing is left.
        65.0 * mean_along([-5.0, 60.0], |z| {
            let distance = (1.5_f64 * 1.5 + z * z).sqrt();
            // Light goes from (1.5, 0) to (0, z), then back along the axis.
            let cos = -z / distance;
            v[0] * v[2] * (-sigma_t * (z + 5.0 + distance)).exp() * phase(cos, g) / (distance * distance)
        })
    };
    let four_blocks = |mode| [expected(mode, [4.0, 3.0, 5.0], &[sigma_a, sigma_s], radiance); 4].concat();
    check("a halo", &text(""), SPP, [4, 4], &Judge::USUAL, four_blocks);
    let same = medium(sigma_a, sigma_s, "\"float g\" 0.5").replace("\"m\"", "\"n\"");
    let ball = format!("{same}MediumInterface \"n\" \"m\" {BALL}");
    check("a halo, a ball", &text(&ball), SPP, [4, 4], &Judge::USUAL, four_blocks);
}
