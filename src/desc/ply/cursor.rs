//! Numbers one after another, in text or in binary.

use std::ops::Range;

use super::Problem;
use super::header::{Element, Encoding, Header, Scalar};

/// Reads the data of a PLY file in order.
#[derive(Debug)]
pub(super) struct Cursor<'a> {
    text: &'a [u8],
    position: usize,
    encoding: Encoding,
    /// The word of a text file that was read last.
    word: Range<usize>,
    /// Where the header declares what is read.
    declared: Range<usize>,
}

impl<'a> Cursor<'a> {
    /// At the start of the data.
    pub fn new(text: &'a [u8], header: &'a Header) -> Self {
        Self {
            text,
            position: header.end,
            encoding: header.encoding,
            word: header.end..header.end,
            declared: 0..0,
        }
    }

    /// Says which element comes next.
    pub fn begin(&mut self, element: &Element) {
        self.declared = element.place.clone();
    }

    /// How many bytes are left.
    pub fn left(&self) -> usize {
        self.text.len() - self.position
    }

    /// A message with the place: the word of a text file. Binary data have no lines: there it is the declaration of the element, and
    /// the message says at which byte.
    fn problem(&self, message: &str) -> Problem {
        if self.encoding == Encoding::Ascii {
            (self.word.clone(), message.to_owned())
        } else {
            (self.declared.clone(), format!("{message} (at byte {})", self.position))
        }
    }

    /// The next so many bytes of a binary file.
    pub fn bytes(&mut self, count: usize) -> Result<&'a [u8], Problem> {
        if count > self.left() {
            return Err(self.problem("the file ends before its data do"));
        }
        let bytes = &self.text[self.position..self.position + count];
        self.position += count;
        Ok(bytes)
    }

    /// The next so many bytes of a binary file, if there are so many, which are read again.
    pub fn peek(&self, count: usize) -> Option<&'a [u8]> {
        self.text.get(self.position..self.position.checked_add(count)?)
    }

    /// The next number.
    pub fn number(&mut self, kind: Scalar) -> Result<f64, Problem> {
        match self.encoding {
            Encoding::Ascii => {
                let word = self.word()?;
                match fast_float2::parse::<f64, _>(word) {
                    Ok(value) => Ok(value),
                    Err(_) => Err(self.problem("expected a number")),
                }
            }
            encoding => Ok(decode(self.bytes(kind.bytes())?, kind, encoding)),
        }
    }

    /// The next number of an integer type, as a length or an index.
    pub fn index(&mut self, kind: Scalar) -> Result<usize, Problem> {
        let value = self.number(kind)?;
        // Integers of 32 bits are exact in f64; the cast of anything else saturates, and so does not compare equal.
        let index = value as u32;
        if f64::from(index) == value {
            return Ok(index as usize);
        }
        Err(self.problem("expected an integer that is not negative"))
    }

    /// Skips so many numbers.
    pub fn skip(&mut self, count: usize, kind: Scalar) -> Result<(), Problem> {
        if self.encoding == Encoding::Ascii {
            for _ in 0..count {
                self.word()?;
            }
        } else {
            self.bytes(count.saturating_mul(kind.bytes()))?;
        }
        Ok(())
    }

    fn word(&mut self) -> Result<&'a [u8], Problem> {
        let space = |b: &u8| b.is_ascii_whitespace();
        let rest = &self.text[self.position..];
        let start = rest.iter().position(|b| !space(b)).unwrap_or(rest.len());
        let word = &rest[start..];
        let word = &word[..word.iter().position(space).unwrap_or(word.len())];
        self.position += start + word.len();
        self.word = self.position - word.len()..self.position;
        if word.is_empty() {
            return Err(self.problem("the file ends before its data do"));
        }
        Ok(word)
    }
}

/// A number from the bytes of its type, which there must be at least.
#[inline]
pub(super) fn decode(bytes: &[u8], kind: Scalar, encoding: Encoding) -> f64 {
    macro_rules! number {
        ($kind:ty) => {{
            let mut array = [0; size_of::<$kind>()];
            array.copy_from_slice(&bytes[..size_of::<$kind>()]);
            f64::from(if encoding == Encoding::BigEndian {
                <$kind>::from_be_bytes(array)
            } else {
                <$kind>::from_le_bytes(array)
            })
        }};
    }
    match kind {
        Scalar::I8 => number!(i8),
        Scalar::U8 => number!(u8),
        Scalar::I16 => number!(i16),
        Scalar::U16 => number!(u16),
        Scalar::I32 => number!(i32),
        Scalar::U32 => number!(u32),
        Scalar::F32 => number!(f32),
        Scalar::F64 => number!(f64),
    }
}
