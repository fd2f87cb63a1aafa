//! The text of an OBJ file as statements of words.

use std::ops::Range;

/// A word, and where it starts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Word<'a> {
    pub bytes: &'a [u8],
    pub start: usize,
}

impl Word<'_> {
    /// The bytes of the file that it is.
    pub fn place(&self) -> Range<usize> {
        self.start..self.start + self.bytes.len()
    }

    /// As text, to be shown.
    pub fn text(&self) -> String {
        String::from_utf8_lossy(self.bytes).into_owned()
    }
}

/// Goes through a file line by line and word by word. A `#` at the start of a word begins a comment; a `\` at the end of a line
/// joins the next one to it.
#[derive(Debug)]
pub(super) struct Words<'a> {
    text: &'a [u8],
    position: usize,
}

impl<'a> Words<'a> {
    /// At the start of a file, behind its byte order mark if it has one.
    pub fn new(text: &'a [u8]) -> Self {
        let position = if text.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        Self { text, position }
    }

    /// The first word of the next line that has any; `None` at the end of the file. What is left of the line before is skipped.
    pub fn statement(&mut self) -> Option<Word<'a>> {
        while self.position < self.text.len() {
            if let Some(word) = self.word() {
                return Some(word);
            }
            self.position += 1;
        }
        None
    }

    /// The next word of the line, if there is one.
    #[inline]
    pub fn word(&mut self) -> Option<Word<'a>> {
        self.skip_space();
        let start = self.position;
        if self.peek() == Some(b'#') {
            self.skip_line();
            return None;
        }
        while let Some(byte) = self.peek() {
            if byte.is_ascii_whitespace() || (byte == b'\\' && self.continuation().is_some()) {
                break;
            }
            self.position += 1;
        }
        let bytes = &self.text[start..self.position];
        (!bytes.is_empty()).then_some(Word { bytes, start })
    }

    /// What is left of the line, spaces within it included; `None` if there is nothing. Names may have spaces and `#` in them.
    pub fn rest(&mut self) -> Option<Word<'a>> {
        self.skip_space();
        let start = self.position;
        self.skip_line();
        let bytes = self.text[start..self.position].trim_ascii_end();
        (!bytes.is_empty()).then_some(Word { bytes, start })
    }

    /// Goes to the end of the line, before its line feed.
    pub fn skip_line(&mut self) {
        let rest = &self.text[self.position..];
        self.position += rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len());
    }

    #[inline]
    fn peek(&self) -> Option<u8> {
        self.text.get(self.position).copied()
    }

    #[inline]
    fn skip_space(&mut self) {
        while let Some(byte) = self.peek() {
            match byte {
                b'\n' => return,
                b'\\' => match self.continuation() {
                    Some(length) => self.position += length,
                    None => return,
                },
                _ if byte.is_ascii_whitespace() => self.position += 1,
                _ => return,
            }
        }
    }

    /// How many bytes from the `\` here on stand for the end of a line that goes on; `None` if it is part of a word.
    fn continuation(&self) -> Option<usize> {
        match &self.text[self.position + 1..] {
            [b'\n', ..] => Some(2),
            [b'\r', b'\n', ..] => Some(3),
            _ => None,
        }
    }
}
