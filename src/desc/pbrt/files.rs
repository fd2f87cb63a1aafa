//! The files of a scene: where they are, what is in them, and one hash over them all.

use std::io;
use std::path::{Path, PathBuf};

use super::images::{self, PendingImages};
use super::report::Report;
use super::texture_names::Textures;
use crate::desc::{ColorSpace, ImageDesc, ParseOptions, bytes};
use crate::error::Span;

/// What every part of the reader shares: the report and the files.
#[derive(Debug)]
pub(super) struct Context {
    pub report: Report,
    /// The textures so far.
    pub textures: Textures,
    /// What `rgb` parameters are in.
    pub color_space: ColorSpace,
    /// The image files named so far.
    pub images: PendingImages,
    /// Where the main file is.
    directory: PathBuf,
    hasher: blake3::Hasher,
    defaults: Vec<Default>,
}

/// A parameter that `Attribute` set.
#[derive(Debug)]
struct Default {
    span: Span,
    /// `shape`, `light`, `material` or `texture`.
    target: &'static str,
    name: String,
    /// Whether any entity had a parameter of that name.
    known: bool,
}

/// Spans count bytes in 32 bits.
const LONGEST_TEXT: u64 = u32::MAX as u64;

impl Context {
    /// For a scene whose main file is in `directory`.
    pub fn new(directory: &Path, options: &ParseOptions) -> Self {
        Self {
            report: Report::new(options),
            textures: Textures::default(),
            color_space: ColorSpace::default(),
            images: PendingImages::default(),
            directory: directory.to_owned(),
            hasher: blake3::Hasher::new(),
            defaults: Vec::new(),
        }
    }

    /// A file named in the scene at `span`. As in pbrt-v4 names are relative to the main file's directory; what is not there is
    /// looked for beside the file that names it.
    pub fn resolve(&self, name: &str, span: Span) -> PathBuf {
        let path = self.directory.join(name);
        if path.exists() {
            return path;
        }
        let naming = self.report.sources.path(span.file).parent();
        let beside = naming.unwrap_or(Path::new("")).join(name);
        if beside.exists() { beside } else { path }
    }

    /// Reads a text, decompressed if need be, and counts it in the hash.
    ///
    /// # Errors
    ///
    /// See [`bytes::read`].
    pub fn read_text(&mut self, path: &Path) -> io::Result<Vec<u8>> {
        let text = bytes::read(path, LONGEST_TEXT)?;
        self.count(&text);
        Ok(text)
    }

    /// Counts the content of a file in the hash.
    pub fn count(&mut self, content: &[u8]) {
        self.hasher.update(&(content.len() as u64).to_le_bytes());
        self.hasher.update(content);
    }

    /// Counts a file that was hashed on its own.
    pub fn count_hash(&mut self, hash: &blake3::Hash) {
        self.hasher.update(hash.as_bytes());
    }

    /// Reads the images that are named, and counts them.
    pub fn read_images(&mut self, pending: &PendingImages) -> Vec<ImageDesc> {
        let hasher = &mut self.hasher;
        images::read(pending, &mut self.report, |hash| {
            hasher.update(hash.as_bytes());
        })
    }

    /// The hash of everything counted.
    pub fn hash(&self) -> String {
        self.hasher.finalize().to_hex().to_string()
    }

    /// Notes that `Attribute` sets a parameter for all entities of a class; its number.
    pub fn add_default(&mut self, target: &'static str, name: &str, span: Span) -> usize {
        self.defaults.push(Default {
            span,
            target,
            name: name.to_owned(),
            known: false,
        });
        self.defaults.len() - 1
    }

    /// Notes that an entity knows the parameter that was set with this number.
    pub fn use_default(&mut self, number: usize) {
        self.defaults[number].known = true;
    }

    /// Warns about what `Attribute` set for nobody: it may be misspelt.
    pub fn report_unused_defaults(&mut self) {
        for default in self.defaults.iter().filter(|d| !d.known) {
            let message = format!(
                "`{}` has no effect: no {} after this has such a parameter",
                default.name, default.target
            );
            self.report.warning(default.span, message);
        }
    }
}
