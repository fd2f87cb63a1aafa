//! Parameter lists: `"float fov" 45 "rgb reflectance" [ 0.2 0.4 0.6 ] ...`, checked against their own types.

use super::directives::is_directive;
use super::report::Report;
use super::suggest;
use super::tokens::{Lexer, Number, Token, TokenKind, unquote};
use crate::desc::ColorSpace;
use crate::error::Span;

/// The types of pbrt-v4.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ParamType {
    Bool,
    Float,
    Integer,
    Point2,
    Vector2,
    Point3,
    Vector3,
    Normal,
    String,
    Texture,
    Rgb,
    Spectrum,
    Blackbody,
}

const TYPES: [(&str, ParamType); 13] = [
    ("bool", ParamType::Bool),
    ("float", ParamType::Float),
    ("integer", ParamType::Integer),
    ("point2", ParamType::Point2),
    ("vector2", ParamType::Vector2),
    ("point3", ParamType::Point3),
    ("vector3", ParamType::Vector3),
    ("normal", ParamType::Normal),
    ("string", ParamType::String),
    ("texture", ParamType::Texture),
    ("rgb", ParamType::Rgb),
    ("spectrum", ParamType::Spectrum),
    ("blackbody", ParamType::Blackbody),
];

/// The names of types in pbrt-v3 that pbrt-v4 no longer has.
const OLD_TYPES: [(&str, ParamType); 3] = [
    ("point", ParamType::Point3),
    ("vector", ParamType::Vector3),
    ("color", ParamType::Rgb),
];

impl ParamType {
    /// As it is written in a file.
    pub fn name(self) -> &'static str {
        TYPES.iter().find(|&&(_, t)| t == self).map_or("", |&(name, _)| name)
    }

    fn parse(name: &str) -> Option<Self> {
        TYPES.iter().find(|&&(n, _)| n == name).map(|&(_, t)| t)
    }
}

/// A parameter as it was written.
#[derive(Clone, Debug)]
pub(super) struct Param {
    pub kind: ParamType,
    pub name: String,
    /// The declaration, `"type name"`.
    pub span: Span,
    /// From the first value to the last.
    pub values_span: Span,
    pub values: Values,
    /// If it stems from an `Attribute` directive, where it may go unused: its number.
    pub default: Option<usize>,
    /// The colour space that was in force at the `Attribute` directive; else the one at the entity holds.
    pub color_space: Option<ColorSpace>,
}

/// The values of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Values {
    /// Not as the type wants them; this has been reported.
    Broken,
    Numbers(Vec<f64>),
    Integers(Vec<i32>),
    Bools(Vec<bool>),
    Strings(Vec<String>),
}

/// Reads parameters until something else comes. A broken one is reported and marked, reading goes on after it.
pub(super) fn read_params(lexer: &mut Lexer, report: &mut Report) -> Vec<Param> {
    let mut params: Vec<Param> = Vec::new();
    while let Some(token) = lexer.peek().filter(|t| t.kind == TokenKind::Quoted) {
        lexer.next();
        let declared = declaration(token, report);
        let start = lexer.peek().map_or(token.span, |t| t.span);
        let values = read_values(lexer, report, token, declared.as_ref().map(|d| d.0));
        let Some((kind, name)) = declared else { continue };
        let param = Param {
            kind,
            name,
            span: token.span,
            values_span: Span {
                end: lexer.here().end.max(start.end),
                ..start
            },
            values,
            default: None,
            color_space: None,
        };
        if params.iter().any(|p| p.name == param.name && p.kind == param.kind) {
            report.error(
                param.span,
                format!("the parameter `{}` is given a second time", param.name),
            );
        } else {
            params.push(param);
        }
    }
    params
}

/// Type and name of a declaration, if it is one.
fn declaration(token: Token, report: &mut Report) -> Option<(ParamType, String)> {
    let text = match unquote(report.bytes(token.span)) {
        Ok(text) => text,
        Err(problem) => {
            report.error(token.span, problem);
            return None;
        }
    };
    let words: Vec<&str> = text.split_ascii_whitespace().take(3).collect();
    let [kind, name] = words[..] else {
        report.error(
            token.span,
            "expected the declaration of a parameter, its type and its name as in \"float fov\"",
        );
        return None;
    };
    if report.is_old()
        && let Some((_, new)) = OLD_TYPES.iter().find(|&&(old, _)| old == kind)
    {
        report.translated(
            token.span,
            "the types `point`, `vector` and `color` are `point3`, `vector3` and `rgb` in pbrt-v4",
        );
        return Some((*new, name.to_owned()));
    }
    let Some(known) = ParamType::parse(kind) else {
        let names = TYPES.map(|(name, _)| name);
        let old = OLD_TYPES.iter().find(|&&(old, _)| old == kind);
        let likely = old.map_or_else(|| suggest::closest(kind, &names), |(_, new)| Some(new.name()));
        let help = likely.map(|name| format!("did you mean `{name}`?"));
        report.error_with_help(token.span, format!("unknown parameter type `{kind}`"), help);
        return None;
    };
    Some((known, name.to_owned()))
}

/// One value, or several in brackets, for a type (none if it is not known: whatever comes is skipped).
fn read_values(lexer: &mut Lexer, report: &mut Report, declaration: Token, kind: Option<ParamType>) -> Values {
    match lexer.peek() {
        Some(token) if token.kind == TokenKind::Open => {
            lexer.next();
            let values = read_list(lexer, report, kind, usize::MAX);
            match lexer.peek() {
                Some(close) if close.kind == TokenKind::Close => {
                    lexer.next();
                    values
                }
                // A list ends early only at a value that does not fit, which has been reported, or at the end.
                found => {
                    if found.is_none() {
                        report.error(token.span, "this list is not closed by `]`");
                    }
                    skip_list(lexer);
                    Values::Broken
                }
            }
        }
        Some(token) if token.kind != TokenKind::Close => {
            let values = read_list(lexer, report, kind, 1);
            if values == Values::Broken && kind.is_some() && !starts_directive(lexer, token) {
                lexer.next();
            }
            values
        }
        _ => {
            report.error(declaration.span, "this parameter has no value");
            Values::Broken
        }
    }
}

