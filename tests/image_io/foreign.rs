//! JPEG, TGA and Radiance files.

use lucerna::image_io::{Encoding, decode};
use std::path::Path;

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
