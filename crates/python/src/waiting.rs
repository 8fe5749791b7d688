//! Work in a thread of its own, while the caller's looks after signals.

use crate::error::raised;
use pyo3::prelude::*;
use selvedge_jobs::{JobError, Stop};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

/// How long a signal may wait.
const BETWEEN: Duration = Duration::from_millis(20);

/// Asks `answer` for a result until there is one, without the interpreter's lock; a signal's exception calls `stop` and is
/// raised at once.
pub fn until<T: Send>(
    py: Python<'_>,
    stop: impl Fn(),
    mut answer: impl FnMut(Duration) -> Option<Result<T, JobError>> + Send,
) -> PyResult<T> {
    loop {
        if let Some(answer) = py.detach(|| answer(BETWEEN)) {
            return answer.map_err(|error| raised(py, &error));
        }
        py.check_signals().inspect_err(|_| stop())?;
    }
}

/// Runs `work` in a thread. After a signal the thread ends where the work looks at its [`Stop`].
pub fn apart<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&Stop) -> Result<T, JobError> + Send + 'static,
) -> PyResult<T> {
    let stop = Stop::default();
    let (tell, told) = mpsc::channel();
    let seen = stop.clone();
    thread::spawn(move || tell.send(work(&seen)));
    until(
        py,
        || stop.set(),
        move |at_most| match told.recv_timeout(at_most) {
            Ok(result) => Some(result),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => Some(Err(JobError::Panicked("a thread ended".to_owned()))),
        },
    )
}
