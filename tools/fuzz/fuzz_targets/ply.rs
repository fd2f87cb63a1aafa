//! Meshes in PLY.
#![no_main]

libfuzzer_sys::fuzz_target!(|input: &[u8]| lucerna_fuzz::shown(lucerna::desc::ply::parse(input, std::path::Path::new("mesh.ply"))));
