//! The same input gives the same bits: for any number of threads, for a crop, for single samples.

use lucerna::desc::PixelRect;
use lucerna::integrator::Integrator;
use lucerna::scene::ViewOverrides;

use crate::common::render::{Built, parse, usual_combinations};
use crate::{film, photon, quad, sppm};

const SIZE: [usize; 2] = [72, 44];

/// A room with glass and a mirror, with a lens, a part of which moves if that is asked for.
fn scene(motion: &str) -> String {
    let walls = [
        quad([-1.5, 0.0, -1.5], [0.0, 0.0, 3.0], [3.0, 0.0, 0.0]),
        quad([-1.5, 0.0, 1.5], [0.0, 2.0, 0.0], [3.0, 0.0, 0.0]),
        quad([-1.5, 0.0, -1.5], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]),
    ];
    format!(
        "LookAt 0 1 -3.2  0 1 0  0 1 0\nCamera \"perspective\" \"float fov\" 50 \"float lensradius\" 0.02 \"float focaldistance\" 3.2\n\
         {}WorldBegin\nAttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [6 5 4]\n{}AttributeEnd\n\
         LightSource \"point\" \"point3 from\" [1 1.8 0] \"rgb I\" [0.5 0.5 0.6]\n\
         Material \"diffuse\" \"rgb reflectance\" [0.6 0.6 0.5]\n{}\
         AttributeBegin Material \"dielectric\" \"spectrum eta\" \"glass-F11\" Translate 0.5 0.5 -0.3 Shape \"sphere\" \"float radius\" 0.4 AttributeEnd\n\
         AttributeBegin {motion} Material \"conductor\" Translate -0.6 0.5 0.4 Shape \"sphere\" \"float radius\" 0.45 AttributeEnd\n",
        film(SIZE),
        quad([-0.4, 1.99, -0.4], [0.8, 0.0, 0.0], [0.0, 0.0, 0.8]),
        walls.concat()
    )
}

const MOVING: &str = "ActiveTransform EndTime Translate 0.2 0.1 0 ActiveTransform All";

fn both() -> [Integrator; 2] {
    let two_pass = photon(Some(5), |p| {
        p.caustic_photons = Some(3000);
        p.global_photons = Some(3000);
        p.passes = 2;
        p.final_gather_samples = 3;
    });
    let Integrator::Sppm(mut progressive) = sppm(Some(5), 0, 0.1) else {
        return [two_pass; 2];
    };
    // As many photons as the whole picture has pixels, and a radius by pixel.
    progressive.parameters.photons = None;
    progressive.parameters.radius = None;
    [two_pass, Integrator::Sppm(progressive)]
}

fn picture(built: &Built, integrator: Integrator, overrides: &ViewOverrides, threads: usize) -> Vec<f32> {
    let view = built.view(0, overrides);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .expect("threads");
    let (picture, stats) = pool.install(|| built.picture_with(&view, integrator));
    assert_eq!(stats.dropped_samples, 0, "dropped: {:?}", stats.dropped);
    picture
}

fn bits(picture: &[f32]) -> Vec<u32> {
    picture.iter().map(|v| v.to_bits()).collect()
}

#[test]
fn threads_crops_and_single_samples_change_nothing() {
    let spp = 4;
    for (i, (backend, color)) in usual_combinations("").enumerate() {
        let built = Built::new(parse(&scene(["", MOVING][i % 2])), backend, color);
        for integrator in both() {
            let name = format!("{}, {backend}, {color:?}", integrator.name());
            let whole_view = ViewOverrides {
                spp: Some(spp),
                ..ViewOverrides::default()
            };
            let whole = picture(&built, integrator, &whole_view, 1);
            for threads in [2, 3] {
                let again = picture(&built, integrator, &whole_view, threads);
                assert_eq!(bits(&whole), bits(&again), "{name}: {threads} threads");
            }
            let [x0, y0, x1, y1] = [29, 13, 51, 37];
            let crop = ViewOverrides {
                crop: Some(PixelRect { x0, y0, x1, y1 }),
                ..whole_view
            };
            let rows = (y0..y1).flat_map(|y| {
                let row = 3 * (y as usize * SIZE[0]);
                whole[row + 3 * x0 as usize..row + 3 * x1 as usize].to_vec()
            });
            let expected: Vec<f32> = rows.collect();
            assert_eq!(
                bits(&picture(&built, integrator, &crop, 2)),
                bits(&expected),
                "{name}: crop"
            );
            // With a box filter all samples of a pixel weigh the same.
            let mut mean = vec![0.0_f64; whole.len()];
            for sample in 0..spp {
                let single = ViewOverrides {
                    sample: Some(sample),
                    ..whole_view
                };
                let single = picture(&built, integrator, &single, 2);
                mean.iter_mut()
                    .zip(single)
                    .for_each(|(sum, v)| *sum += f64::from(v) / f64::from(spp));
            }
            for (i, (&value, sum)) in whole.iter().zip(&mean).enumerate() {
                let far = (f64::from(value) - sum).abs();
                assert!(
                    far <= 1e-6 * sum.abs() + 1e-7,
                    "{name}: value {i} is {value}, its samples are {sum}"
                );
            }
        }
    }
}
