//! Image files: what is written is read back, what is broken is refused, and a target is replaced whole or not at all.

use lucerna::Error;
use lucerna::image_io::{
    Comparison, Encoding, Image, ImageMetadata, PendingOutput, Window, decode, read, read_exr, read_png,
};
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::tempdir;

const CROP: Window = Window {
    x0: 5,
    y0: 7,
    x1: 42,
    y1: 60,
};

/// A crop (of several ZIP blocks) of a 64x64 picture, with values that only a lossless file keeps.
fn crop() -> Image {
    let mut data: Vec<f32> = (0..CROP.pixel_count() * 3)
        .map(|i| (i as f32 * 0.37).sin() * 10_f32.powi((i % 61) as i32 - 30))
        .collect();
    data[..6].copy_from_slice(&[0.0, -0.0, f32::MIN_POSITIVE / 4.0, f32::MAX, f32::INFINITY, -1.5]);
    Image::rgb(CROP, Window::of_size(64, 64), data).unwrap()
}

fn metadata() -> ImageMetadata {
    ImageMetadata {
        seed: u64::MAX - 1,
        spp: 64,
        integrator: "path".to_owned(),
        backend: "embree".to_owned(),
        version: "0.1.0".to_owned(),
        render_seconds: 12.345_678_9,
        scene_hash: "00ff".repeat(16),
        chromaticities: [[0.68, 0.32], [0.265, 0.69], [0.15, 0.06], [0.3127, 0.329]],
    }
}

fn write(path: &Path, image: &Image, metadata: Option<&ImageMetadata>, exposure: f32) {
    let written = PendingOutput::create(path)
        .and_then(|pending| pending.commit(image, metadata, exposure))
        .unwrap();
    assert_eq!(written.path, path);
    assert!(written.instead_because.is_none());
}

fn bits(image: &Image) -> Vec<u32> {
    image.data().iter().map(|v| v.to_bits()).collect()
}

fn names_in(directory: &Path) -> Vec<String> {
    let entries = fs::read_dir(directory).unwrap();
    let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

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
fn png_has_the_curve_and_the_chunk_of_srgb() {
    let directory = tempdir().unwrap();
    let path = directory.path().join("a.PNG");
    // PNG cannot say where a crop lies.
    write(&path, &crop(), None, 0.0);
    assert_eq!(read(&path).unwrap().data_window(), Window::of_size(37, 53));

    let window = Window::of_size(3, 1);
    let data = vec![0.0, 0.002, 0.18, 0.5, 1.0, 3.0, f32::NAN, -1.0, 0.09];
    let image = Image::rgb(window, window, data).unwrap();
    for (exposure, expected) in [
        (0.0, [0, 7, 118, 188, 255, 255, 0, 0, 85]),
        // 0.004 -> 12.9, 0.36 -> 161.7; 0.18 as above.
        (1.0, [0, 13, 162, 255, 255, 255, 0, 0, 118]),
    ] {
        write(&path, &image, None, exposure);
        let file = fs::read(&path).unwrap();
        assert!(
            file.windows(8).any(|w| w == b"\0\0\0\x01sRGB"),
            "the sRGB chunk is missing"
        );
        let mut reader = png::Decoder::new(std::io::Cursor::new(&file)).read_info().unwrap();
        let mut codes = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut codes).unwrap();
        assert_eq!(
            (info.color_type, info.bit_depth),
            (png::ColorType::Rgb, png::BitDepth::Eight)
        );
        assert_eq!(codes, expected, "exposure {exposure}");
    }
}

/// A PNG file of 2x1 pixels; its palette is red and a green of code 188.
fn png_file(path: &Path, color: png::ColorType, depth: png::BitDepth, bytes: &[u8]) {
    let mut encoder = png::Encoder::new(fs::File::create(path).unwrap(), 2, 1);
    encoder.set_color(color);
    encoder.set_depth(depth);
    if color == png::ColorType::Indexed {
        encoder.set_palette(vec![255, 0, 0, 0, 188, 0]);
    }
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(bytes).unwrap();
    writer.finish().unwrap();
}

