//! Statements to vertices and triangles.

use std::collections::HashMap;
use std::ops::Range;
use std::path::Path;

use glam::{Vec2, Vec3};

use super::words::{Word, Words};
use super::{ObjFile, ObjName, ObjPart};
use crate::desc::MeshDesc;
use crate::error::{Diagnostic, Error, Result, Severity};

/// After so many problems reading stops.
const MOST: usize = 50;

/// No texture coordinate, no normal, no further vertex.
const NONE: u32 = u32::MAX;

/// What says nothing about the faces.
const PASSED_OVER: [&[u8]; 13] = [
    b"g",
    b"o",
    b"s",
    b"l",
    b"p",
    b"vp",
    b"mg",
    b"lod",
    b"bevel",
    b"c_interp",
    b"d_interp",
    b"shadow_obj",
    b"trace_obj",
];

/// Free-form curves and surfaces.
const FREE_FORM: [&[u8]; 4] = [b"cstype", b"curv", b"curv2", b"surf"];

/// What belongs to them.
const OF_FREE_FORM: [&[u8]; 11] = [
    b"deg", b"bmat", b"step", b"parm", b"trim", b"hole", b"scrv", b"sp", b"end", b"con", b"ctech",
];

/// Reads the content of a file. See [`super::parse`].
pub(super) fn read(text: &[u8], path: &Path) -> Result<ObjFile> {
    let mut reader = Reader {
        text,
        path,
        words: Words::new(text),
        positions: Vec::new(),
        uvs: Vec::new(),
        normals: Vec::new(),
        vertices: Vertices::default(),
        indices: Vec::new(),
        parts: Vec::new(),
        materials: Names::default(),
        libraries: Names::default(),
        material: None,
        warned: Vec::new(),
        errors: Vec::new(),
        warnings: Vec::new(),
    };
    while let Some(keyword) = reader.words.statement() {
        if let Err((place, message)) = reader.statement(keyword) {
            reader.errors.push(reader.diagnostic(Severity::Error, place, message));
            reader.words.skip_line();
        }
        if reader.errors.len() >= MOST {
            break;
        }
    }
    reader.finish()
}

/// What is wrong, and where.
type Problem = (Range<usize>, String);

/// Names in the order of their first use.
#[derive(Default)]
struct Names {
    list: Vec<ObjName>,
    numbers: HashMap<String, usize>,
}

/// The vertices of the mesh: corners of faces that differ in position, texture coordinate or normal.
#[derive(Default)]
struct Vertices {
    /// Of each: which position, texture coordinate and normal, each counted from 0.
    corners: Vec<[u32; 3]>,
    /// By position: the first vertex there.
    first: Vec<u32>,
    /// By vertex: the next one with the same position.
    next: Vec<u32>,
}

impl Vertices {
    /// The vertex of a corner, made if there is none; `None` if 32 bits cannot count them.
    #[inline]
    fn of(&mut self, corner: [u32; 3]) -> Option<u32> {
        let position = corner[0] as usize;
        if position >= self.first.len() {
            self.first.resize(position + 1, NONE);
        }
        let mut vertex = self.first[position];
        while vertex != NONE {
            if self.corners[vertex as usize] == corner {
                return Some(vertex);
            }
            vertex = self.next[vertex as usize];
        }
        let vertex = u32::try_from(self.corners.len()).ok().filter(|&v| v != NONE)?;
        self.next.push(self.first[position]);
        self.corners.push(corner);
        self.first[position] = vertex;
        Some(vertex)
    }
}

struct Reader<'a> {
    text: &'a [u8],
    path: &'a Path,
    words: Words<'a>,
    positions: Vec<Vec3>,
    uvs: Vec<Vec2>,
    normals: Vec<Vec3>,
    vertices: Vertices,
    indices: Vec<[u32; 3]>,
    parts: Vec<ObjPart>,
    materials: Names,
    libraries: Names,
    /// That of the faces to come.
    material: Option<usize>,
    /// Keywords that have been warned about.
    warned: Vec<&'a [u8]>,
    errors: Vec<Diagnostic>,
    warnings: Vec<Diagnostic>,
}

