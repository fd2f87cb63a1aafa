//! No bytes make the reader panic, run away or exhaust memory: thousands of mutations of valid files, from fixed seeds.

use std::path::Path;

use lucerna::desc::{ParseOptions, obj, pbrt, ply};

/// SplitMix64 (Steele, Lea and Flood 2014).
pub(super) struct Random(pub u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub fn below(&mut self, end: usize) -> usize {
        (self.next() % end.max(1) as u64) as usize
    }
}

/// What is likely to matter to a reader of text or binary.
const PIECES: [&[u8]; 24] = [
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
];

/// One to four changes from byte `start` on: bytes changed, removed, doubled, pieces put in, the end cut off.
pub(super) fn mutate(original: &[u8], start: usize, random: &mut Random) -> Vec<u8> {
    let mut bytes = original.to_vec();
    for _ in 0..1 + random.below(4) {
        let at = (start + random.below(bytes.len().saturating_sub(start))).min(bytes.len().saturating_sub(1));
        let end = (at + 1 + random.below(12)).min(bytes.len());
        match random.below(6) {
            0 if !bytes.is_empty() => bytes[at] = random.next() as u8,
            1 => drop(bytes.drain(at..end)),
            2 => {
                let copy = bytes[at..end].to_vec();
                bytes.splice(at..at, copy);
            }
            3 if random.below(8) == 0 => bytes.truncate(at),
            _ => {
                let piece = PIECES[random.below(PIECES.len())];
                bytes.splice(at..at, piece.iter().copied());
            }
        }
    }
    bytes
}

const SCENES: [&str; 5] = [
    r#"LookAt 0 0 5 0 0 0 0 1 0 # view
Camera "perspective" "float fov" [ 45 ] "float lensradius" .1 "string name" "a b"
Film "rgb" "integer xresolution" 64 "integer yresolution" [ 48 ] "float cropwindow" [ 0 .5 0 1 ] "string filename" "x\"y.exr"
Sampler "zsobol" "integer pixelsamples" 4 PixelFilter "mitchell" "float xradius" 2
Integrator "path" "integer maxdepth" -1 "string lightsampler" "power"
WorldBegin
AttributeBegin AreaLightSource "diffuse" "blackbody L" 6500 "bool twosided" true
Shape "sphere" "float radius" 2 AttributeEnd
LightSource "distant" "spectrum L" [ 400 1 500 2 600 1.5 ] "point3 from" [ 0 1 0 ]"#,
    r#"WorldBegin
MakeNamedMaterial "glass" "string type" "dielectric" "float eta" 1.5 "float roughness" .1
MakeNamedMaterial "gold" "string type" "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k"
ObjectBegin "thing" NamedMaterial "gold" Translate 1 2 3
Shape "trianglemesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 1 1 0 ] "integer indices" [ 0 1 2 2 1 3 ] "normal N" [0 0 1 0 0 1 0 0 1 0 0 1]
ObjectEnd ActiveTransform EndTime Rotate 30 0 1 0 ActiveTransform All ObjectInstance "thing"
NamedMaterial "glass" Attribute "shape" "float radius" 3 Shape "sphere""#,
    r#"Transform [ 1 0 0 0 0 1 0 0 0 0 -1 0 0 -1 6.8 1 ] Camera "orthographic" "float screenwindow" [ -1 1 -1 1 ]
TransformTimes 0 2 ColorSpace "srgb" Option "seed" 3 WorldBegin CoordinateSystem "here"
ConcatTransform [ 1 0 0 0 0 1 0 0 0 0 1 0 0 -1 6.8 1 ] ReverseOrientation CoordSysTransform "here"
MediumInterface "" "" Material "diffuse" "rgb reflectance" [ .5 .5 .5 ] Shape "sphere""#,
    r#"Camera "spherical" "string mapping" "equirectangular" Film "spectral" "integer nbuckets" 4 "float lambdamin" 400
Integrator "simplepath" "bool samplelights" false Option "disablepixeljitter" false WorldBegin
Material "hair" "float eumelanin" .3 "float beta_m" .2 Shape "sphere" Material "hair" "rgb color" [ .3 .2 .1 ]"#,
    r#"Film "image" "float scale" 2 Camera "environment" Sampler "02sequence" PixelFilter "gaussian" "float alpha" 2
Integrator "directlighting" "string lightsamplestrategy" "spatial" WorldBegin
Texture "t" "color" "scale" "rgb tex1" [ .5 .5 .5 ] "rgb tex2" [ 1 .5 .5 ]
MakeNamedMaterial "a" "string type" "plastic" "texture Kd" "t" "float roughness" .1 MakeNamedMaterial "b" "string type" "glass"
Material "mix" "string namedmaterial1" "a" "string namedmaterial2" "b" "rgb amount" [ .2 .2 .2 ]
Shape "trianglemesh" "point P" [ 0 0 0 1 0 0 0 1 0 ] "integer indices" [ 0 1 2 ] "float st" [ 0 0 1 0 0 1 ]
Material "uber" "rgb Kr" [ 0 0 0 ] Material "translucent" "rgb reflect" [ .2 .2 .2 ]
LightSource "point" "rgb I" [ 1 2 3 ] "rgb scale" [ 2 1 1 ] AreaLightSource "area" "blackbody L" [ 5000 2 ] "bool twosided" "true"
WorldEnd"#,
];

