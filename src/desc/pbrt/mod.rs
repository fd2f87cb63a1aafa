//! The pbrt-v4 scene format.

use std::path::Path;

use super::{ParseOptions, SceneDesc};
use crate::error::{Error, Result};

/// Reads a pbrt-v4 scene file.
pub fn load(path: &Path, _options: &ParseOptions) -> Result<SceneDesc> {
    Err(Error::Usage(format!(
        "{}: the reader is not written yet",
        path.display()
    )))
}
