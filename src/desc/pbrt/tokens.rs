//! Tokens of the pbrt format: words, quoted strings and brackets, with the place of each.
//!
//! White space separates tokens, `#` comments out the rest of a line. A quote or a bracket ends a word, as in pbrt-v4.

use std::sync::Arc;

use super::report::Report;
use crate::error::Span;

/// What a token is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TokenKind {
    /// A directive, a number, `true` or `false`.
    Word,
    /// A string in double quotes; the span includes them.
    Quoted,
    /// `[`
    Open,
    /// `]`
    Close,
}

/// A token and its place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Token {
    pub kind: TokenKind,
    pub span: Span,
}

/// Cuts one file into tokens.
#[derive(Clone, Debug)]
pub(super) struct Lexer {
    text: Arc<[u8]>,
    file: u32,
    position: usize,
}

/// A number, or why there is none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Number {
    /// A finite one.
    Value(f64),
    /// The next token is something else; nothing was read.
    Other,
    /// The next token looks like a number but is none, or is not finite; nothing was read.
    Malformed,
}

impl Lexer {
    /// From byte `start` of a file that the report knows.
    pub fn new(report: &Report, file: u32, start: usize) -> Self {
        Self {
            text: report.text(file),
            file,
            position: start,
        }
    }

    /// The bytes of one of its tokens.
    pub fn bytes(&self, token: Token) -> &[u8] {
        &self.text[token.span.start as usize..token.span.end as usize]
    }

    /// An empty span where reading stands.
    pub fn here(&self) -> Span {
        self.span(self.position, self.position)
    }

    /// The next token, if there is one; it stays the next.
    pub fn peek(&mut self) -> Option<Token> {
        self.skip_space();
        let start = self.position;
        let kind = match *self.text.get(start)? {
            b'[' => return Some(self.token(TokenKind::Open, start, start + 1)),
            b']' => return Some(self.token(TokenKind::Close, start, start + 1)),
            b'"' => TokenKind::Quoted,
            _ => TokenKind::Word,
        };
        let end = match kind {
            TokenKind::Quoted => self.end_of_string(start),
            _ => self.end_of_word(start),
        };
        Some(self.token(kind, start, end))
    }

    /// The next token; reading goes on after it.
    pub fn next(&mut self) -> Option<Token> {
        let token = self.peek()?;
        self.position = token.span.end as usize;
        Some(token)
    }

    /// Reads a number if one is next: the fast path for long lists.
    pub fn number(&mut self) -> Number {
        self.skip_space();
        let rest = &self.text[self.position..];
        if !rest
            .first()
            .is_some_and(|b| matches!(b, b'0'..=b'9' | b'+' | b'-' | b'.'))
        {
            return Number::Other;
        }
        match fast_float2::parse_partial::<f64, _>(rest) {
            Ok((value, length)) if value.is_finite() && rest.get(length).is_none_or(|&b| ends_word(b)) => {
                self.position += length;
                Number::Value(value)
            }
            _ => Number::Malformed,
        }
    }

    fn token(&self, kind: TokenKind, start: usize, end: usize) -> Token {
        Token {
            kind,
            span: self.span(start, end),
        }
    }

    fn span(&self, start: usize, end: usize) -> Span {
        // Texts are at most 4 GiB: `input` refuses longer ones.
        Span {
            file: self.file,
            start: start as u32,
            end: end as u32,
        }
    }

    fn skip_space(&mut self) {
        while let Some(&byte) = self.text.get(self.position) {
            match byte {
                b' ' | b'\n' | b'\t' | b'\r' => self.position += 1,
                b'#' => {
                    let rest = &self.text[self.position..];
                    let line = rest.iter().position(|b| matches!(b, b'\n' | b'\r'));
                    self.position += line.unwrap_or(rest.len());
                }
                _ => break,
            }
        }
    }

