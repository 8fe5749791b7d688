//! Why there is no model or no picture, and how a caller ends what takes too long.

use selvedge::headless::HeadlessError;
use selvedge::model::CameraError;
use selvedge::picture::BadEdges;
use selvedge_io::import::{ImportError, Summary};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Why a file gives no model, or a job no picture.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SessionError {
    /// The file cannot be read, or is not of a known format.
    #[error(transparent)]
    Import(#[from] ImportError),
    /// Nothing of the file can be drawn.
    #[error("{file}: {summary}")]
    Nothing {
        /// The file.
        file: String,
        /// What it holds in place of surfaces.
        summary: Box<Summary>,
    },
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
    /// Settings of lines that draw nothing sensible.
    #[error(transparent)]
    Edges(#[from] BadEdges),
    /// The caller said [`Stop::set`].
    #[error("stopped")]
    Stopped,
    /// The renderer was closed, or has failed in a way that it does not survive.
    #[error("the renderer is closed")]
    Closed,
    /// A defect: an invariant of the library does not hold.
    #[error("internal error: {0}")]
    Panicked(String),
}

/// A flag that ends an import or an upload: set from any thread, seen between two faces.
#[derive(Clone, Debug, Default)]
pub struct Stop(Arc<AtomicBool>);

/// What unwinds through the library to the caller who stopped it.
struct Stopping;

impl Stop {
    /// From now on.
    pub fn set(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether it was set.
    pub fn is_set(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// Unwinds to [`guarded`] if it was set: progress callbacks cannot say no.
    pub(crate) fn check(&self) {
        if self.is_set() {
            resume_unwind(Box::new(Stopping));
        }
    }
}

/// Runs work whose progress callbacks call [`Stop::check`]; a panic becomes an error.
///
/// What the work had in hand may be half done: the caller throws it away.
pub(crate) fn guarded<T>(work: impl FnOnce() -> Result<T, SessionError>) -> Result<T, SessionError> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|cause| Err(unwound(cause)))
}

fn unwound(cause: Box<dyn Any + Send>) -> SessionError {
    if cause.is::<Stopping>() {
        return SessionError::Stopped;
    }
    let text = cause.downcast_ref::<String>().cloned();
    let text = text.or_else(|| cause.downcast_ref::<&str>().map(|text| (*text).to_owned()));
    SessionError::Panicked(text.unwrap_or_else(|| "no message".to_owned()))
}
