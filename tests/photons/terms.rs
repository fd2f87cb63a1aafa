//! The table of path expressions: every path belongs to one term. What terms add up to is held against `path`, in rooms where it finds
//! all light; and rooms where only one kind of path exists show it in one term only.

use lucerna::desc::{Term, Terms};
use lucerna::integrator::Integrator;
use lucerna::scene::ViewOverrides;
use lucerna::spectrum::ColorMode;

use crate::common::full_tier;
use crate::common::render::{Built, MODES};
use crate::{assert_agree, build, film, photon, quad, runs, sppm};

const TERMS: [Term; 4] = [Term::Direct, Term::Specular, Term::Caustic, Term::Indirect];

fn only(integrator: Integrator, terms: &[Term]) -> Integrator {
    let terms = terms.iter().fold(Terms::NONE, |terms, &term| terms.with(term));
    integrator.with_terms(terms).expect("an integrator with terms")
}

fn named(built: &Built, name: &str, max_depth: Option<u32>) -> Integrator {
    Integrator::from_desc(&built.desc.integrator)
        .named(name)
        .with_max_depth(max_depth)
}

/// A room, open towards the camera, under a large lamp, with some things in it.
fn room(things: &str) -> String {
    let walls = [
        quad([-1.5, 0.0, -1.5], [0.0, 0.0, 3.0], [3.0, 0.0, 0.0]),
        quad([-1.5, 0.0, 1.5], [0.0, 2.0, 0.0], [3.0, 0.0, 0.0]),
        quad([-1.5, 0.0, -1.5], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]),
        quad([1.5, 0.0, -1.5], [0.0, 0.0, 3.0], [0.0, 2.0, 0.0]),
    ];
    format!(
        "LookAt 0 1 -4  0 0.9 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\n{}WorldBegin\n\
         AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [3 2.7 2.4]\nMaterial \"diffuse\" \"rgb reflectance\" [0.2 0.2 0.2]\n{}AttributeEnd\n\
         Material \"diffuse\" \"rgb reflectance\" [0.6 0.5 0.4]\n{}{things}",
        film([16, 8]),
        quad([-1.2, 2.0, -1.2], [2.4, 0.0, 0.0], [0.0, 0.0, 2.4]),
        walls.concat()
    )
}

fn ball(x: f64, material: &str) -> String {
    format!(
        "AttributeBegin Material {material} Translate {x} 0.55 0 Shape \"sphere\" \"float radius\" 0.5 AttributeEnd\n"
    )
}

/// Everything that is told apart: smooth and rough specular surfaces, coats, mixtures, what is not specular.
fn rooms() -> Vec<(&'static str, String)> {
    let two = |a: &str, b: &str| ball(-0.65, a) + &ball(0.65, b);
    vec![
        (
            "diffuse and glossy",
            two(
                r#""diffuse" "rgb reflectance" [0.8 0.7 0.3]"#,
                r#""conductor" "float roughness" 0.3"#,
            ),
        ),
        (
            "glass and mirror",
            two(
                r#""dielectric" "float eta" 1.5"#,
                r#""conductor" "rgb reflectance" [0.9 0.8 0.7]"#,
            ),
        ),
        (
            "polished",
            two(
                r#""dielectric" "float roughness" 0.05 "bool remaproughness" false"#,
                r#""conductor" "rgb reflectance" [0.9 0.8 0.7] "float roughness" 0.08 "bool remaproughness" false"#,
            ),
        ),
        (
            "coats",
            two(
                r#""coateddiffuse" "rgb reflectance" [0.6 0.4 0.2] "float roughness" 0"#,
                r#""principled" "rgb base_color" [0.7 0.5 0.3] "float roughness" 0.3 "float spec_trans" 0.5"#,
            ),
        ),
    ]
}

/// Two-pass and progressive, so that their bias stays below a percent of the picture: circles reach over an edge by 0.17 of their radius in the mean.
fn both(max_depth: Option<u32>) -> [(Integrator, u32); 2] {
    let two_pass = photon(max_depth, |p| {
        p.global_photons = Some(10_000);
        p.caustic_photons = Some(3000);
        p.max_distance = Some(0.1);
        p.passes = 4;
        p.final_gather_samples = 4;
    });
    [(two_pass, 8), (sppm(max_depth, 10_000, 0.1), 12)]
}

#[test]
fn all_terms_together_are_what_path_finds() {
    for (name, things) in rooms() {
        // The others are in the full tier only.
        if !matches!(name, "glass and mirror" | "coats") && !full_tier() {
            continue;
        }
        let built = build(&room(&things), ColorMode::Rgb);
        let depth = Some(4);
        let reference = runs(&built, named(&built, "path", depth), 96, 101, [8, 8]);
        for (integrator, spp) in both(depth) {
            // Each room by one of them, where it has shown mistakes.
            if !full_tier() && (name == "coats") == matches!(integrator, Integrator::Sppm(_)) {
                continue;
            }
            let name = format!("{name} by {}", integrator.name());
            let ours = runs(&built, integrator, spp, 1, [8, 8]);
            assert_agree(&name, &ours, &reference, 0.01, 0.05);
        }
    }
}

