//! Meshes in Mitsuba's binary format: several in a file, each compressed by zlib, an index of their places at its end.

use std::io::Read;
use std::path::Path;

use flate2::read::ZlibDecoder;
use glam::{Vec2, Vec3};

use super::MeshDesc;

/// A mesh of a file.
#[derive(Debug)]
pub struct SerializedMesh {
    /// What it describes.
    pub mesh: MeshDesc,
    /// Whether it is to be shown without shading normals.
    pub face_normals: bool,
    /// BLAKE3 of the file's content.
    pub hash: blake3::Hash,
}

/// The first two bytes of each mesh, and the versions that are read.
const FORMAT: u16 = 0x041c;
const VERSIONS: [u16; 2] = [3, 4];

/// What a mesh has.
const HAS_NORMALS: u32 = 0x0001;
const HAS_TEXTURE_COORDINATES: u32 = 0x0002;
const HAS_COLORS: u32 = 0x0008;
const FACE_NORMALS: u32 = 0x0010;
const DOUBLE_PRECISION: u32 = 0x2000;

/// Reads the mesh with this number of a file, counted from 0.
///
/// # Errors
///
/// What is wrong.
pub fn load(path: &Path, index: u32) -> Result<SerializedMesh, String> {
    let content = std::fs::read(path).map_err(|e| e.to_string())?;
    let mut found = parse(&content, index)?;
    found.hash = blake3::hash(&content);
    Ok(found)
}

/// Reads the mesh with this number from the content of a file.
///
/// # Errors
///
/// What is wrong.
pub fn parse(content: &[u8], index: u32) -> Result<SerializedMesh, String> {
    let start = start(content, index)?;
    let rest = &content[start..];
    header(rest)?;
    let version = u16::from_le_bytes([rest[2], rest[3]]);
    let mut stream = Stream(ZlibDecoder::new(&rest[4..]));
    let flags = u32::from_le_bytes(stream.bytes()?);
    if version == 4 {
        // Its name.
        while stream.bytes::<1>()? != [0] {}
    }
    let [vertices, faces] = [u64::from_le_bytes(stream.bytes()?), u64::from_le_bytes(stream.bytes()?)];
    if vertices > u64::from(u32::MAX) || faces == 0 {
        return Err(format!("a mesh of {vertices} vertices and {faces} faces"));
    }
    let doubles = flags & DOUBLE_PRECISION != 0;
    let has = |flag: u32| flags & flag != 0;
    let positions = stream.vectors(vertices, doubles)?;
    let normals = if has(HAS_NORMALS) {
        stream.vectors(vertices, doubles)?
    } else {
        Vec::new()
    };
    let uvs = if has(HAS_TEXTURE_COORDINATES) {
        stream.many(vertices, |stream| {
            Ok(Vec2::new(stream.number(doubles)?, stream.number(doubles)?))
        })?
    } else {
        Vec::new()
    };
    if has(HAS_COLORS) {
        stream.vectors(vertices, doubles)?;
    }
    let indices = stream.many(faces, |stream| {
        let mut triangle = [0; 3];
        for corner in &mut triangle {
            *corner = u32::from_le_bytes(stream.bytes()?);
            if u64::from(*corner) >= vertices {
                return Err(format!("there is no vertex {corner}: there are {vertices}"));
            }
        }
        Ok(triangle)
    })?;
    Ok(SerializedMesh {
        mesh: MeshDesc {
            positions,
            normals,
            uvs,
            indices,
            ..MeshDesc::default()
        },
        face_normals: has(FACE_NORMALS),
        hash: blake3::hash(&[]),
    })
}

/// Checks the first four bytes of a mesh.
fn header(bytes: &[u8]) -> Result<(), String> {
    let [a, b, c, d, ..] = bytes else {
        return Err("the file ends early".to_owned());
    };
    let (format, version) = (u16::from_le_bytes([*a, *b]), u16::from_le_bytes([*c, *d]));
    if format != FORMAT {
        return Err("this is no serialized mesh of Mitsuba".to_owned());
    }
    if !VERSIONS.contains(&version) {
        return Err(format!("version {version} of the format is not known; 3 and 4 are"));
    }
    Ok(())
}

/// Where a mesh begins, by the index at the end of the file.
fn start(content: &[u8], index: u32) -> Result<usize, String> {
    header(content)?;
    let count = content
        .len()
        .checked_sub(4)
        .and_then(|at| content[at..].try_into().ok());
    let count = u32::from_le_bytes(count.ok_or("the file ends early")?);
    if index >= count {
        return Err(format!(
            "there is no mesh {index}: the file has {count}, counted from 0"
        ));
    }
    let bytes = if content[2] == 4 { 8 } else { 4 };
    let back = (count - index) as usize * bytes + 4;
    let at = content.len().checked_sub(back).ok_or("the file ends early")?;
    let mut offset = [0; 8];
    offset[..bytes].copy_from_slice(&content[at..at + bytes]);
    usize::try_from(u64::from_le_bytes(offset))
        .ok()
        .filter(|start| start.checked_add(4).is_some_and(|end| end <= at))
        .ok_or_else(|| "the index of the file is damaged".to_owned())
}

/// The content of a mesh as it is decompressed: counts are not believed, memory grows with what is there.
struct Stream<R>(R);

impl<R: Read> Stream<R> {
    fn bytes<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let mut bytes = [0; N];
        let read = self.0.read_exact(&mut bytes);
        read.map_err(|e| format!("the mesh ends early or is damaged ({e})"))?;
        Ok(bytes)
    }

    fn number(&mut self, double: bool) -> Result<f32, String> {
        let value = if double {
            f64::from_le_bytes(self.bytes()?) as f32
        } else {
            f32::from_le_bytes(self.bytes()?)
        };
        if value.is_finite() {
            Ok(value)
        } else {
            Err("a number is not finite".to_owned())
        }
    }

    fn many<T>(&mut self, count: u64, mut one: impl FnMut(&mut Self) -> Result<T, String>) -> Result<Vec<T>, String> {
        let mut values = Vec::new();
        for _ in 0..count {
            values.push(one(self)?);
        }
        Ok(values)
    }

    fn vectors(&mut self, count: u64, double: bool) -> Result<Vec<Vec3>, String> {
        self.many(count, |stream| {
            Ok(Vec3::new(
                stream.number(double)?,
                stream.number(double)?,
                stream.number(double)?,
            ))
        })
    }
}
