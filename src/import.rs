//! Files to models.

use crate::model::Model;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;

/// A file read.
#[derive(Clone, Debug, Default)]
pub struct Import {
    /// What it holds.
    pub model: Model,
    /// What was healed, replaced or left out.
    pub warnings: Vec<Warning>,
    /// Counts for the record.
    pub report: ImportReport,
}

/// Something that the reader did not take as it was.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Warning(String);

/// Counts of what was read.
#[derive(Clone, Debug, Default, Serialize)]
pub struct ImportReport {
    /// Faces before any was left out.
    pub faces: usize,
    /// Faces left out, by reason.
    pub dropped: BTreeMap<String, usize>,
}

/// Why a file gives no model.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)]
pub enum ImportError {
    #[error("{file}: {source}")]
    Read { file: String, source: std::io::Error },
    #[error("{file}: not a CAD file of a known format")]
    Format { file: String },
}

/// Reads `path`.
///
/// # Errors
/// [`ImportError`].
pub fn open(path: &Path) -> Result<Import, ImportError> {
    let file = path.display().to_string();
    std::fs::read(path).map_err(|source| ImportError::Read { file: file.clone(), source })?;
    Err(ImportError::Format { file })
}
