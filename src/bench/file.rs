//! Streams of rays in a file, with the triangles that they were shot at and what they hit there: `--rays FILE`, in the format of
//! docs/rays.md.

use std::fs;
use std::path::Path;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::case::Case;
use super::streams::{Stream, StreamKind};
use crate::accel::bvh::Bvh;
use crate::accel::{Accel, BuildOptions, BuildQuality, RayKind};
use crate::error::{Error, Result};
use crate::geometry::{
    Geometry, GeometryId, HitPacket, LANES, Ray, RayPacket, Shape, TriangleMesh, World, WorldBuilder,
};
use crate::math::{Vec3, transform_point};

const MAGIC: &[u8; 8] = b"LUCRAYS1";

/// Every array starts at a multiple of this.
const ALIGNMENT: usize = 64;

/// Numbers of a packet of rays: twelve rows of eight.
const PACKET_NUMBERS: usize = 12 * LANES;

/// Triangles, with every instance of them, beyond which a world is not written.
const MOST_TRIANGLES: u64 = 50_000_000;

/// What a file holds.
#[derive(Debug, Serialize, Deserialize)]
struct Header {
    /// For people.
    name: String,
    /// 0 if the world is not made of triangles that stand still.
    vertices: usize,
    triangles: usize,
    streams: Vec<StreamHeader>,
}

#[derive(Debug, Serialize, Deserialize)]
struct StreamHeader {
    kind: String,
    rays: usize,
    waves: usize,
    packets: usize,
}

/// A world as one mesh without instances; `None` if it is not made of triangles that stand still, or of too many.
fn flattened(world: &World) -> Option<TriangleMesh> {
    let moves = |geometry: &Geometry| !matches!(&geometry.shape, Shape::Mesh(mesh) if !mesh.is_moving());
    if world.geometries().iter().any(moves) || world.moves() || world.instanced_primitive_count() > MOST_TRIANGLES {
        return None;
    }
    let (mut positions, mut indices) = (Vec::new(), Vec::new());
    let mut add = |id: GeometryId, place: &dyn Fn(Vec3) -> Vec3| {
        if let Shape::Mesh(mesh) = &world.geometry(id).shape {
            let first = positions.len() as u32;
            positions.extend(mesh.positions(0).iter().map(|&p| place(p)));
            indices.extend(mesh.indices().iter().map(|corners| corners.map(|v| v + first)));
        }
    };
    world.root().iter().for_each(|&id| add(id, &|p| p));
    for instance in world.instances() {
        let matrix = instance.world_from_object.at(0.0);
        for &id in &world.groups()[instance.group.index()] {
            add(id, &|p| transform_point(&matrix, p));
        }
    }
    TriangleMesh::new(vec![positions], indices).ok()
}

fn world_of(mesh: TriangleMesh) -> Result<Arc<World>> {
    let mut builder = WorldBuilder::default();
    let id = builder.add_geometry(Geometry::opaque(Shape::Mesh(mesh)));
    builder.root.geometries.push(id);
    Ok(Arc::new(builder.build()?))
}

/// Bytes under way to a file.
#[derive(Default)]
struct Out(Vec<u8>);

impl Out {
    fn align(&mut self) {
        self.0.resize(self.0.len().next_multiple_of(ALIGNMENT), 0);
    }

    fn floats(&mut self, numbers: &[f32]) {
        self.0.extend(numbers.iter().flat_map(|x| x.to_le_bytes()));
    }

    fn words(&mut self, numbers: &[u32]) {
        self.0.extend(numbers.iter().flat_map(|x| x.to_le_bytes()));
    }

    fn packet(&mut self, p: &RayPacket) {
        for row in [
            &p.org_x, &p.org_y, &p.org_z, &p.tnear, &p.dir_x, &p.dir_y, &p.dir_z, &p.time, &p.tfar,
        ] {
            self.floats(row);
        }
        for row in [&p.mask, &p.id, &p.flags] {
            self.words(row);
        }
    }

