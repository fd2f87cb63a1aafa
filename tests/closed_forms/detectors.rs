//! What a film makes of light: the irradiance of its pixels, its sensor, its colour space.

use lucerna::desc::ColorSpace;
use lucerna::spectrum::{Spectrum, cie, daylight};

use super::common::render::Judge;
use super::{check, check_uniform, grey};
use lucerna::spectrum::ColorMode;

/// A camera and a film of 8 x 8 pixels in a white sky.
fn sky(camera: &str, film: &str) -> String {
    format!(
        "Camera {camera}\nFilm \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8 {film}\nPixelFilter \"box\"\n\
         Sampler \"sobol\"\nIntegrator \"path\" \"integer maxdepth\" 0\nWorldBegin\n\
         LightSource \"infinite\" \"rgb L\" [1 1 1]\n"
    )
}

/// The irradiance of a white sky through the rectangle [x0, x1] x [y0, y1] of the plane at depth 1: the integral of cos⁴ over it, or
/// of dx dy / (1 + x² + y²)². Inside, by x: (x / (1 + x² + y²) + atan(x / s) / s) / (2 s²) with s² = 1 + y²; by y in 2000 steps.
fn through([x0, x1]: [f64; 2], [y0, y1]: [f64; 2]) -> f64 {
    const STEPS: usize = 2000;
    let inner = |x: f64, y: f64| {
        let s = (1.0 + y * y).sqrt();
        (x / (s * s + x * x) + (x / s).atan() / s) / (2.0 * s * s)
    };
    let step = (y1 - y0) / STEPS as f64;
    let at = |i: usize| y0 + (i as f64 + 0.5) * step;
    (0..STEPS).map(|i| (inner(x1, at(i)) - inner(x0, at(i))) * step).sum()
}

/// Cos⁴ varies little over a pixel; what noise there is comes from the wavelengths.
const PIXELS: Judge = Judge { power: (0.05, 0.005) };

#[test]
fn the_irradiance_of_a_pinhole_is_the_cosine_over_the_pixels_solid_angle() {
    for fov in [20.0, 90.0, 130.0] {
        let side = f64::tan(0.5 * f64::to_radians(fov));
        let cell = |i: usize| [-side + 0.25 * side * i as f64, -side + 0.25 * side * (i + 1) as f64];
        let expected = grey((0..64).map(|i| through(cell(i % 8), cell(i / 8))));
        let text = sky(
            &format!("\"perspective\" \"float fov\" {fov}"),
            "\"string measure\" \"irradiance\"",
        );
        check(
            &format!("pinhole of {fov} degrees"),
            &text,
            256,
            [1, 1],
            &PIXELS,
            |_| expected.clone(),
        );
    }
    // All pixels together: the irradiance through a square. For 90 degrees it is known: 4 atan(1 / sqrt 2) / sqrt 2.
    let all = through([-1.0, 1.0], [-1.0, 1.0]);
    assert!((all - 4.0 * (0.5_f64.sqrt()).atan() / 2.0_f64.sqrt()).abs() < 1e-6);
}

#[test]
fn the_irradiance_of_parallel_rays_is_the_pixels_area() {
    let camera = "\"orthographic\" \"float screenwindow\" [-3 1 -0.5 1.5]";
    let text = sky(camera, "\"string measure\" \"irradiance\"");
    check_uniform("orthographic", &text, 16, |_| [4.0 * 2.0 / 64.0; 3]);
}

/// A ray from the point l of the lens to the point of the plane of focus behind s: its direction is (s - l / f, 1), so the pixel's
/// window is moved by l / f.
#[test]
fn the_irradiance_of_a_lens_is_the_mean_over_its_points() {
    const RADIUS: f64 = 0.6;
    const FOCUS: f64 = 1.5;
    let cell = |i: usize| [-1.0 + 0.25 * i as f64, -1.0 + 0.25 * (i + 1) as f64];
    // A square lens: corners on the circle, turned so that its sides are along the axes.
    let half = RADIUS / 2.0_f64.sqrt() / FOCUS;
    const STEPS: usize = 16;
    let points: Vec<f64> = (0..STEPS)
        .map(|i| half * (2.0 * (i as f64 + 0.5) / STEPS as f64 - 1.0))
        .collect();
    let moved = |[a, b]: [f64; 2], by: f64| [a - by, b - by];
    // The midpoint rule over the lens and over the pixel: cos⁴ is smooth.
    let mean = |x: [f64; 2], y: [f64; 2]| {
        let mut sum = 0.0;
        for &lx in &points {
            for &ly in &points {
                sum += coarse(moved(x, lx), moved(y, ly));
            }
        }
        sum / (STEPS * STEPS) as f64
    };
    let expected = grey((0..64).map(|i| mean(cell(i % 8), cell(i / 8))));
    let text = sky(
        &format!(
            "\"perspective\" \"float fov\" 90 \"float lensradius\" {RADIUS} \"float focaldistance\" {FOCUS} \
             \"integer blades\" 4 \"float bladerotation\" 45"
        ),
        "\"string measure\" \"irradiance\"",
    );
    check("square lens", &text, 1024, [1, 1], &PIXELS, |_| expected.clone());

    // Parallel rays through a round lens: directions (-l / f, 1), the mean of their cosine times the pixel's area. Over a disk of radius
    // a = R / f the mean of 1 / sqrt(1 + r²) is 2 (sqrt(1 + a²) - 1) / a².
    let a = RADIUS / FOCUS;
    let cosine = 2.0 * ((1.0 + a * a).sqrt() - 1.0) / (a * a);
    let text = sky(
        &format!("\"orthographic\" \"float lensradius\" {RADIUS} \"float focaldistance\" {FOCUS}"),
        "\"string measure\" \"irradiance\"",
    );
    check_uniform("orthographic lens", &text, 256, |_| [cosine / 16.0; 3]);
}