impl<'a> Reader<'a> {
    fn diagnostic(&self, severity: Severity, place: Range<usize>, message: String) -> Diagnostic {
        Diagnostic::new(severity, self.path, self.text, place, message)
    }

    fn statement(&mut self, keyword: Word<'a>) -> Result<(), Problem> {
        match keyword.bytes {
            b"v" => {
                let position = self.numbers(&keyword, "a vertex has 3 coordinates")?;
                self.positions.push(Vec3::from_array(position));
                // The weights of free-form curves, or colours.
                self.words.skip_line();
            }
            b"vn" => {
                let normal = self.numbers(&keyword, "a normal has 3 coordinates")?;
                self.normals.push(Vec3::from_array(normal));
                self.words.skip_line();
            }
            b"vt" => self.texture_coordinates(&keyword)?,
            b"f" | b"fo" => self.face(&keyword)?,
            b"usemtl" => self.material = self.words.rest().map(|name| self.name(name, |r| &mut r.materials)),
            b"mtllib" => {
                if let Some(name) = self.words.rest() {
                    self.name(name, |reader| &mut reader.libraries);
                }
            }
            other if FREE_FORM.contains(&other) => {
                self.words.skip_line();
                if !self.warned.contains(&b"free form".as_slice()) {
                    self.warned.push(b"free form");
                    let message = "free-form curves and surfaces are not supported".to_owned();
                    return Err((keyword.place(), message));
                }
            }
            other if PASSED_OVER.contains(&other) || OF_FREE_FORM.contains(&other) => self.words.skip_line(),
            other => {
                self.words.skip_line();
                if !self.warned.contains(&other) && self.warned.len() < MOST {
                    self.warned.push(other);
                    let message = format!("`{}` is no statement of an OBJ file: it is passed over", keyword.text());
                    let warning = self.diagnostic(Severity::Warning, keyword.place(), message);
                    self.warnings.push(warning);
                }
            }
        }
        Ok(())
    }

    /// The number of a name, which is new or has been used before.
    fn name(&mut self, word: Word<'a>, names: impl Fn(&mut Self) -> &mut Names) -> usize {
        let name = word.text();
        if let Some(&number) = names(self).numbers.get(&name) {
            return number;
        }
        let place = self.diagnostic(Severity::Warning, word.place(), String::new());
        let names = names(self);
        names.numbers.insert(name.clone(), names.list.len());
        names.list.push(ObjName { name, place });
        names.list.len() - 1
    }

    /// The next `N` numbers of a statement.
    fn numbers<const N: usize>(&mut self, keyword: &Word, expected: &str) -> Result<[f32; N], Problem> {
        let mut numbers = [0.0; N];
        for (count, number) in numbers.iter_mut().enumerate() {
            let Some(word) = self.words.word() else {
                return Err((keyword.place(), format!("{expected}, found {count}")));
            };
            *number = parse_number(&word)?;
        }
        Ok(numbers)
    }

    /// One number, or two, or three of which the last says nothing about surfaces.
    fn texture_coordinates(&mut self, keyword: &Word) -> Result<(), Problem> {
        let [u] = self.numbers(keyword, "a texture coordinate has 2 numbers")?;
        let v = match self.words.word() {
            Some(word) => parse_number(&word)?,
            None => 0.0,
        };
        self.uvs.push(Vec2::new(u, v));
        self.words.skip_line();
        Ok(())
    }

    fn face(&mut self, keyword: &Word) -> Result<(), Problem> {
        let first_triangle = self.indices.len();
        let (mut first, mut previous, mut count) = (0, 0, 0);
        while let Some(word) = self.words.word() {
            let corner = self.corner(&word)?;
            let vertex = self.vertices.of(corner).ok_or_else(|| {
                let message = "there are more vertices than 32 bits can count".to_owned();
                (word.place(), message)
            })?;
            match count {
                0 => first = vertex,
                1 => {}
                _ => self.indices.push([first, previous, vertex]),
            }
            previous = vertex;
            count += 1;
        }
        if count < 3 {
            let message = format!("a face has at least 3 corners, found {count}");
            return Err((keyword.place(), message));
        }
        match self.parts.last_mut() {
            Some(part) if part.material == self.material => part.triangles.end = self.indices.len(),
            _ => self.parts.push(ObjPart {
                material: self.material,
                triangles: first_triangle..self.indices.len(),
            }),
        }
        Ok(())
    }

