//! PLY meshes in all encodings, and bad ones.

use std::path::Path;

use glam::{Vec2, Vec3};
use lucerna::desc::{AttributeDomain, MeshDesc, ply};

/// Numbers of a file, written in one of the encodings.
#[derive(Clone, Copy, PartialEq)]
enum Encoding {
    Ascii,
    Little,
    Big,
}

const ENCODINGS: [Encoding; 3] = [Encoding::Ascii, Encoding::Little, Encoding::Big];

/// A file of so many numbers of so many types.
struct Writer {
    encoding: Encoding,
    bytes: Vec<u8>,
}

macro_rules! put {
    ($($name:ident: $kind:ty),*) => {
        $(fn $name(&mut self, value: $kind) -> &mut Self {
            match self.encoding {
                Encoding::Ascii => self.bytes.extend(format!("{value} ").into_bytes()),
                Encoding::Little => self.bytes.extend(value.to_le_bytes()),
                Encoding::Big => self.bytes.extend(value.to_be_bytes()),
            }
            self
        })*
    };
}

impl Writer {
    fn new(encoding: Encoding, header: &str) -> Self {
        let format = match encoding {
            Encoding::Ascii => "ascii",
            Encoding::Little => "binary_little_endian",
            Encoding::Big => "binary_big_endian",
        };
        let header = format!("ply\r\nformat {format} 1.0\ncomment made by hand\n{header}\nend_header\n");
        Self {
            encoding,
            bytes: header.into_bytes(),
        }
    }

    put!(u8: u8, i16: i16, i32: i32, u32: u32, f32: f32, f64: f64);

    fn read(&self) -> Result<MeshDesc, String> {
        parse(&self.bytes)
    }
}

fn parse(content: &[u8]) -> Result<MeshDesc, String> {
    ply::parse(content, Path::new("m.ply")).map_err(|e| e.to_string())
}

fn parse_with_attributes(content: &[u8]) -> Result<MeshDesc, String> {
    ply::parse_with_attributes(content, Path::new("m.ply")).map_err(|e| e.to_string())
}

#[test]
fn all_that_matters_is_read_and_the_rest_skipped() {
    let header = "element camera 2\nproperty list uchar float view\nproperty short f\n\
                  element vertex 5\nproperty uchar red\nproperty double x\nproperty float y\nproperty short z\n\
                  property float nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty float t\n\
                  element face 4\nproperty int flags\nproperty list uchar uint vertex_index\nproperty list uint short more\n\
                  element edge 1\nproperty int vertex1";
    for encoding in ENCODINGS {
        let mut file = Writer::new(encoding, header);
        file.u8(2).f32(0.5).f32(1.5).i16(-1).u8(0).i16(-1);
        for i in 0..5_i16 {
            let v = f32::from(i);
            file.u8(255).f64(f64::from(i) + 0.25).f32(-v).i16(10 * i);
            file.f32(0.0).f32(1.0).f32(v).f32(v / 4.0).f32(1.0 - v / 4.0);
        }
        for corners in [&[0, 1, 2][..], &[0, 1, 2, 3], &[4, 3, 2, 1, 0], &[1, 2]] {
            file.i32(7).u8(corners.len() as u8);
            for &corner in corners {
                file.u32(corner);
            }
            file.u32(2).i16(3).i16(4);
        }
        file.i32(9);
        let mesh = file.read().unwrap_or_else(|e| panic!("{e}"));
        let positions = [0.0, 1.0, 2.0, 3.0, 4.0_f32].map(|i| Vec3::new(i + 0.25, -i, 10.0 * i));
        assert_eq!(mesh.positions, positions);
        assert_eq!(mesh.normals[3], Vec3::new(0.0, 1.0, 3.0));
        assert_eq!(mesh.uvs[1], Vec2::new(0.25, 0.75));
        let fans = [[0, 1, 2], [0, 1, 2], [0, 2, 3], [4, 3, 2], [4, 2, 1], [4, 1, 0]];
        assert_eq!(mesh.indices, fans);
        assert!(mesh.tangents.is_empty() && mesh.positions_end.is_none());
    }
}