/// [`through`] by the midpoint rule in few steps.
fn coarse([x0, x1]: [f64; 2], [y0, y1]: [f64; 2]) -> f64 {
    const STEPS: usize = 8;
    let at = |a: f64, b: f64, i: usize| a + (b - a) * (i as f64 + 0.5) / STEPS as f64;
    let cell = (x1 - x0) * (y1 - y0) / (STEPS * STEPS) as f64;
    let value = |i: usize| (1.0 + at(x0, x1, i % STEPS).powi(2) + at(y0, y1, i / STEPS).powi(2)).powi(-2);
    (0..STEPS * STEPS).map(|i| cell * value(i)).sum()
}

/// Radiance, the default, does not care for any of this.
#[test]
fn the_radiance_of_a_white_sky_is_one() {
    let lens =
        "\"perspective\" \"float fov\" 100 \"float lensradius\" 0.5 \"float focaldistance\" 2 \"integer blades\" 5";
    for film in ["", "\"string measure\" \"radiance\""] {
        check_uniform(film, &sky(lens, film), 16, |_| [1.0; 3]);
    }
}

/// The sky's white in the picture's space: (1, 1, 1) where that is D65, else what the matrices say, in both modes.
#[test]
fn pictures_are_in_the_color_space_of_the_film() {
    for space in ColorSpace::ALL {
        let text = format!(
            "ColorSpace \"{}\"\n{}",
            space.name(),
            sky("\"perspective\"", "").replace("WorldBegin", "ColorSpace \"srgb\"\nWorldBegin")
        );
        let text = text.replace("[1 1 1]", "[0.9 0.5 0.2]");
        let expected = space.xyz_to_rgb(cie::srgb_to_xyz([0.9, 0.5, 0.2]));
        check_uniform(space.name(), &text, 256, |_| expected);
        // And colours that are given in it are seen again.
        let text = format!("ColorSpace \"{}\"\n{}", space.name(), sky("\"perspective\"", ""));
        let text = text.replace("[1 1 1]", "[0.6 0.5 0.4]");
        check_uniform(&format!("{} throughout", space.name()), &text, 256, |_| [0.6, 0.5, 0.4]);
    }
}

/// Daylight of the temperature that the film is balanced for is white, seen by the observer and by a camera.
#[test]
fn a_balanced_film_sees_its_daylight_as_white() {
    let kelvin = 4300.0;
    let light = daylight(kelvin);
    let samples: Vec<String> = (360..=830)
        .map(|nm| format!("{nm} {}", light.value(nm as f32)))
        .collect();
    let world = format!("\"spectrum L\" [{}]", samples.join(" "));
    for (sensor, judge) in [("cie1931", Judge { power: (0.05, 0.005) }), ("nikon_d850", CAMERA)] {
        let film = format!("\"string sensor\" \"{sensor}\" \"float whitebalance\" {kelvin}");
        let text = sky("\"perspective\"", &film).replace("\"rgb L\" [1 1 1]", &world);
        let expected = |mode| {
            let white = match (mode, sensor) {
                // The fit is to patches that reflect: white is off by what it leaves.
                (ColorMode::Spectral, "nikon_d850") => camera_white(sensor, kelvin, &light),
                _ => [1.0; 3],
            };
            [white; 4].concat()
        };
        check(sensor, &text, 512, [4, 4], &judge, expected);
    }
}

const CAMERA: Judge = Judge { power: (0.05, 0.005) };

/// What a camera makes of a light of luminance 1, without noise.
fn camera_white(name: &str, kelvin: f64, light: &Spectrum) -> [f64; 3] {
    use lucerna::film::{Sensor, SensorSpec};
    use lucerna::spectrum::{SampledSpectrum, Wavelengths, sensor_curves};
    let sensor = Sensor::new(
        ColorMode::Spectral,
        &SensorSpec {
            curves: sensor_curves(name),
            white_balance: Some(kelvin),
            color_space: ColorSpace::Srgb,
            imaging_ratio: 1.0 / f64::from(cie::y_integral()),
            max_component: f64::INFINITY,
        },
    )
    .expect("a camera");
    const STEPS: usize = 1 << 13;
    let mut sum = [0.0; 3];
    for i in 0..STEPS {
        let lambda = Wavelengths::sample_visible((i as f32 + 0.5) / STEPS as f32);
        let l = SampledSpectrum(lambda.lambda.map(|nm| light.value(nm)));
        for (sum, c) in sum.iter_mut().zip(sensor.to_rgb(l, &lambda)) {
            *sum += f64::from(c) / STEPS as f64;
        }
    }
    // White it is, as nearly as a camera can.
    assert!(sum.iter().all(|c| (c - 1.0).abs() < 0.05), "{sum:?}");
    sum
}
