//! PNG.

use lucerna::image_io::{Image, Window, read, read_png};
use std::fs;
use std::path::Path;
use tempfile::tempdir;

use crate::{crop, write};

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
