//! Reads docs/rays.md.

use serde::Deserialize;

#[derive(Deserialize)]
struct Header {
    name: String,
    vertices: usize,
    triangles: usize,
    streams: Vec<StreamHeader>,
}

#[derive(Deserialize)]
struct StreamHeader {
    kind: String,
    waves: usize,
    packets: usize,
}

pub struct Ray {
    pub origin: [f32; 3],
    pub direction: [f32; 3],
    pub tnear: f32,
    pub tfar: f32,
}

/// Twelve rows of eight.
pub struct Packet(Vec<f32>);

pub enum Answer {
    /// A bit for each ray.
    Any(u8),
    /// Triangles and distances.
    Nearest([u32; 8], [f32; 8]),
}

pub struct Stream {
    pub kind: String,
    pub packets: Vec<Packet>,
    pub answers: Vec<Answer>,
}

pub struct File {
    pub name: String,
    pub vertices: Vec<[f32; 3]>,
    pub triangles: Vec<[u32; 3]>,
    pub streams: Vec<Stream>,
}

impl Packet {
    /// The rays that take part, with their lanes.
    pub fn lanes(&self) -> impl Iterator<Item = (usize, Ray)> + '_ {
        let at = |row: usize, lane: usize| self.0[row * 8 + lane];
        (0..8).filter(move |&lane| at(3, lane) <= at(8, lane)).map(move |lane| {
            let ray = Ray {
                origin: [at(0, lane), at(1, lane), at(2, lane)],
                direction: [at(4, lane), at(5, lane), at(6, lane)],
                tnear: at(3, lane),
                tfar: at(8, lane),
            };
            (lane, ray)
        })
    }

    pub fn active(&self) -> impl Iterator<Item = Ray> + '_ {
        self.lanes().map(|(_, ray)| ray)
    }
}

struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Reader<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8], String> {
        let taken = self.bytes.get(self.at..self.at + count).ok_or("the file is too short")?;
        self.at += count;
        Ok(taken)
    }

    fn align(&mut self) {
        self.at = self.at.next_multiple_of(64);
    }

    fn words(&mut self, count: usize) -> Result<Vec<u32>, String> {
        let bytes = self.take(4 * count)?;
        Ok(bytes.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect())
    }

    fn floats(&mut self, count: usize) -> Result<Vec<f32>, String> {
        Ok(self.words(count)?.into_iter().map(f32::from_bits).collect())
    }

    fn stream(&mut self, header: StreamHeader) -> Result<Stream, String> {
        self.words(header.waves)?;
        self.align();
        let packets = (0..header.packets).map(|_| Ok(Packet(self.floats(96)?))).collect::<Result<_, String>>()?;
        let is_shadow = header.kind == "shadow";
        let answers = (0..header.packets).map(|_| {
            if is_shadow {
                return Ok(Answer::Any(self.take(1)?[0]));
            }
            let (triangles, distances) = (self.words(8)?, self.floats(8)?);
            let lane = |i: usize| triangles[i];
            Ok(Answer::Nearest(std::array::from_fn(lane), std::array::from_fn(|i| distances[i])))
        });
        let answers = answers.collect::<Result<_, String>>()?;
        self.align();
        Ok(Stream {
            kind: header.kind,
            packets,
            answers,
        })
    }
}

impl File {
    pub fn read(path: &str) -> Result<Self, String> {
        let bytes = std::fs::read(path).map_err(|e| format!("{path}: {e}"))?;
        let mut reader = Reader { bytes: &bytes, at: 0 };
        if reader.take(8)? != b"LUCRAYS1" {
            return Err(format!("{path}: no file of rays"));
        }
        let length = reader.take(8)?.iter().rev().fold(0usize, |n, &byte| n << 8 | usize::from(byte));
        let header: Header = serde_json::from_slice(reader.take(length)?).map_err(|e| e.to_string())?;
        if header.triangles == 0 {
            return Err(format!("{path}: no triangles in it"));
        }
        let vertices = reader.floats(3 * header.vertices)?;
        reader.align();
        let triangles = reader.words(3 * header.triangles)?;
        reader.align();
        Ok(Self {
            name: header.name,
            vertices: vertices.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect(),
            triangles: triangles.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
            streams: header.streams.into_iter().map(|header| reader.stream(header)).collect::<Result<_, _>>()?,
        })
    }
}
