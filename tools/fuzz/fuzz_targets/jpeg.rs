//! Images.
#![no_main]

libfuzzer_sys::fuzz_target!(|input: &[u8]| lucerna_fuzz::image(input, b"\xff\xd8", "x.jpg"));
