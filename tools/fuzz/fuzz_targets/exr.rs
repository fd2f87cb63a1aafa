//! Images.
#![no_main]

use std::sync::Once;

static QUIET: Once = Once::new();

libfuzzer_sys::fuzz_target!(|input: &[u8]| {
    // The reader catches panics of the crate that it uses; the fuzzer's hook would end the process before. A panic that is not caught
    // ends it still.
    QUIET.call_once(|| std::panic::set_hook(Box::new(|_| {})));
    lucerna_fuzz::image(input, b"\x76\x2f\x31\x01", "x.exr");
});
