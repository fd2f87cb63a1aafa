//! Large binary files, read a part at a time on each thread: the whole of one in memory would take more time and room than what it
//! describes.

use std::fs::File;
use std::io::{self, Read};
use std::os::unix::fs::FileExt;
use std::path::Path;

use glam::{Vec2, Vec3};
use rayon::prelude::*;

use super::header::{self, Encoding, Header};
use super::{Columns, PlyFile, check, rows};
use crate::desc::MeshDesc;

/// Bytes that a header may have here.
const LONGEST_HEADER: u64 = 1 << 16;
/// Rows that a task reads at a time.
const SPAN: usize = 1 << 14;
/// Bytes that are hashed at a time.
const PIECE: usize = 1 << 20;

/// Reads a file of `least` bytes or more that has nothing but rows of one length for each element: vertices, triangles, and what does
/// not matter. `None` of any other, and if anything is wrong: who reads it as a whole finds out what.
pub(super) fn load(path: &Path, least: u64) -> Option<PlyFile> {
    let file = File::open(path).ok()?;
    let about = file.metadata().ok()?;
    let is_compressed = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("gz"));
    if !about.is_file() || about.len() < least || is_compressed {
        return None;
    }
    let mut start = Vec::new();
    (&file).take(LONGEST_HEADER).read_to_end(&mut start).ok()?;
    let header = header::parse(&start).ok()?;
    if header.encoding == Encoding::Ascii {
        return None;
    }
    let (mesh, hash) = rayon::join(|| mesh(&file, about.len(), &header), || hash(&file));
    Some(PlyFile {
        mesh: mesh?,
        hash: hash.ok()?,
    })
}

fn mesh(file: &File, length: u64, header: &Header) -> Option<MeshDesc> {
    let mut mesh = MeshDesc::default();
    let mut start = header.end as u64;
    for element in &header.elements {
        let is_faces = element.name == "face" && mesh.indices.is_empty();
        let row = if is_faces {
            rows::triangle_row(element)?
        } else {
            element.fixed_row()?
        };
        let end = start.checked_add(element.count.checked_mul(row as u64)?)?;
        if end > length {
            return None;
        }
        let part = Part {
            file,
            start,
            row,
            count: usize::try_from(element.count).ok()?,
        };
        if is_faces {
            mesh.indices = part.read(|face| rows::triangle(face, header.encoding))?;
        } else if element.name == "vertex" && mesh.positions.is_empty() {
            u32::try_from(element.count).ok()?;
            let columns = Columns::of(element, Vec::new()).ok()?;
            let three = |columns: [usize; 3]| {
                let tuple = rows::tuples(element, header.encoding, columns);
                part.read(|row| Some(tuple(row)))
            };
            let vectors = |values: Vec<[f32; 3]>| values.into_iter().map(Vec3::from_array).collect();
            mesh.positions = vectors(three(columns.position)?);
            if let Some(normal) = columns.normal {
                mesh.normals = vectors(three(normal)?);
            }
            if let Some(uv) = columns.uv {
                let tuple = rows::tuples(element, header.encoding, uv);
                let values: Vec<[f32; 2]> = part.read(|row| Some(tuple(row)))?;
                mesh.uvs = values.into_iter().map(Vec2::from_array).collect();
            }
        }
        start = end;
    }
    check(&mesh).ok()?;
    Some(mesh)
}

/// The rows of an element.
struct Part<'a> {
    file: &'a File,
    start: u64,
    row: usize,
    count: usize,
}

impl Part<'_> {
    /// What `of` makes of each row; `None` if it does so of one.
    fn read<T: Copy + Default + Send, const N: usize>(
        &self,
        of: impl Fn(&[u8]) -> Option<[T; N]> + Sync,
    ) -> Option<Vec<[T; N]>> {
        // Numbers that are zero: memory that is as the system hands it out, and first written by the threads below.
        let mut values = vec![[T::default(); N]; self.count];
        let read = |buffer: &mut Vec<u8>, (i, values): (usize, &mut [[T; N]])| {
            buffer.resize(values.len() * self.row, 0);
            let start = self.start + (i * SPAN * self.row) as u64;
            self.file.read_exact_at(buffer, start).ok()?;
            for (value, row) in values.iter_mut().zip(buffer.chunks_exact(self.row)) {
                *value = of(row)?;
            }
            Some(())
        };
        let parts = values.par_chunks_mut(SPAN).enumerate();
        let is_whole = parts.map_init(Vec::new, read).all(|part| part.is_some());
        is_whole.then_some(values)
    }
}

