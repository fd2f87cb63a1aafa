//! Mitsuba's meshes, the first and the second of a file.
#![no_main]

libfuzzer_sys::fuzz_target!(|input: &[u8]| {
    for index in 0..2 {
        lucerna_fuzz::shown(lucerna::desc::serialized::parse(input, index));
    }
});