    /// What the rays of a wave hit.
    fn answers(&mut self, accel: &dyn Accel, kind: RayKind, wave: &[RayPacket]) {
        if kind == RayKind::Shadow {
            let mut rays = wave.to_vec();
            accel.occluded(kind, &mut rays, None);
            for (after, before) in rays.iter().zip(wave) {
                let bit = |lane: usize| u8::from(before.is_active(lane) && after.is_occluded(lane)) << lane;
                self.0.push((0..LANES).map(bit).sum());
            }
            return;
        }
        let mut hits = vec![HitPacket::EMPTY; wave.len()];
        accel.intersect(kind, wave, &mut hits, None);
        for hits in &hits {
            self.words(&hits.primitive);
            self.floats(&hits.t);
        }
    }
}

/// Writes the streams of a case and, if it is made of triangles that stand still, these and what the rays hit.
///
/// # Errors
/// [`Error::Io`].
pub fn write(path: &Path, case: &Case) -> Result<()> {
    let mesh = flattened(&case.world);
    let count = |of: &dyn Fn(&TriangleMesh) -> usize| mesh.as_ref().map_or(0, of);
    let header = Header {
        name: case.name.clone(),
        vertices: count(&TriangleMesh::vertex_count),
        triangles: count(&TriangleMesh::triangle_count),
        streams: case.streams.iter().map(stream_header).collect(),
    };
    let mut text = serde_json::to_vec(&header).map_err(|e| Error::io("write", path, e.into()))?;
    text.resize((text.len() + 16).next_multiple_of(ALIGNMENT) - 16, b' ');
    let mut out = Out::default();
    out.0.extend(MAGIC);
    out.0.extend((text.len() as u64).to_le_bytes());
    out.0.extend(text);
    if let Some(mesh) = &mesh {
        mesh.positions(0).iter().for_each(|p| out.floats(&p.to_array()));
        out.align();
        mesh.indices().iter().for_each(|corners| out.words(corners));
        out.align();
    }
    let options = BuildOptions {
        quality: BuildQuality::High,
        ..BuildOptions::default()
    };
    let bvh = mesh
        .map(|mesh| world_of(mesh).map(|world| Bvh::build(&world, &options)))
        .transpose()?;
    for stream in &case.streams {
        let lengths: Vec<u32> = stream.waves.iter().map(|wave| wave.len() as u32).collect();
        out.words(&lengths);
        out.align();
        stream.waves.iter().flatten().for_each(|packet| out.packet(packet));
        if let Some(bvh) = &bvh {
            stream
                .waves
                .iter()
                .for_each(|wave| out.answers(bvh, stream.kind.ray_kind(), wave));
            out.align();
        }
    }
    fs::write(path, out.0).map_err(|e| Error::io("write", path, e))
}

fn stream_header(stream: &Stream) -> StreamHeader {
    StreamHeader {
        kind: stream.kind.to_string(),
        rays: stream.rays(),
        waves: stream.waves.len(),
        packets: stream.waves.iter().map(Vec::len).sum(),
    }
}

/// What is left of a file's bytes.
struct In<'a> {
    path: &'a Path,
    bytes: &'a [u8],
    at: usize,
}

impl<'a> In<'a> {
    fn error(&self, message: &str) -> Error {
        Error::Usage(format!("{}: {message}, at byte {}", self.path.display(), self.at))
    }

