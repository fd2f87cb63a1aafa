//! PNG files: 8-bit sRGB out, 8 or 16 bits in.

use super::{Encoding, Image, Window, check_length, image_error, read_bytes, srgb};
use crate::Result;
use ::png::{BitDepth, ColorType, Decoder, Encoder, SrgbRenderingIntent, Transformations};
use std::io::Cursor;
use std::path::Path;

/// The most bytes that a compressed byte can stand for.
const DEFLATE: u64 = 1032;

/// Reads a PNG file (any colour type and depth) as linear values in [0, 1]: channels R, G, B or Y, and A if the file has alpha or a
/// transparent colour. Colour is taken as sRGB whatever gamma or profile the file names, alpha as linear; colour is not multiplied
/// by alpha.
///
/// # Errors
/// [`crate::Error::Io`] if the file cannot be read, [`crate::Error::Image`] if it is malformed, truncated or too large for memory.
pub fn read_png(path: &Path) -> Result<Image> {
    decode(&read_bytes(path)?, Encoding::Srgb).map_err(|message| image_error(path, message))
}

/// The image in a PNG file's bytes, with colour in `encoding`, or what is wrong with them.
pub(super) fn decode(bytes: &[u8], encoding: Encoding) -> Result<Image, String> {
    let malformed = |error: ::png::DecodingError| format!("malformed PNG file: {error}");
    let mut decoder = Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(malformed)?;
    let (header, mut samples) = (reader.info(), Vec::new());
    let pixels = u64::from(header.width) * u64::from(header.height);
    let packed = pixels.saturating_mul(header.bits_per_pixel() as u64) / 8;
    check_length(packed, bytes, DEFLATE)?;
    let size = reader.output_buffer_size();
    // The decoded bytes, and four times as much for them as floats.
    let fits = size.is_some_and(|n| Vec::<[u8; 5]>::new().try_reserve_exact(n).is_ok());
    let (Some(size), true) = (size, fits) else {
        return Err("the pixels do not fit into memory".to_owned());
    };
    samples.resize(size, 0);
    let info = reader.next_frame(&mut samples).map_err(malformed)?;
    let samples = &samples[..info.buffer_size()];

    let (names, colours): (&[&str], usize) = match info.color_type {
        ColorType::Grayscale => (&["Y"], 1),
        ColorType::GrayscaleAlpha => (&["Y", "A"], 1),
        ColorType::Rgb => (&["R", "G", "B"], 3),
        ColorType::Rgba => (&["R", "G", "B", "A"], 3),
        ColorType::Indexed => return Err("malformed PNG file: the palette is missing".to_owned()),
    };
    let encoded: Vec<f32> = match info.bit_depth {
        BitDepth::Sixteen => samples
            .chunks_exact(2)
            .map(|pair| f32::from(u16::from_be_bytes([pair[0], pair[1]])) / 65535.0)
            .collect(),
        _ => samples.iter().map(|&code| f32::from(code) / 255.0).collect(),
    };
    let linear = |(i, value): (usize, f32)| {
        let is_alpha = i % names.len() >= colours;
        if is_alpha { value } else { encoding.decode(value) }
    };
    let data = encoded.into_iter().enumerate().map(linear).collect();
    let side = |n: u32| i32::try_from(n).map_err(|_| "malformed PNG file: larger than PNG allows".to_owned());
    let window = Window::of_size(side(info.width)?, side(info.height)?);
    let names = names.iter().map(ToString::to_string).collect();
    Image::new(window, window, names, data).map_err(|error| error.to_string())
}

/// The bytes of an 8-bit RGB file of the image's data window (PNG cannot say where a crop lies), with the sRGB chunk. Values are
/// multiplied by `2^exposure`, clamped to [0, 1] and rounded to the nearest code; NaN is black.
pub(super) fn encode(image: &Image, exposure: f32) -> Result<Vec<u8>, String> {
    let pixels = image
        .to_rgb()
        .ok_or("a PNG file needs the channels R, G, B or Y".to_owned())?;
    let scale = exposure.exp2();
    let codes: Vec<u8> = pixels
        .iter()
        .flatten()
        .map(|value| srgb::encode_u8(value * scale))
        .collect();
    let side = |n: usize| u32::try_from(n).map_err(|_| "larger than PNG allows".to_owned());
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, side(image.width())?, side(image.height())?);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_source_srgb(SrgbRenderingIntent::RelativeColorimetric);
    let explain = |error: ::png::EncodingError| error.to_string();
    let mut writer = encoder.write_header().map_err(explain)?;
    writer.write_image_data(&codes).map_err(explain)?;
    writer.finish().map_err(explain)?;
    Ok(bytes)
}
