//! What is wrong with a scene, collected while reading goes on.

use std::path::Path;
use std::sync::Arc;

use super::ParseOptions;
use super::suggest;
use crate::error::{Diagnostic, Error, Severity, SourceMap, Span};

/// After so many errors reading stops, and so many warnings are kept: whoever has more will want to fix these first.
const MOST: usize = 50;

/// Why a scene cannot have a mesh that it names: the place in the mesh's file, and what is wrong there first of all.
pub(in crate::desc) fn mesh_problem(path: &Path, error: &Error) -> String {
    let path = path.display();
    match error {
        Error::Scene(diagnostics) if !diagnostics.is_empty() => {
            let Diagnostic {
                line, column, message, ..
            } = &diagnostics[0];
            format!("cannot read the mesh {path}:{line}:{column}: {message}")
        }
        Error::Io { source, .. } => format!("cannot read the mesh {path}: {source}"),
        other => format!("cannot read the mesh {path}: {other}"),
    }
}

/// The files read so far, and what was found wrong in them.
#[derive(Debug, Default)]
pub(in crate::desc) struct Report {
    pub sources: SourceMap,
    texts: Vec<Arc<[u8]>>,
    errors: Vec<(Span, Diagnostic)>,
    warnings: Vec<(Span, Diagnostic)>,
    warnings_left_out: usize,
    lenient: bool,
    /// Errors that would be warnings with `--lenient`.
    forgivable: usize,
    /// Whether the scene is of pbrt-v3.
    old: bool,
    /// What was translated from pbrt-v3: where first, how, and how often.
    translated: Vec<(Span, &'static str, usize)>,
}

impl Report {
    pub fn new(options: &ParseOptions) -> Self {
        Self {
            lenient: options.lenient,
            ..Self::default()
        }
    }

    /// Adds a file, at most 4 GiB of it; returns its index.
    pub fn add_file(&mut self, path: &Path, text: Arc<[u8]>) -> u32 {
        self.texts.push(Arc::clone(&text));
        self.sources.add(path, text)
    }

    /// The text of a file, shared.
    pub fn text(&self, file: u32) -> Arc<[u8]> {
        Arc::clone(&self.texts[file as usize])
    }

    /// The bytes that a span covers.
    pub fn bytes(&self, span: Span) -> &[u8] {
        self.texts[span.file as usize]
            .get(span.start as usize..span.end as usize)
            .unwrap_or_default()
    }

    /// What a span covers, to be quoted in a message: at most some 40 characters.
    pub fn excerpt(&self, span: Span) -> String {
        const LONGEST: usize = 40;
        let text = String::from_utf8_lossy(self.bytes(span)).replace(char::is_control, " ");
        match text.char_indices().nth(LONGEST) {
            None => text,
            Some((cut, _)) => format!("{}...", &text[..cut]),
        }
    }

    /// The scene cannot be rendered as it is.
    pub fn error(&mut self, span: Span, message: impl Into<String>) {
        self.error_with_help(span, message, None);
    }

    /// [`Self::error`] with advice.
    pub fn error_with_help(&mut self, span: Span, message: impl Into<String>, help: Option<String>) {
        if self.errors.len() < MOST {
            let mut diagnostic = self.sources.diagnostic(Severity::Error, span, message.into());
            diagnostic.help = help;
            self.errors.push((span, diagnostic));
        }
    }

    /// The scene can be rendered, but this has no effect or is approximated.
    pub fn warning(&mut self, span: Span, message: impl Into<String>) {
        self.warning_with_help(span, message, None);
    }

    fn warning_with_help(&mut self, span: Span, message: impl Into<String>, help: Option<String>) {
        if self.warnings.len() < MOST {
            let mut diagnostic = self.sources.diagnostic(Severity::Warning, span, message.into());
            diagnostic.help = help;
            self.warnings.push((span, diagnostic));
        } else {
            self.warnings_left_out += 1;
        }
    }

    /// The scene is of pbrt-v3, as the text at `span` shows.
    pub fn set_old(&mut self, span: Span) {
        if !std::mem::replace(&mut self.old, true) {
            let message = "this scene is of pbrt-v3: it is translated to pbrt-v4, which may look different in places";
            self.warning(span, message);
        }
    }

    /// Whether the scene is of pbrt-v3.
    pub fn is_old(&self) -> bool {
        self.old
    }

    /// Something of pbrt-v3 was translated as `message` says: a warning where it is met first.
    pub fn translated(&mut self, span: Span, message: &'static str) {
        match self.translated.iter_mut().find(|(_, known, _)| *known == message) {
            Some((_, _, count)) => *count += 1,
            None => self.translated.push((span, message, 1)),
        }
    }

    /// Something is not known or not supported and would change the image: an error, or with `--lenient` a warning, which `instead`
    /// completes by saying what is done instead.
    pub fn unsupported(&mut self, span: Span, message: impl Into<String>, instead: &str) {
        self.unsupported_with_help(span, message, instead, None);
    }

    /// [`Self::unsupported`], with "did you mean" if one of `known` resembles `word`.
    pub fn unknown(&mut self, span: Span, message: impl Into<String>, instead: &str, word: &str, known: &[&str]) {
        let help = suggest::closest(word, known).map(|name| format!("did you mean `{name}`?"));
        self.unsupported_with_help(span, message, instead, help);
    }

    /// [`Self::unsupported`] with advice.
    pub fn unsupported_with_help(
        &mut self,
        span: Span,
        message: impl Into<String>,
        instead: &str,
        help: Option<String>,
    ) {
        if self.lenient {
            self.warning_with_help(span, format!("{}: {instead}", message.into()), help);
        } else {
            self.forgivable += 1;
            self.error_with_help(span, message, help);
        }
    }

    /// Whether enough errors have been found to stop reading.
    pub fn is_full(&self) -> bool {
        self.errors.len() >= MOST
    }

    /// Whether anything is wrong.
    pub fn has_errors(&self) -> bool {
        !self.errors.is_empty()
    }

    /// The errors, file by file, in order. Where there are many, the last one says what `--lenient` would forgive.
    pub fn into_errors(self) -> Vec<Diagnostic> {
        const FEW: usize = 3;
        let mut errors = in_order(self.errors);
        let (count, forgivable) = (errors.len(), self.forgivable.min(errors.len()));
        if count > FEW
            && forgivable > 0
            && let Some(last) = errors.last_mut()
        {
            let those = if forgivable == 1 {
                "is a warning"
            } else {
                "are warnings"
            };
            let advice = format!("{forgivable} of these {count} errors {those} with --lenient");
            last.help = Some(
                last.help
                    .take()
                    .map_or(advice.clone(), |help| format!("{help}; {advice}")),
            );
        }
        errors
    }

    /// The sources and the warnings, file by file, in order.
    pub fn into_sources_and_warnings(mut self) -> (SourceMap, Vec<Diagnostic>) {
        for (span, message, count) in std::mem::take(&mut self.translated) {
            let help = (count > 1).then(|| format!("the same {} times more", count - 1));
            self.warning_with_help(span, message, help);
        }
        if self.warnings_left_out > 0
            && let Some((_, last)) = self.warnings.last_mut()
        {
            last.help = Some(format!("{} more warnings are not shown", self.warnings_left_out));
        }
        (self.sources, in_order(self.warnings))
    }
}

fn in_order(mut diagnostics: Vec<(Span, Diagnostic)>) -> Vec<Diagnostic> {
    diagnostics.sort_by_key(|(span, _)| (span.file, span.start));
    diagnostics.into_iter().map(|(_, diagnostic)| diagnostic).collect()
}
