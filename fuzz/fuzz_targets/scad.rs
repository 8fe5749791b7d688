#![no_main]
use selvedge_io::import::{Facets, scad};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    selvedge_fuzz::sound(scad(bytes, "fuzz.csg", Facets::Round));
    selvedge_fuzz::sound(scad(bytes, "fuzz.csg", Facets::AsWritten));
});
