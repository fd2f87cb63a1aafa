//! Images to and from plain arrays: EXR and PNG files, readers of other formats, atomic output, and measures of the difference of
//! two images.
//!
//! - [`Image`] holds linear values and knows which part of the whole picture it is (data window and display window).
//! - [`read`] reads any supported file; [`PendingOutput`] writes one, in two steps around the render.
//! - [`Comparison`] is what `lucerna compare` prints; [`flip`] is its perceptual part.
//!
//! Nothing here knows about scenes or rendering.

mod encoding;
mod exr;
mod false_color;
pub mod flip;
mod foreign;
mod image;
mod metadata;
mod metrics;
mod output;
mod pfm;
mod png;
pub mod srgb;

pub use self::encoding::Encoding;
pub use self::exr::read_exr;
pub use self::false_color::false_colors;
pub use self::image::{Chromaticities, Image, Window};
pub use self::metadata::ImageMetadata;
pub use self::metrics::Comparison;
pub use self::output::{ImageFormat, PendingOutput, Written, replace_file};
pub use self::png::read_png;

use crate::{Error, Result};
use std::path::Path;

/// The first bytes of every EXR file.
const EXR_MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];
/// The first bytes of every JPEG file.
const JPEG_MAGIC: [u8; 3] = [0xff, 0xd8, 0xff];
/// The first bytes of every PNG file.
const PNG_MAGIC: [u8; 8] = *b"\x89PNG\r\n\x1a\n";

/// Reads an EXR or PNG file as linear values; the contents say which it is, not the name.
///
/// # Errors
/// [`Error::Io`] if the file cannot be read, [`Error::Image`] if it is neither kind, malformed, or of a variant that is not
/// supported (see [`read_exr`] and [`read_png`]).
pub fn read(path: &Path) -> Result<Image> {
    let bytes = read_bytes(path)?;
    if bytes.starts_with(&EXR_MAGIC) {
        exr::decode(&bytes).map(|(image, _)| image)
    } else if bytes.starts_with(&PNG_MAGIC) {
        png::decode(&bytes, Encoding::Srgb)
    } else {
        Err("neither an EXR nor a PNG file".to_owned())
    }
    .map_err(|message| image_error(path, message))
}

/// The image in the bytes of a PNG, EXR, JPEG, TGA, HDR or PFM file, as linear values; the contents say which format it is, but for
/// TGA, which has no mark and goes by the extension of `path`. `encoding` is that of the samples of the integer formats (PNG, JPEG,
/// TGA), alpha excepted; a single part or frame is read.
///
/// # Errors
/// [`Error::Image`] about `path` if it is none of these, malformed, or of a variant that is not supported.
pub fn decode(bytes: &[u8], path: &Path, encoding: Encoding) -> Result<Image> {
    let is_tga = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("tga"));
    if bytes.starts_with(&EXR_MAGIC) {
        exr::decode(bytes).map(|(image, _)| image)
    } else if bytes.starts_with(&PNG_MAGIC) {
        png::decode(bytes, encoding)
    } else if bytes.starts_with(&JPEG_MAGIC) {
        foreign::decode(bytes, ::image::ImageFormat::Jpeg, encoding)
    } else if bytes.starts_with(b"#?") {
        foreign::decode(bytes, ::image::ImageFormat::Hdr, encoding)
    } else if bytes.starts_with(b"PF") || bytes.starts_with(b"Pf") {
        pfm::decode(bytes)
    } else if is_tga {
        foreign::decode(bytes, ::image::ImageFormat::Tga, encoding)
    } else {
        Err("not a PNG, EXR, JPEG, TGA, HDR or PFM file".to_owned())
    }
    .map_err(|message| image_error(path, message))
}

/// Refuses a file of which a header promises more `units` (pixels or bytes) than it can hold, if a byte can stand for `most` of them:
/// before anything is allocated by that number.
fn check_length(units: u64, file: &[u8], most: u64) -> Result<(), String> {
    if units <= most.saturating_mul(file.len() as u64) {
        return Ok(());
    }
    Err("the file is too short for as many pixels as it claims to have".to_owned())
}

/// The whole file.
fn read_bytes(path: &Path) -> Result<Vec<u8>> {
    std::fs::read(path).map_err(|source| Error::io("read", path, source))
}

/// An [`Error::Image`] about `path`.
fn image_error(path: &Path, message: String) -> Error {
    Error::Image {
        path: path.to_owned(),
        message,
    }
}
