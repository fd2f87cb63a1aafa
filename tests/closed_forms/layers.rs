//! What a film keeps beside colours: the surfaces seen first, and radiance by wavelength.

use lucerna::accel::Backend;
use lucerna::film::Film;
use lucerna::integrator::{Integrator, Silent};
use lucerna::scene::ViewOverrides;
use lucerna::spectrum::{ColorMode, Outside, Spectrum, cie};

use super::common::render::{Built, MODES, combinations, parse};

/// A film of 8 x 8 pixels with its layers, rendered on so many threads.
fn film(text: &str, backend: Backend, mode: ColorMode, threads: usize) -> Film {
    let built = Built::new(parse(text), backend, mode);
    let view = built.view(0, &ViewOverrides::default());
    let integrator = Integrator::from_desc(&built.desc.integrator);
    let film = view.with_layers(integrator.film(&view), &built.scene);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .expect("threads");
    let stats = pool.install(|| integrator.render(&built.scene, &view, &film, &Silent));
    assert_eq!((stats.dropped_samples, film.dropped_surfaces()), (0, 0));
    film
}

/// The values of a layer by pixel.
fn layer(film: &Film, name: &str) -> Vec<f64> {
    let channels = film.layer_channels();
    let index = channels
        .iter()
        .position(|channel| channel == name)
        .unwrap_or_else(|| panic!("no {name}"));
    let values = film.develop_layers();
    values
        .iter()
        .skip(index)
        .step_by(channels.len())
        .map(|&v| f64::from(v))
        .collect()
}

/// The plane z = 5 + x / 2 before a camera at the origin, as far as x = 3: to the right of that nothing is seen.
fn plane(film: &str, integrator: &str) -> String {
    format!(
        "Camera \"perspective\" \"float fov\" 90
        Film \"gbuffer\" \"integer xresolution\" 8 \"integer yresolution\" 8 {film} PixelFilter \"box\"
        Sampler \"sobol\" \"integer pixelsamples\" 64 Integrator \"{integrator}\" \"integer maxdepth\" 2 WorldBegin
        LightSource \"infinite\" \"rgb L\" [1 1 1]
        Material \"diffuse\" \"rgb reflectance\" [.2 .5 .8]
        Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point2 uv\" [-9 -99 3 -99 3 99 -9 99]
            \"point3 P\" [-9 -99 .5  3 -99 6.5  3 99 6.5  -9 99 .5]"
    )
}

/// The column where the plane ends: at x / z = 3 / 6.5, which is 5.85 of 8 pixels.
const LAST: usize = 5;

#[test]
fn surfaces_are_where_they_are() {
    for (backend, mode) in combinations() {
        let film = film(&plane("", "path"), backend, mode, 2);
        let of = |name| layer(&film, name);
        let (x, z, n, ns) = (of("P.X"), of("P.Z"), of("N.X"), of("Ns.Z"));
        let (u, dzdx, dzdy) = (of("u"), of("dzdx"), of("dzdy"));
        for pixel in 0..64 {
            let column = pixel % 8;
            if column > LAST {
                assert_eq!([x[pixel], z[pixel], n[pixel], u[pixel]], [0.0; 4]);
                continue;
            }
            // Positions lie on the plane, and so do their means; here u is x.
            assert!((z[pixel] - 5.0 - 0.5 * x[pixel]).abs() < 1e-5);
            assert!((u[pixel] - x[pixel]).abs() < 1e-4);
            let root = 1.25_f64.sqrt();
            assert!((n[pixel] - 0.5 / root).abs() < 1e-6 && (ns[pixel] + 1.0 / root).abs() < 1e-6);
            if column < LAST {
                // z is 5 / (1 - s / 2) at the slope s of a ray; a pixel is a quarter wide.
                let at = |s: f64| 5.0 / (1.0 - 0.5 * s);
                let left = -1.0 + 0.25 * column as f64;
                let mean = (0..64).map(|i| left + 0.25 * (f64::from(i) + 0.5) / 64.0);
                let change = mean.map(|s| at(s + 0.125) - at(s - 0.125)).sum::<f64>() / 64.0;
                assert!(
                    (dzdx[pixel] / change - 1.0).abs() < 2e-3,
                    "{} and {change}",
                    dzdx[pixel]
                );
                assert!(dzdy[pixel].abs() < 1e-4);
            }
        }
    }
}

