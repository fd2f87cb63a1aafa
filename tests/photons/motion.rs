//! What moves: each pass has one time, the mean over passes is what `path` sees.

use lucerna::integrator::Integrator;
use lucerna::scene::ViewOverrides;
use lucerna::spectrum::ColorMode;

use crate::common::full_tier;
use crate::common::render::blocks;
use crate::{assert_agree, build, film, photon, quad, runs, sppm};

/// A diffuse ball and a ball of glass that move before a wall, under a large lamp, seen by a lens.
fn scene() -> String {
    format!(
        "LookAt 0 1 -4  0 0.8 0  0 1 0\nCamera \"perspective\" \"float fov\" 38 \"float shutteropen\" 0 \"float shutterclose\" 1 \"float lensradius\" 0.05 \"float focaldistance\" 4\n\
         {}WorldBegin\nAttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [3 2.7 2.4]\n{}AttributeEnd\n\
         Material \"diffuse\" \"rgb reflectance\" [0.6 0.6 0.5]\n{}{}\
         AttributeBegin ActiveTransform EndTime Translate 0.8 0.4 0 ActiveTransform All Translate -0.9 0.5 0\n\
         Material \"diffuse\" \"rgb reflectance\" [0.8 0.3 0.3] Shape \"sphere\" \"float radius\" 0.4 AttributeEnd\n\
         AttributeBegin ActiveTransform EndTime Translate 0 0.6 0 ActiveTransform All Translate 0.7 0.5 0\n\
         Material \"dielectric\" \"float eta\" 1.5 Shape \"sphere\" \"float radius\" 0.4 AttributeEnd\n",
        film([16, 8]),
        quad([-1.5, 3.0, -1.5], [3.0, 0.0, 0.0], [0.0, 0.0, 3.0]),
        quad([-3.0, 0.0, -3.0], [0.0, 0.0, 4.0], [6.0, 0.0, 0.0]),
        quad([-3.0, 0.0, 1.0], [0.0, 3.0, 0.0], [6.0, 0.0, 0.0]),
    )
}

#[test]
fn a_moving_scene_is_what_path_sees() {
    let built = build(&scene(), ColorMode::Rgb);
    let depth = Some(4);
    let path = Integrator::from_desc(&built.desc.integrator).with_max_depth(depth);
    let reference = runs(&built, path, 96, 101, [8, 8]);
    let two_pass = photon(depth, |p| {
        p.global_photons = Some(20_000);
        p.caustic_photons = Some(20_000);
        p.max_distance = Some(0.1);
        p.passes = 4;
        p.final_gather_samples = 4;
    });
    for integrator in [two_pass, sppm(depth, 4000, 0.12)] {
        // Two passes are the dearer, as each sample is a pass.
        if matches!(integrator, Integrator::Photon(_)) && !full_tier() {
            continue;
        }
        let ours = runs(&built, integrator, 32, 1, [8, 8]);
        assert_agree(integrator.name(), &ours, &reference, 0.01, 0.05);
    }
}

/// How often a profile rises above its mean from below half of that.
fn rises(profile: &[f64]) -> usize {
    let mean = profile.iter().sum::<f64>() / profile.len() as f64;
    let mut is_high = false;
    let mut count = 0;
    for &value in profile {
        if !is_high && value > mean {
            is_high = true;
            count += 1;
        } else if value < 0.5 * mean {
            is_high = false;
        }
    }
    count
}

/// A bright ball that flies twelve times its width: of eight passes, at random times in eighths of the exposure, most can be told apart;
/// 64 are one streak.
#[test]
fn a_fast_ball_leaves_no_ghosts() {
    let text = format!(
        "LookAt 0 0 -4  0 0 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [-1.5 1.5 -0.1 0.1] \"float shutteropen\" 0 \"float shutterclose\" 1\n\
         {}WorldBegin\n\
         AttributeBegin ActiveTransform EndTime Translate 2.4 0 0 ActiveTransform All Translate -1.2 0 0\n\
         AreaLightSource \"diffuse\" \"rgb L\" [3 3 3] Shape \"sphere\" \"float radius\" 0.1 AttributeEnd\n\
         Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n{}",
        film([120, 8]),
        quad([-2.0, -0.5, -2.0], [0.0, 0.0, 4.0], [4.0, 0.0, 0.0])
    );
    let built = build(&text, ColorMode::Rgb);
    let two_pass = photon(Some(3), |p| p.passes = 4);
    for integrator in [two_pass, sppm(Some(3), 1000, 0.1)] {
        let streaks = |passes: u32| {
            let overrides = ViewOverrides {
                spp: Some(passes),
                ..ViewOverrides::default()
            };
            let (picture, _) = built.picture_with(&built.view(0, &overrides), integrator);
            let columns = blocks(&picture, 120, [1, 8]);
            rises(&columns.iter().step_by(3).copied().collect::<Vec<_>>())
        };
        let (few, many) = (streaks(8), streaks(64));
        assert!(few >= 5 && many == 1, "{}: {few}, {many}", integrator.name());
    }
}
