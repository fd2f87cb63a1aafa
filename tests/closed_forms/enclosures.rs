//! Closed rooms whose walls all emit e and reflect rho have the radiance e / (1 - rho) everywhere, whatever loses nothing stands
//! in them; paths of at most k scattering events gather e (1 - rho^(k+1)) / (1 - rho).

use lucerna::spectrum::{Spectrum, SpectrumRole};

use super::common::render::expected_rgb;
use super::{check_uniform, options};

const SPP: u32 = 256;
const E: [f32; 3] = [0.9, 0.6, 0.3];
const RHO: [f32; 3] = [0.2, 0.5, 0.7];

/// Radiance e and albedo rho of walls.
struct Walls {
    e: [f32; 3],
    rho: [f32; 3],
}

impl Walls {
    const GREY: Self = Self {
        e: [1.0; 3],
        rho: [0.5; 3],
    };
    const COLOURED: Self = Self { e: E, rho: RHO };

    /// A scene: the camera in the origin, `inside` around it, `shape` for the walls.
    fn scene(&self, max_depth: i32, inside: &str, shape: &str) -> String {
        let [e, rho] = [self.e, self.rho].map(|[r, g, b]| format!("{r} {g} {b}"));
        format!(
            "Camera \"perspective\" \"float fov\" 100\n{}WorldBegin\n{inside}\n\
             AreaLightSource \"diffuse\" \"rgb L\" [{e}]\nMaterial \"diffuse\" \"rgb reflectance\" [{rho}]\n{shape}\n",
            options(max_depth)
        )
    }

    /// Judges the scene (dispersion, which leaves one wavelength of four, takes more samples); the radiance is that of `terms` scattering events.
    fn check(&self, name: &str, max_depth: i32, inside: &str, shape: &str) {
        let emission = Spectrum::rgb_illuminant(self.e);
        let photometric = f64::from(emission.photometric());
        let spectra = [
            (emission, SpectrumRole::Emission),
            (Spectrum::rgb_albedo(self.rho), SpectrumRole::Reflectance),
        ];
        let lost = |rho: f64| if max_depth < 0 { 0.0 } else { rho.powi(max_depth + 1) };
        let radiance = |v: &[f64]| v[0] / photometric * (1.0 - lost(v[1])) / (1.0 - v[1]);
        let spp = if inside.contains("glass-") { 4 * SPP } else { SPP };
        check_uniform(name, &self.scene(max_depth, inside, shape), spp, |mode| {
            expected_rgb(mode, &spectra, radiance)
        });
    }
}

/// A box around the origin that lets nothing out; the normals point inwards.
const BOX: &str = "Shape \"trianglemesh\"
    \"integer indices\" [0 2 6 0 6 4  1 5 7 1 7 3  0 4 5 0 5 1  2 3 7 2 7 6  0 1 3 0 3 2  4 6 7 4 7 5]
    \"point3 P\" [-1.5 -2.5 -3.5  2 -2.5 -3.5  -1.5 3 -3.5  2 3 -3.5  -1.5 -2.5 4  2 -2.5 4  -1.5 3 4  2 3 4]";

#[test]
fn a_closed_box_has_its_radiance_everywhere() {
    Walls::GREY.check("grey box", -1, "", BOX);
    Walls::COLOURED.check("coloured box", -1, "", BOX);
    let turned = format!("Rotate 33 1 2 -3\n{BOX}");
    Walls::COLOURED.check("turned box", -1, "", &turned);
}

#[test]
fn a_closed_box_has_the_partial_sum_at_each_depth() {
    for depth in [0, 1, 2, 5] {
        let turned = format!("Rotate 33 1 2 -3\n{BOX}");
        Walls::COLOURED.check(&format!("box to depth {depth}"), depth, "", &turned);
    }
}

#[test]
fn a_closed_sphere_has_its_radiance_everywhere() {
    let shape = "ReverseOrientation\nTranslate 0.3 -0.4 0.5\nShape \"sphere\" \"float radius\" 2";
    Walls::GREY.check("grey sphere", -1, "", shape);
    Walls::COLOURED.check("coloured sphere", -1, "", shape);
    Walls::COLOURED.check("sphere to depth 1", 1, "", shape);
    // A transform that mirrors leaves the outside outside. (pbrt-v4 turns the normal of a hit there, but not that of a light sample.)
    let mirrored = "ReverseOrientation\nTranslate 0.3 -0.4 0.5\nScale -1 1 1\nShape \"sphere\" \"float radius\" 2";
    Walls::COLOURED.check("mirrored sphere", 1, "", mirrored);
}

/// What absorbs nothing changes nothing in a uniform field: glass, mirrors and white paint, each met by paths from the camera,
/// from walls, and between them and the light samples.
#[test]
fn what_loses_nothing_is_invisible_in_a_closed_box() {
    let sphere = |material: &str, radius: f64| {
        format!(
            "AttributeBegin\nMaterial {material}\nTranslate 0.2 0.1 1.4\nShape \"sphere\" \"float radius\" {radius}\nAttributeEnd"
        )
    };
    for (name, material) in [
        ("glass", "\"dielectric\" \"float eta\" 1.5"),
        ("an air bubble", "\"dielectric\" \"float eta\" 0.75"),
        ("dispersive glass", "\"dielectric\" \"spectrum eta\" \"glass-F11\""),
        ("a mirror", "\"conductor\" \"rgb reflectance\" [1 1 1]"),
        ("white paint", "\"diffuse\" \"rgb reflectance\" [1 1 1]"),
    ] {
        Walls::COLOURED.check(&format!("box with {name}"), -1, &sphere(material, 1.1), BOX);
    }
    // Seen from inside the glass radiance is eta² times as large.
    let around = "AttributeBegin\nMaterial \"dielectric\" \"float eta\" 1.5\nTranslate 0.2 0.1 0\n\
                  Shape \"sphere\" \"float radius\" 1.2\nAttributeEnd";
    let inside_glass = |v: f32| v / (1.5 * 1.5);
    let walls = Walls {
        e: E.map(inside_glass),
        rho: RHO,
    };
    let text = walls.scene(-1, around, BOX);
    let emission = Spectrum::rgb_illuminant(E);
    let photometric = f64::from(emission.photometric());
    let spectra = [
        (emission, SpectrumRole::Emission),
        (Spectrum::rgb_albedo(RHO), SpectrumRole::Reflectance),
    ];
    check_uniform("from inside glass", &text, SPP, |mode| {
        expected_rgb(mode, &spectra, |v| v[0] / photometric / (1.0 - v[1]))
    });
}