/// The parts of one picture add up to it. In `photon` directions serve indirect and direct light together, so that either alone is drawn
/// otherwise: there each other part is seen beside the indirect one.
#[test]
fn terms_add_up_to_the_picture() {
    let things = ball(-0.65, r#""dielectric" "float eta" 1.5"#)
        + &ball(
            0.65,
            r#""coateddiffuse" "rgb reflectance" [0.6 0.4 0.2] "float roughness" 0"#,
        );
    for color in MODES {
        let built = build(&room(&things), color);
        let [(two_pass, _), (progressive, _)] = both(Some(5));
        for (integrator, base) in [(two_pass, &[Term::Indirect][..]), (progressive, &[])] {
            let overrides = ViewOverrides {
                spp: Some(4),
                seed: 3,
                ..ViewOverrides::default()
            };
            let view = built.view(0, &overrides);
            let render = |terms: &[Term]| built.picture_with(&view, only(integrator, terms)).0;
            let whole = render(&TERMS);
            let background = render(base);
            let mut sums: Vec<f64> = background.iter().map(|&v| f64::from(v)).collect();
            let mut sizes = vec![0.0_f64; sums.len()];
            for term in TERMS.into_iter().filter(|term| !base.contains(term)) {
                let part = render(&[base, &[term]].concat());
                let difference = part.iter().zip(&background).map(|(&a, &b)| f64::from(a) - f64::from(b));
                let mut total = 0.0;
                for ((sum, size), v) in sums.iter_mut().zip(&mut sizes).zip(difference) {
                    *sum += v;
                    *size += v.abs();
                    total += v;
                }
                assert!(total > 0.1, "{term:?} shows next to nothing: {total}");
            }
            for (i, &value) in whole.iter().enumerate() {
                let far = (f64::from(value) - sums[i]).abs();
                let allowed = 1e-5 * (sizes[i] + f64::from(background[i].abs())) + 1e-6;
                assert!(far <= allowed, "value {i}: {value}, and {} by terms", sums[i]);
            }
        }
    }
}

/// Which terms of an integrator show anything.
fn shown(built: &Built, integrator: Integrator) -> Vec<Term> {
    let overrides = ViewOverrides {
        spp: Some(4),
        ..ViewOverrides::default()
    };
    let view = built.view(0, &overrides);
    let shows = |term: &Term| {
        let (picture, _) = built.picture_with(&view, only(integrator, &[*term]));
        picture.iter().any(|&v| v != 0.0)
    };
    TERMS.into_iter().filter(shows).collect()
}

/// Rooms that have one kind of path beside the lamp that is seen.
#[test]
fn each_kind_of_path_shows_in_its_term_only() {
    let floor = |material: &str| {
        let quad = quad([-2.0, 0.0, -2.0], [0.0, 0.0, 4.0], [4.0, 0.0, 0.0]);
        format!("Material {material}\n{quad}")
    };
    let seen_from = |eye: &str, things: &str| {
        format!(
            "LookAt {eye}\nCamera \"perspective\" \"float fov\" 30\n{}WorldBegin\n\
             AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [3 3 3]\nMaterial \"diffuse\" \"rgb reflectance\" [0 0 0]\n{}AttributeEnd\n{things}",
            film([12, 8]),
            quad([-1.0, 2.0, -1.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0])
        )
    };
    // Steep enough to see the lamp in the floor.
    let open = |things: &str| seen_from("0 1.8 -0.6  0 0 0  0 1 0", things);
    let white = r#""diffuse" "rgb reflectance" [0.8 0.8 0.8]"#;
    let mirror = r#""conductor" "rgb reflectance" [0.8 0.8 0.8]"#;
    let polished = r#""conductor" "float roughness" 0.08 "bool remaproughness" false"#;
    let glossy = r#""conductor" "float roughness" 0.3 "bool remaproughness" false"#;
    let wall = quad([-2.0, 0.0, 2.0], [0.0, 2.0, 0.0], [4.0, 0.0, 0.0]);
    // A board between the lamp and the floor, a mirror beside it.
    let around = format!(
        "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n{}Material {mirror}\n{}",
        quad([-1.6, 1.2, -1.6], [0.0, 0.0, 3.2], [3.2, 0.0, 0.0]),
        quad([2.0, 0.0, -2.0], [0.0, 0.0, 4.0], [0.0, 3.0, 0.0])
    );
    let cases = [
        ("a white floor", 5, open(&floor(white)), vec![Term::Direct]),
        ("a glossy floor", 5, open(&floor(glossy)), vec![Term::Direct]),
        ("a mirror", 5, open(&floor(mirror)), vec![Term::Specular]),
        ("a polished floor", 5, open(&floor(polished)), vec![Term::Specular]),
        (
            "a white room",
            5,
            open(&(floor(white) + &wall)),
            vec![Term::Direct, Term::Indirect],
        ),
        (
            "a floor lit by way of a mirror",
            2,
            seen_from("0 1 -3  0 0.3 0  0 1 0", &(floor(white) + &around)),
            vec![Term::Caustic],
        ),
    ];
    for (name, depth, text, expected) in cases {
        let built = build(&text, ColorMode::Rgb);
        let path = named(&built, "path", Some(depth));
        // What is simple is left to other tests.
        let is_judged = full_tier() || name.contains("polished") || name.contains("way of");
        let reference = if is_judged {
            runs(&built, path, 64, 101, [6, 8])
        } else {
            Vec::new()
        };
        for (integrator, spp) in both(Some(depth)) {
            let name = format!("{name} by {}", integrator.name());
            assert_eq!(shown(&built, integrator), expected, "{name}");
            if reference.is_empty() {
                continue;
            }
            let ours = runs(&built, integrator, spp, 1, [6, 8]);
            // A path that is counted twice, or never, is half or all of what is seen.
            assert_agree(&name, &ours, &reference, 0.01, 0.4);
        }
    }
}
