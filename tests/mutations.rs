//! No bytes make a reader panic, run away or exhaust memory: 10^5 mutations of small valid files (`tests/seeds`) of all formats, from
//! fixed seeds. `tools/fuzz` looks for such bytes for longer, and starts from the same files.

use std::alloc::System;
use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};

use cap::Cap;
use lucerna::desc::{ParseOptions, SceneDesc, mitsuba, obj, pbrt, ply, rgl, serialized};
use lucerna::error::Result;
use lucerna::image_io::{self, Encoding};
use lucerna::scene::{Scene, SceneOptions, View, ViewOverrides};
use tempfile::TempDir;

/// What all tests here may have at any time, in bytes: more is an error, of the reader that asks for it first.
const MOST_MEMORY: usize = 160 << 20;

/// Refuses what is beyond all reason, before the machine has to.
#[global_allocator]
static MEMORY: Cap<System> = Cap::new(System, 1 << 30);

/// SplitMix64 (Steele, Lea and Flood 2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, end: usize) -> usize {
        (self.next() % end.max(1) as u64) as usize
    }
}

/// What is likely to matter to a reader of text or binary.
const PIECES: [&[u8]; 29] = [
    b"\"",
    b"[",
    b"]",
    b"#",
    b"\n",
    b" ",
    b"\\",
    b"-",
    b"1e39",
    b"-1",
    b"0",
    b"nan",
    b"99999999999999999999",
    b"true",
    b"Shape",
    b"AttributeEnd",
    b"ObjectBegin \"x\"",
    b"\"float radius\"",
    b"list",
    b"\xff\xff\xff\xff",
    b"\0\0\0\x80",
    b"\xc3\xa4",
    b"Import \"x.pbrt\"",
    b"element face 3",
    b"\x7f",
    b"<ref id=\"b\"/>",
    b"$spp",
    b"&#0;",
    b"/>",
];

/// One to four changes from byte `start` on: bytes changed, removed, doubled, written over, pieces put in, the end cut off.
fn mutate(original: &[u8], start: usize, random: &mut Random) -> Vec<u8> {
    let mut bytes = original.to_vec();
    for _ in 0..1 + random.below(4) {
        let at = (start + random.below(bytes.len().saturating_sub(start))).min(bytes.len().saturating_sub(1));
        let end = (at + 1 + random.below(12)).min(bytes.len());
        let piece = PIECES[random.below(PIECES.len())];
        match random.below(8) {
            0 | 1 if !bytes.is_empty() => bytes[at] = random.next() as u8,
            2 => drop(bytes.drain(at..end)),
            3 => {
                let copy = bytes[at..end].to_vec();
                bytes.splice(at..at, copy);
            }
            4 if random.below(8) == 0 => bytes.truncate(at),
            5 => {
                let end = (at + piece.len()).min(bytes.len());
                bytes.splice(at..end, piece.iter().copied());
            }
            _ => {
                bytes.splice(at..at, piece.iter().copied());
            }
        }
    }
    bytes
}

/// The files of a format, in the order of their names.
fn seeds(format: &str) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/seeds").join(format);
    let entries = fs::read_dir(&folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display()));
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("a file").path()).collect();
    paths.sort();
    let read = |path: &PathBuf| fs::read(path).expect("a file");
    paths.iter().map(read).collect()
}

/// Where the data begin, of formats whose header, once damaged, hides the rest of the reader.
fn data_start(format: &str, file: &[u8]) -> usize {
    let after = |mark: &[u8]| {
        file.windows(mark.len())
            .position(|w| w == mark)
            .map_or(0, |at| at + mark.len())
    };
    match format {
        "ply" => after(b"end_header\n"),
        "png" => 16,
        "exr" => 8,
        "hdr" => after(b"\n\n"),
        "jpeg" => 20,
        _ => 0,
    }
}

/// Reads `rounds` mutations of the files of a format. Every fault must be told; some mutations do no harm, and some do: else this
/// would test little.
fn survives(format: &str, rounds: usize, read: impl Fn(&[u8], usize) -> Result<(), String>) {
    let files = seeds(format);
    for (i, file) in files.iter().enumerate() {
        read(file, 0).unwrap_or_else(|e| panic!("{format}, file {i}: {e}"));
    }
    let mut random = Random(format.bytes().fold(7, |n, b| n * 31 + u64::from(b)));
    let mut refused = 0;
    let mut messages = HashSet::new();
    for round in 0..rounds {
        let file = &files[round % files.len()];
        let is_of_data = (round / files.len()).is_multiple_of(2);
        let start = if is_of_data { data_start(format, file) } else { 0 };
        let mut bytes = mutate(file, start, &mut random);
        if format == "png" && round % 8 != 0 {
            mend_checksums(&mut bytes);
        }
        if let Err(message) = read(&bytes, round) {
            assert!(!message.is_empty());
            refused += 1;
            messages.insert(message);
        }
        let most = MEMORY.max_allocated();
        assert!(most < MOST_MEMORY, "{format}, round {round}: {most} bytes");
    }
    assert!(refused > rounds / 10, "{format}: {refused} of {rounds} refused");
    assert!(
        refused < rounds - rounds / 200,
        "{format}: {refused} of {rounds} refused"
    );
    assert!(messages.len() >= 5, "{format}: {messages:?}");
}