    fn take(&mut self, count: Option<usize>) -> Result<&'a [u8]> {
        let end = count.and_then(|count| self.at.checked_add(count));
        let Some(taken) = end.and_then(|end| self.bytes.get(self.at..end)) else {
            return Err(self.error("the file of rays is shorter than it says"));
        };
        self.at += taken.len();
        Ok(taken)
    }

    fn align(&mut self) {
        self.at = self.at.next_multiple_of(ALIGNMENT);
    }

    fn words(&mut self, count: Option<usize>) -> Result<Vec<u32>> {
        let bytes = self.take(count.and_then(|count| count.checked_mul(4)))?;
        let word = |b: &[u8]| u32::from_le_bytes([b[0], b[1], b[2], b[3]]);
        Ok(bytes.chunks_exact(4).map(word).collect())
    }

    fn header(&mut self) -> Result<Header> {
        if self.take(Some(MAGIC.len()))? != MAGIC {
            self.at = 0;
            return Err(self.error("no file of rays: expected LUCRAYS1"));
        }
        let length = self
            .take(Some(8))?
            .iter()
            .rev()
            .fold(0, |n, &byte| n << 8 | u64::from(byte));
        let text = self.take(usize::try_from(length).ok())?;
        serde_json::from_slice(text).map_err(|e| self.error(&format!("the header is not as expected: {e}")))
    }

    fn mesh(&mut self, header: &Header) -> Result<TriangleMesh> {
        let positions = self.words(header.vertices.checked_mul(3))?;
        self.align();
        let corners = self.words(header.triangles.checked_mul(3))?;
        self.align();
        let positions = positions
            .chunks_exact(3)
            .map(|p| Vec3::from_array([p[0], p[1], p[2]].map(f32::from_bits)));
        let corners = corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]]);
        TriangleMesh::new(vec![positions.collect()], corners.collect()).map_err(|e| self.error(&e.to_string()))
    }

    fn stream(&mut self, header: &StreamHeader, has_answers: bool) -> Result<Stream> {
        let Ok(kind) = header.kind.parse::<StreamKind>() else {
            return Err(self.error(&format!("unknown kind of rays `{}`", header.kind)));
        };
        let lengths = self.words(Some(header.waves))?;
        self.align();
        let mut waves = Vec::new();
        for length in &lengths {
            let numbers = self.words((*length as usize).checked_mul(PACKET_NUMBERS))?;
            waves.push(numbers.chunks_exact(PACKET_NUMBERS).map(packet).collect::<Vec<_>>());
        }
        let packets: usize = lengths.iter().map(|&length| length as usize).sum();
        let rays = waves
            .iter()
            .flatten()
            .flat_map(|packet| (0..LANES).map(move |lane| packet.get(lane)));
        if packets != header.packets || !rays.filter(|ray| ray.tnear <= ray.tfar).all(|ray| Ray::is_valid(&ray)) {
            return Err(self.error("the packets are not as many as the header says, or hold a ray that is not valid"));
        }
        if has_answers {
            let size = if kind == StreamKind::Shadow { 1 } else { 8 * LANES };
            self.take(packets.checked_mul(size))?;
            self.align();
        }
        Ok(Stream { kind, waves })
    }
}

fn packet(numbers: &[u32]) -> RayPacket {
    let words = |row: usize| -> [u32; LANES] { std::array::from_fn(|lane| numbers[row * LANES + lane]) };
    let floats = |row: usize| words(row).map(f32::from_bits);
    RayPacket {
        org_x: floats(0),
        org_y: floats(1),
        org_z: floats(2),
        tnear: floats(3),
        dir_x: floats(4),
        dir_y: floats(5),
        dir_z: floats(6),
        time: floats(7),
        tfar: floats(8),
        mask: words(9),
        id: words(10),
        flags: [0; LANES],
    }
}

/// Reads streams. The world is that of the file; `world` stands in for it where the file has none.
///
/// # Errors
/// [`Error::Io`]; [`Error::Usage`] if the file is malformed, or has no triangles and there is no `world`.
pub fn read(path: &Path, world: Option<&Arc<World>>) -> Result<Case> {
    let bytes = fs::read(path).map_err(|e| Error::io("read", path, e))?;
    let mut file = In {
        path,
        bytes: &bytes,
        at: 0,
    };
    let header = file.header()?;
    let has_world = header.triangles > 0;
    let world = match (has_world, world) {
        (true, _) => world_of(file.mesh(&header)?)?,
        (false, Some(world)) => Arc::clone(world),
        (false, None) => return Err(file.error("the file has rays only: name the scene that they belong to")),
    };
    let streams = header.streams.iter().map(|header| file.stream(header, has_world));
    let streams = streams.collect::<Result<Vec<_>>>()?;
    Ok(Case {
        name: header.name,
        recipe: None,
        world,
        streams,
    })
}
