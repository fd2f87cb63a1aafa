//! Images in colour spaces wider than sRGB, as their EXR files say: texels reflect and pixels emit what an rgb value of that space
//! does.

mod common;

use std::path::Path;

use common::render::{Built, MODES, parse};
use lucerna::accel::Backend;
use lucerna::image_io::{Image, ImageMetadata, PendingOutput, Window};
use lucerna::scene::ViewOverrides;
use lucerna::spectrum::{ColorMode, ColorSpace, cie};
use tempfile::TempDir;

/// Writes a 4 x 4 image of one colour of `space`; its name, as a scene file has it.
fn image_of(directory: &TempDir, rgb: [f32; 3], space: ColorSpace) -> String {
    let path = directory.path().join(format!("{}.exr", space.name()));
    let window = Window::of_size(4, 4);
    let image = Image::rgb(window, window, rgb.repeat(16)).expect("an image");
    let [red, green, blue] = space.primaries();
    let metadata = ImageMetadata {
        seed: 0,
        spp: 1,
        integrator: String::new(),
        backend: String::new(),
        version: String::new(),
        render_seconds: 0.0,
        scene_hash: String::new(),
        chromaticities: [red, green, blue, space.white()].map(|xy| xy.map(|c| c as f32)),
        is_spectral: false,
    };
    write(&path, &image, &metadata);
    format!("\"string filename\" \"{}\"", path.display())
}

fn write(path: &Path, image: &Image, metadata: &ImageMetadata) {
    let written = PendingOutput::create(path).and_then(|output| output.commit(image, Some(metadata), 0.0));
    written.expect("a writable directory");
}

/// The mean colour of a picture of 4 x 4 pixels, straight down on the xy plane.
fn seen(world: &str, mode: ColorMode) -> [f64; 3] {
    let text = format!(
        "LookAt 0 0 1  0 0 0  0 1 0\nCamera \"orthographic\"\n\
         Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\nSampler \"sobol\" \"integer pixelsamples\" 256\n\
         Integrator \"path\" \"integer maxdepth\" 1\nWorldBegin\n{world}"
    );
    let built = Built::new(parse(&text), Backend::Bvh, mode);
    assert_eq!(built.desc.warnings.len(), 0, "{:?}", built.desc.warnings);
    let picture = built.picture(&built.view(0, &ViewOverrides::default()));
    std::array::from_fn(|c| picture.chunks_exact(3).map(|pixel| f64::from(pixel[c])).sum::<f64>() / 16.0)
}

const PLANE: &str =
    "Shape \"trianglemesh\" \"point3 P\" [-9 -9 0  9 -9 0  9 9 0  -9 9 0] \"integer indices\" [0 1 2 0 2 3]";

/// Colours of reflectances and lights, none at the border of what there is in the smallest space.
const COLORS: [[f32; 3]; 4] = [[0.5, 0.3, 0.2], [0.25, 0.45, 0.3], [0.2, 0.25, 0.4], [0.6; 3]];

/// The pictures that `image` and `value` (a parameter's values) give differ by no more than the tables' interpolation: the random
/// numbers are the same.
fn compare(what: &str, image: impl Fn(&str) -> String, value: impl Fn(&str) -> String) {
    let directory = tempfile::tempdir().expect("a temporary directory");
    for space in ColorSpace::ALL {
        for rgb in COLORS {
            let file = image_of(&directory, rgb, space);
            let rgb_text = format!("[{} {} {}]", rgb[0], rgb[1], rgb[2]);
            for mode in MODES {
                let by_image = seen(&image(&file), mode);
                let by_value = seen(&format!("ColorSpace \"{}\"\n{}", space.name(), value(&rgb_text)), mode);
                for (a, b) in by_image.into_iter().zip(by_value) {
                    // In rgb mode a constant reflectance has no component beyond its spectrum's largest value.
                    let bound = if mode == ColorMode::Rgb { 1e-2 } else { 4e-3 };
                    assert!(
                        (a - b).abs() < bound,
                        "{what} {space:?} {mode:?} {rgb:?}: {by_image:?} and {by_value:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn texels_reflect_in_the_space_of_their_image() {
    const SKY: &str = "AttributeBegin ColorSpace \"srgb\" LightSource \"infinite\" AttributeEnd";
    compare(
        "reflectance",
        |file| {
            let texture = format!("Texture \"t\" \"spectrum\" \"imagemap\" {file}");
            format!("{SKY}\n{texture}\nMaterial \"diffuse\" \"texture reflectance\" \"t\"\n{PLANE}")
        },
        |rgb| format!("{SKY}\nMaterial \"diffuse\" \"rgb reflectance\" {rgb}\n{PLANE}"),
    );
}

#[test]
fn pixels_emit_in_the_space_of_their_image() {
    compare(
        "area light",
        |file| format!("AreaLightSource \"diffuse\" {file}\n{PLANE}"),
        |rgb| format!("AreaLightSource \"diffuse\" \"rgb L\" {rgb}\n{PLANE}"),
    );
    compare(
        "sky",
        |file| format!("LightSource \"infinite\" {file}"),
        |rgb| format!("LightSource \"infinite\" \"rgb L\" {rgb}"),
    );
}

/// Without random wavelengths, a sky that is looked at has the colour of the image to rounding.
#[test]
fn a_sky_has_the_color_of_its_image() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    for space in ColorSpace::ALL {
        let rgb = [0.3, 0.5, 0.4];
        let file = image_of(&directory, rgb, space);
        let expected = cie::xyz_to_srgb(space.rgb_to_xyz(rgb.map(f64::from)));
        let found = seen(&format!("LightSource \"infinite\" {file}"), ColorMode::Rgb);
        for (a, b) in found.into_iter().zip(expected) {
            assert!((a - b).abs() < 1e-5, "{space:?}: {found:?} and {expected:?}");
        }
        // It is not that of the same numbers in sRGB.
        let differs = expected.iter().zip(rgb).any(|(a, b)| (a - f64::from(b)).abs() > 0.02);
        assert_eq!(differs, space != ColorSpace::Srgb, "{space:?}");
    }
}

/// The white that a light without a spectrum has is that of the color space in force.
#[test]
fn a_light_without_a_spectrum_has_the_white_of_its_space() {
    for space in ColorSpace::ALL {
        let expected = cie::xyz_to_srgb(space.rgb_to_xyz([1.0; 3]));
        let found = seen(
            &format!("ColorSpace \"{}\" LightSource \"infinite\"", space.name()),
            ColorMode::Rgb,
        );
        for (a, b) in found.into_iter().zip(expected) {
            assert!((a - b).abs() < 1e-4, "{space:?}: {found:?} and {expected:?}");
        }
    }
}