#[test]
fn png_of_any_kind_is_read_as_linear() {
    use png::BitDepth::{Eight, One, Sixteen};
    use png::ColorType::{Grayscale, GrayscaleAlpha, Indexed, Rgb};
    let directory = tempdir().unwrap();
    let path = directory.path().join("a.png");
    // By the definition of sRGB: code 188 is 0.5028865, 7 is 7 / 255 / 12.92; 0x8000 of 16 bits is 0.2140482.
    let half = 0.502_886_5;
    type Case<'a> = (png::ColorType, png::BitDepth, &'a [u8], &'a str, &'a [f32]);
    let cases: [Case; 5] = [
        (
            Rgb,
            Eight,
            &[188, 7, 255, 0, 0, 0],
            "RGB",
            &[half, 0.002_124_7, 1.0, 0.0, 0.0, 0.0],
        ),
        (Grayscale, One, &[0b0100_0000], "Y", &[0.0, 1.0]),
        (GrayscaleAlpha, Eight, &[188, 51, 0, 255], "YA", &[half, 0.2, 0.0, 1.0]),
        (Indexed, Eight, &[1, 0], "RGB", &[0.0, half, 0.0, 1.0, 0.0, 0.0]),
        (Grayscale, Sixteen, &[0x80, 0, 0xff, 0xff], "Y", &[0.214_048_2, 1.0]),
    ];
    for (color, depth, bytes, channels, expected) in cases {
        png_file(&path, color, depth, bytes);
        let image = read_png(&path).unwrap();
        assert_eq!(image.channels().concat(), channels);
        assert_eq!(image.data().len(), expected.len());
        for (found, expected) in image.data().iter().zip(expected) {
            assert!(
                (found - expected).abs() < 1e-6,
                "{color:?} {depth:?}: {found}, not {expected}"
            );
        }
    }
}

#[test]
fn truncated_and_damaged_files_are_errors_and_no_panics() {
    let directory = tempdir().unwrap();
    let window = Window::of_size(9, 20);
    let image = Image::rgb(window, window, vec![0.25; 540]).unwrap();
    for name in ["a.exr", "a.png"] {
        let path = directory.path().join(name);
        write(&path, &image, Some(&metadata()), 0.0);
        let whole = fs::read(&path).unwrap();
        for length in 0..whole.len() {
            fs::write(&path, &whole[..length]).unwrap();
            // The last chunk of a PNG file holds nothing: the decoder may do without.
            let complete = name == "a.png" && length >= whole.len() - 12;
            assert!(
                complete || matches!(read(&path), Err(Error::Image { .. })),
                "{name}: {length} bytes"
            );
        }
        // Any byte may be wrong: an image or an error, but nothing else. 0x80 makes sizes huge or negative.
        for flip in [0x01, 0x80, 0xff] {
            for position in 0..whole.len() {
                let mut damaged = whole.clone();
                damaged[position] ^= flip;
                fs::write(&path, &damaged).unwrap();
                assert!(
                    matches!(read(&path), Ok(_) | Err(Error::Image { .. })),
                    "{name}: byte {position}"
                );
            }
        }
    }
}

#[test]
fn other_files_and_missing_ones_are_errors() {
    let directory = tempdir().unwrap();
    let path = directory.path().join("a.exr");
    assert!(matches!(read(&path), Err(Error::Io { action: "read", .. })));
    fs::write(&path, "P6 1 1 255 abc").unwrap();
    assert!(matches!(read(&path), Err(Error::Image { message, .. }) if message.contains("neither")));
    assert!(matches!(read_exr(&path), Err(Error::Image { .. })));
    assert!(matches!(read_png(&path), Err(Error::Image { .. })));
}

