//! Errors as Python's exceptions: the classes stand in `selvedge/_errors.py`.

use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use selvedge_io::import::{ImportError, Warning};
use selvedge_jobs::{Exceeded, JobError, Work};
use std::io::ErrorKind;

/// An instance of one of the package's classes.
fn instance<'py, A: pyo3::call::PyCallArgs<'py>>(py: Python<'py>, class: &str, args: A) -> PyErr {
    let made = || py.import("selvedge._errors")?.getattr(class)?.call1(args);
    made().map_or_else(|error| error, PyErr::from_value)
}

/// The exception of an error.
pub fn raised(py: Python<'_>, error: &JobError) -> PyErr {
    let text = error.to_string();
    let nowhere = (None::<usize>, None::<u32>);
    match error {
        JobError::Import(import) => {
            let missing = matches!(import, ImportError::Read { source, .. } if source.kind() == ErrorKind::NotFound);
            let class = if missing { "MissingFileError" } else { "ReadError" };
            instance(py, class, (text, import.file(), import.line(), nowhere.1))
        }
        JobError::Nothing { file, .. } | JobError::Limit(Exceeded { file, work: Work::Reading, .. }) => {
            instance(py, "ReadError", (text, file, nowhere.0, nowhere.1))
        }
        JobError::Camera(_) | JobError::Pinhole(_) | JobError::Edges(_) | JobError::Snap => PyValueError::new_err(text),
        JobError::Device(_) => instance(py, "DeviceError", (text,)),
        JobError::Closed => instance(py, "ClosedError", (text,)),
        JobError::Draw(_) | JobError::Boundary { .. } | JobError::Validation(_) | JobError::Limit(_) => {
            instance(py, "RenderError", (text,))
        }
        _ => PyRuntimeError::new_err(text),
    }
}

/// The exception of a file of which something is left out, at the first thing that is.
pub fn incomplete(py: Python<'_>, file: &str, told: &str, warnings: &[Warning]) -> PyErr {
    let first = warnings.iter().find(|w| w.message.contains("left out")).or(warnings.first());
    let (line, entity) = first.map_or((None, None), |w| w.place.numbers());
    let text = first.map_or_else(|| format!("{file}: {told}"), |w| format!("{file}: {told}; first: {w}"));
    instance(py, "ReadError", (text, first.map_or(file, |w| w.file.as_str()), line, entity))
}
