//! Files of the responses of sensors.
#![no_main]

libfuzzer_sys::fuzz_target!(|input: &[u8]| lucerna_fuzz::named(input, r#"Film "rgb" "string sensor" FILE WorldBegin"#));
