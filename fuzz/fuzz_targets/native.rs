#![no_main]
//! The input is what follows the header; a header that fits is put before it, so that the checksum stops nothing.
use selvedge_io::native::{MAGIC, VERSION};

libfuzzer_sys::fuzz_target!(|body: &[u8]| {
    let mut crc = flate2::Crc::new();
    crc.update(body);
    let length = (body.len() as u64).to_le_bytes();
    let bytes = [MAGIC, &VERSION.to_le_bytes()[..], &length, &crc.sum().to_le_bytes(), body].concat();
    selvedge_fuzz::sound(selvedge_io::import::native(&bytes, "fuzz.selvedge"));
});
