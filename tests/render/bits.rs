//! A picture has the same bits for any number of threads, crop and split of the samples, and others for another seed.

use lucerna::accel::Backend;
use lucerna::film::PixelRect;
use lucerna::integrator::{Integrator, Silent};
use lucerna::sampling::SamplerKind;
use lucerna::scene::{View, ViewOverrides};
use lucerna::spectrum::ColorMode;

use crate::common::render::{Built, combinations, parse};
use crate::{different_pixels, everything, with_threads};

#[test]
fn pictures_have_the_same_bits_for_any_number_of_threads() {
    let desc = parse(&everything("PixelFilter \"mitchell\""));
    for (backend, color) in combinations() {
        let picture = |threads| {
            with_threads(threads, || {
                let built = Built::new(desc.clone(), backend, color);
                built.picture(&built.view(0, &ViewOverrides::default()))
            })
        };
        let one = picture(1);
        for threads in [2, 5] {
            assert_eq!(
                different_pixels(&one, &picture(threads)),
                0,
                "{backend}, {color:?}, {threads} threads"
            );
        }
    }
}

#[test]
fn a_crop_has_the_pixels_of_the_whole() {
    let crops = [
        [0, 0, 1, 1],
        [63, 63, 65, 65],
        [17, 5, 90, 77],
        [149, 99, 150, 100],
        [3, 64, 67, 66],
        [0, 41, 150, 42],
        [127, 0, 129, 100],
    ];
    let filters = [
        "PixelFilter \"box\"",
        "PixelFilter \"gaussian\" \"float xradius\" 2.5",
        "PixelFilter \"sinc\"",
    ];
    for (filter, color) in filters
        .into_iter()
        .zip([ColorMode::Rgb, ColorMode::Spectral, ColorMode::Spectral])
    {
        let desc = parse(&everything(filter));
        for &backend in Backend::AVAILABLE {
            let built = Built::new(desc.clone(), backend, color);
            let whole = built.picture(&built.view(0, &ViewOverrides::default()));
            for [x0, y0, x1, y1] in crops {
                let overrides = ViewOverrides {
                    crop: Some(PixelRect { x0, y0, x1, y1 }),
                    ..ViewOverrides::default()
                };
                let crop = built.picture(&built.view(0, &overrides));
                let part: Vec<f32> = (y0..y1)
                    .flat_map(|y| &whole[3 * (150 * y + x0) as usize..3 * (150 * y + x1) as usize])
                    .copied()
                    .collect();
                let different = different_pixels(&crop, &part);
                assert_eq!(different, 0, "{backend}, {filter}, {:?}", [x0, y0, x1, y1]);
            }
        }
    }
}

#[test]
fn ranges_of_samples_add_up() {
    let desc = parse(&everything("PixelFilter \"gaussian\""));
    for (backend, color) in combinations() {
        for sampler in [SamplerKind::Sobol, SamplerKind::Independent] {
            let built = Built::new(desc.clone(), backend, color);
            let overrides = ViewOverrides {
                spp: Some(16),
                resolution: Some([70, 30]),
                sampler: Some(sampler),
                ..ViewOverrides::default()
            };
            let view = built.view(0, &overrides);
            let whole = built.picture(&view);
            for splits in [&[0, 8, 16][..], &[0, 1, 2, 13, 16]] {
                let film = view.film();
                // The last range first: no order is promised.
                for range in splits.windows(2).rev() {
                    let part = View {
                        samples: range[0]..range[1],
                        ..view.clone()
                    };
                    let integrator = Integrator::from_desc(&built.desc.integrator);
                    integrator.render(&built.scene, &part, &film, &Silent);
                }
                let different = different_pixels(&whole, &film.develop());
                assert_eq!(different, 0, "{backend}, {color:?}, {sampler:?}, {splits:?}");
            }
        }
    }
}

#[test]
fn seeds_give_other_noise() {
    let desc = parse(&everything("PixelFilter \"box\""));
    for (backend, color) in combinations() {
        let built = Built::new(desc.clone(), backend, color);
        let picture = |seed| {
            let overrides = ViewOverrides {
                seed,
                resolution: Some([64, 48]),
                ..ViewOverrides::default()
            };
            built.picture(&built.view(0, &overrides))
        };
        let (a, b) = (picture(1), picture(2));
        // In rgb mode the sky, which is half of the picture, has no noise.
        assert!(different_pixels(&a, &b) > 64 * 48 / 2, "{backend}, {color:?}");
        assert_eq!(different_pixels(&a, &picture(1)), 0, "{backend}, {color:?}");
    }
}
