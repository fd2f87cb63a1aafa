//! Lights in scene files: every parameter, and what is said about each bad value.

use std::path::Path;

use glam::DVec3;
use lucerna::desc::{AreaSpread, ColorSpace, LightKind, SceneDesc, SpotFalloff, color_space_of, load};
use lucerna::error::Error;
use lucerna::image_io::{Image, ImageMetadata, PendingOutput, Window};

use crate::STRICT;

/// A directory with images: `square.exr` of 4 x 4 pixels, `wide.exr` of 8 x 4, `odd.exr` of 5 x 4, `nan.exr` with a bad pixel,
/// `black.exr`.
pub fn images() -> tempfile::TempDir {
    let directory = tempfile::tempdir().expect("a temporary directory");
    for (name, width, value) in [
        ("square", 4, 0.5),
        ("wide", 8, 0.5),
        ("odd", 5, 0.5),
        ("nan", 4, f32::NAN),
        ("black", 4, 0.0),
    ] {
        let window = Window::of_size(width, 4);
        let mut data = vec![value; 12 * width as usize];
        data[3..].fill(if value.is_nan() { 1.0 } else { value });
        let image = Image::rgb(window, window, data).expect("an image");
        write(&directory.path().join(name).with_extension("exr"), &image);
    }
    directory
}

fn write(path: &Path, image: &Image) {
    let written = PendingOutput::create(path).and_then(|output| output.commit(image, None, 0.0));
    written.expect("a writable directory");
}

/// The scene of a text whose files are in `directory`.
pub fn load_text(directory: &tempfile::TempDir, text: &str) -> Result<SceneDesc, Error> {
    let path = directory.path().join("scene.pbrt");
    std::fs::write(&path, text).expect("a file");
    load(&path, &STRICT)
}

fn read(directory: &tempfile::TempDir, world: &str) -> Result<SceneDesc, Error> {
    load_text(directory, &format!("WorldBegin\n{world}\n"))
}

#[test]
fn spotlights_have_the_parameters_of_pbrt() {
    let directory = images();
    let scene = read(
        &directory,
        "LightSource \"spot\"\nLightSource \"spot\" \"point3 from\" [1 2 3] \"point3 to\" [4 5 6] \"float coneangle\" 60 \
         \"float conedeltaangle\" 60 \"float power\" 7 \"blackbody I\" 3000",
    );
    let scene = scene.unwrap_or_else(|e| panic!("{e}"));
    let (from, to) = (DVec3::ZERO, DVec3::Z);
    let (angle, delta) = (30.0, 5.0);
    assert_eq!(
        scene.lights[0].kind,
        LightKind::Spot {
            from,
            to,
            angle,
            delta,
            falloff: SpotFalloff::Smooth
        }
    );
    let (from, to) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, 5.0, 6.0));
    let (angle, delta) = (60.0, 60.0);
    assert_eq!(
        scene.lights[1].kind,
        LightKind::Spot {
            from,
            to,
            angle,
            delta,
            falloff: SpotFalloff::Smooth
        }
    );
    assert_eq!(scene.lights[1].photometric, Some(7.0));
}

#[test]
fn images_are_read_and_counted_in_the_hash() {
    let directory = images();
    let text = "LightSource \"goniometric\" \"string filename\" \"square.exr\"
        LightSource \"projection\" \"string filename\" \"odd.exr\" \"float fov\" 40
        LightSource \"infinite\" \"string filename\" \"wide.exr\" \"float illuminance\" 3
        LightSource \"infinite\" \"string filename\" \"square.exr\" \"point3 portal\" [0 0 0  0 1 0  1 1 0  1 0 0]
        AreaLightSource \"diffuse\" \"string filename\" \"odd.exr\" \"bool twosided\" true Shape \"sphere\"";
    let scene = read(&directory, text).unwrap_or_else(|e| panic!("{e}"));
    let widths: Vec<usize> = scene
        .lights
        .iter()
        .filter_map(|light| match &light.kind {
            LightKind::Goniometric { image } | LightKind::Projection { image, .. } => Some(image.width()),
            LightKind::Infinite { image, .. } => image.as_ref().map(|image| image.width()),
            _ => None,
        })
        .collect();
    assert_eq!(widths, [4, 5, 8, 4]);
    assert!(matches!(scene.lights[1].kind, LightKind::Projection { fov: 40.0, .. }));
    let LightKind::Infinite { portal, .. } = &scene.lights[3].kind else {
        panic!()
    };
    assert_eq!(
        *portal,
        Some([DVec3::ZERO, DVec3::Y, DVec3::new(1.0, 1.0, 0.0), DVec3::X])
    );
    let area = scene.shapes[0].area_light.as_ref().expect("a light");
    assert!(area.two_sided && area.image.as_ref().is_some_and(|image| image.width() == 5));
    assert_eq!(area.spread, AreaSpread::Diffuse);
    let beam = "AreaLightSource \"diffuse\" \"string spread\" \"normal\" Shape \"disk\"";
    let beam = read(&directory, beam).unwrap_or_else(|e| panic!("{e}"));
    assert!(
        beam.shapes[0]
            .area_light
            .as_ref()
            .is_some_and(|light| light.spread == AreaSpread::Normal)
    );

    let window = Window::of_size(5, 4);
    write(
        &directory.path().join("odd.exr"),
        &Image::rgb(window, window, vec![0.25; 60]).expect("an image"),
    );
    let changed = read(&directory, text).unwrap_or_else(|e| panic!("{e}"));
    assert_ne!(scene.hash, changed.hash);
}

