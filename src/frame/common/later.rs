//! Pipelines that a thread of their own makes: frames that do not draw with them do not wait for them.
//!
//! ```text
//!   upload: pipelines of every frame ──▶ frames that leave lines out ──▶ first frame with lines
//!                                    └── thread: pipelines of lines ──────────▲
//! ```

use crate::gpu::GpuError;
use std::panic::resume_unwind;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};

type Make<T> = dyn Fn() -> Result<T, GpuError> + Send + Sync;

/// What a thread makes, or has made.
pub(crate) struct Later<T> {
    make: Arc<Make<T>>,
    state: Mutex<State<T>>,
}

enum State<T> {
    /// Nobody makes it.
    Absent,
    Making(JoinHandle<Result<T, GpuError>>),
    Made(Arc<T>),
}

impl<T: Send + 'static> Later<T> {
    /// Calls `make` in a thread. Where there can be no thread, [`get`](Self::get) calls it.
    pub(crate) fn begin(make: impl Fn() -> Result<T, GpuError> + Send + Sync + 'static) -> Self {
        let make: Arc<Make<T>> = Arc::new(make);
        let of_thread = Arc::clone(&make);
        let thread = thread::Builder::new().name("later pipelines".into()).spawn(move || of_thread());
        let state = thread.map_or(State::Absent, State::Making);
        Self { make, state: Mutex::new(state) }
    }

    /// Waits for it.
    ///
    /// # Errors
    /// Of `make`, which the next call calls once more.
    pub(crate) fn get(&self) -> Result<Arc<T>, GpuError> {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        let made = match std::mem::replace(&mut *state, State::Absent) {
            State::Absent => Arc::new((self.make)()?),
            State::Making(thread) => Arc::new(thread.join().unwrap_or_else(|panic| resume_unwind(panic))?),
            State::Made(made) => made,
        };
        *state = State::Made(Arc::clone(&made));
        Ok(made)
    }
}

impl<T> Drop for Later<T> {
    /// The thread uses the device: nothing may outlive it.
    fn drop(&mut self) {
        let state = self.state.get_mut().unwrap_or_else(PoisonError::into_inner);
        if let State::Making(thread) = std::mem::replace(state, State::Absent) {
            drop(thread.join());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ash::vk;
    use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

    #[test]
    fn it_is_made_once() {
        let calls = Arc::new(AtomicU32::new(0));
        let counted = Arc::clone(&calls);
        let later = Later::begin(move || Ok(counted.fetch_add(1, Relaxed)));
        assert_eq!([*later.get().unwrap(), *later.get().unwrap()], [0; 2]);
        assert_eq!(calls.load(Relaxed), 1);
    }

    /// The error is told, and what failed is made by the next call.
    #[test]
    fn a_failure_is_told_and_made_good() {
        let calls = AtomicU32::new(0);
        let failed = || GpuError::Vulkan { call: "none", resource: "it".into(), result: vk::Result::ERROR_UNKNOWN };
        let later = Later::begin(move || if calls.fetch_add(1, Relaxed) == 0 { Err(failed()) } else { Ok(7) });
        assert!(later.get().unwrap_err().to_string().contains("none failed for `it`"));
        assert_eq!(*later.get().unwrap(), 7);
    }

    /// Nothing of the thread is left when it is dropped.
    #[test]
    fn a_drop_waits_for_the_thread() {
        let (held, inner) = (Arc::new(()), Arc::new(Mutex::new(())));
        let (of_thread, gate) = (Arc::clone(&held), Arc::clone(&inner));
        let closed = inner.lock().unwrap();
        let later = Later::begin(move || Ok((Arc::clone(&of_thread), drop(gate.lock()))));
        let dropper = thread::spawn(move || drop(later));
        drop(closed);
        dropper.join().unwrap();
        assert_eq!(Arc::strong_count(&held), 1);
    }
}