/// Makes the checksums of a PNG file's chunks right, so that what is in them is read.
fn mend_checksums(file: &mut [u8]) {
    let mut at = 8;
    while let Some(length) = file.get(at..at + 4) {
        let length = u32::from_be_bytes([length[0], length[1], length[2], length[3]]) as usize;
        let end = at + 8 + length.min(file.len());
        let (Some(content), true) = (file.get(at + 4..end), end + 4 <= file.len()) else {
            return;
        };
        let mut sum = flate2::Crc::new();
        sum.update(content);
        file[end..end + 4].copy_from_slice(&sum.sum().to_be_bytes());
        at = end + 4;
    }
}

/// What is reported must be fit to be shown, too.
fn told(scene: Result<SceneDesc>) -> Result<SceneDesc, String> {
    let scene = scene.map_err(|e| e.to_string())?;
    scene.warnings.iter().for_each(|warning| drop(warning.to_string()));
    Ok(scene)
}

fn options(round: usize) -> ParseOptions {
    ParseOptions {
        lenient: round % 2 == 1,
        ..ParseOptions::default()
    }
}

const NOWHERE: &str = "no/such/directory/scene";

#[test]
fn pbrt_scenes() {
    survives("pbrt", 16_000, |text, round| {
        told(pbrt::parse_str(text, Path::new(NOWHERE), &options(round))).map(drop)
    });
}

/// What can be read can be made ready to be rendered, or it is said why not.
#[test]
fn pbrt_scenes_until_they_could_be_rendered() {
    survives("pbrt", 1000, |text, round| {
        let desc = told(pbrt::parse_str(text, Path::new(NOWHERE), &options(round)))?;
        let options = SceneOptions::default();
        Scene::build(&desc, &options).map_err(|e| e.to_string())?;
        for view in &desc.views {
            View::build(&desc, view, options.color, &ViewOverrides::default()).map_err(|e| e.to_string())?;
        }
        Ok(())
    });
}

#[test]
fn mitsuba_scenes() {
    survives("mitsuba", 10_000, |text, round| {
        told(mitsuba::parse_str(text, Path::new(NOWHERE), &options(round))).map(drop)
    });
}

#[test]
fn ply_meshes() {
    survives("ply", 16_000, |file, _| {
        let path = Path::new("mesh.ply");
        let with_attributes = ply::parse_with_attributes(file, path).map(drop);
        let both = ply::parse(file, path).and(with_attributes);
        both.map_err(|e| e.to_string())
    });
}

#[test]
fn obj_meshes() {
    survives("obj", 10_000, |text, _| {
        let file = obj::parse(text, Path::new("mesh.obj")).map_err(|e| e.to_string())?;
        file.warnings.iter().for_each(|w| drop(w.to_string()));
        let triangles = file.mesh.indices.len();
        let meshes = file.into_meshes();
        let in_all: usize = meshes.iter().map(|(_, mesh)| mesh.indices.len()).sum();
        assert_eq!(in_all, triangles);
        Ok(())
    });
}

#[test]
fn mtl_libraries() {
    survives("mtl", 6_000, |text, _| {
        let file = obj::mtl::parse(text, Path::new("colours.mtl")).map_err(|e| e.to_string())?;
        file.warnings.iter().for_each(|w| drop(w.to_string()));
        Ok(())
    });
}

#[test]
fn serialized_meshes() {
    survives("serialized", 8_000, |file, round| {
        serialized::parse(file, round as u32 % 2).map(drop)
    });
}

#[test]
fn measured_materials() {
    survives("measured", 6_000, |file, _| rgl::parse(file).map(drop));
}

/// Mutations of a file that a scene names: `scene` has its name where `FILE` stands.
fn named_survives(format: &str, rounds: usize, scene: &str) {
    let folder = TempDir::new().expect("a folder");
    let path = folder.path().join("file");
    let text = scene.replace("FILE", &format!("\"{}\"", path.display()));
    survives(format, rounds, |content, round| {
        fs::write(&path, content).expect("a file");
        let read = pbrt::parse_str(text.as_bytes(), Path::new(NOWHERE), &options(round));
        told(read).map(drop)
    });
}

#[test]
fn spectra() {
    named_survives(
        "spectrum",
        3_000,
        "WorldBegin Material \"diffuse\" \"spectrum reflectance\" FILE Shape \"sphere\"",
    );
}

#[test]
fn responses_of_sensors() {
    named_survives("sensor", 3_000, "Film \"rgb\" \"string sensor\" FILE WorldBegin");
}

#[test]
fn tables_of_lenses() {
    named_survives(
        "lens",
        3_000,
        "Camera \"realistic\" \"string lensfile\" FILE WorldBegin",
    );
}

fn images_survive(format: &str, rounds: usize, name: &str) {
    survives(format, rounds, |file, _| {
        let image = image_io::decode(file, Path::new(name), Encoding::Srgb).map_err(|e| e.to_string())?;
        let pixels = image.width() * image.height();
        assert_eq!(image.data().len(), pixels * image.channels().len());
        Ok(())
    });
}

#[test]
fn png_images() {
    images_survive("png", 5_000, "x.png");
}

#[test]
fn jpeg_images() {
    images_survive("jpeg", 3_000, "x.jpg");
}

#[test]
fn tga_images() {
    images_survive("tga", 4_000, "x.tga");
}

#[test]
fn hdr_images() {
    images_survive("hdr", 4_000, "x.hdr");
}

#[test]
fn exr_images() {
    images_survive("exr", 3_000, "x.exr");
}

#[test]
fn pfm_images() {
    images_survive("pfm", 3_000, "x.pfm");
}
