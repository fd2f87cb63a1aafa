//! Material libraries (MTL), which OBJ files name.
//!
//! Read are the colours `Kd`, `Ks`, `Ke`, the exponent `Ns`, the index `Ni`, the opacity `d` or `Tr`, the model `illum` and the texture
//! `map_Kd`. What else there is may matter and is warned about; `Ka`, `Tf` and `sharpness` say nothing that light transport asks for.

use std::ops::Range;
use std::path::{Path, PathBuf};

use super::words::{Word, Words};
use crate::desc::bytes;
use crate::error::{Diagnostic, Error, Result, Severity};

/// One material of a library.
#[derive(Clone, Debug, PartialEq)]
pub struct MtlMaterial {
    /// After `newmtl`.
    pub name: String,
    /// `Kd`; default 0.8 in each channel, which are linear sRGB.
    pub diffuse: [f32; 3],
    /// `Ks`; default 0.
    pub specular: [f32; 3],
    /// `Ke`; default 0.
    pub emission: [f32; 3],
    /// `Ns`; default 0.
    pub exponent: f32,
    /// `Ni`; default 1.5.
    pub index: f32,
    /// `d`, or 1 - `Tr`, in [0, 1]; default 1.
    pub opacity: f32,
    /// `illum`; default 2.
    pub model: u32,
    /// `map_Kd`: a file that exists. It multiplies `Kd`.
    pub diffuse_map: Option<PathBuf>,
}

/// A library.
#[derive(Debug, Default)]
pub struct MtlFile {
    /// Its materials, in file order.
    pub materials: Vec<MtlMaterial>,
    /// What is passed over and may have mattered.
    pub warnings: Vec<Diagnostic>,
}

/// The longest library that is read.
const LONGEST: u64 = 1 << 28;

/// After so many problems reading stops.
const MOST: usize = 50;

/// What says nothing that matters here.
const PASSED_OVER: [&[u8]; 4] = [b"Ka", b"Tf", b"sharpness", b"map_Ka"];

type Problem = (Range<usize>, String);

/// Reads a library.
///
/// # Errors
///
/// [`Error::Scene`] with every problem found (at most some 50), [`Error::Io`] if it cannot be read.
pub fn load(path: &Path) -> Result<MtlFile> {
    let content = bytes::read(path, LONGEST).map_err(|e| Error::io("read", path, e))?;
    parse(&content, path)
}

/// Reads a library from the content of the file `path`, beside which its textures are.
///
/// # Errors
///
/// [`Error::Scene`] with every problem found (at most some 50).
pub fn parse(content: &[u8], path: &Path) -> Result<MtlFile> {
    let mut reader = Reader {
        words: Words::new(content),
        directory: path.parent().unwrap_or(Path::new("")),
        file: MtlFile::default(),
    };
    let mut errors = Vec::new();
    let at = |severity, (place, message): Problem| Diagnostic::new(severity, path, content, place, message);
    while let Some(keyword) = reader.words.statement() {
        match reader.statement(keyword) {
            Ok(None) => {}
            Ok(Some(warning)) if reader.file.warnings.len() < MOST => {
                reader.file.warnings.push(at(Severity::Warning, warning));
            }
            Ok(Some(_)) => {}
            Err(problem) => errors.push(at(Severity::Error, problem)),
        }
        reader.words.skip_line();
        if errors.len() >= MOST {
            break;
        }
    }
    if errors.is_empty() {
        Ok(reader.file)
    } else {
        Err(Error::Scene(errors))
    }
}

struct Reader<'a> {
    words: Words<'a>,
    directory: &'a Path,
    file: MtlFile,
}

