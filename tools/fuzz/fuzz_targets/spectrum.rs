//! Files of spectra.
#![no_main]

libfuzzer_sys::fuzz_target!(|input: &[u8]| lucerna_fuzz::named(input, r#"WorldBegin Material "diffuse" "spectrum reflectance" FILE"#));