    /// Which position, texture coordinate and normal a corner has: `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    fn corner(&self, word: &Word) -> Result<[u32; 3], Problem> {
        let mut corner = [NONE; 3];
        let counts = [
            (self.positions.len(), "vertex"),
            (self.uvs.len(), "texture coordinate"),
            (self.normals.len(), "normal"),
        ];
        let bad = || {
            let message = "expected a corner as vertex, vertex/texture, vertex//normal or vertex/texture/normal";
            (word.place(), message.to_owned())
        };
        let mut start = word.start;
        for (i, part) in word.bytes.split(|&b| b == b'/').enumerate() {
            let (count, what) = *counts.get(i).ok_or_else(bad)?;
            if !part.is_empty() {
                let number = parse_index(part).ok_or_else(bad)?;
                let index = if number < 0 { count as i64 + number } else { number - 1 };
                corner[i] = u32::try_from(index)
                    .ok()
                    .filter(|&i| (i as usize) < count && number != 0)
                    .ok_or_else(|| {
                        let message = if number == 0 {
                            "0 is no index: they count from 1, or from -1 backwards".to_owned()
                        } else {
                            format!("there is no {what} {number}: up to here there are {count}")
                        };
                        (start..start + part.len(), message)
                    })?;
            }
            start += part.len() + 1;
        }
        if corner[0] == NONE { Err(bad()) } else { Ok(corner) }
    }

    fn finish(mut self) -> Result<ObjFile> {
        if self.errors.is_empty() && self.indices.is_empty() {
            let message = "there are no faces".to_owned();
            self.errors.push(self.diagnostic(Severity::Error, 0..0, message));
        }
        if !self.errors.is_empty() {
            return Err(Error::Scene(self.errors));
        }
        let corners = &self.vertices.corners;
        let has = |what: usize| corners.iter().any(|corner| corner[what] != NONE);
        let mut mesh = MeshDesc {
            positions: corners.iter().map(|c| self.positions[c[0] as usize]).collect(),
            indices: self.indices,
            ..MeshDesc::default()
        };
        if has(1) {
            let uv = |c: &[u32; 3]| self.uvs.get(c[1] as usize).copied().unwrap_or_default();
            mesh.uvs = corners.iter().map(uv).collect();
        }
        if has(2) {
            let normal = |c: &[u32; 3]| self.normals.get(c[2] as usize).copied().unwrap_or_default();
            mesh.normals = corners.iter().map(normal).collect();
        }
        Ok(ObjFile {
            mesh,
            parts: self.parts,
            materials: self.materials.list,
            libraries: self.libraries.list,
            warnings: self.warnings,
            hash: blake3::hash(self.text),
        })
    }
}

fn parse_number(word: &Word) -> Result<f32, Problem> {
    let number = fast_float2::parse::<f32, _>(word.bytes)
        .map_err(|_| (word.place(), format!("expected a number, found `{}`", word.text())))?;
    if number.is_finite() {
        return Ok(number);
    }
    let message = "this number does not fit into 32-bit floating point".to_owned();
    Err((word.place(), message))
}

/// An integer of at most 10 digits.
#[inline]
fn parse_index(word: &[u8]) -> Option<i64> {
    let (negative, digits) = match word {
        [b'-', digits @ ..] => (true, digits),
        [b'+', digits @ ..] => (false, digits),
        digits => (false, digits),
    };
    if digits.is_empty() || digits.len() > 10 {
        return None;
    }
    let mut value = 0_i64;
    for digit in digits {
        if !digit.is_ascii_digit() {
            return None;
        }
        value = 10 * value + i64::from(digit - b'0');
    }
    Some(if negative { -value } else { value })
}