#[test]
fn texture_coordinates_have_many_names() {
    for (u, v) in [
        ("u", "v"),
        ("s", "t"),
        ("texture_u", "texture_v"),
        ("texture_s", "texture_t"),
    ] {
        let names = format!("property float z\nproperty float {u}\nproperty float {v}\n");
        let text = triangle()
            .replace("property float z\n", &names)
            .replace("0 0 0\n1 0 0\n0 1 0\n", "0 0 0 .5 1\n1 0 0 1 0\n0 1 0 0 0\n");
        let mesh = parse(text.as_bytes()).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(mesh.uvs, [Vec2::new(0.5, 1.0), Vec2::X, Vec2::ZERO]);
    }
}

fn triangle() -> String {
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n\
     property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2"
        .to_owned()
}

#[test]
fn bad_files_are_refused_with_the_place() {
    assert!(parse(triangle().as_bytes()).is_ok());
    for (from, to, message) in [
        ("ply\n", "pyl\n", "m.ply:1:1: error: this is not a PLY file"),
        ("ascii", "ebcdic", "m.ply:2:8: error: unknown format: expected `ascii`"),
        ("format ascii 1.0\n", "", "m.ply:8:1: error: the header has no `format`"),
        (
            "end_header",
            " end_headr",
            "m.ply:9:2: error: expected `format`, `element`",
        ),
        (
            "element vertex 3",
            "element vertex three",
            "m.ply:3:16: error: expected the number of rows",
        ),
        (
            "property float y",
            "property flot y",
            "m.ply:5:1: error: expected a type",
        ),
        (
            "property float y",
            "property float v",
            "m.ply:3:1: error: the vertices have no properties `x`, `y`",
        ),
        (
            "element vertex 3\n",
            "",
            "m.ply:3:1: error: a property before any element",
        ),
        ("list uchar", "list float", "m.ply:8:1: error: expected a type"),
        (
            "uchar int",
            "uchar float",
            "m.ply:7:1: error: the faces have no list of integers",
        ),
        (
            "vertex_indices",
            "corners",
            "m.ply:7:1: error: the faces have no list of integers",
        ),
        (
            "element face 1",
            "element face 0",
            "m.ply:7:1: error: there are no vertices or no faces",
        ),
        (
            "element vertex 3",
            "element vertex 0",
            "m.ply:3:1: error: there are no vertices or no faces",
        ),
        (
            "element vertex 3",
            "element vertex 4",
            "m.ply:13:8: error: the file ends before its data do",
        ),
        (
            "element vertex 3",
            "element vertex 18446744073709551615",
            "m.ply:3:1: error: the file is too short for",
        ),
        (
            "element face 1",
            "element face 123456789012",
            "m.ply:7:1: error: the file is too short for",
        ),
        ("1 0 0\n", "1 x 0\n", "m.ply:11:3: error: expected a number"),
        (
            "1 0 0\n",
            "1 nan 0\n",
            "m.ply:3:1: error: the position of vertex 1 is not finite",
        ),
        (
            "1 0 0\n",
            "1 1e39 0\n",
            "m.ply:3:1: error: the position of vertex 1 is not finite",
        ),
        (
            "3 0 1 2",
            "3 0 1 3",
            "m.ply:7:1: error: a face has the vertex 3, but there are 3",
        ),
        ("3 0 1 2", "3 0 1 -1", "m.ply:13:7: error: expected an integer"),
        ("3 0 1 2", "3 0 1 1.5", "m.ply:13:7: error: expected an integer"),
        ("3 0 1 2", "3000000000 0 1 2", "m.ply:13:17: error: the file ends"),
        (
            "3 0 1 2",
            "2 0 1",
            "m.ply:7:1: error: there are no vertices or no faces",
        ),
    ] {
        let error = parse(triangle().replacen(from, to, 1).as_bytes()).expect_err(to);
        assert!(error.starts_with(message), "{to}: {error}");
    }
    let open = "ply\nformat ascii 1.0\ncomment and nothing more";
    let error = parse(open.as_bytes()).expect_err("an open header");
    assert!(
        error.starts_with("m.ply:3:1: error: the file ends before `end_header`"),
        "{error}"
    );
}

