//! OpenEXR.

use lucerna::Error;
use lucerna::image_io::{Image, Window, read, read_exr};
use std::fs;
use std::path::Path;
use tempfile::tempdir;

use crate::{CROP, bits, crop, metadata, names_in, write};

#[test]
fn exr_keeps_every_bit_and_both_windows_and_the_metadata() {
    let directory = tempdir().unwrap();
    let path = directory.path().join("a picture.exr");
    write(&path, &crop(), Some(&metadata()), 0.0);
    let (image, read_metadata) = read_exr(&path).unwrap();
    assert_eq!(bits(&image), bits(&crop()));
    assert_eq!(image.data_window(), CROP);
    assert_eq!(image.display_window(), Window::of_size(64, 64));
    assert_eq!(image.channels(), ["R", "G", "B"]);
    assert_eq!(read_metadata, Some(metadata()));
    assert_eq!(image.chromaticities(), Some(metadata().chromaticities));
    assert_eq!(bits(&read(&path).unwrap()), bits(&crop()));
    assert_eq!(names_in(directory.path()), ["a picture.exr"]);
}

#[test]
fn exr_of_one_image_is_always_the_same_file() {
    let directory = tempdir().unwrap();
    let (a, b) = (directory.path().join("a.exr"), directory.path().join("b.exr"));
    write(&a, &crop(), Some(&metadata()), 0.0);
    write(&b, &crop(), Some(&metadata()), 0.0);
    assert_eq!(fs::read(a).unwrap(), fs::read(b).unwrap());
}

#[test]
fn exr_metadata_are_attributes_of_their_proper_types() {
    let directory = tempdir().unwrap();
    let path = directory.path().join("a.exr");
    write(&path, &crop(), Some(&metadata()), 0.0);
    let file = fs::read(&path).unwrap();
    let attribute = |name: &str, kind: &str, value: &[u8]| {
        let mut bytes = format!("{name}\0{kind}\0").into_bytes();
        bytes.extend((value.len() as u32).to_le_bytes());
        bytes.extend(value);
        bytes
    };
    for expected in [
        attribute("lucerna:seed", "string", b"18446744073709551614"),
        attribute("lucerna:spp", "int", &64_i32.to_le_bytes()),
        attribute("lucerna:integrator", "string", b"path"),
        attribute("lucerna:render_seconds", "double", &12.345_678_9_f64.to_le_bytes()),
        attribute("compression", "compression", &[3]),
        attribute("dataWindow", "box2i", &[5, 7, 41, 59].map(i32::to_le_bytes).concat()),
        attribute("displayWindow", "box2i", &[0, 0, 63, 63].map(i32::to_le_bytes).concat()),
    ] {
        let found = file.windows(expected.len()).any(|window| window == expected);
        assert!(found, "{}", String::from_utf8_lossy(&expected));
    }
}

#[test]
fn exr_without_metadata_and_with_other_channels() {
    let directory = tempdir().unwrap();
    let path = directory.path().join("a.exr");
    let window = Window {
        x0: -3,
        y0: -2,
        x1: 1,
        y1: 1,
    };
    let names = ["B", "Z", "A", "R", "G"].map(str::to_owned).to_vec();
    let data = (0..window.pixel_count() * 5).map(|i| i as f32).collect();
    let image = Image::new(window, Window::of_size(1, 1), names, data).unwrap();
    write(&path, &image, None, 0.0);
    let (image, metadata) = read_exr(&path).unwrap();
    assert_eq!(metadata, None);
    assert_eq!(image.data_window(), window);
    assert_eq!(image.channels(), ["R", "G", "B", "A"]);
    // The pixel's values were 45 to 49, in the order B, Z, A, R, G.
    assert_eq!(image.pixel(1, 2), [48.0, 49.0, 45.0, 47.0]);
    let depth = Image::new(window, window, vec!["Z".to_owned()], vec![1.0; 12]).unwrap();
    write(&path, &depth, None, 0.0);
    assert!(matches!(read_exr(&path), Err(Error::Image { message, .. }) if message.contains("only Z")));
}

#[test]
fn exr_samples_of_every_type_are_read() {
    use exr::prelude::{
        AnyChannel, AnyChannels, Compression, Encoding, FlatSamples, Image, Layer, LayerAttributes, WritableImage, f16,
    };
    let directory = tempdir().unwrap();
    let path = directory.path().join("a.exr");
    let channels = [
        AnyChannel::new("A", FlatSamples::F16(vec![f16::from_f32(0.5); 6])),
        AnyChannel::new("B", FlatSamples::U32(vec![7; 6])),
        AnyChannel::new("G", FlatSamples::F32(vec![0.1; 6])),
        AnyChannel::new("R", FlatSamples::F16(vec![f16::from_f32(1.0 / 3.0); 6])),
    ];
    for compression in [
        Compression::PIZ,
        Compression::RLE,
        Compression::Uncompressed,
        Compression::ZIP1,
    ] {
        let encoding = Encoding {
            compression,
            ..Encoding::SMALL_LOSSLESS
        };
        let channels = AnyChannels::sort(channels.iter().cloned().collect());
        let layer = Layer::new((3, 2), LayerAttributes::default(), encoding, channels);
        Image::from_layer(layer).write().to_file(&path).unwrap();
        let image = read(&path).unwrap();
        assert_eq!(image.channels(), ["R", "G", "B", "A"]);
        assert_eq!(
            image.pixel(2, 1),
            [f16::from_f32(1.0 / 3.0).to_f32(), 0.1, 7.0, 0.5],
            "{compression:?}"
        );
    }
}

#[test]
fn files_of_other_programs_are_read() {
    let reference = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/reference/pbrt-cornell-box-mean.exr");
    if !reference.exists() {
        assert!(std::env::var_os("CI").is_none(), "{} is missing", reference.display());
        eprintln!("skipped: {} is missing", reference.display());
        return;
    }
    let (image, metadata) = read_exr(&reference).unwrap();
    assert_eq!(image.data_window(), Window::of_size(128, 128));
    assert_eq!((image.channels().concat().as_str(), metadata), ("RGB", None));
    // As OpenEXR's own library reads it.
    assert_eq!(image.pixel(7, 5), [0.076_057_58, 0.032_302_894, 0.007_341_178]);
    let mean = image.data().iter().map(|&v| f64::from(v)).sum::<f64>() / image.data().len() as f64;
    assert!((mean - 0.118_815_423).abs() < 1e-9, "{mean}");
}
