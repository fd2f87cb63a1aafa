//! JPEG, TGA and Radiance HDR files, read by the crate `image`.

use super::{Encoding, Image, Window, check_length};
use image::{ColorType, DynamicImage, ImageDecoder, ImageFormat, ImageReader};
use std::io::Cursor;

/// The image in a file's bytes, or what is wrong with them. `encoding` is that of 8-bit samples; alpha is linear.
pub(super) fn decode(bytes: &[u8], format: ImageFormat, encoding: Encoding) -> Result<Image, String> {
    // The most pixels that a byte of the file can stand for: in JPEG each block of 64 samples takes a bit at least; a packet of TGA is
    // 128 pixels in two bytes; a row of HDR in the old way of counting runs is some twelve bytes.
    let (name, most) = match format {
        ImageFormat::Jpeg => ("JPEG", 512),
        ImageFormat::Tga => ("TGA", 64),
        _ => ("HDR", 4096),
    };
    let malformed = |error: image::ImageError| format!("malformed {name} file: {error}");
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    // The whole file must fit into memory anyway.
    reader.no_limits();
    let decoder = reader.into_decoder().map_err(malformed)?;
    let (width, height) = decoder.dimensions();
    check_length(u64::from(width) * u64::from(height), bytes, most)?;
    let decoded = DynamicImage::from_decoder(decoder).map_err(malformed)?;
    let side = |n: u32| i32::try_from(n).map_err(|_| format!("malformed {name} file: too large"));
    let window = Window::of_size(side(decoded.width())?, side(decoded.height())?);
    let table = encoding.decode_table();
    let eight_bits = |samples: &[u8], channels: usize, colours: usize| -> Vec<f32> {
        let value = |(i, &code): (usize, &u8)| {
            if i % channels < colours {
                table[usize::from(code)]
            } else {
                f32::from(code) / 255.0
            }
        };
        samples.iter().enumerate().map(value).collect()
    };
    let (names, data): (&[&str], Vec<f32>) = match decoded {
        DynamicImage::ImageLuma8(image) => (&["Y"], eight_bits(&image, 1, 1)),
        DynamicImage::ImageLumaA8(image) => (&["Y", "A"], eight_bits(&image, 2, 1)),
        DynamicImage::ImageRgb8(image) => (&["R", "G", "B"], eight_bits(&image, 3, 3)),
        DynamicImage::ImageRgba8(image) => (&["R", "G", "B", "A"], eight_bits(&image, 4, 3)),
        DynamicImage::ImageRgb32F(image) => (&["R", "G", "B"], image.into_raw()),
        other => {
            let kind: ColorType = other.color();
            return Err(format!("{name} file with pixels that are not supported: {kind:?}"));
        }
    };
    let names = names.iter().map(ToString::to_string).collect();
    Image::new(window, window, names, data).map_err(|error| error.to_string())
}
