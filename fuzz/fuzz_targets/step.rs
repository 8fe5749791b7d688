#![no_main]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| drop(selvedge::import::step(bytes, "fuzz.step")));
