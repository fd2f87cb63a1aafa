//! Tables of lenses.
#![no_main]

libfuzzer_sys::fuzz_target!(|input: &[u8]| lucerna_fuzz::named(input, r#"Camera "realistic" "string lensfile" FILE WorldBegin"#));
