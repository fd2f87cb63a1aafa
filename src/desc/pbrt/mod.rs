//! The pbrt-v4 scene format; files of pbrt-v3 are translated (`v3`).
//!
//! Read in three steps: `tokens` cuts the text, `directives` reads the arguments of each directive and has the `Builder` carry
//! it out (the parameters of each kind of entity have a file of their own), and `finish` resolves names and reads mesh files.
//! Nothing recurses, so no input can exhaust the stack.
//!
//! Beyond pbrt-v4, whatever is unknown, has the wrong type or is given twice is an error, many of them in one run.

mod attributes;
mod blocks;
mod builder;
mod camera;
mod directives;
mod files;
mod film;
mod finish;
mod input;
mod integrator;
mod light;
mod material;
mod medium;
mod nested;
mod options;
mod params;
mod reader;
mod realistic;
mod sampler;
mod sensor;
mod shape;
mod spectrum;
mod state;
mod texture;
mod texture_names;
mod textured;
mod tokens;
mod v3;
mod world;
mod write;

use std::path::Path;

use super::{ParseOptions, SceneDesc, images, report, suggest};
use crate::error::{Error, Result, Span};
use builder::Builder;
use directives::{Next, execute};
use files::Context;
use input::Input;

pub use write::write;

/// Reads a pbrt-v4 scene file.
///
/// # Errors
///
/// See [`super::load`].
pub fn load(path: &Path, options: &ParseOptions) -> Result<SceneDesc> {
    let text = super::bytes::read(path, u32::MAX.into()).map_err(|e| Error::io("read", path, e))?;
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
    let directory = path.parent().unwrap_or(Path::new(""));
    let mut builder = Builder::new(Context::new(directory, options));
    let mut input = Input::default();
    let world_end = v3::world_end(&text);
    input.open_main(&mut builder.context, path, text);
    if let (Some(start), Some(file)) = (world_end, input.current()) {
        // Texts are shorter than 4 GiB.
        let start = start as u32;
        let span = Span {
            start,
            end: start + 8,
            ..file.lexer.here()
        };
        builder.context.report.set_old(span);
    }
    let mut end = Span::default();
    while let Some(file) = input.current() {
        if builder.context.report.is_full() {
            break;
        }
        let Some(token) = file.lexer.next() else {
            end = file.lexer.here();
            if input.close().is_some_and(|file| file.is_import) {
                builder.import_end();
            }
            continue;
        };
        if let Next::Open { name, span, is_import } = execute(&mut builder, &mut file.lexer, token)
            && input.open(&mut builder.context, &name, span, is_import)
            && is_import
        {
            builder.import_begin(span);
        }
    }
    if !builder.context.report.is_full() {
        builder.end(end);
    }
    finish::finish(builder)
}