/// `@` marks the place.
#[test]
fn each_bad_value_has_its_error() {
    let directory = images();
    let square = "\"string filename\" \"square.exr\"";
    let cases = [
        (
            "LightSource \"spot\" \"float coneangle\" @0",
            "more than 0 and at most 180",
        ),
        (
            "LightSource \"spot\" \"float coneangle\" @181",
            "more than 0 and at most 180",
        ),
        ("LightSource \"spot\" \"float conedeltaangle\" @-1", "0 or more"),
        (
            "AreaLightSource \"diffuse\" \"string spread\" @\"wide\"",
            "one of diffuse, normal",
        ),
        (
            "LightSource \"spot\" \"float conedeltaangle\" @31",
            "no more than `coneangle`, 30",
        ),
        ("LightSource \"spot\" @\"point3 to\" [0 0 0]", "must differ"),
        ("LightSource \"spot\" \"float scale\" @-1", "0 or more"),
        ("LightSource @\"goniometric\"", "has no `\"string filename\"`"),
        (
            "LightSource \"goniometric\" \"string filename\" @\"wide.exr\"",
            "must be square",
        ),
        (
            "LightSource \"goniometric\" \"string filename\" @\"none.exr\"",
            "cannot read",
        ),
        (
            "LightSource \"goniometric\" \"string filename\" @\"scene.pbrt\"",
            "not a PNG, EXR",
        ),
        ("LightSource @\"projection\"", "has no `\"string filename\"`"),
        (
            "LightSource \"projection\" \"string filename\" @\"nan.exr\"",
            "not finite, in column 0 of row 0",
        ),
        ("LightSource \"projection\" SQUARE \"float fov\" @180", "less than 180"),
        (
            "LightSource \"projection\" SQUARE @\"float fovv\" 18",
            "no parameter `fovv`",
        ),
        (
            "LightSource \"infinite\" \"string filename\" @\"odd.exr\"",
            "twice as wide as high",
        ),
        (
            "LightSource \"infinite\" \"rgb L\" [1 1 1] @SQUARE",
            "exclude each other",
        ),
        (
            "LightSource \"infinite\" SQUARE \"point3 portal\" @[0 0 0 1 1 1]",
            "takes 12 values",
        ),
        (
            "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] @SQUARE",
            "exclude each other",
        ),
        (
            "AreaLightSource \"diffuse\" @\"float twosided\" 1",
            "has the type `float`",
        ),
    ];
    for (marked, message) in cases {
        let marked = marked.replace("SQUARE", square);
        let column = 1 + marked.find('@').expect("a mark");
        let Err(Error::Scene(errors)) = read(&directory, &marked.replacen('@', "", 1)) else {
            panic!("no error in {marked}")
        };
        let found = errors
            .iter()
            .any(|e| (e.line, e.column) == (2, column) && e.message.contains(message));
        let all: Vec<String> = errors.iter().map(ToString::to_string).collect();
        assert!(found && errors.len() == 1, "{marked}\n{}", all.join("\n"));
    }
}

/// What an EXR file says of its primaries and its white counts if it is a space with a name; else the scene is told.
#[test]
fn chromaticities_of_images_are_looked_at() {
    let directory = images();
    let window = Window::of_size(4, 4);
    let image = Image::rgb(window, window, vec![0.5; 48]).expect("an image");
    let write = |name: &str, chromaticities| {
        let metadata = ImageMetadata {
            seed: 0,
            spp: 1,
            integrator: String::new(),
            backend: String::new(),
            version: String::new(),
            render_seconds: 0.0,
            scene_hash: String::new(),
            chromaticities,
            is_spectral: false,
        };
        let path = directory.path().join(name);
        let written = PendingOutput::create(&path).and_then(|output| output.commit(&image, Some(&metadata), 0.0));
        written.expect("a writable directory");
    };
    let white = [0.3127, 0.329];
    write("rec2020.exr", [[0.708, 0.292], [0.17, 0.797], [0.131, 0.046], white]);
    write("other.exr", [[0.7, 0.3], [0.17, 0.797], [0.131, 0.046], white]);
    for (name, space, warnings) in [
        ("square.exr", ColorSpace::Srgb, 0),
        ("rec2020.exr", ColorSpace::Rec2020, 0),
        ("other.exr", ColorSpace::Srgb, 2),
    ] {
        let text = format!(
            "LightSource \"infinite\" \"string filename\" \"{name}\"\n\
             Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"{name}\""
        );
        let scene = read(&directory, &text).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(color_space_of(&scene.images[0].image), space);
        let LightKind::Infinite { image: Some(image), .. } = &scene.lights[0].kind else {
            panic!("{:?}", scene.lights[0].kind)
        };
        assert_eq!(color_space_of(image), space);
        let lines: Vec<usize> = scene.warnings.iter().map(|w| w.line).collect();
        assert_eq!(lines, [2, 3][..warnings], "{:?}", scene.warnings);
        assert!(scene.warnings.iter().all(|w| w.message.contains("sRGB is taken")));
    }
}