#[test]
fn outputs_that_cannot_be_written_are_refused_before_the_render() {
    let directory = tempdir().unwrap();
    for name in ["a.jpg", "a", "exr", ".png", "a.exr.gz"] {
        let Err(Error::Usage(message)) = PendingOutput::create(&directory.path().join(name)) else {
            panic!("{name} must be refused");
        };
        assert!(message.contains(".exr") && message.contains(".png"), "{message}");
    }
    fs::create_dir(directory.path().join("directory.exr")).unwrap();
    fs::write(directory.path().join("file"), "").unwrap();
    // Nobody can create files in /proc, root included.
    for path in ["missing/a.exr", "directory.exr", "file/a.png", "/proc/a.exr"] {
        let refused = PendingOutput::create(&directory.path().join(path));
        assert!(
            matches!(refused, Err(Error::Io { action: "create", .. })),
            "{path}: {refused:?}"
        );
    }
    assert_eq!(names_in(directory.path()), ["directory.exr", "file"]);
}

#[test]
fn a_target_stays_until_it_is_replaced_whole() {
    let directory = tempdir().unwrap();
    let path = directory.path().join("a.png");
    fs::write(&path, "old").unwrap();
    let pending = PendingOutput::create(&path).unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"old");
    assert_eq!(names_in(directory.path()), ["a.png"]);
    drop(pending);
    assert_eq!(names_in(directory.path()), ["a.png"]);

    // An image that PNG cannot hold is found when it is encoded: the old file survives that.
    let window = Window::of_size(1, 1);
    let depth = Image::new(window, window, vec!["Z".to_owned()], vec![1.0]).unwrap();
    let failed = PendingOutput::create(&path).unwrap().commit(&depth, None, 0.0);
    assert!(matches!(failed, Err(Error::Image { .. })));
    assert_eq!(fs::read(&path).unwrap(), b"old");

    write(&path, &crop(), None, 0.0);
    assert_eq!(read(&path).unwrap().width(), 37);
    assert_eq!(names_in(directory.path()), ["a.png"]);
}

#[cfg(unix)]
#[test]
fn written_files_have_the_permissions_of_any_new_file() {
    use std::os::unix::fs::PermissionsExt;
    let directory = tempdir().unwrap();
    let mode = |path: &PathBuf| fs::metadata(path).unwrap().permissions().mode();
    let (ours, other) = (directory.path().join("a.exr"), directory.path().join("other"));
    write(&ours, &crop(), None, 0.0);
    fs::write(&other, "").unwrap();
    assert_eq!(mode(&ours), mode(&other));
}

#[cfg(unix)]
#[test]
fn a_link_is_followed() {
    let directory = tempdir().unwrap();
    let inner = directory.path().join("inner");
    fs::create_dir(&inner).unwrap();
    fs::write(inner.join("real.exr"), "old").unwrap();
    let link = directory.path().join("link.exr");
    std::os::unix::fs::symlink("inner/real.exr", &link).unwrap();
    write(&link, &crop(), None, 0.0);
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(bits(&read(&inner.join("real.exr")).unwrap()), bits(&crop()));
    assert_eq!(names_in(&inner), ["real.exr"]);
}