impl<'a> Reader<'a> {
    /// Reads a statement; what is to be warned about, if anything.
    fn statement(&mut self, keyword: Word<'a>) -> Result<Option<Problem>, Problem> {
        if keyword.bytes == b"newmtl" {
            let name = self
                .words
                .rest()
                .ok_or((keyword.place(), "expected a name".to_owned()))?;
            self.file.materials.push(MtlMaterial {
                name: name.text(),
                diffuse: [0.8; 3],
                specular: [0.0; 3],
                emission: [0.0; 3],
                exponent: 0.0,
                index: 1.5,
                opacity: 1.0,
                model: 2,
                diffuse_map: None,
            });
            return Ok(None);
        }
        if PASSED_OVER.contains(&keyword.bytes) {
            return Ok(None);
        }
        if self.file.materials.is_empty() {
            let message = format!("`{}` before any `newmtl`", keyword.text());
            return Err((keyword.place(), message));
        }
        match keyword.bytes {
            b"Kd" => self.current().diffuse = self.color(&keyword, 1.0)?,
            b"Ks" => self.current().specular = self.color(&keyword, 1.0)?,
            b"Ke" => self.current().emission = self.color(&keyword, f32::MAX)?,
            b"Ns" => self.current().exponent = self.number(&keyword, 0.0..=f32::MAX, "0 or more")?,
            b"Ni" => self.current().index = self.number(&keyword, 1e-3..=1e3, "between 0.001 and 1000")?,
            b"d" => self.current().opacity = self.number(&keyword, 0.0..=1.0, "between 0 and 1")?,
            b"Tr" => self.current().opacity = 1.0 - self.number(&keyword, 0.0..=1.0, "between 0 and 1")?,
            b"illum" => self.current().model = self.number(&keyword, 0.0..=10.0, "between 0 and 10")? as u32,
            b"map_Kd" => return self.map(&keyword),
            _ => {
                let message = format!("`{}` has no effect", keyword.text());
                return Ok(Some((keyword.place(), message)));
            }
        }
        Ok(None)
    }

    /// The material that is being described: there is one.
    fn current(&mut self) -> &mut MtlMaterial {
        let last = self.file.materials.len() - 1;
        &mut self.file.materials[last]
    }

    fn number(&mut self, keyword: &Word, range: std::ops::RangeInclusive<f32>, expected: &str) -> Result<f32, Problem> {
        let word = self
            .words
            .word()
            .ok_or_else(|| (keyword.place(), format!("`{}` takes a number", keyword.text())))?;
        match fast_float2::parse::<f32, _>(word.bytes) {
            Ok(number) if range.contains(&number) => Ok(number),
            Ok(_) => Err((word.place(), format!("this must be {expected}"))),
            Err(_) => Err((word.place(), format!("expected a number, found `{}`", word.text()))),
        }
    }

    /// One number for all channels, or one for each, each at most `most`.
    fn color(&mut self, keyword: &Word, most: f32) -> Result<[f32; 3], Problem> {
        let expected = if most == 1.0 { "between 0 and 1" } else { "0 or more" };
        let red = self.number(keyword, 0.0..=most, expected)?;
        let Some(next) = self.words.word() else {
            return Ok([red; 3]);
        };
        let green = fast_float2::parse::<f32, _>(next.bytes)
            .ok()
            .filter(|g| (0.0..=most).contains(g))
            .ok_or_else(|| (next.place(), format!("expected a number {expected}")))?;
        Ok([red, green, self.number(keyword, 0.0..=most, expected)?])
    }

    /// The file of a texture; its options are passed over.
    fn map(&mut self, keyword: &Word) -> Result<Option<Problem>, Problem> {
        let rest = self
            .words
            .rest()
            .ok_or_else(|| (keyword.place(), "expected a file name".to_owned()))?;
        let mut name = rest;
        let mut has_options = false;
        while name.bytes.first() == Some(&b'-') {
            has_options = true;
            name = after_option(name);
        }
        // Many files have the separators of other systems.
        let file = self.directory.join(name.text().replace('\\', "/"));
        if !file.is_file() {
            return Err((name.place(), format!("there is no file {}", file.display())));
        }
        self.current().diffuse_map = Some(file);
        Ok(has_options.then(|| (rest.place(), "the options of this texture have no effect".to_owned())))
    }
}

/// What follows an option and its values: one word, or up to three numbers.
fn after_option(text: Word<'_>) -> Word<'_> {
    let skip = |word: Word<'_>| -> usize {
        let end = word
            .bytes
            .iter()
            .position(u8::is_ascii_whitespace)
            .unwrap_or(word.bytes.len());
        let space = word.bytes[end..].iter().position(|b| !b.is_ascii_whitespace());
        end + space.unwrap_or(word.bytes.len() - end)
    };
    fn from<'a>(word: Word<'a>, start: usize) -> Word<'a> {
        Word {
            bytes: &word.bytes[start..],
            start: word.start + start,
        }
    }
    let first_word = |word: &Word<'_>| word.bytes.split(u8::is_ascii_whitespace).next().map(<[u8]>::to_vec);
    let mut rest = from(text, skip(text));
    for count in 0..3 {
        let word = first_word(&rest).unwrap_or_default();
        let is_number = fast_float2::parse::<f32, _>(&word).is_ok();
        if count > 0 && !is_number {
            break;
        }
        rest = from(rest, skip(rest));
        if !is_number {
            break;
        }
    }
    rest
}
