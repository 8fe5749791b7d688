#![no_main]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| selvedge_fuzz::sound(selvedge_io::import::step(bytes, "fuzz.step")));
