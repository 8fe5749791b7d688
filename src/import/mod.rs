//! CAD files in, [`Model`]s out.
//!
//! ```text
//!   path ──read, gunzip──▶ bytes ──format by content──▶ step ────▶ Import { model, warnings, report }
//!                                                       scad, brlcad: Boolean solids
//! ```
//!
//! A file that is not what it claims to be is an [`ImportError`]. Everything smaller (a bad record, a
//! face that cannot be built) is left out, and a [`Warning`] names the file and the line or entity.
//! Time and memory are bounded by a multiple of the file's size, whatever its content.

mod brlcad;
mod error;
mod report;
mod scad;
mod solid;
mod step;

pub use error::ImportError;
pub(crate) use report::Warnings;
pub use report::{ImportReport, Place, Warning};
pub use scad::Facets;

use crate::model::Model;
use std::io::Read;
use std::path::Path;

/// What a file held.
#[derive(Clone, Debug, Default)]
pub struct Import {
    /// Parts and instances, in millimetres.
    pub model: Model,
    /// What was left out or healed, in the order in which it was found.
    pub warnings: Vec<Warning>,
    /// Counts for people.
    pub report: ImportReport,
}

/// A gzip stream may expand by this factor at most. STEP text shrinks 4 to 12 times; deflate itself
/// cannot exceed 1032.
const MAX_EXPANSION: u64 = 100;

/// Expansion that is always allowed, whatever the factor.
const FREE_EXPANSION: u64 = 1 << 20;

/// Reads a file; the format is chosen by its content. Gzip (`.stpz`, `.step.gz`) is undone first.
///
/// # Errors
/// [`ImportError`] when the file cannot be read or is not a known format.
pub fn open(path: &Path) -> Result<Import, ImportError> {
    let name = path.display().to_string();
    let unreadable = |source| ImportError::Read { file: name.clone(), source };
    let size = std::fs::metadata(path).map_err(unreadable)?.len();
    if size > u64::from(u32::MAX) {
        return Err(ImportError::TooLarge { file: name });
    }
    let mut bytes = std::fs::read(path).map_err(unreadable)?;
    if bytes.starts_with(&[0x1f, 0x8b]) {
        bytes = inflate(&bytes, &name)?;
    }
    if step::recognise(&bytes) {
        return step(&bytes, &name);
    }
    let file = path.file_name().and_then(|f| f.to_str()).map(str::to_ascii_lowercase).unwrap_or_default();
    let ends = |all: &[&str]| all.iter().any(|e| file.ends_with(e));
    let text = std::str::from_utf8(&bytes).unwrap_or_default();
    if ends(&[".stp", ".step", ".p21", ".stpz", ".stp.gz", ".step.gz"]) {
        Err(ImportError::NotStep { file: name })
    } else if ends(&[".csg", ".csg.gz"]) || scad::recognise(text) {
        scad(&bytes, &name, Facets::Round)
    } else if ends(&[".asc", ".asc.gz"]) || brlcad::recognise(text) {
        brlcad(&bytes, &name)
    } else {
        Err(ImportError::Format { file: name })
    }
}

/// Reads ISO 10303-21 text (STEP AP203, AP214, AP242); `name` is the file's name in messages.
///
/// # Errors
/// [`ImportError`] when the text is not STEP or holds no usable data.
pub fn step(bytes: &[u8], name: &str) -> Result<Import, ImportError> {
    step::read(bytes, name)
}

/// Reads OpenSCAD's flattened solids (`openscad -o x.csg`); `name` is the file's name in messages.
///
/// # Errors
/// [`ImportError::Solid`] names the line and node that is not read: hulls, Minkowski sums, text, ...
pub fn scad(bytes: &[u8], name: &str, facets: Facets) -> Result<Import, ImportError> {
    scad::read(text(bytes, name)?, name, facets)
}

/// Reads BRL-CAD's text of solids (`g2asc`, version 5); `name` is the file's name in messages.
///
/// # Errors
/// [`ImportError::Solid`] names the line and object that is not read.
pub fn brlcad(bytes: &[u8], name: &str) -> Result<Import, ImportError> {
    brlcad::read(text(bytes, name)?, name)
}

fn text<'a>(bytes: &'a [u8], name: &str) -> Result<&'a str, ImportError> {
    std::str::from_utf8(bytes).map_err(|e| {
        let line = 1 + bytes[..e.valid_up_to()].iter().filter(|b| **b == b'\n').count();
        ImportError::Solid { file: name.to_owned(), line, message: "not UTF-8 text".to_owned() }
    })
}

/// The file's name without folder and extension.
fn stem(file: &str) -> String {
    Path::new(file).file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default()
}

/// Undoes gzip; output is bounded by [`MAX_EXPANSION`].
fn inflate(bytes: &[u8], name: &str) -> Result<Vec<u8>, ImportError> {
    let limit = (bytes.len() as u64 * MAX_EXPANSION + FREE_EXPANSION).min(u64::from(u32::MAX));
    let mut text = Vec::new();
    flate2::read::MultiGzDecoder::new(bytes)
        .take(limit + 1)
        .read_to_end(&mut text)
        .map_err(|source| ImportError::Read { file: name.to_owned(), source })?;
    if text.len() as u64 > limit {
        return Err(ImportError::Expansion { file: name.to_owned(), limit });
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    fn gzip(text: &[u8]) -> Vec<u8> {
        let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::best());
        encoder.write_all(text).unwrap();
        encoder.finish().unwrap()
    }

    #[test]
    fn gzip_round_trip() {
        let text = b"ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n";
        assert_eq!(inflate(&gzip(text), "a.stpz").unwrap(), text);
    }

    #[test]
    fn gzip_bomb_is_an_error() {
        let bomb = gzip(&vec![b' '; 1 << 24]);
        assert!(matches!(inflate(&bomb, "bomb.gz"), Err(ImportError::Expansion { .. })));
    }

    #[test]
    fn missing_and_unknown_files_are_named() {
        let error = open(Path::new("no/such/file.step")).unwrap_err();
        assert!(error.to_string().contains("no/such/file.step"));
        let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml");
        assert!(matches!(open(&manifest), Err(ImportError::Format { .. })));
    }
}
