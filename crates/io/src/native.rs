//! The engine's own file form: a [`Model`] bit for bit, so that a file of another form is read once.
//!
//! ```text
//!   offset  bytes
//!        0      9   "selvedge" and a zero byte
//!        9      4   version of the form, little endian
//!       13      8   length of what follows the header
//!       21      4   CRC-32 (IEEE 802.3) of what follows the header
//!       25      …   the model in MessagePack, structures as arrays, fields in the order of the Rust types
//! ```
//!
//! MessagePack (<https://github.com/msgpack/msgpack/blob/master/spec.md>): numbers with their IEEE bits, so
//! that minus zero stays what it is; an option that is absent is nil; an enumeration is its variant's name.
//!
//! [`VERSION`] changes with every change of [`Model`] or of a type inside it; other versions are an
//! error, not a guess. Reading checks every invariant of the types; it takes time and memory
//! proportional to the bytes given (an item takes at least one byte, and at most 100 times that in memory).

use crate::model::Model;
use serde::Deserialize;

/// How every file begins.
pub const MAGIC: &[u8; 9] = b"selvedge\0";

/// The version that is written, and the only one that is read.
pub const VERSION: u32 = 4;

/// Bytes before the model.
const HEADER: usize = 25;

/// Why bytes are not a stored model.
#[allow(missing_docs)] // the messages say what each field is
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NativeError {
    /// Another kind of file.
    #[error("does not begin as a selvedge file does")]
    Magic,
    /// Written by another version of the engine.
    #[error("version {found} of the selvedge form; this engine reads version {VERSION}: convert the source again")]
    Version { found: u32 },
    /// Cut short, or something after the end.
    #[error("the header says {expected} bytes, and {found} follow it")]
    Length { expected: u64, found: u64 },
    /// Damaged.
    #[error("damaged: the checksum does not fit the contents")]
    Checksum,
    /// Not a model, or one that breaks an invariant.
    #[error("not a valid model: {0}")]
    Model(String),
}

/// The bytes begin as a stored model does.
pub fn recognise(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC)
}

/// The bytes of a file that holds `model`.
///
/// The same model gives the same bytes, and [`read`] gives it back bit for bit.
pub fn write(model: &Model) -> Vec<u8> {
    let mut bytes = vec![0; HEADER];
    rmp_serde::encode::write(&mut bytes, model).expect("memory takes every model");
    seal(&mut bytes);
    bytes
}

/// Fills in the header of what follows it.
fn seal(bytes: &mut [u8]) {
    let (header, body) = bytes.split_at_mut(HEADER);
    header[..9].copy_from_slice(MAGIC);
    header[9..13].copy_from_slice(&VERSION.to_le_bytes());
    header[13..21].copy_from_slice(&(body.len() as u64).to_le_bytes());
    header[21..].copy_from_slice(&checksum(body).to_le_bytes());
}

/// The model that the bytes of a file hold.
///
/// # Errors
/// [`NativeError`] for whatever [`write()`] could not have written.
pub fn read(bytes: &[u8]) -> Result<Model, NativeError> {
    let rest = bytes.strip_prefix(MAGIC).ok_or(NativeError::Magic)?;
    let cut = NativeError::Length { expected: HEADER as u64, found: bytes.len() as u64 };
    let (version, rest) = rest.split_first_chunk::<4>().ok_or(cut.clone())?;
    let found = u32::from_le_bytes(*version);
    if found != VERSION {
        return Err(NativeError::Version { found });
    }
    let (length, rest) = rest.split_first_chunk::<8>().ok_or(cut.clone())?;
    let (sum, body) = rest.split_first_chunk::<4>().ok_or(cut)?;
    let expected = u64::from_le_bytes(*length);
    if expected != body.len() as u64 {
        return Err(NativeError::Length { expected, found: body.len() as u64 });
    }
    if checksum(body) != u32::from_le_bytes(*sum) {
        return Err(NativeError::Checksum);
    }
    let mut from = rmp_serde::Deserializer::new(body);
    let model = Model::deserialize(&mut from).map_err(|error| NativeError::Model(error.to_string()))?;
    match from.into_inner().len() {
        0 => Ok(model),
        more => Err(NativeError::Model(format!("{more} bytes after its end"))),
    }
}

fn checksum(bytes: &[u8]) -> u32 {
    let mut crc = flate2::Crc::new();
    crc.update(bytes);
    crc.sum()
}

#[cfg(test)]
mod tests;
