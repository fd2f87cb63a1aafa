//! Surfaces in a uniform environment or before a black or bright ground, against Fresnel's equations and the quadrature of the
//! single-scattering microfacet model.

use lucerna::spectrum::{Spectrum, SpectrumRole};

use super::common::microfacet::{Shape, Slopes, conductor_reflectance, dielectric_reflectance, direction};
use super::common::render::expected_rgb;
use super::{check_uniform, options, quad};

const WHITE_SKY: &str = "LightSource \"infinite\" \"rgb L\" [1 1 1]";
const Z: f64 = 0.35;

/// A plane at z = Z with tangent +x, of a material, seen at an angle from its normal (above 90 degrees: from below) and an
/// azimuth, by parallel rays.
fn plane(theta: f64, phi: f64, max_depth: i32, world: &str, material: &str) -> String {
    let eye = direction(theta, phi) * 3.0;
    format!(
        "LookAt {} {} {}  0 0 {Z}  0 1 0.1\nCamera \"orthographic\" \"float screenwindow\" [-0.1 0.1 -0.1 0.1]\n{}WorldBegin\n\
         {world}\nMaterial {material}\n{}",
        eye.x,
        eye.y,
        eye.z + Z,
        options(max_depth),
        quad([-40.0, -40.0, Z], [80.0, 0.0, 0.0], [0.0, 80.0, 0.0])
    )
}

/// A sphere that fills the view, in a white environment.
fn sphere(material: &str) -> String {
    format!(
        "LookAt 3 1 -4  0.2 0.1 0.3  0 1 0\nCamera \"perspective\" \"float fov\" 10\n{}WorldBegin\n{WHITE_SKY}\n\
         Material {material}\nTranslate 0.2 0.1 0.3\nShape \"sphere\" \"float radius\" 1.2",
        options(-1)
    )
}

#[test]
fn a_furnace_of_what_loses_nothing_is_white() {
    for material in [
        "\"diffuse\" \"rgb reflectance\" [1 1 1]",
        "\"conductor\" \"rgb reflectance\" [1 1 1]",
        "\"dielectric\" \"float eta\" 1.5",
        "\"dielectric\" \"float eta\" 0.7",
        "\"dielectric\" \"float eta\" 1",
        "\"dielectric\" \"spectrum eta\" \"glass-BK7\"",
    ] {
        check_uniform(material, &sphere(material), 64, |_| [1.0; 3]);
    }
    let grey = "\"diffuse\" \"rgb reflectance\" [0.25 0.5 0.75]";
    let albedo = [(Spectrum::illuminant_d65(), SpectrumRole::Emission)];
    let white = expected_rgb(super::ColorMode::Spectral, &albedo, |v| v[0])[1];
    let spectra = [
        (Spectrum::illuminant_d65(), SpectrumRole::Emission),
        (Spectrum::rgb_albedo([0.25, 0.5, 0.75]), SpectrumRole::Reflectance),
    ];
    check_uniform(grey, &sphere(grey), 64, |mode| match mode {
        super::ColorMode::Rgb => [0.25, 0.5, 0.75],
        super::ColorMode::Spectral => expected_rgb(mode, &spectra, |v| v[0] * v[1] / white),
    });
}

#[test]
fn a_smooth_boundary_reflects_as_fresnel_says() {
    // Only what is reflected meets light: the sky is white, the ground is black.
    let black_ground = format!(
        "{WHITE_SKY}\nAttributeBegin\nMaterial \"diffuse\" \"rgb reflectance\" [0 0 0]\n{}AttributeEnd",
        quad([-80.0, -80.0, Z - 0.5], [160.0, 0.0, 0.0], [0.0, 160.0, 0.0])
    );
    // The less is reflected, the more samples it takes.
    for (theta, spp) in [(20.0, 4096), (60.0, 2048), (80.0, 512)] {
        let cos = direction(theta, 0.0).z;
        let text = plane(theta, 25.0, 4, &black_ground, "\"dielectric\" \"float eta\" 1.5");
        check_uniform(&format!("glass at {theta}"), &text, spp, |_| {
            [dielectric_reflectance(cos, 1.5); 3]
        });
        let gold = "\"conductor\" \"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" \"metal-Au-k\"";
        let named = |name| Spectrum::named(name).expect("a metal of pbrt's");
        let light = Spectrum::rgb_illuminant([1.0; 3]);
        let photometric = f64::from(light.photometric());
        let spectra = [
            (light, SpectrumRole::Emission),
            (named("metal-Au-eta"), SpectrumRole::Reflectance),
            (named("metal-Au-k"), SpectrumRole::Reflectance),
        ];
        let text = plane(theta, 25.0, 1, WHITE_SKY, gold);
        check_uniform(&format!("gold at {theta}"), &text, 256, |mode| {
            expected_rgb(mode, &spectra, |v| {
                v[0] / photometric * conductor_reflectance(cos, v[1], v[2])
            })
        });
    }
}