#[test]
fn albedos_and_variances_are_those_of_the_surface() {
    for mode in MODES {
        let film = film(&plane("", "path"), Backend::default(), mode, 2);
        let inside = |name| layer(&film, name).into_iter().enumerate().filter(|(i, _)| i % 8 < LAST);
        for (name, expected) in [("Albedo.R", 0.2), ("Albedo.G", 0.5), ("Albedo.B", 0.8)] {
            let (sum, count) = inside(name).fold((0.0, 0.0), |(sum, n), (_, v)| (sum + v, n + 1.0));
            // Half of a percent of it: noise of wavelengths over some 10000 samples.
            assert!(
                (sum / count - expected).abs() < 5e-3,
                "{name}, {mode:?}: {}",
                sum / count
            );
        }
        // The mean of what samples bring is the albedo, so that the one is twice the other.
        let ratios = inside("RelativeVariance.G")
            .zip(inside("Variance.G"))
            .map(|((_, a), (_, b))| b / a);
        let ratios: Vec<f64> = ratios.collect();
        assert!(
            ratios.iter().all(|mean| (mean - 0.5).abs() < 0.2),
            "{mode:?}: {ratios:?}"
        );
        // Half of the pixels of the last column's samples see the plane: there the albedo is a share of it.
        let part = layer(&film, "Albedo.B")[LAST];
        assert!(part > 0.5 && part < 0.75, "{part}");
    }
}

#[test]
fn world_space_is_that_of_the_scene() {
    let turned = plane("\"string coordinatesystem\" \"world\"", "path")
        .replace("Camera", "Rotate 180 0 0 1 Translate 0 0 2 Camera");
    let film = film(&turned, Backend::default(), ColorMode::Rgb, 1);
    let (x, z, n) = (layer(&film, "P.X"), layer(&film, "P.Z"), layer(&film, "N.Z"));
    // The picture is upside down: the plane ends on the left.
    assert_eq!((z[0], n[0]), (0.0, 0.0));
    assert!((z[7] - 5.0 - 0.5 * x[7]).abs() < 1e-5 && z[7] > 1.0 && n[7] < -0.8);
}

#[test]
fn layers_have_the_same_bits_on_any_number_of_threads_and_with_any_integrator() {
    let layers = |threads, integrator: &str| {
        let film = film(&plane("", integrator), Backend::default(), ColorMode::Spectral, threads);
        (film.develop(), film.develop_layers())
    };
    let one = layers(1, "path");
    assert_eq!(one, layers(3, "path"));
    // Surfaces are the same to all.
    let of_others = ["bdpt", "kajiya", "sppm"].map(|integrator| layers(2, integrator).1);
    for other in of_others {
        for (pixel, (a, b)) in one.1.chunks(22).zip(other.chunks(22)).enumerate() {
            assert_eq!(a[3..16], b[3..16], "pixel {pixel}");
        }
    }
}

#[test]
fn a_spectral_film_has_the_radiance_of_each_part_of_the_spectrum() {
    let text = "Camera \"perspective\" Film \"spectral\" \"integer xresolution\" 8 \"integer yresolution\" 8 \"integer nbuckets\" 8
        \"float lambdamin\" 400 \"float lambdamax\" 720 PixelFilter \"gaussian\" Sampler \"sobol\" \"integer pixelsamples\" 64
        Integrator \"path\" WorldBegin LightSource \"infinite\" \"spectrum L\" [360 .2 500 1 600 .5 830 2] \"float scale\" 3";
    let film = film(text, Backend::default(), ColorMode::Spectral, 2);
    let points = vec![(360.0, 0.2), (500.0, 1.0), (600.0, 0.5), (830.0, 2.0)];
    let spectrum = Spectrum::tabulated(points, Outside::Zero);
    let scale = 3.0 * cie::y_integral() / spectrum.photometric();
    for bin in 0..8 {
        let name = format!("S0.{},000nm", 420 + 40 * bin);
        let values = layer(&film, &name);
        let found = values.iter().sum::<f64>() / 64.0;
        let at = |i: usize| spectrum.value(400.0 + 40.0 * (bin as f32 + (i as f32 + 0.5) / 64.0));
        let expected = f64::from(scale) * (0..64).map(|i| f64::from(at(i))).sum::<f64>() / 64.0;
        // Radiance varies by a fifth over a bin; some 2000 wavelengths of a bin are well spread.
        assert!((found / expected - 1.0).abs() < 3e-3, "{name}: {found} and {expected}");
    }
}
