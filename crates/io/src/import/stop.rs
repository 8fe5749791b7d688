//! How a caller ends an import, and how a defect of a reader is caught.
//!
//! ```text
//!   another thread ── Stop::set                     progress callback ── Stop::check, unwinds ─▶ caught ─▶ Unwound
//! ```

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A flag that ends an import or an upload: set from any thread, tested by the callback to which the work reports its
/// progress.
#[derive(Clone, Debug, Default)]
pub struct Stop {
    set: Arc<AtomicBool>,
}

/// The panic that unwinds through the work to the caller who stopped it.
struct Stopping;

impl Stop {
    /// From now on.
    pub fn set(&self) {
        self.set.store(true, Ordering::Relaxed);
    }

    /// Whether it was set.
    pub fn is_set(&self) -> bool {
        self.set.load(Ordering::Relaxed)
    }

    /// Unwinds to [`caught`] if it was set, without a message: callbacks cannot return an error.
    pub fn check(&self) {
        if self.is_set() {
            resume_unwind(Box::new(Stopping));
        }
    }
}

/// Why work did not end by itself.
#[derive(Debug)]
pub enum Unwound {
    /// [`Stop::check`] ended it.
    Stopped,
    /// A panic, or the value with which a callback unwound.
    Cause(Box<dyn Any + Send>),
}

impl Unwound {
    /// The message of a panic, if it has one.
    pub fn message(&self) -> Option<String> {
        let Self::Cause(cause) = self else { return None };
        let text = cause.downcast_ref::<String>().cloned();
        text.or_else(|| cause.downcast_ref::<&str>().map(|text| (*text).to_owned()))
    }
}

/// Runs work whose callbacks may unwind.
///
/// The objects of the work may be half done: the caller discards them.
///
/// # Errors
/// [`Unwound`]: by [`Stop::check`], by a callback of the caller's, or by a defect.
pub fn caught<T>(work: impl FnOnce() -> T) -> Result<T, Unwound> {
    catch_unwind(AssertUnwindSafe(work))
        .map_err(|cause| if cause.is::<Stopping>() { Unwound::Stopped } else { Unwound::Cause(cause) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flag_and_panics_are_told_apart() {
        let stop = Stop::default();
        assert!(matches!(caught(|| stop.check()), Ok(())));
        stop.clone().set();
        let stopped = caught(|| stop.check());
        assert!(matches!(&stopped, Err(Unwound::Stopped)) && stopped.unwrap_err().message().is_none());
        let number = 3;
        let ends: [Result<(), Unwound>; 3] = [
            caught(|| panic!("{number} is no invariant")),
            caught(|| panic!("no invariant")),
            caught(|| resume_unwind(Box::new(number))),
        ];
        let messages = ends.map(|end| end.unwrap_err().message());
        assert_eq!(messages, [Some("3 is no invariant".to_owned()), Some("no invariant".to_owned()), None]);
    }
}