/// Radiance is squeezed by the square of the relative index on its way in and spread on its way out.
#[test]
fn refraction_scales_radiance_by_the_squared_index() {
    let lamp = |z: f64, flip: &str| {
        format!(
            "AttributeBegin\n{flip}\nAreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\n\
             Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n{}AttributeEnd",
            quad([-80.0, -80.0, z], [160.0, 0.0, 0.0], [0.0, 160.0, 0.0])
        )
    };
    for (theta, eta) in [(30.0, 1.5_f64), (70.0, 1.5), (40.0, 1.0 / 1.3)] {
        let glass = format!("\"dielectric\" \"float eta\" {eta}");
        let cos = direction(theta, 0.0).z;
        // From above: a lamp below shines up through the boundary.
        let expected = (1.0 - dielectric_reflectance(cos, eta)) / (eta * eta);
        let text = plane(theta, 0.0, 4, &lamp(Z - 0.5, ""), &glass);
        check_uniform(&format!("lamp below eta {eta} at {theta}"), &text, 256, |_| {
            [expected; 3]
        });
        // From below, inside: a lamp above shines down through it.
        let expected = (1.0 - dielectric_reflectance(cos, 1.0 / eta)) * eta * eta;
        let text = plane(180.0 - theta, 0.0, 4, &lamp(Z + 3.0, "ReverseOrientation"), &glass);
        check_uniform(&format!("lamp above eta {eta} at {theta}"), &text, 256, |_| {
            [expected; 3]
        });
    }
}

const ROUGH: [(f64, f64); 4] = [(0.1, 0.1), (0.5, 0.5), (0.9, 0.9), (0.15, 0.6)];

fn roughness((x, y): (f64, f64)) -> String {
    format!("\"float uroughness\" {x} \"float vroughness\" {y} \"bool remaproughness\" false")
}

#[test]
fn a_rough_conductor_reflects_what_its_model_says() {
    let named = |name| Spectrum::named(name).expect("a metal of pbrt's");
    for (alpha, theta, phi) in [
        (ROUGH[0], 30.0, 0.0),
        (ROUGH[1], 60.0, 0.0),
        (ROUGH[2], 80.0, 0.0),
        (ROUGH[3], 60.0, 20.0),
        (ROUGH[3], 70.0, 80.0),
    ] {
        let wo = direction(theta, phi);
        let slopes = Slopes(alpha.0, alpha.1, Shape::Ggx);
        let grey = format!("\"conductor\" \"rgb reflectance\" [0.6 0.6 0.6] {}", roughness(alpha));
        let k = 2.0 * (0.6_f64 / 0.4).sqrt();
        let expected = slopes.reflected(wo, |cos| conductor_reflectance(cos, 1.0, k));
        let name = format!("grey metal of {alpha:?} at {theta}, {phi}");
        check_uniform(&name, &plane(theta, phi, 1, WHITE_SKY, &grey), 256, |_| [expected; 3]);
    }
    let (theta, phi, alpha) = (55.0, 40.0, ROUGH[3]);
    let wo = direction(theta, phi);
    let copper = format!(
        "\"conductor\" \"spectrum eta\" \"metal-Cu-eta\" \"spectrum k\" \"metal-Cu-k\" {}",
        roughness(alpha)
    );
    let light = Spectrum::rgb_illuminant([1.0; 3]);
    let photometric = f64::from(light.photometric());
    let spectra = [
        (light, SpectrumRole::Emission),
        (named("metal-Cu-eta"), SpectrumRole::Reflectance),
        (named("metal-Cu-k"), SpectrumRole::Reflectance),
    ];
    let text = plane(theta, phi, 1, WHITE_SKY, &copper);
    check_uniform("copper", &text, 256, |mode| {
        expected_rgb(mode, &spectra, |v| {
            let fresnel = |cos| conductor_reflectance(cos, v[1], v[2]);
            v[0] / photometric * Slopes(alpha.0, alpha.1, Shape::Ggx).reflected(wo, fresnel)
        })
    });
}

#[test]
fn roughness_is_remapped_to_the_square_of_alpha() {
    // pbrt-v4: alpha is the square root of the roughness.
    let metal = "\"conductor\" \"rgb reflectance\" [0.6 0.6 0.6] \"float roughness\" 0.25";
    let k = 2.0 * (0.6_f64 / 0.4).sqrt();
    let expected =
        Slopes(0.5, 0.5, Shape::Ggx).reflected(direction(75.0, 0.0), |cos| conductor_reflectance(cos, 1.0, k));
    check_uniform(metal, &plane(75.0, 0.0, 1, WHITE_SKY, metal), 256, |_| [expected; 3]);
}

#[test]
fn a_rough_dielectric_reflects_and_transmits_what_its_model_says() {
    for (alpha, theta, phi) in [(ROUGH[0], 30.0, 0.0), (ROUGH[1], 60.0, 0.0), (ROUGH[3], 70.0, 30.0)] {
        let slopes = Slopes(alpha.0, alpha.1, Shape::Ggx);
        let glass = format!("\"dielectric\" \"float eta\" 1.5 {}", roughness(alpha));
        for (side, theta_seen, eta) in [("above", theta, 1.5), ("below", 180.0 - theta, 1.0 / 1.5)] {
            let wo = direction(theta, phi);
            let reflected = slopes.reflected(wo, |cos| dielectric_reflectance(cos, eta));
            let expected = reflected + slopes.transmitted(wo, eta) / (eta * eta);
            let name = format!("rough glass of {alpha:?} at {theta}, {phi} from {side}");
            let text = plane(theta_seen, phi, 1, WHITE_SKY, &glass);
            check_uniform(&name, &text, 256, |_| [expected; 3]);
        }
    }
}
