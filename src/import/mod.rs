//! CAD files in, [`Model`]s out.
//!
//! ```text
//!   path ──read, gunzip──▶ bytes ──format by content──▶ step, iges ┬─▶ Import { model, warnings, report }
//!                                                    ├▶ obj, bv ─┤
//!                                                    ├▶ rhino ───┤
//!                                                    └▶ native ──┘
//! ```
//!
//! A file that is not what it claims to be is an [`ImportError`]. Everything smaller (a bad record, a
//! face that cannot be built) is left out, and a [`Warning`] names the file and the line or entity.
//! Time and memory are bounded by a multiple of the file's size, whatever its content.

mod bv;
mod chain;
mod colour;
mod error;
mod facets;
mod iges;
mod locate;
mod native;
mod obj;
mod parts;
mod progress;
mod report;
#[cfg(feature = "rhino")]
mod rhino;
mod step;

pub use error::ImportError;
pub(crate) use progress::FaceCount;
pub use progress::{Options, Stage};
pub(crate) use report::Warnings;
pub use report::{FaceRecord, ImportReport, Place, Warning};

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

/// How Rhino's files begin.
const RHINO: &[u8] = b"3D Geometry File Format ";

/// Expansion that is always allowed, whatever the factor.
const FREE_EXPANSION: u64 = 1 << 20;

/// Reads a file; the format is chosen by its content. Gzip (`.stpz`, `.step.gz`) is undone first.
///
/// # Errors
/// [`ImportError`] when the file cannot be read or is not a known format.
pub fn open(path: &Path) -> Result<Import, ImportError> {
    open_with(path, &Options::default())
}

/// As [`open`], and tells how far it has come; the result is the same.
///
/// # Errors
/// As [`open`].
pub fn open_with(path: &Path, options: &Options<'_>) -> Result<Import, ImportError> {
    let name = path.display().to_string();
    let unreadable = |source| ImportError::Read { file: name.clone(), source };
    let size = std::fs::metadata(path).map_err(unreadable)?.len();
    if size > u64::from(u32::MAX) {
        return Err(ImportError::TooLarge { file: name });
    }
    options.tell(Stage::Read { bytes: size });
    let mut bytes = std::fs::read(path).map_err(unreadable)?;
    if bytes.starts_with(&[0x1f, 0x8b]) {
        bytes = inflate(&bytes, &name)?;
    }
    options.tell(Stage::Parse { bytes: bytes.len() as u64 });
    if native::recognise(&bytes) {
        return native(&bytes, &name);
    }
    if step::recognise(&bytes) {
        return step::read(&bytes, &name, options);
    }
    if iges::recognise(&bytes) {
        return iges(&bytes, &name);
    }
    if bytes.starts_with(RHINO) {
        return rhino(&bytes, &name);
    }
    let folder = path.parent();
    match path.file_name().and_then(|f| f.to_str()).map(str::to_ascii_lowercase) {
        Some(f) if [".stp", ".step", ".p21", ".stpz", ".stp.gz", ".step.gz"].iter().any(|e| f.ends_with(e)) => {
            Err(ImportError::NotStep { file: name })
        }
        Some(f) if [".igs", ".iges", ".igs.gz", ".iges.gz"].iter().any(|e| f.ends_with(e)) => {
            Err(ImportError::NotIges { file: name })
        }
        Some(f) if f.ends_with(".selvedge") || f.ends_with(".selvedge.gz") => native(&bytes, &name),
        Some(f) if f.ends_with(".obj") || f.ends_with(".obj.gz") => obj(&bytes, &name, folder),
        Some(f) if f.ends_with(".bv") || f.ends_with(".bv.gz") => bv(&bytes, &name),
        _ if bv::recognise(&bytes) => bv(&bytes, &name),
        _ if obj::recognise(&bytes) => obj(&bytes, &name, folder),
        _ => Err(ImportError::Format { file: name }),
    }
}

/// Reads ISO 10303-21 text (STEP AP203, AP214, AP242); `name` is the file's name in messages.
///
/// # Errors
/// [`ImportError`] when the text is not STEP or holds no usable data.
pub fn step(bytes: &[u8], name: &str) -> Result<Import, ImportError> {
    step::read(bytes, name, &Options::default())
}

/// Reads the engine's own form: see [`crate::model::native`].
///
/// # Errors
/// [`ImportError::Native`] when the bytes hold no valid model.
pub fn native(bytes: &[u8], name: &str) -> Result<Import, ImportError> {
    native::read(bytes, name)
}

/// Reads Wavefront OBJ text; materials are looked for in `folder`, if there is one.
///
/// # Errors
/// [`ImportError::Nothing`] when the text holds no vertex.
pub fn obj(bytes: &[u8], name: &str, folder: Option<&Path>) -> Result<Import, ImportError> {
    obj::read(bytes, name, folder)
}

/// Reads a BezierView `.bv` file.
///
/// # Errors
/// [`ImportError::Nothing`] when the text does not begin with a patch.
pub fn bv(bytes: &[u8], name: &str) -> Result<Import, ImportError> {
    bv::read(bytes, name)
}

/// Reads a Rhino `.3dm` file.
///
/// # Errors
/// [`ImportError::Rhino`] when it cannot be decoded, or when the library was built without the feature
/// `rhino`.
pub fn rhino(bytes: &[u8], name: &str) -> Result<Import, ImportError> {
    #[cfg(feature = "rhino")]
    return rhino::read(bytes, name);
    #[cfg(not(feature = "rhino"))]
    return Err(ImportError::Rhino {
        file: name.to_owned(),
        why: format!("{} bytes of a Rhino file, for which the feature `rhino` is not built in", bytes.len()),
    });
}

/// Reads IGES 5.3 and older in fixed format; `name` is the file's name in messages.
///
/// # Errors
/// [`ImportError`] when the text is not IGES, is in compressed or binary form, or holds no entity.
pub fn iges(bytes: &[u8], name: &str) -> Result<Import, ImportError> {
    iges::read(bytes, name)
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
