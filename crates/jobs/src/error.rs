//! Why there is no model or no picture.

use crate::limits::Exceeded;
use selvedge::edges::EdgeError;
use selvedge::headless::HeadlessError;
use selvedge::model::CameraError;
use selvedge::picture::BadEdges;
pub use selvedge_io::import::Stop;
use selvedge_io::import::{ImportError, Summary, Unwound, caught};

/// Why a file gives no model, or a job no picture.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum JobError {
    /// The file cannot be read, or is not of a known format.
    #[error(transparent)]
    Import(#[from] ImportError),
    /// Nothing of the file can be drawn.
    #[error("{file}: {summary}")]
    Nothing {
        /// The file.
        file: String,
        /// Its content in place of surfaces.
        summary: Box<Summary>,
    },
    /// The work on a file exceeds a limit.
    #[error(transparent)]
    Limit(#[from] Exceeded),
    /// No device, or none that suffices.
    #[error(transparent)]
    Device(HeadlessError),
    /// The model cannot be drawn, or the device failed.
    #[error(transparent)]
    Draw(#[from] HeadlessError),
    /// The camera shows nothing.
    #[error("the camera shows nothing: {0}")]
    Camera(#[from] CameraError),
    /// A matrix that no camera of the renderer has.
    #[error("{0}")]
    Pinhole(&'static str),
    /// Invalid settings of lines.
    #[error(transparent)]
    Edges(#[from] BadEdges),
    /// A part whose edges cannot be found.
    #[error("part {part}: {source}")]
    Boundary {
        /// Index of the part.
        part: usize,
        /// The fault of one of its faces.
        source: EdgeError,
    },
    /// A place or a radius that cannot be snapped within.
    #[error("the place must be two numbers and the radius a number above 0, in pixels")]
    Snap,
    /// The validation layer found something while a picture was drawn.
    #[error("validation: {0}")]
    Validation(String),
    /// The caller said [`Stop::set`].
    #[error("stopped before it was done")]
    Stopped,
    /// The renderer was closed, or failed for good.
    #[error("the renderer is closed")]
    Closed,
    /// A defect: an invariant of the library does not hold.
    #[error("internal error: {0}")]
    Panicked(String),
}

/// Runs work whose progress callbacks call [`Stop::check`] or [`Step::check`](crate::Step::check); a panic becomes an
/// error.
///
/// The objects of the work may be half done: the caller discards them.
///
/// # Errors
/// Those of the work, [`JobError::Stopped`], [`JobError::Limit`], [`JobError::Panicked`].
pub fn guarded<T>(work: impl FnOnce() -> Result<T, JobError>) -> Result<T, JobError> {
    caught(work).unwrap_or_else(|unwound| Err(failed(&unwound)))
}

fn failed(unwound: &Unwound) -> JobError {
    match unwound {
        Unwound::Stopped => JobError::Stopped,
        Unwound::Cause(cause) => match cause.downcast_ref::<Exceeded>() {
            Some(exceeded) => JobError::Limit(exceeded.clone()),
            None => JobError::Panicked(unwound.message().unwrap_or_else(|| "no message".to_owned())),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panics_are_reported_by_their_cause() {
        let stop = Stop::default();
        let done: Result<u8, JobError> = guarded(|| {
            stop.check();
            Ok(7)
        });
        assert!(matches!(done, Ok(7)));
        stop.clone().set();
        assert!(stop.is_set());
        let stopped: Result<(), JobError> = guarded(|| {
            stop.check();
            Ok(())
        });
        assert!(matches!(stopped, Err(JobError::Stopped)));
        let number = 3;
        let broken: Result<(), JobError> = guarded(|| panic!("{number} is no invariant"));
        assert_eq!(broken.expect_err("a panic").to_string(), "internal error: 3 is no invariant");
    }
}
