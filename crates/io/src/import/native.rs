//! The engine's own form ([`crate::native`]): a file is read as a whole or refused, so there are no warnings.

use super::{Import, ImportError, ImportReport};
use crate::native;

pub(super) use native::recognise;

/// Reads a stored model; `name` is the file's name in messages.
pub(super) fn read(bytes: &[u8], name: &str) -> Result<Import, ImportError> {
    let model = native::read(bytes).map_err(|source| ImportError::Native { file: name.to_owned(), source })?;
    let report = ImportReport {
        format: format!("selvedge {}", native::VERSION),
        bodies: model.parts.len(),
        faces: model.face_count(),
        units: if model.unit.is_empty() { Vec::new() } else { vec![model.unit.clone()] },
        occurrences: model.instances.iter().map(|i| i.name.clone()).filter(|n| !n.is_empty()).collect(),
        ..ImportReport::default()
    };
    Ok(Import { model, report, ..Import::default() })
}
