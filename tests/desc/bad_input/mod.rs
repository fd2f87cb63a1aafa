//! Bad input: what is said, and where, by directive. `@` in a text marks the first character that is meant.

mod lights;
mod lists;
mod materials;
mod media;
mod options;
mod shapes;
mod structure;
mod syntax;
mod textures;
mod view;

use crate::errors;

/// (text with one `@`, part of the message, part of the help).
type Case = (&'static str, &'static str, &'static str);

/// Checks that a text gives one error, with this message and help at the mark.
fn check(&(marked, message, help): &Case) {
    let at = marked.find('@').unwrap_or_else(|| panic!("no mark in {marked}"));
    let before = &marked[..at];
    let line = 1 + before.matches('\n').count();
    let column = 1 + before.rsplit('\n').next().map_or(0, |l| l.chars().count());
    let errors = errors(&marked.replacen('@', "", 1));
    let all: Vec<String> = errors.iter().map(ToString::to_string).collect();
    let [error] = &errors[..] else {
        panic!("{marked}\ngives {} errors:\n{}", errors.len(), all.join("\n"))
    };
    assert!(
        error.message.contains(message),
        "{marked}\ngives\n{error}\nwithout `{message}`"
    );
    assert_eq!((error.line, error.column), (line, column), "{marked}\ngives\n{error}");
    let found = error.help.as_deref().unwrap_or_default();
    assert!(found.contains(help), "{marked}\ngives\n{error}\nwithout `{help}`");
    assert!(!help.is_empty() || found.is_empty(), "{marked}\ngives\n{error}");
}