#[test]
fn no_text_makes_the_reader_panic() {
    let mut random = Random(1);
    let mut refused = 0;
    for round in 0..12_000 {
        let text = mutate(SCENES[round % SCENES.len()].as_bytes(), 0, &mut random);
        let options = ParseOptions {
            lenient: round % 2 == 0,
            ..ParseOptions::default()
        };
        // What is reported must be fit to be shown, too.
        match pbrt::parse_str(&text, Path::new("no/such/directory/scene.pbrt"), &options) {
            Ok(scene) => scene.warnings.iter().for_each(|w| drop(w.to_string())),
            Err(error) => {
                assert!(!error.to_string().is_empty());
                refused += 1;
            }
        }
    }
    // Most mutations break something, and not all do: else this would test little.
    assert!((3000..11_700).contains(&refused), "{refused} refused");
}

#[test]
fn no_bytes_make_the_mesh_reader_panic() {
    let mut files: Vec<Vec<u8>> = Vec::new();
    for format in ["ascii", "binary_little_endian", "binary_big_endian"] {
        let mut file = format!(
            "ply\nformat {format} 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty uchar u\n\
             property uchar v\nelement face 2\nproperty list uchar short vertex_indices\nelement more 2\nproperty list char char x\nend_header\n"
        )
        .into_bytes();
        match format {
            "ascii" => file.extend(b"0 0 0 1 2\n1 0 0 3 4\n0 1 0 5 6\n3 0 1 2\n4 0 1 2 0\n2 1 1\n0\n"),
            _ => {
                let big = format == "binary_big_endian";
                for (i, v) in [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
                    .iter()
                    .enumerate()
                {
                    for x in v {
                        file.extend(if big { x.to_be_bytes() } else { x.to_le_bytes() });
                    }
                    file.extend([i as u8, i as u8]);
                }
                for face in [&[0_i16, 1, 2][..], &[0, 1, 2, 0]] {
                    file.push(face.len() as u8);
                    for x in face {
                        file.extend(if big { x.to_be_bytes() } else { x.to_le_bytes() });
                    }
                }
                file.extend([2, 1, 1, 0]);
            }
        }
        assert!(ply::parse(&file).is_ok(), "{format}");
        files.push(file);
    }
    let mut random = Random(2);
    let mut refused = 0;
    for round in 0..12_000 {
        // Half of the time only the data are changed: most changes of a header are fatal.
        let file = &files[round % 3];
        let header = file
            .windows(11)
            .position(|w| w == b"end_header\n")
            .map_or(0, |i| i + 11);
        let start = if round % 2 == 0 { header } else { 0 };
        let mutated = mutate(file, start, &mut random);
        let _ = ply::parse_with_attributes(&mutated);
        refused += usize::from(ply::parse(&mutated).is_err());
    }
    assert!((3000..11_500).contains(&refused), "{refused} refused");
}

#[test]
fn no_text_makes_the_obj_reader_panic() {
    let file = b"mtllib a.mtl\nv 0 0 0\nv 1 0 0 1\nv 0 1 \\\n 0\nvt 0 1\nvn 0 0 1\nusemtl x\nf 1/1/1 2//1 -1/-1\nusemtl y\nf 1 2 3 1\n";
    let parse = |bytes: &[u8]| obj::parse(bytes, Path::new("mesh.obj"));
    assert!(parse(file).is_ok());
    let mut random = Random(3);
    let mut refused = 0;
    for _ in 0..12_000 {
        match parse(&mutate(file, 0, &mut random)) {
            Ok(file) => {
                file.warnings.iter().for_each(|w| drop(w.to_string()));
                let triangles = file.mesh.indices.len();
                let meshes = file.into_meshes();
                assert_eq!(
                    meshes.iter().map(|(_, mesh)| mesh.indices.len()).sum::<usize>(),
                    triangles
                );
            }
            Err(error) => {
                assert!(!error.to_string().is_empty());
                refused += 1;
            }
        }
    }
    assert!((3000..11_500).contains(&refused), "{refused} refused");
}

#[test]
fn no_text_makes_the_library_reader_panic() {
    let file =
        b"newmtl a b\nKd .5 .5 .5\nKs .1\nNs 10 # shiny\nd .5\nnewmtl c\nillum 7\nNi 1.5\nbump -bm 2 x.png\nKe 1 2 3\n";
    let parse = |bytes: &[u8]| obj::mtl::parse(bytes, Path::new("colours.mtl"));
    assert!(parse(file).is_ok());
    let mut random = Random(4);
    let mut refused = 0;
    for _ in 0..6000 {
        match parse(&mutate(file, 0, &mut random)) {
            Ok(file) => file.warnings.iter().for_each(|w| drop(w.to_string())),
            Err(error) => {
                assert!(!error.to_string().is_empty());
                refused += 1;
            }
        }
    }
    assert!((1000..5900).contains(&refused), "{refused} refused");
}
