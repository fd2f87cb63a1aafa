//! Scenes of pbrt-v4, until they could be rendered.
#![no_main]

libfuzzer_sys::fuzz_target!(|input: &[u8]| lucerna_fuzz::scene(input));