#[test]
fn truncated_binary_files_are_refused() {
    let header = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list int int vertex_indices";
    let mut file = Writer::new(Encoding::Little, header);
    let start = file.bytes.len();
    for v in [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0] {
        file.f32(v);
    }
    file.i32(3).i32(0).i32(1).i32(2);
    assert!(file.read().is_ok());
    for length in 0..file.bytes.len() {
        let error = parse(&file.bytes[..length]).expect_err("truncated");
        assert!(
            length < start || error.starts_with("m.ply:4:1: ") || error.starts_with("m.ply:8:1: "),
            "{error}"
        );
    }
}

/// Names and numbers as in Mitsuba 3, but for colours of bytes.
#[test]
fn attributes_are_read_if_they_are_asked_for() {
    let header = |format: &str| {
        format!(
            "ply\nformat {format} 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
             property uchar green\nproperty uchar red\nproperty uchar blue\nproperty uchar alpha\n\
             property float heat_0\nproperty short bend_x\nproperty short bend_y\nproperty short bend_z\nproperty float lone\n\
             element face 2\nproperty list uchar int vertex_indices\nproperty float paint_r\nproperty float paint_g\n\
             property float paint_b\nend_header\n"
        )
    };
    let vertices = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let mut text = header("ascii");
    let mut binary = header("binary_big_endian").into_bytes();
    for (i, v) in vertices.iter().enumerate() {
        let (colors, bends) = ([51_u8, 255, 0, 7], [i as i16, -1, 2]);
        let [x, y, z] = v;
        text += &format!("{x} {y} {z} 51 255 0 7 {i}.5 {i} -1 2 9\n");
        v.iter().for_each(|c| binary.extend(c.to_be_bytes()));
        binary.extend(colors);
        binary.extend((i as f32 + 0.5).to_be_bytes());
        bends.iter().for_each(|c| binary.extend(c.to_be_bytes()));
        binary.extend(9.0_f32.to_be_bytes());
    }
    // A quadrilateral, which becomes two triangles, and a triangle.
    for corners in [&[0_i32, 1, 2, 1][..], &[2, 1, 0]] {
        let words: Vec<String> = corners.iter().map(i32::to_string).collect();
        text += &format!("{} {} 0.25 0.5 {}\n", corners.len(), words.join(" "), corners.len());
        binary.push(corners.len() as u8);
        corners.iter().for_each(|c| binary.extend(c.to_be_bytes()));
        [0.25, 0.5, corners.len() as f32]
            .iter()
            .for_each(|c| binary.extend(c.to_be_bytes()));
    }
    for content in [text.as_bytes(), &binary] {
        let mesh = parse_with_attributes(content).unwrap_or_else(|e| panic!("{e}"));
        let [color, heat, bend, paint] = &mesh.attributes[..] else {
            panic!("{:?}", mesh.attributes)
        };
        assert_eq!((color.name.as_str(), color.channels), ("vertex_color", 3));
        assert_eq!(color.values, [1.0, 0.2, 0.0].repeat(3));
        assert_eq!((heat.name.as_str(), heat.channels), ("vertex_heat", 1));
        assert_eq!(heat.values, [0.5, 1.5, 2.5]);
        assert_eq!((bend.name.as_str(), bend.channels), ("vertex_bend", 3));
        assert_eq!(bend.values, [0.0, -1.0, 2.0, 1.0, -1.0, 2.0, 2.0, -1.0, 2.0]);
        assert_eq!((paint.name.as_str(), paint.channels), ("face_paint_color", 3));
        assert_eq!(paint.values, [0.25, 0.5, 4.0, 0.25, 0.5, 4.0, 0.25, 0.5, 3.0]);
        assert_eq!(paint.domain, AttributeDomain::Triangles);
        assert!(parse(content).is_ok_and(|mesh| mesh.attributes.is_empty() && mesh.indices.len() == 3));
    }
    let endless = text.replace("0.25 0.5", "0.25 inf");
    let error = parse_with_attributes(endless.as_bytes()).expect_err("not finite");
    assert!(error.contains("face_paint_color"), "{error}");
}
