//! Meshes in the OBJ format (Wavefront): vertices, normals, texture coordinates and polygons.
//!
//! Polygons become fans of triangles around their first vertex; what names one position with several normals or texture coordinates
//! becomes as many vertices. Groups, materials, lines and points are passed over.

mod line;

use std::collections::HashMap;
use std::path::Path;

use glam::{Vec2, Vec3};

use super::{MeshDesc, bytes};
use line::{Line, index, statement};

/// A mesh file.
#[derive(Debug)]
pub struct ObjFile {
    /// What it describes.
    pub mesh: MeshDesc,
    /// BLAKE3 of its content, decompressed.
    pub hash: blake3::Hash,
}

/// The longest file that is read, decompressed.
const LONGEST: u64 = 1 << 36;

/// Reads a file.
///
/// # Errors
///
/// What is wrong, and in which line.
pub fn load(path: &Path) -> Result<ObjFile, String> {
    let content = bytes::read(path, LONGEST).map_err(|e| e.to_string())?;
    Ok(ObjFile {
        mesh: parse(&content)?,
        hash: blake3::hash(&content),
    })
}

/// Reads a mesh from the content of a file, not compressed.
///
/// # Errors
///
/// What is wrong, and in which line.
pub fn parse(content: &[u8]) -> Result<MeshDesc, String> {
    let mut reader = Reader::default();
    for (number, line) in content.split(|&b| b == b'\n').enumerate() {
        let statement = statement(line);
        statement
            .and_then(|statement| reader.add(statement))
            .map_err(|problem| format!("line {}: {problem}", number + 1))?;
    }
    reader.finish()
}

/// A corner of a polygon: places in the lists of the file, 0 for none, counted from 1.
type Corner = [u32; 3];

#[derive(Debug, Default)]
struct Reader {
    positions: Vec<Vec3>,
    uvs: Vec<Vec2>,
    normals: Vec<Vec3>,
    vertices: HashMap<Corner, u32>,
    /// By vertex.
    corners: Vec<Corner>,
    indices: Vec<[u32; 3]>,
    polygon: Vec<u32>,
}

impl Reader {
    fn add(&mut self, line: Line<'_>) -> Result<(), String> {
        match line {
            Line::Position(p) => self.positions.push(p),
            Line::TextureCoordinates(uv) => self.uvs.push(uv),
            Line::Normal(n) => self.normals.push(n),
            Line::Face(words) => self.face(words)?,
            Line::Other => {}
        }
        Ok(())
    }

    fn face(&mut self, words: &[u8]) -> Result<(), String> {
        self.polygon.clear();
        let counts = [self.positions.len(), self.uvs.len(), self.normals.len()];
        for word in words.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()) {
            let mut corner: Corner = [0; 3];
            for (i, part) in word.split(|&b| b == b'/').enumerate() {
                let Some(place) = corner.get_mut(i) else {
                    return Err(format!("`{}` has more than two slashes", String::from_utf8_lossy(word)));
                };
                if !part.is_empty() {
                    *place = index(part, counts[i], ["vertex", "texture coordinate", "normal"][i])?;
                }
            }
            if corner[0] == 0 {
                return Err(format!("`{}` names no vertex", String::from_utf8_lossy(word)));
            }
            let next = self.corners.len() as u32;
            let vertex = *self.vertices.entry(corner).or_insert(next);
            if vertex == next {
                if next == u32::MAX {
                    return Err("more vertices than 32 bits count".to_owned());
                }
                self.corners.push(corner);
            }
            self.polygon.push(vertex);
        }
        if self.polygon.len() < 3 {
            return Err(format!(
                "a face has 3 corners at least, this one {}",
                self.polygon.len()
            ));
        }
        let first = self.polygon[0];
        self.indices
            .extend(self.polygon[1..].windows(2).map(|pair| [first, pair[0], pair[1]]));
        Ok(())
    }

    /// Normals and texture coordinates are kept only if every corner has them.
    fn finish(self) -> Result<MeshDesc, String> {
        if self.indices.is_empty() {
            return Err("there are no faces".to_owned());
        }
        let all = |i: usize| self.corners.iter().all(|corner| corner[i] != 0);
        let pick = |i: usize| self.corners.iter().map(move |corner| corner[i] as usize - 1);
        let positions = pick(0).map(|at| self.positions[at]).collect();
        let uvs = if all(1) {
            pick(1).map(|at| self.uvs[at]).collect()
        } else {
            Vec::new()
        };
        let normals = if all(2) {
            pick(2).map(|at| self.normals[at]).collect()
        } else {
            Vec::new()
        };
        Ok(MeshDesc {
            positions,
            uvs,
            normals,
            indices: self.indices,
            ..MeshDesc::default()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polygons_become_fans_and_corners_vertices() {
        let text =
            b"# a square\r\nv 0 0 0\nv 1 0 0\nv 1 1 0 1.0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1 0\nvn 0 0 1\no x\n\
                     f 1/1/1 2/2/1 3/3/1 4/4/1\nf -4/-4/-1 -2/-2/-1 -1/-1/-1\n";
        let mesh = parse(text).unwrap();
        assert_eq!(mesh.indices, [[0, 1, 2], [0, 2, 3], [0, 2, 3]]);
        assert_eq!(mesh.positions[2], Vec3::new(1.0, 1.0, 0.0));
        assert_eq!(mesh.uvs[3], Vec2::new(0.0, 1.0));
        assert_eq!(mesh.normals, [Vec3::Z; 4]);
    }

    #[test]
    fn what_only_some_corners_have_is_left_out() {
        let mesh = parse(b"v 0 0 0\nv 1 0 0\nv 1 1 0\nvn 0 0 1\nvt 0 0\nf 1//1 2//1 3\nf 1/1 2/1 3/1").unwrap();
        assert!(mesh.normals.is_empty() && mesh.uvs.is_empty());
        assert_eq!(mesh.positions.len(), 6);
    }

    #[test]
    fn errors_say_the_line() {
        for (text, expected) in [
            ("v 0 0\n", "line 1: "),
            ("v 0 0 0\nv 1 0 x\n", "line 2: "),
            ("v 0 0 0\nf 1 1 2\n", "there is no vertex 2: there are 1"),
            ("v 0 0 0\nf 1 1 0\n", "line 2: "),
            ("v 0 0 0\nf 1 1 -2\n", "line 2: "),
            ("v 0 0 0\nf 1 1\n", "3 corners"),
            ("v 0 0 0\nf 1/2/3/4 1 1\n", "line 2: "),
            ("v 0 0 nan\n", "line 1: "),
            ("v 0 0 1e300\n", "line 1: "),
            ("", "no faces"),
        ] {
            let problem = parse(text.as_bytes()).unwrap_err();
            assert!(problem.contains(expected), "{text:?}: {problem}");
        }
    }
}
