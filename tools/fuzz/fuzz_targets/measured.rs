//! Measured materials.
#![no_main]

libfuzzer_sys::fuzz_target!(|input: &[u8]| lucerna_fuzz::shown(lucerna::desc::rgl::parse(input)));
