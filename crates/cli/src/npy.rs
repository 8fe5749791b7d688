//! NumPy arrays, format version 1.0.
//!
//! ```text
//!   93 "NUMPY" 1 0 | u16 length | {'descr': '<f4', 'fortran_order': False, 'shape': (H, W), }  \n | data
//!   ◀────────── a multiple of 64 bytes, padded with spaces before the line feed ─────────────────▶
//! ```
//!
//! Source: NumPy Enhancement Proposal 1, *A Simple File Format for NumPy Arrays*.

use bytemuck::NoUninit;
use std::io::{self, Write};

/// A number type of NumPy.
pub trait Element: NoUninit {
    /// Its kind and size in bytes, without the byte order.
    const KIND: &'static str;
}

impl Element for f32 {
    const KIND: &'static str = "f4";
}

impl Element for u32 {
    const KIND: &'static str = "u4";
}

/// Writes `data` as an array of `shape`, the last dimension running fastest.
///
/// # Panics
/// When the shape does not match the number of elements.
pub fn write<T: Element>(to: &mut impl Write, shape: &[usize], data: &[T]) -> io::Result<()> {
    assert_eq!(shape.iter().product::<usize>(), data.len(), "the shape holds the data");
    const MAGIC: &[u8] = b"\x93NUMPY\x01\x00";
    let order = if cfg!(target_endian = "little") { '<' } else { '>' };
    let sides: Vec<String> = shape.iter().map(usize::to_string).collect();
    // a tuple of one side needs the comma after it
    let header =
        format!("{{'descr': '{order}{}', 'fortran_order': False, 'shape': ({},), }}", T::KIND, sides.join(", "));
    let before = MAGIC.len() + 2;
    let padded = (before + header.len() + 1).next_multiple_of(64) - before;
    let length = u16::try_from(padded).map_err(|_| io::Error::other("the shape has too many dimensions"))?;
    to.write_all(MAGIC)?;
    to.write_all(&length.to_le_bytes())?;
    writeln!(to, "{header:<width$}", width = padded - 1)?;
    to.write_all(bytemuck::cast_slice(data))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_header_ends_at_a_multiple_of_64_and_the_data_follow() {
        let mut file = Vec::new();
        write(&mut file, &[2, 1, 2], &[1.0f32, f32::INFINITY, -2.5, 0.0]).expect("written");
        let length = usize::from(u16::from_le_bytes([file[8], file[9]]));
        assert_eq!(&file[..8], b"\x93NUMPY\x01\x00");
        assert_eq!((10 + length) % 64, 0);
        let header = std::str::from_utf8(&file[10..10 + length]).expect("ASCII");
        assert!(header.starts_with("{'descr': '<f4', 'fortran_order': False, 'shape': (2, 1, 2,), }"));
        assert!(header.ends_with(" \n"));
        assert_eq!(&file[10 + length..][4..8], f32::INFINITY.to_le_bytes());
        assert_eq!(file.len(), 10 + length + 16);
    }

    #[test]
    fn one_dimension_is_a_tuple_too() {
        let mut file = Vec::new();
        write(&mut file, &[3], &[7u32, 8, 9]).expect("written");
        assert!(String::from_utf8_lossy(&file).contains("'<u4', 'fortran_order': False, 'shape': (3,)"));
    }
}