fn hash(file: &File) -> io::Result<blake3::Hash> {
    let mut hasher = blake3::Hasher::new();
    let mut buffer = vec![0; PIECE];
    let mut start = 0;
    loop {
        let count = file.read_at(&mut buffer, start)?;
        if count == 0 {
            return Ok(hasher.finalize());
        }
        hasher.update(&buffer[..count]);
        start += count as u64;
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;
    use crate::desc::ply::parse;

    /// A file with an element that does not matter before its vertices, and rows enough for some parts.
    fn content(encoding: &str, length: u8, last_corner: u32) -> Vec<u8> {
        const VERTICES: u32 = 40_000;
        let is_big = encoding == "big";
        let header = format!(
            "ply\nformat binary_{encoding}_endian 1.0\ncomment a\nelement odd 3\nproperty short a\nproperty char b\nelement vertex {VERTICES}\n\
             property double x\nproperty float y\nproperty short z\nproperty float nx\nproperty float ny\nproperty float nz\n\
             property uchar red\nproperty float u\nproperty float v\n\
             element face {VERTICES}\nproperty list uchar int vertex_indices\nend_header\n"
        );
        let mut content = header.into_bytes();
        content.extend([7; 9]);
        let f32_of = |x: f32| if is_big { x.to_be_bytes() } else { x.to_le_bytes() };
        let u32_of = |x: u32| if is_big { x.to_be_bytes() } else { x.to_le_bytes() };
        for i in 0..VERTICES {
            let x = f64::from(i) * 0.1;
            content.extend(if is_big { x.to_be_bytes() } else { x.to_le_bytes() });
            content.extend(f32_of(1.0 / (1.0 + i as f32)));
            let z = i as i16;
            content.extend(if is_big { z.to_be_bytes() } else { z.to_le_bytes() });
            content.extend([0.5, 0.25, i as f32].map(f32_of).as_flattened());
            content.push(i as u8);
            content.extend([i as f32 * 0.25, 3.0].map(f32_of).as_flattened());
        }
        for i in 0..VERTICES {
            let last = i + 1 == VERTICES;
            content.push(if last { length } else { 3 });
            let corners = [i, (i * 7) % VERTICES, if last { last_corner } else { 0 }];
            content.extend(corners.map(u32_of).as_flattened());
        }
        content
    }

    fn load_of(content: &[u8]) -> Option<PlyFile> {
        let mut file = tempfile::NamedTempFile::new().expect("a file");
        file.write_all(content).expect("written");
        load(file.path(), 0)
    }

    #[test]
    fn parts_are_the_mesh_that_the_whole_is() {
        for encoding in ["little", "big"] {
            let content = content(encoding, 3, 1);
            let whole = parse(&content, Path::new("m.ply")).expect("a mesh");
            let parts = load_of(&content).expect("read in parts");
            assert_eq!(format!("{:?}", parts.mesh), format!("{whole:?}"));
            assert_eq!(parts.hash, blake3::hash(&content));
            assert!(whole.positions.len() > 2 * SPAN && !whole.normals.is_empty() && !whole.uvs.is_empty());
        }
    }

    #[test]
    fn what_is_wrong_or_unusual_is_left_to_who_reads_the_whole() {
        let good = content("little", 3, 1);
        assert!(load_of(&good).is_some());
        // A polygon; a corner that there is not; a negative one; an end that is missing; a text.
        for (length, last_corner) in [(4, 1), (3, 40_000), (3, u32::MAX)] {
            assert!(load_of(&content("little", length, last_corner)).is_none());
        }
        assert!(load_of(&good[..good.len() - 1]).is_none());
        let text = b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n";
        assert!(load_of(text).is_none());
        assert!(load_of(b"").is_none());
        assert!(load(Path::new("no such file"), 0).is_none());
    }
}