/// At most `most` values of a type, up to a closing bracket or the end. [`Values::Broken`], having said so, at one of another kind.
fn read_list(lexer: &mut Lexer, report: &mut Report, kind: Option<ParamType>, most: usize) -> Values {
    match kind {
        None => {
            skip(lexer, most);
            Values::Broken
        }
        Some(ParamType::Bool) => {
            let old = report.is_old();
            read_each(lexer, report, most, "`true` or `false`", |token, bytes| {
                match (token.kind, bytes) {
                    (TokenKind::Word, b"true") => Ok(true),
                    (TokenKind::Word, b"false") => Ok(false),
                    // As pbrt-v3 has them.
                    (TokenKind::Quoted, b"\"true\"") if old => Ok(true),
                    (TokenKind::Quoted, b"\"false\"") if old => Ok(false),
                    _ => Err(None),
                }
            })
            .map_or(Values::Broken, Values::Bools)
        }
        Some(ParamType::String | ParamType::Texture) => {
            read_strings(lexer, report, most).map_or(Values::Broken, Values::Strings)
        }
        Some(ParamType::Spectrum) if lexer.peek().is_some_and(|t| t.kind == TokenKind::Quoted) => {
            read_strings(lexer, report, most).map_or(Values::Broken, Values::Strings)
        }
        Some(ParamType::Integer) => read_each(lexer, report, most, "an integer", |token, bytes| {
            let text = std::str::from_utf8(bytes).map_err(|_| None)?;
            match text.parse::<i32>() {
                Ok(value) if token.kind == TokenKind::Word => Ok(value),
                Err(e)
                    if matches!(
                        e.kind(),
                        std::num::IntErrorKind::PosOverflow | std::num::IntErrorKind::NegOverflow
                    ) =>
                {
                    Err(Some("this integer does not fit into 32 bits"))
                }
                _ => Err(None),
            }
        })
        .map_or(Values::Broken, Values::Integers),
        Some(_) => read_numbers(lexer, report, most).map_or(Values::Broken, Values::Numbers),
    }
}

fn read_numbers(lexer: &mut Lexer, report: &mut Report, most: usize) -> Option<Vec<f64>> {
    let mut numbers = Vec::new();
    while numbers.len() < most {
        match lexer.number() {
            Number::Value(value) => numbers.push(value),
            _ => match lexer.peek() {
                None => break,
                Some(token) if token.kind == TokenKind::Close => break,
                Some(token) => {
                    let found = report.excerpt(token.span);
                    report.error(token.span, format!("expected a finite number, found `{found}`"));
                    return None;
                }
            },
        }
    }
    Some(numbers)
}

fn read_strings(lexer: &mut Lexer, report: &mut Report, most: usize) -> Option<Vec<String>> {
    read_each(lexer, report, most, "a string in double quotes", |token, bytes| {
        if token.kind == TokenKind::Quoted {
            unquote(bytes).map_err(Some)
        } else {
            Err(None)
        }
    })
}

/// Values by `convert`, whose error is what is wrong, or `None` for "this is not `expected`". The value at fault stays the next token.
fn read_each<T>(
    lexer: &mut Lexer,
    report: &mut Report,
    most: usize,
    expected: &str,
    convert: impl Fn(Token, &[u8]) -> Result<T, Option<&'static str>>,
) -> Option<Vec<T>> {
    let mut values = Vec::new();
    while values.len() < most {
        let Some(token) = lexer.peek().filter(|t| t.kind != TokenKind::Close) else {
            break;
        };
        match convert(token, report.bytes(token.span)) {
            Ok(value) => values.push(value),
            Err(problem) => {
                let message = problem.map_or_else(
                    || format!("expected {expected}, found `{}`", report.excerpt(token.span)),
                    str::to_owned,
                );
                report.error(token.span, message);
                return None;
            }
        }
        lexer.next();
    }
    Some(values)
}

/// Skips at most `most` values.
fn skip(lexer: &mut Lexer, most: usize) {
    for _ in 0..most {
        if lexer.peek().is_none_or(|t| t.kind == TokenKind::Close) {
            break;
        }
        lexer.next();
    }
}

/// Skips to the end of a list that is broken: past its bracket, or to a word that starts a directive.
fn skip_list(lexer: &mut Lexer) {
    while let Some(token) = lexer.peek() {
        if starts_directive(lexer, token) {
            return;
        }
        lexer.next();
        if token.kind == TokenKind::Close {
            return;
        }
    }
}

fn starts_directive(lexer: &Lexer, token: Token) -> bool {
    token.kind == TokenKind::Word && is_directive(lexer.bytes(token))
}

/// The place of value `index` of a parameter, for a message about it.
pub(super) fn value_span(report: &Report, param: &Param, index: usize) -> Span {
    let mut lexer = Lexer::new(report, param.values_span.file, param.values_span.start as usize);
    let mut left = index;
    while let Some(token) = lexer.next() {
        match token.kind {
            TokenKind::Close => break,
            _ if token.span.end > param.values_span.end => break,
            TokenKind::Open => {}
            _ if left == 0 => return token.span,
            _ => left -= 1,
        }
    }
    param.span
}
