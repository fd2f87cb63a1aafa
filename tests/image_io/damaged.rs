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
