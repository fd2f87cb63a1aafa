//! The image files that a scene names: each is read once for each encoding, all of them in parallel at the end.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use rayon::prelude::*;

use super::report::Report;
use super::{ColorSpace, ImageDesc, ImageId};
use crate::error::{Error, Span};
use crate::image_io::{self, Encoding, Image};

/// The images named so far.
#[derive(Debug, Default)]
pub(in crate::desc) struct PendingImages {
    /// The files, and where each was first named.
    files: Vec<(PathBuf, Encoding, Span)>,
    /// By path and name of the encoding.
    indices: HashMap<(PathBuf, String), ImageId>,
}

impl PendingImages {
    /// The image in a file that is named at `span`.
    pub fn add(&mut self, path: PathBuf, encoding: Encoding, span: Span) -> ImageId {
        let files = &mut self.files;
        let key = (path, format!("{encoding:?}"));
        *self.indices.entry(key).or_insert_with_key(|(path, _)| {
            files.push((path.clone(), encoding, span));
            // There are fewer images than bytes in a file.
            ImageId(files.len() as u32 - 1)
        })
    }
}

/// Reads all images; `count` is told the hash of each file, in order. Complains about those that cannot be read, and leaves them
/// out.
pub(in crate::desc) fn read(
    pending: &PendingImages,
    report: &mut Report,
    mut count: impl FnMut(&blake3::Hash),
) -> Vec<ImageDesc> {
    let files = &pending.files;
    let read: Vec<_> = files
        .par_iter()
        .map(|(path, encoding, _)| read_one(path, *encoding))
        .collect();
    let mut images = Vec::with_capacity(read.len());
    for ((path, encoding, span), outcome) in files.iter().zip(read) {
        match outcome {
            Ok((image, hash)) => {
                count(&hash);
                check_color_space(report, *span, path, &image);
                images.push(ImageDesc {
                    path: path.clone(),
                    encoding: *encoding,
                    image: Arc::new(image),
                });
            }
            Err(problem) => report.error(*span, problem),
        }
    }
    images
}

/// Says so if the colours of an image are in a space that has no name.
pub(in crate::desc) fn check_color_space(report: &mut Report, span: Span, path: &Path, image: &Image) {
    if let Some(chromaticities) = image.chromaticities()
        && ColorSpace::from_chromaticities(chromaticities).is_none()
    {
        let message = format!(
            "the chromaticities in {} are of no color space that has a name: sRGB is taken",
            path.display()
        );
        report.warning(span, message);
    }
}

/// An image and the hash of its file, or what is wrong.
fn read_one(path: &Path, encoding: Encoding) -> Result<(Image, blake3::Hash), String> {
    let bytes = std::fs::read(path).map_err(|e| format!("cannot read the image {}: {e}", path.display()))?;
    let image = image_io::decode(&bytes, path, encoding).map_err(|e| match e {
        Error::Image { message, .. } => format!("cannot read the image {}: {message}", path.display()),
        other => other.to_string(),
    })?;
    if image.colour_channels().is_none() {
        let found = image.channels().join(", ");
        return Err(format!(
            "the image {} has neither R, G and B nor Y, only {found}",
            path.display()
        ));
    }
    Ok((image, blake3::hash(&bytes)))
}
