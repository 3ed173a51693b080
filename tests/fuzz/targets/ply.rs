#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    welt_fuzz::ply(bytes);
});
