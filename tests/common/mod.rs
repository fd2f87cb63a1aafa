//! The statistics that the tests of this crate decide by.
//!
//! A test draws from fixed seeds, so it always gives the same answer; these functions make that answer mean something. Each
//! one says how often it would be wrong for a correct program (its significance, after Sidak's correction for the number of
//! comparisons made), and `tests/statistics.rs` proves that each one fails where it should.

#![allow(dead_code, reason = "each test binary uses a part of this module")]

pub mod chi2;
pub mod covering;
pub mod grooves;
pub mod means;
pub mod microfacet;
pub mod random;
pub mod reference;
pub mod render;

use std::path::{Path, PathBuf};

use lucerna::image_io::{Image, PendingOutput, Window};

/// Whether this is the full tier (`./run test --full`).
pub fn full_tier() -> bool {
    std::env::var_os("LUCERNA_TEST_TIER").is_some_and(|tier| tier == "full")
}

/// How many times as many samples are drawn in this tier: `full` times in the full one.
pub fn effort(full: usize) -> usize {
    if full_tier() { full } else { 1 }
}

/// Whether test `index` belongs to the shard K/N that is asked for; all do if none is.
pub fn in_shard(index: usize) -> bool {
    let Ok(shard) = std::env::var("LUCERNA_TEST_SHARD") else {
        return true;
    };
    let numbers = shard
        .split_once('/')
        .and_then(|(k, n)| Some((k.parse().ok()?, n.parse().ok()?)));
    let (k, n): (usize, usize) = numbers.expect("LUCERNA_TEST_SHARD is K/N");
    index % n == k - 1
}

/// A directory of what is shared beside the checkout. `None`, with a note, if it is missing; in CI that is a failure.
pub fn shared(name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared").join(name);
    if path.is_dir() {
        return Some(path);
    }
    let ci = std::env::var_os("CI").is_some_and(|ci| ci == "true");
    assert!(!ci, "{} is missing", path.display());
    println!("SKIPPED: {} is missing", path.display());
    None
}

/// Writes (ours - reference) / reference as a picture under the target directory, for a person to look at: grey where both agree,
/// brighter where ours is, white and black at 10 %.
pub fn picture_of_difference(name: &str, ours: &[f32], reference: &reference::Reference) -> PathBuf {
    let values = ours.iter().zip(&reference.mean).map(|(&a, &r)| {
        let relative = if a == r { 0.0 } else { (a - r) / r.max(1e-4) };
        (0.2 + 2.0 * relative).clamp(0.0, 1.0)
    });
    let window = Window::of_size(reference.width as i32, reference.height as i32);
    let image = Image::rgb(window, window, values.collect()).expect("a picture");
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{}.png", name.replace(' ', "-")));
    let written = PendingOutput::create(&path).and_then(|output| output.commit(&image, None, 0.0));
    written.expect("a writable target directory").path
}

/// The level of each of `tests` independent tests that together have the level `significance` (Sidak 1967).
pub fn sidak(significance: f64, tests: usize) -> f64 {
    -((-significance).ln_1p() / tests as f64).exp_m1()
}

/// Writes a picture under the target directory, by columns and rows from the top; its path.
pub fn write_image(name: &str, [width, height]: [usize; 2], value: impl Fn(usize, usize) -> [f32; 3]) -> String {
    let window = Window::of_size(width as i32, height as i32);
    let pixels = (0..width * height).flat_map(|i| value(i % width, i / width));
    let image = Image::rgb(window, window, pixels.collect()).expect("an image");
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}-{}.exr", std::process::id()));
    let written = PendingOutput::create(&path).and_then(|output| output.commit(&image, None, 0.0));
    written.expect("a writable directory").path.display().to_string()
}
