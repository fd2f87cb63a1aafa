//! The scene format of Mitsuba 3 (and 2): XML.
//!
//! Read in three steps. `xml` makes elements with their places of files, replaces `$parameters` and puts `<include>`d files in their
//! place; `graph` makes objects with typed properties of these, and resolves references; `loader` and the files beside it translate the
//! plugins, one class a file. As in Mitsuba, a property that no reader asks for is an error.
//!
//! What differs from pbrt's conventions is translated here, or has a kind of its own in the description:
//!
//! - A bsdf that is not inside a `twosided` is black from behind ([`MaterialKind::Sided`](super::MaterialKind::Sided)).
//! - Masking and shadowing of microfacets are independent
//!   ([`RoughnessDesc::separable_masking`](super::RoughnessDesc::separable_masking)).
//! - A light's spectrum is not normalised to its luminance, so that its description has that luminance as its scale.
//! - `max_depth` counts edges, one more than scattering events; -1 is no limit.
//! - A camera's x axis points to the left of the picture, and its angle of view is that of the width.
//! - The first row of an image is at v = 0; meshes get 1 - v for pbrt's convention.

mod attribute;
mod bsdf;
mod camera;
mod curve;
mod emitter;
mod film;
mod graph;
mod integrator;
mod ior;
mod light_image;
mod loader;
mod medium;
mod mesh;
mod nested;
mod parameters;
mod plugins;
mod props;
mod shape;
mod solids;
mod spectrum;
mod texture;
mod transform;
mod values;
mod xml;

use std::path::Path;

use super::{ParseOptions, SceneDesc, bytes};
use crate::error::{Error, Result};
use graph::Graph;
use loader::Loader;
use xml::XmlReader;

/// Reads a Mitsuba scene file.
///
/// # Errors
///
/// See [`super::load`].
pub fn load(path: &Path, options: &ParseOptions) -> Result<SceneDesc> {
    let text = bytes::read(path, u32::MAX.into()).map_err(|e| Error::io("read", path, e))?;
    parse(text, path, options)
}

/// Reads a scene from a text, as if it were in the file `path`: messages name it, and other files are looked for beside it.
///
/// # Errors
///
/// [`Error::Scene`] with every problem found, [`Error::Usage`] for a text of 4 GiB or more.
pub fn parse_str(text: &[u8], path: &Path, options: &ParseOptions) -> Result<SceneDesc> {
    if u32::try_from(text.len()).is_err() {
        return Err(Error::Usage("a scene text is longer than 4 GiB".to_owned()));
    }
    parse(text.to_vec(), path, options)
}

fn parse(text: Vec<u8>, path: &Path, options: &ParseOptions) -> Result<SceneDesc> {
    let mut xml = XmlReader::new(path, options);
    let Some(root) = xml.read(path, text) else {
        return Err(Error::Scene(xml.report.into_errors()));
    };
    let graph = Graph::new(&root, &mut xml);
    // Objects that contain themselves must not be followed.
    if xml.report.has_errors() {
        return Err(Error::Scene(xml.report.into_errors()));
    }
    let unused: Vec<String> = xml.parameters.unused().map(str::to_owned).collect();
    if !unused.is_empty() {
        let message = format!("the scene has no parameter ${}", unused.join(", $"));
        xml.report.error(root.span, message);
    }
    Loader::new(&graph, xml).scene()
}
