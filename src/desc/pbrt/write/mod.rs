//! Scenes as pbrt-v4 files: what is written, read back, is the same scene, number for number.
//!
//! What pbrt-v4 cannot say is written as one of Lucerna's extensions, and noted. Meshes of some size, and images that have no file of
//! their own, become files in a folder beside the scene's.

mod entity;
mod lights;
mod materials;
mod parts;
mod shapes;
mod textures;
mod view;

use std::collections::BTreeSet;
use std::path::Path;

use entity::{Entity, quoted, transform};
use glam::DAffine3;
use parts::Parts;

use super::super::{ColorSpace, MotionDesc, SceneDesc};
use crate::error::{Error, Result};
use crate::image_io::replace_file;

/// Writes `desc` to the file `path`, and what belongs to it into the folder `NAME-parts` beside, where `path` is `NAME.pbrt`. Returns
/// the extensions that the file uses, for people.
///
/// # Errors
/// [`Error::Io`] if a file cannot be written, [`Error::Usage`] for what no file can say.
pub fn write(desc: &SceneDesc, path: &Path) -> Result<Vec<String>> {
    let mut writer = Writer {
        desc,
        parts: Parts::beside(path),
        text: String::new(),
        space: ColorSpace::default(),
        texture_names: textures::names(desc),
        material_names: materials::names(desc),
        notes: BTreeSet::new(),
    };
    writer.options()?;
    writer.media()?;
    writer.line("WorldBegin");
    writer.textures()?;
    writer.materials()?;
    writer.lights()?;
    writer.shapes()?;
    replace_file(path, writer.text.as_bytes())?;
    Ok(writer.notes.into_iter().collect())
}

/// A file in the making.
struct Writer<'a> {
    desc: &'a SceneDesc,
    parts: Parts,
    text: String,
    /// The color space in force.
    space: ColorSpace,
    /// By texture.
    texture_names: Vec<String>,
    /// By material.
    material_names: Vec<String>,
    notes: BTreeSet<String>,
}

impl Writer<'_> {
    fn line(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }

    /// Writes a directive, in the color space that it wants.
    fn put(&mut self, entity: Entity) -> Result<()> {
        let (space, is_mixed, text) = entity.finish();
        if is_mixed {
            let message = "parameters in several color spaces in one directive cannot be written";
            return Err(Error::Usage(message.to_owned()));
        }
        self.in_space(space);
        self.line(&text);
        Ok(())
    }

    fn in_space(&mut self, space: ColorSpace) {
        if space != self.space {
            self.line(&format!("ColorSpace {}", quoted(space.name())));
            self.space = space;
        }
    }

    /// Writes what `inside` writes as a block, after which the state is what it was.
    fn block(&mut self, inside: impl FnOnce(&mut Self) -> Result<()>) -> Result<()> {
        let space = self.space;
        self.line("\nAttributeBegin");
        inside(self)?;
        self.line("AttributeEnd");
        self.space = space;
        Ok(())
    }

    /// Makes `motion` the current transform.
    fn motion(&mut self, motion: &MotionDesc) {
        if motion.is_static() {
            if motion.start != DAffine3::IDENTITY {
                self.line(&transform(&motion.start));
            }
            return;
        }
        self.line("ActiveTransform StartTime");
        self.line(&transform(&motion.start));
        self.line("ActiveTransform EndTime");
        self.line(&transform(&motion.end));
        self.line("ActiveTransform All");
    }

    /// Says that the file goes beyond pbrt-v4.
    fn note(&mut self, extension: &str) {
        self.notes.insert(extension.to_owned());
    }
}
