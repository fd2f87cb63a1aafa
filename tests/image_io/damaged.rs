//! Files that are damaged, of no known format, or missing.

use lucerna::Error;
use lucerna::image_io::{Encoding, Image, Window, decode, read, read_exr, read_png};
use std::fs;
use std::path::Path;
use tempfile::tempdir;

use crate::{metadata, write};

#[test]
fn truncated_and_damaged_files_are_errors_and_no_panics() {
    let directory = tempdir().unwrap();
    let window = Window::of_size(9, 20);
    let image = Image::rgb(window, window, vec![0.25; 540]).unwrap();
    for name in ["a.exr", "a.png"] {
        let path = directory.path().join(name);
        write(&path, &image, Some(&metadata()), 0.0);
        let whole = fs::read(&path).unwrap();
        for length in 0..whole.len() {
            fs::write(&path, &whole[..length]).unwrap();
            // The last chunk of a PNG file holds nothing: the decoder may do without.
            let complete = name == "a.png" && length >= whole.len() - 12;
            assert!(
                complete || matches!(read(&path), Err(Error::Image { .. })),
                "{name}: {length} bytes"
            );
        }
        // Any byte may be wrong: an image or an error, but nothing else. 0x80 makes sizes huge or negative.
        for flip in [0x01, 0x80, 0xff] {
            for position in 0..whole.len() {
                let mut damaged = whole.clone();
                damaged[position] ^= flip;
                fs::write(&path, &damaged).unwrap();
                assert!(
                    matches!(read(&path), Ok(_) | Err(Error::Image { .. })),
                    "{name}: byte {position}"
                );
            }
        }
    }
}

#[test]
fn other_files_and_missing_ones_are_errors() {
    let directory = tempdir().unwrap();
    let path = directory.path().join("a.exr");
    assert!(matches!(read(&path), Err(Error::Io { action: "read", .. })));
    fs::write(&path, "P6 1 1 255 abc").unwrap();
    assert!(matches!(read(&path), Err(Error::Image { message, .. }) if message.contains("neither")));
    assert!(matches!(read_exr(&path), Err(Error::Image { .. })));
    assert!(matches!(read_png(&path), Err(Error::Image { .. })));
}

#[test]
fn what_is_no_image_is_refused() {
    let refused = |bytes: &[u8], name: &str| match decode(bytes, Path::new(name), Encoding::Srgb) {
        Err(Error::Image { message, .. }) => message,
        other => panic!("{other:?}"),
    };
    assert!(refused(b"hello", "x.png").contains("not a PNG"));
    assert!(refused(b"", "x.png").contains("not a PNG"));
    assert!(refused(b"\xff\xd8\xff\xe0 and no more", "x.jpg").contains("malformed JPEG"));
    assert!(refused(b"#?RADIANCE\n", "x.hdr").contains("malformed HDR"));
    assert!(refused(b"short", "x.tga").contains("malformed TGA"));
}

/// A small file cannot have many pixels, whatever its header says: nothing is allocated by that.
#[test]
fn files_too_short_for_their_pixels_are_refused() {
    let seed = |name: &str| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/seeds").join(name);
        fs::read(path).expect("a file")
    };
    let after = |file: &[u8], mark: &[u8]| {
        let at = file.windows(mark.len()).position(|w| w == mark).expect("the mark");
        at + mark.len()
    };
    let mut png = seed("png/rgb8.png");
    png[16..24].copy_from_slice(&[0, 1, 0, 0, 0, 1, 0, 0]);
    let mut sum = flate2::Crc::new();
    sum.update(&png[12..29]);
    png[29..33].copy_from_slice(&sum.sum().to_be_bytes());
    let mut jpeg = seed("jpeg/colour.jpg");
    let size = after(&jpeg, b"\xff\xc0") + 3;
    jpeg[size..size + 4].fill(0xff);
    let mut tga = seed("tga/runs.tga");
    tga[12..16].fill(0xff);
    let hdr = String::from_utf8_lossy(&seed("hdr/plain.hdr")[..46]).into_owned() + "-Y 30000 +X 30000\n....";
    let mut exr = seed("exr/half.exr");
    for window in [&b"dataWindow\0box2i\0"[..], b"displayWindow\0box2i\0"] {
        let size = after(&exr, window) + 12;
        exr[size..size + 8].copy_from_slice(&[0, 0, 2, 0, 0, 0, 2, 0]);
    }
    for (name, file) in [
        ("x.png", png),
        ("x.jpg", jpeg),
        ("x.tga", tga),
        ("x.hdr", hdr.into_bytes()),
        ("x.exr", exr),
        ("x.pfm", b"PF 100000 100000 -1\n....".to_vec()),
    ] {
        match decode(&file, Path::new(name), Encoding::Srgb) {
            Err(Error::Image { message, .. }) => {
                let says_so = ["too short", "ends before"].iter().any(|part| message.contains(part));
                assert!(says_so, "{name}: {message}");
            }
            other => panic!("{name}: {other:?}"),
        }
    }
}
