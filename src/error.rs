//! The one error type of the crate, and the located diagnostics that scene files get.
//!
//! The library never prints and never exits: it returns an [`Error`], and `main` alone prints it and picks the exit code.

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Everything that can go wrong, by whose fault it is.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The scene description is wrong or asks for what Lucerna does not support: every problem found, in file order.
    #[error("{}", join(.0))]
    Scene(Vec<Diagnostic>),
    /// The command line, or an argument of a library call, makes no sense.
    #[error("{0}")]
    Usage(String),
    /// A file could not be read or written.
    #[error("cannot {action} {}: {source}", .path.display())]
    Io {
        /// What was tried: `read`, `write`, `create`.
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// An image file is malformed or of a kind that is not supported.
    #[error("{}: {message}", .path.display())]
    Image {
        /// The file.
        path: PathBuf,
        /// What is wrong, and what was expected.
        message: String,
    },
    /// An intersection backend failed.
    #[error("backend {backend}: {message}")]
    Backend {
        /// `embree` or `bvh`.
        backend: &'static str,
        /// What it said.
        message: String,
    },
}

/// The result of everything fallible in this crate.
pub type Result<T, E = Error> = std::result::Result<T, E>;

impl Error {
    /// An [`Error::Io`] for `path`.
    pub fn io(action: &'static str, path: &Path, source: std::io::Error) -> Self {
        Self::Io {
            action,
            path: path.to_owned(),
            source,
        }
    }

    /// The exit code of the process that ends by this error: 2 for a bad scene or bad usage, 1 for anything else.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Scene(_) | Self::Usage(_) => 2,
            Self::Io { .. } | Self::Image { .. } | Self::Backend { .. } => 1,
        }
    }
}

/// A place in a scene file. Cheap to copy: it names the file by its index in a [`SourceMap`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Span {
    /// Index of the file in the [`SourceMap`].
    pub file: u32,
    /// First byte.
    pub start: u32,
    /// One past the last byte.
    pub end: u32,
}

/// The texts of the files that a scene was read from, so that a [`Span`] can be shown to a person.
#[derive(Clone, Debug, Default)]
pub struct SourceMap {
    files: Vec<(Arc<Path>, Arc<[u8]>)>,
}

impl SourceMap {
    /// Adds a file and returns its index, the `file` of its spans.
    pub fn add(&mut self, path: &Path, text: Arc<[u8]>) -> u32 {
        self.files.push((Arc::from(path), text));
        u32::try_from(self.files.len() - 1).expect("fewer than 2^32 files")
    }

    /// The path of file `index`.
    pub fn path(&self, index: u32) -> &Path {
        &self.files[index as usize].0
    }

    /// The paths of all files.
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        self.files.iter().map(|(path, _)| &**path)
    }

    /// A diagnostic at `span`, with the line it points into.
    pub fn diagnostic(&self, severity: Severity, span: Span, message: String) -> Diagnostic {
        let (path, text) = &self.files[span.file as usize];
        Diagnostic::new(severity, path, text, span.start as usize..span.end as usize, message)
    }
}

/// How much a diagnostic matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// The scene cannot be rendered as it is written.
    Error,
    /// The scene can be rendered; something in it has no effect or is approximated.
    Warning,
}

/// One problem at one place of a scene file.
#[derive(Clone, Debug)]
pub struct Diagnostic {
    /// Whether it stops the render.
    pub severity: Severity,
    /// The file.
    pub path: PathBuf,
    /// Counted from 1.
    pub line: usize,
    /// In characters, counted from 1.
    pub column: usize,
    /// How many characters are meant, at least 1.
    pub width: usize,
    /// The line itself, without its end.
    pub source_line: String,
    /// What is wrong, and what was expected.
    pub message: String,
    /// What to do about it ("did you mean ...?").
    pub help: Option<String>,
}

impl Diagnostic {
    /// About the bytes `place` of the `text` of a file, with the line that they begin in.
    pub fn new(severity: Severity, path: &Path, text: &[u8], place: Range<usize>, message: String) -> Self {
        let start = place.start.min(text.len());
        let line_start = text[..start].iter().rposition(|&b| b == b'\n').map_or(0, |i| i + 1);
        let line_end = text[start..]
            .iter()
            .position(|&b| b == b'\n')
            .map_or(text.len(), |i| start + i);
        let chars = |bytes: &[u8]| String::from_utf8_lossy(bytes).chars().count();
        Self {
            severity,
            path: path.to_owned(),
            line: 1 + text[..start].iter().filter(|&&b| b == b'\n').count(),
            column: 1 + chars(&text[line_start..start]),
            width: chars(&text[start..place.end.clamp(start, line_end)]).max(1),
            source_line: String::from_utf8_lossy(&text[line_start..line_end])
                .trim_end()
                .to_owned(),
            message,
            help: None,
        }
    }
}

/// The longest part of a source line that a diagnostic shows: a mesh may well be one line of a megabyte.
const SHOWN_CHARS: usize = 100;

impl fmt::Display for Diagnostic {
    /// `file:line:column: error: message`, the source line, a caret under the place, and the help.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let severity = match self.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        let (path, line, column) = (self.path.display(), self.line, self.column);
        write!(f, "{path}:{line}:{column}: {severity}: {}", self.message)?;
        let first = (self.column - 1).saturating_sub(SHOWN_CHARS / 2);
        let shown: String = self
            .source_line
            .chars()
            .skip(first)
            .take(SHOWN_CHARS)
            .map(|c| if c.is_control() { ' ' } else { c })
            .collect();
        let margin = line.to_string().len();
        let caret = self.column - 1 - first;
        let width = self.width.min(shown.chars().count().saturating_sub(caret)).max(1);
        write!(
            f,
            "\n{:margin$} |\n{line} | {shown}\n{:margin$} | {:caret$}{}",
            "",
            "",
            "",
            "^".repeat(width)
        )?;
        if let Some(help) = &self.help {
            write!(f, "\n{:margin$} = help: {help}", "")?;
        }
        Ok(())
    }
}

/// All of them, and how many there are where that is not seen at a glance.
fn join(diagnostics: &[Diagnostic]) -> String {
    const FEW: usize = 3;
    let mut lines: Vec<String> = diagnostics.iter().map(ToString::to_string).collect();
    if diagnostics.len() > FEW {
        lines.push(format!("{} errors", diagnostics.len()));
    }
    lines.join("\n")
}
