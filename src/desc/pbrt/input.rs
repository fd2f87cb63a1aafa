//! The files being read: the main one, and those that `Include` and `Import` put on top.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::files::Context;
use super::tokens::Lexer;
use crate::error::Span;

/// The stack of open files. It is a vector, so no input can overflow the program's stack.
#[derive(Debug, Default)]
pub(super) struct Input {
    open: Vec<OpenFile>,
    /// All files so far, without links.
    seen: HashSet<PathBuf>,
    /// How often a file was opened that had been read before, and how many bytes that was.
    again: (usize, usize),
}

/// A file being read.
#[derive(Debug)]
pub(super) struct OpenFile {
    pub lexer: Lexer,
    /// Whether `Import` opened it: then it leaves the graphics state as it found it.
    pub is_import: bool,
    /// Without links, to find cycles.
    path: PathBuf,
}

/// More files cannot be open at once.
const DEEPEST: usize = 64;

/// Files that are read again, and their bytes: each of a few files that includes the next one twice would never come to an end.
const MOST_AGAIN: (usize, usize) = (20_000, 1 << 30);

impl Input {
    /// The file that is read now.
    pub fn current(&mut self) -> Option<&mut OpenFile> {
        self.open.last_mut()
    }

    /// Opens the main file, whose text is there already.
    pub fn open_main(&mut self, context: &mut Context, path: &Path, text: Vec<u8>) {
        context.count(&text);
        self.push(context, path, text, false);
    }

    /// Opens a file that `Include` or `Import` names at `span`. If that cannot be, says so and changes nothing.
    pub fn open(&mut self, context: &mut Context, name: &str, span: Span, is_import: bool) -> bool {
        let path = context.resolve(name, span);
        let canonical = path.canonicalize().unwrap_or_else(|_| path.clone());
        let problem = if self.open.iter().any(|f| f.path == canonical) {
            format!("{} includes itself", path.display())
        } else if self.open.len() >= DEEPEST {
            format!("more than {DEEPEST} files include one another")
        } else {
            match context.read_text(&path) {
                Ok(text) if self.may_read(canonical, text.len()) => {
                    self.push(context, &path, text, is_import);
                    return true;
                }
                Ok(_) => "files are included again and again, without end as it seems".to_owned(),
                Err(e) => format!("cannot read {}: {e}", path.display()),
            }
        };
        context.report.error(span, problem);
        false
    }

    /// Counts a file of this length; false if it makes too much of those that are read again.
    fn may_read(&mut self, path: PathBuf, length: usize) -> bool {
        if !self.seen.insert(path) {
            self.again = (self.again.0 + 1, self.again.1.saturating_add(length));
        }
        self.again.0 <= MOST_AGAIN.0 && self.again.1 <= MOST_AGAIN.1
    }

    /// Closes the current file.
    pub fn close(&mut self) -> Option<OpenFile> {
        self.open.pop()
    }

    fn push(&mut self, context: &mut Context, path: &Path, text: Vec<u8>, is_import: bool) {
        let start = if text.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        let utf16 = text.starts_with(b"\xff\xfe") || text.starts_with(b"\xfe\xff");
        let file = context.report.add_file(path, Arc::from(text));
        if utf16 {
            let span = Span { file, start: 0, end: 1 };
            context.report.error(span, "this file is UTF-16; expected UTF-8");
        }
        self.open.push(OpenFile {
            lexer: Lexer::new(&context.report, file, start),
            is_import,
            path: path.canonicalize().unwrap_or_else(|_| path.to_owned()),
        });
    }
}