#[test]
fn comparison_of_files() {
    let directory = tempdir().unwrap();
    let [a, b, small, infinite] = ["a.exr", "b.png", "small.exr", "infinite.exr"].map(|n| directory.path().join(n));
    let constant = |width, height, value| {
        let window = Window::of_size(width, height);
        Image::rgb(window, window, vec![value; window.pixel_count() * 3]).unwrap()
    };
    write(&a, &constant(8, 4, 0.75), None, 0.0);
    write(&b, &constant(8, 4, 1.0), None, 0.0);
    write(&small, &constant(4, 4, 1.0), None, 0.0);
    write(&infinite, &crop(), None, 0.0);
    let comparison = Comparison::of_files(&a, &b).unwrap();
    assert_eq!((comparison.mse, comparison.mean_difference), (0.0625, Some(-0.25)));
    let json = serde_json::to_value(comparison).unwrap();
    let keys: Vec<_> = json.as_object().unwrap().keys().cloned().collect();
    assert_eq!(keys, ["flip", "mean_a", "mean_b", "mean_difference", "mse", "relmse"]);

    let different = Comparison::of_files(&a, &small).unwrap_err();
    assert_eq!((different.exit_code(), matches!(different, Error::Usage(_))), (2, true));
    let not_finite = Comparison::of_files(&infinite, &infinite).unwrap_err().to_string();
    assert!(
        not_finite.contains("infinite.exr") && not_finite.contains("not a finite number"),
        "{not_finite}"
    );
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

/// The bytes of an image as another program would write them.
fn foreign(format: image::ImageFormat, picture: &image::DynamicImage) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    picture.write_to(&mut bytes, format).expect("the format can be written");
    bytes.into_inner()
}

#[test]
fn other_formats_are_read() {
    let rgb = image::RgbImage::from_fn(16, 8, |x, y| image::Rgb([10 + 8 * x as u8, 20 * y as u8, 200]));
    let picture = image::DynamicImage::ImageRgb8(rgb.clone());
    let path = Path::new("picture.tga");
    let decoded = |format| decode(&foreign(format, &picture), path, Encoding::Linear).expect("a picture");
    let tga = decoded(image::ImageFormat::Tga);
    assert_eq!((tga.width(), tga.height(), tga.channels().len()), (16, 8, 3));
    for (x, y, pixel) in rgb.enumerate_pixels() {
        let expected = pixel.0.map(|code| f32::from(code) / 255.0);
        assert_eq!(tga.pixel(x as usize, y as usize), expected);
    }
    // JPEG loses some: smooth pictures little.
    let jpeg = decoded(image::ImageFormat::Jpeg);
    for (a, b) in jpeg.data().iter().zip(tga.data()) {
        assert!((a - b).abs() < 0.06, "{a} and {b}");
    }
    let srgb = decode(&foreign(image::ImageFormat::Tga, &picture), path, Encoding::Srgb).expect("a picture");
    for (a, b) in srgb.data().iter().zip(tga.data()) {
        assert!((lucerna::image_io::srgb::encode(*a) - b).abs() < 1e-5);
    }
}

#[test]
fn radiance_files_have_their_exponents() {
    let values = image::Rgb32FImage::from_fn(8, 2, |x, _| image::Rgb([2.0_f32.powi(x as i32 - 3), 0.5, 0.0]));
    let bytes = foreign(
        image::ImageFormat::Hdr,
        &image::DynamicImage::ImageRgb32F(values.clone()),
    );
    let image = decode(&bytes, Path::new("x.hdr"), Encoding::Srgb).expect("a picture");
    for (x, y, pixel) in values.enumerate_pixels() {
        for (a, b) in image.pixel(x as usize, y as usize).iter().zip(pixel.0) {
            // Eight bits of the largest component.
            assert!((a - b).abs() <= pixel.0[0].max(0.5) / 128.0, "{a} and {b}");
        }
    }
}

#[test]
fn what_is_no_image_is_refused() {
    let refused = |bytes: &[u8], name: &str| match decode(bytes, Path::new(name), Encoding::Srgb) {
        Err(Error::Image { message, .. }) => message,
        other => panic!("{other:?}"),
    };
    assert!(refused(b"hello", "x.png").contains("not a PNG"));
    assert!(refused(b"", "x.png").contains("not a PNG"));
    assert!(refused(b"\xff\xd8\xff\xe0 and no more", "x.jpg").contains("malformed JPEG"));
    assert!(refused(b"#?RADIANCE\n", "x.hdr").contains("malformed HDR"));
    assert!(refused(b"short", "x.tga").contains("malformed TGA"));
}