    /// One past the closing quote of the string that opens at `start`; for a string that is not closed, the end of its line.
    fn end_of_string(&self, start: usize) -> usize {
        let mut i = start + 1;
        while let Some(&byte) = self.text.get(i) {
            match byte {
                b'"' => return i + 1,
                b'\n' => return i,
                b'\\' => i += 2,
                _ => i += 1,
            }
        }
        self.text.len()
    }

    fn end_of_word(&self, start: usize) -> usize {
        let rest = &self.text[start..];
        start + rest.iter().position(|&b| ends_word(b)).unwrap_or(rest.len())
    }
}

fn ends_word(byte: u8) -> bool {
    matches!(byte, b' ' | b'\n' | b'\t' | b'\r' | b'"' | b'[' | b']')
}

/// The content of a quoted token, escapes resolved. What is not UTF-8 is replaced.
///
/// # Errors
///
/// What is wrong with it: it is not closed, or has an unknown escape.
pub(super) fn unquote(bytes: &[u8]) -> Result<String, &'static str> {
    const OPEN: &str = "this string is not closed on its line";
    let inner = bytes.strip_prefix(b"\"").ok_or(OPEN)?;
    let mut content = Vec::with_capacity(inner.len());
    let mut rest = inner.iter();
    while let Some(&byte) = rest.next() {
        match byte {
            b'"' if rest.as_slice().is_empty() => return Ok(String::from_utf8_lossy(&content).into_owned()),
            b'\\' => content.push(match rest.next().ok_or(OPEN)? {
                b'b' => 8,
                b'f' => 12,
                b'n' => b'\n',
                b'r' => b'\r',
                b't' => b'\t',
                &b @ (b'\\' | b'\'' | b'"') => b,
                _ => return Err("unknown escape in this string (known are \\b \\f \\n \\r \\t \\\\ \\' \\\")"),
            }),
            _ => content.push(byte),
        }
    }
    Err(OPEN)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn lexer(text: &str) -> Lexer {
        let mut report = Report::default();
        let file = report.add_file(Path::new("test"), Arc::from(text.as_bytes()));
        Lexer::new(&report, file, 0)
    }

    #[test]
    fn tokens_end_where_pbrt_ends_them() {
        let text = "Shape\"a b\"[1 2]# c\n]x";
        let mut lexer = lexer(text);
        let mut found = Vec::new();
        while let Some(token) = lexer.next() {
            found.push((token.kind, &text[token.span.start as usize..token.span.end as usize]));
        }
        use TokenKind::{Close, Open, Quoted, Word};
        let expected = [
            (Word, "Shape"),
            (Quoted, "\"a b\""),
            (Open, "["),
            (Word, "1"),
            (Word, "2"),
            (Close, "]"),
            (Close, "]"),
            (Word, "x"),
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn numbers_are_read_and_others_are_left() {
        let mut lexer = lexer("1 -2.5e-3 +.5 4.37114e-008]7 1x 1e999 -inf");
        for expected in [1.0, -2.5e-3, 0.5, 4.37114e-8] {
            assert_eq!(lexer.number(), Number::Value(expected));
        }
        assert_eq!(lexer.number(), Number::Other);
        assert_eq!(lexer.next().map(|t| t.kind), Some(TokenKind::Close));
        assert_eq!(lexer.number(), Number::Value(7.0));
        for _ in 0..3 {
            assert_eq!(lexer.number(), Number::Malformed);
            lexer.next();
        }
        assert_eq!(lexer.number(), Number::Other);
        assert_eq!(lexer.next(), None);
    }

    #[test]
    fn strings_lose_quotes_and_escapes() {
        assert_eq!(unquote(b"\"a \\\"b\\\" \\\\ \\n\""), Ok("a \"b\" \\ \n".to_owned()));
        assert!(unquote(b"\"open").is_err());
        assert!(unquote(b"\"open\\\"").is_err());
        assert!(unquote(b"\"").is_err());
        assert!(unquote(b"\"\\q\"").is_err());
    }
}
