//! Renders as wholes: the same bits for any number of threads, crop and split of the samples; the same picture from either
//! backend, any sampler and any format; nothing dropped.

#[path = "../common/mod.rs"]
mod common;

mod backends;
mod bits;
mod formats;
mod samplers;

use std::path::{Path, PathBuf};

/// 150 x 100 pixels, so that tiles and packets end in the middle; a lens, motion of each kind, glass, metal, every light. `filter`
/// is a `PixelFilter` directive.
fn everything(filter: &str) -> String {
    format!(
        "LookAt 0 1.5 -6  0 0.8 0  0 1 0
        Camera \"perspective\" \"float fov\" 45 \"float lensradius\" 0.1 \"float focaldistance\" 6
        Film \"rgb\" \"integer xresolution\" 150 \"integer yresolution\" 100
        {filter}
        Sampler \"sobol\" \"integer pixelsamples\" 4
        Integrator \"path\" \"integer maxdepth\" 8
        WorldBegin
        LightSource \"infinite\" \"rgb L\" [0.2 0.25 0.3]
        LightSource \"distant\" \"point3 from\" [1 2 -1] \"point3 to\" [0 0 0] \"rgb L\" [0.5 0.5 0.4]
        LightSource \"point\" \"point3 from\" [-2 3 -1] \"rgb I\" [4 3 2]
        AttributeBegin
            AreaLightSource \"diffuse\" \"rgb L\" [5 5 6]
            Translate 1 3 0.5
            Shape \"sphere\" \"float radius\" 0.3
        AttributeEnd
        Material \"diffuse\" \"rgb reflectance\" [0.6 0.5 0.4]
        Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [-8 0 -8  -8 0 8  8 0 8  8 0 -8]
        AttributeBegin
            Material \"dielectric\" \"float eta\" 1.5
            Translate -1 0.8 -0.5
            Shape \"sphere\" \"float radius\" 0.8
        AttributeEnd
        AttributeBegin
            Material \"conductor\" \"float roughness\" 0.05
            ActiveTransform EndTime
            Translate 0.2 0.3 0
            ActiveTransform All
            Translate 0.9 0.6 0
            Shape \"sphere\" \"float radius\" 0.6
        AttributeEnd
        ObjectBegin \"fin\"
            Material \"dielectric\" \"spectrum eta\" \"glass-BK7\" \"float roughness\" 0.1
            Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point3 P\" [0 0 0  0.7 0 0.2  0 1 0.4]
                \"point3 P1\" [0 0 0  0.7 0.1 0.2  0.2 1 0.4]
        ObjectEnd
        Translate 0.2 0.1 -2
        ObjectInstance \"fin\"
        ActiveTransform EndTime
        Rotate 20 0 1 0
        ActiveTransform All
        Translate -0.8 0 0.3
        ObjectInstance \"fin\""
    )
}

/// The scene files of the repository.
fn scene_files() -> Vec<PathBuf> {
    let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let entries = std::fs::read_dir(&directory).expect("the scenes");
    let files = entries.map(|entry| entry.expect("an entry").path());
    let mut files: Vec<_> = files
        .filter(|path| path.extension().is_some_and(|e| e == "pbrt"))
        .collect();
    files.sort();
    assert!(files.len() >= 6, "{files:?}");
    files
}

fn bits(picture: &[f32]) -> Vec<u32> {
    picture.iter().map(|v| v.to_bits()).collect()
}

/// How many pixels differ in any bit.
fn different_pixels(a: &[f32], b: &[f32]) -> usize {
    assert_eq!(a.len(), b.len());
    let pairs = a.chunks_exact(3).zip(b.chunks_exact(3));
    pairs.filter(|(a, b)| bits(a) != bits(b)).count()
}

fn with_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.expect("threads").install(work)
}
