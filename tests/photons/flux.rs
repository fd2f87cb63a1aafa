//! Closed rooms whose walls emit e and reflect rho: the photons of all orders bring e / (1 - rho), however far they are looked for.

use lucerna::spectrum::{ColorMode, Spectrum, SpectrumRole};

use crate::common::full_tier;
use crate::common::render::{Built, expected_rgb, parse, usual_combinations};
use crate::{assert_exact, film, photon, runs, sppm};

const E: [f32; 3] = [0.9, 0.6, 0.3];
const RHO: [f32; 3] = [0.2, 0.5, 0.7];

fn room(fov: f64, shape: &str) -> String {
    let [e, rho] = [E, RHO].map(|[r, g, b]| format!("{r} {g} {b}"));
    format!(
        "Camera \"perspective\" \"float fov\" {fov}\n{}WorldBegin\nAreaLightSource \"diffuse\" \"rgb L\" [{e}]\n\
         Material \"diffuse\" \"rgb reflectance\" [{rho}]\n{shape}",
        film([4, 4])
    )
}

/// The part of a disk of a sphere that lies within a distance from its middle is the square of that distance: density
/// estimation is exact there.
const SPHERE: &str = "ReverseOrientation\nTranslate 0.3 -0.4 0.5\nShape \"sphere\" \"float radius\" 2";

const BOX: &str = "Shape \"trianglemesh\"
    \"integer indices\" [0 2 6 0 6 4  1 5 7 1 7 3  0 4 5 0 5 1  2 3 7 2 7 6  0 1 3 0 3 2  4 6 7 4 7 5]
    \"point3 P\" [-1.5 -2.5 -3.5  2 -2.5 -3.5  -1.5 3 -3.5  2 3 -3.5  -1.5 -2.5 4  2 -2.5 4  -1.5 3 4  2 3 4]";

/// e (1 + rho + ... + rho^depth), in the part `share(rho)` of which light of more than one bounce is found.
fn radiance(mode: ColorMode, depth: Option<i32>, found: impl Fn(f64) -> f64) -> [f64; 3] {
    let emission = Spectrum::rgb_illuminant(E);
    let photometric = f64::from(emission.photometric());
    let spectra = [
        (emission, SpectrumRole::Emission),
        (Spectrum::rgb_albedo(RHO), SpectrumRole::Reflectance),
    ];
    expected_rgb(mode, &spectra, |v| {
        let lost = depth.map_or(0.0, |depth| v[1].powi(depth + 1));
        let once = 1.0 + v[1];
        v[0] / photometric * (once + found(v[1]) * ((1.0 - lost) / (1.0 - v[1]) - once))
    })
}

/// What error is noticed: eight passes have few wavelengths.
fn power(color: ColorMode) -> f64 {
    match color {
        ColorMode::Rgb => 0.03,
        ColorMode::Spectral => 0.1,
    }
}

fn whole(_: f64) -> f64 {
    1.0
}

#[test]
fn a_closed_sphere_has_its_radiance() {
    for (i, (backend, color)) in usual_combinations("sphere").enumerate() {
        let built = Built::new(parse(&room(100.0, SPHERE)), backend, color);
        for depth in [None, Some(3)] {
            let expected = radiance(color, depth.map(u32::cast_signed), whole);
            let two_pass = photon(depth, |p| {
                p.global_photons = Some(4000);
                // Some three photons an estimate: no precomputed irradiance is near many points.
                p.max_distance = Some(0.1);
                p.passes = 8;
                p.final_gather_samples = 4;
            });
            for (name, integrator) in [("photon", two_pass), ("sppm", sppm(depth, 4000, 0.5))] {
                // In the normal tier each integrator meets one depth with each backend and colour mode.
                let is_other = (name == "photon") == (depth.is_some() == (i % 2 == 0));
                if !full_tier() && is_other {
                    continue;
                }
                let runs = runs(&built, integrator, 8, 1, [4, 4]);
                let name = format!("{name} to depth {depth:?}, {backend}, {color:?}");
                assert_exact(&name, &runs, &expected, 1e-3, power(color));
            }
        }
    }
}

/// The camera sees the middle of a wall only, where no circle reaches an edge: `sppm` has no bias there. In `photon` the gather
/// rays meet all walls; near edges a part of the circle is empty.
#[test]
fn a_closed_box_has_its_radiance_away_from_edges() {
    const RADIUS: f64 = 0.2;
    for (backend, color) in usual_combinations("box") {
        let built = Built::new(parse(&room(30.0, BOX)), backend, color);
        let progressive = runs(&built, sppm(None, 8000, 0.8), 8, 1, [4, 4]);
        assert_exact(
            &format!("sppm, {backend}, {color:?}"),
            &progressive,
            &radiance(color, None, whole),
            1e-3,
            power(color),
        );
        let two_pass = photon(None, |p| {
            p.global_photons = Some(20_000);
            p.used = 1000;
            p.max_distance = Some(RADIUS as f32);
            p.passes = 8;
            p.final_gather_samples = 4;
        });
        let expected = radiance(color, None, |_| 1.0 - edge_loss(RADIUS));
        // The loss itself is half a percent of the picture at most.
        assert_exact(
            &format!("photon, {backend}, {color:?}"),
            &runs(&built, two_pass, 8, 1, [4, 4]),
            &expected,
            2e-3,
            power(color),
        );
    }
}

/// The part of the photons' light that the circles of a radius lose over the edges of the box: where x is the distance from an edge
/// the cone filter misses P(X > x), X being an offset drawn from it; that is E[max(X, 0)] = E[s] / pi by length of the edge, twice
/// for its two sides.
fn edge_loss(radius: f64) -> f64 {
    let k = 1.1;
    let mean = (2.0 / 3.0 - 1.0 / (2.0 * k)) / (1.0 - 2.0 / (3.0 * k));
    let [a, b, c] = [3.5, 5.5, 7.5];
    let (edges, area) = (4.0 * (a + b + c), 2.0 * (a * b + b * c + c * a));
    2.0 * edges / area * radius * mean / std::f64::consts::PI
}
