//! Images to and from plain arrays: EXR and PNG files, atomic output, and measures of the difference of two images.
//!
//! - [`Image`] holds linear values and knows which part of the whole picture it is (data window and display window).
//! - [`read`] reads any supported file; [`PendingOutput`] writes one, in two steps around the render.
//! - [`Comparison`] is what `lucerna compare` prints; [`flip`] is its perceptual part.
//!
//! Nothing here knows about scenes or rendering.

mod exr;
pub mod flip;
mod image;
mod metadata;
mod metrics;
mod output;
mod png;
pub mod srgb;

pub use self::exr::read_exr;
pub use self::image::{Image, Window};
pub use self::metadata::ImageMetadata;
pub use self::metrics::Comparison;
pub use self::output::{ImageFormat, PendingOutput, Written};
pub use self::png::read_png;

use crate::{Error, Result};
use std::path::Path;

/// The first bytes of every EXR file.
const EXR_MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];
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
        png::decode(&bytes)
    } else {
        Err("neither an EXR nor a PNG file".to_owned())
    }
    .map_err(|message| image_error(path, message))
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
