//! Image files: what is written is read back, what is broken is refused, and a target is replaced whole or not at all.

mod damaged;
mod exr;
mod foreign;
mod metrics;
mod output;
mod png;

use lucerna::image_io::{Image, ImageMetadata, PendingOutput, Window};
use std::fs;
use std::path::Path;

const CROP: Window = Window {
    x0: 5,
    y0: 7,
    x1: 42,
    y1: 60,
};

/// A crop (of several ZIP blocks) of a 64x64 picture, with values that only a lossless file keeps.
fn crop() -> Image {
    let mut data: Vec<f32> = (0..CROP.pixel_count() * 3)
        .map(|i| (i as f32 * 0.37).sin() * 10_f32.powi((i % 61) as i32 - 30))
        .collect();
    data[..6].copy_from_slice(&[0.0, -0.0, f32::MIN_POSITIVE / 4.0, f32::MAX, f32::INFINITY, -1.5]);
    Image::rgb(CROP, Window::of_size(64, 64), data).unwrap()
}

fn metadata() -> ImageMetadata {
    ImageMetadata {
        seed: u64::MAX - 1,
        spp: 64,
        integrator: "path".to_owned(),
        backend: "embree".to_owned(),
        version: "0.1.0".to_owned(),
        render_seconds: 12.345_678_9,
        scene_hash: "00ff".repeat(16),
        chromaticities: [[0.68, 0.32], [0.265, 0.69], [0.15, 0.06], [0.3127, 0.329]],
        is_spectral: true,
    }
}

fn write(path: &Path, image: &Image, metadata: Option<&ImageMetadata>, exposure: f32) {
    let written = PendingOutput::create(path)
        .and_then(|pending| pending.commit(image, metadata, exposure))
        .unwrap();
    assert_eq!(written.path, path);
    assert!(written.instead_because.is_none());
}

fn bits(image: &Image) -> Vec<u32> {
    image.data().iter().map(|v| v.to_bits()).collect()
}

fn names_in(directory: &Path) -> Vec<String> {
    let entries = fs::read_dir(directory).unwrap();
    let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}
