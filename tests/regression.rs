//! A test for each bug that was found, by name.

mod common;

use common::render::{Built, combinations, parse};
use lucerna::material::fresnel_complex;
use lucerna::scene::ViewOverrides;

/// Planes through the coordinate origin were black: the offset of a ray that leaves a surface was relative to the position, so
/// there it was 0 and the ray met its own plane again.
#[test]
fn planes_through_the_origin_do_not_shadow_themselves() {
    for [right, away, up] in [
        ["1 0 0", "0 0 1", "0 1 0"],
        ["0 1 0", "1 0 0", "0 0 1"],
        ["0 0 1", "0 1 0", "1 0 0"],
    ] {
        let text = format!(
            "LookAt {eye}  0 0 0  {away}\n\
             Camera \"orthographic\"\n\
             Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\n\
             PixelFilter \"box\" Sampler \"sobol\" \"integer pixelsamples\" 16 Integrator \"path\" \"integer maxdepth\" 1\n\
             WorldBegin\n\
             LightSource \"point\" \"rgb I\" [ 10 10 10 ] \"point3 from\" [ {light} ]\n\
             Material \"diffuse\" \"rgb reflectance\" [ 0.5 0.5 0.5 ]\n\
             Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 0 2 3 ] \"point3 P\" [ {a} {b} {c} {d} ]\n",
            eye = along(&[(up, 5.0)]),
            light = along(&[(up, 2.0)]),
            a = along(&[(right, -3.0), (away, -3.0)]),
            b = along(&[(right, 3.0), (away, -3.0)]),
            c = along(&[(right, 3.0), (away, 3.0)]),
            d = along(&[(right, -3.0), (away, 3.0)]),
        );
        for (backend, color) in combinations() {
            let built = Built::new(parse(&text), backend, color);
            let picture = built.picture(&built.view(0, &ViewOverrides::default()));
            for (i, pixel) in picture.chunks_exact(3).enumerate() {
                // rho / pi I cos / d² at the middle of a pixel; its mean over the pixel is within 1 % of that.
                let at = |i: usize| (i as f32 + 0.5) / 4.0 - 1.0;
                let d2 = 4.0 + at(i % 8).powi(2) + at(i / 8).powi(2);
                let expected = 0.5 / std::f32::consts::PI * 10.0 * 2.0 / d2.powf(1.5);
                let error = pixel[1] / expected - 1.0;
                assert!(
                    error.abs() < 0.02,
                    "{backend} {color:?} up {up}, pixel {i}: {pixel:?}, not {expected}"
                );
            }
        }
    }
}

/// The sum of axes, given as text, times lengths.
fn along(parts: &[(&str, f32)]) -> String {
    let mut sum = [0.0; 3];
    for (axis, length) in parts {
        for (sum, component) in sum.iter_mut().zip(axis.split(' ')) {
            *sum += length * component.parse::<f32>().expect("an axis");
        }
    }
    format!("{} {} {}", sum[0], sum[1], sum[2])
}

/// A metal in rgb mode has an index of 0 in the fourth lane; head on its reflectance was 0 / 0, and the sample was dropped.
#[test]
fn metals_reflect_a_finite_part_in_the_unused_lane_of_rgb_mode() {
    assert!(fresnel_complex(1.0, 0.0, 0.0).is_finite());
}
