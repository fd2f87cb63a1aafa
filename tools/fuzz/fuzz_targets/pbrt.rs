//! Scenes of pbrt-v4 and pbrt-v3.
#![no_main]

libfuzzer_sys::fuzz_target!(|input: &[u8]| lucerna_fuzz::pbrt(input));
