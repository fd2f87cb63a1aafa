//! The header of a PLY file: which elements there are, and what properties each has.

use std::ops::Range;

use super::Problem;

/// A number's type in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn parse(word: &[u8]) -> Option<Self> {
        Some(match word {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    /// In a binary file.
    pub fn bytes(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// Whether it can count or index.
    pub fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }
}

/// How numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// One property of an element.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Property {
    pub name: String,
    /// The type of the value, or of the list's values.
    pub value: Scalar,
    /// The type of the length, if it is a list.
    pub length: Option<Scalar>,
}

/// A table of the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Element {
    pub name: String,
    /// Its rows.
    pub count: u64,
    pub properties: Vec<Property>,
    /// The bytes of the file that declare it.
    pub place: Range<usize>,
}

impl Element {
    /// A problem with it.
    pub fn problem(&self, message: &str) -> Problem {
        (self.place.clone(), message.to_owned())
    }

    /// The fewest bytes that a row can have.
    pub fn least_row(&self, encoding: Encoding) -> u64 {
        let least = |p: &Property| match encoding {
            // A digit and a space.
            Encoding::Ascii => 2,
            _ => p.length.unwrap_or(p.value).bytes() as u64,
        };
        self.properties.iter().map(least).sum()
    }

    /// The bytes of a row of a binary file, if all rows have the same.
    pub fn fixed_row(&self) -> Option<usize> {
        self.properties
            .iter()
            .map(|p| p.length.is_none().then(|| p.value.bytes()))
            .sum()
    }
}

/// What a file consists of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Header {
    pub encoding: Encoding,
    pub elements: Vec<Element>,
    /// Where the data start.
    pub end: usize,
}

impl Header {
    /// Where the element of a name is declared; the first line if it is not.
    pub fn place_of(&self, name: &str) -> Range<usize> {
        let named = self.elements.iter().find(|element| element.name == name);
        named.map_or(0..3, |element| element.place.clone())
    }
}

/// Reads a header.
///
/// # Errors
///
/// What is wrong, and where.
pub(super) fn parse(text: &[u8]) -> Result<Header, Problem> {
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    let mut start = 0;
    loop {
        let length = text[start..].iter().position(|&b| b == b'\n');
        let end = length.map_or(text.len(), |length| start + length);
        let places = words(text, start..end);
        let words: Vec<&[u8]> = places.iter().map(|place| &text[place.clone()]).collect();
        let at = |word: usize, problem: &str| (places[word].clone(), problem.to_owned());
        let whole = places
            .first()
            .map_or(start..end, |first| first.start..places[places.len() - 1].end);
        let wrong = |problem: &str| (whole.clone(), problem.to_owned());
        match words[..] {
            _ if start == 0 => {
                if words != [b"ply"] {
                    return Err(wrong("this is not a PLY file: its first line is not `ply`"));
                }
            }
            [] | [b"comment" | b"obj_info", ..] => {}
            [b"format", kind, _] => {
                encoding = Some(match kind {
                    b"ascii" => Encoding::Ascii,
                    b"binary_little_endian" => Encoding::LittleEndian,
                    b"binary_big_endian" => Encoding::BigEndian,
                    _ => {
                        let expected = "expected `ascii`, `binary_little_endian` or `binary_big_endian`";
                        return Err(at(1, &format!("unknown format: {expected}")));
                    }
                });
            }
            [b"element", name, count] => elements.push(Element {
                name: String::from_utf8_lossy(name).into_owned(),
                count: number_of(count).ok_or_else(|| at(2, "expected the number of rows"))?,
                properties: Vec::new(),
                place: whole.clone(),
            }),
            [b"property", ..] => {
                let element = elements
                    .last_mut()
                    .ok_or_else(|| at(0, "a property before any element"))?;
                let property =
                    property(&words[1..]).ok_or_else(|| wrong("expected a type and a name of a property"))?;
                element.properties.push(property);
            }
            [b"end_header"] => {
                return Ok(Header {
                    encoding: encoding.ok_or_else(|| at(0, "the header has no `format`"))?,
                    elements,
                    end: length.map_or(end, |_| end + 1),
                });
            }
            _ => {
                let expected = "expected `format`, `element`, `property`, `comment` or `end_header`";
                return Err(wrong(expected));
            }
        }
        if length.is_none() {
            return Err(wrong("the file ends before `end_header`"));
        }
        start = end + 1;
    }
}

/// The places of the words of a line.
fn words(text: &[u8], line: Range<usize>) -> Vec<Range<usize>> {
    let mut places: Vec<Range<usize>> = Vec::new();
    for at in line.filter(|&at| !text[at].is_ascii_whitespace()) {
        match places.last_mut() {
            Some(last) if last.end == at => last.end += 1,
            _ => places.push(at..at + 1),
        }
    }
    places
}

fn number_of(word: &[u8]) -> Option<u64> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

fn property(words: &[&[u8]]) -> Option<Property> {
    let (length, value, name) = match *words {
        [value, name] => (None, value, name),
        [b"list", length, value, name] => (Some(Scalar::parse(length)?), value, name),
        _ => return None,
    };
    if length.is_some_and(|l| !l.is_integer()) {
        return None;
    }
    Some(Property {
        name: String::from_utf8_lossy(name).into_owned(),
        value: Scalar::parse(value)?,
        length,
    })
}
