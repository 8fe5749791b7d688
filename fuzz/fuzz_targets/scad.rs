#![no_main]
//! Files of a folder that does not exist: what the input imports is missing, whatever else lies on the machine.
use selvedge_io::import::{Facets, scad};

const FILE: &str = "missing/fuzz.csg";

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    selvedge_fuzz::sound(scad(bytes, FILE, Facets::Round));
    selvedge_fuzz::sound(scad(bytes, FILE, Facets::AsWritten));
});
