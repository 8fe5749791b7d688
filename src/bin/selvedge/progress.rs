//! A sign of life for work that takes longer than a second.

use indicatif::ProgressBar;
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

/// Nothing is shown before this: short work needs no comment.
const SILENCE: Duration = Duration::from_secs(1);

/// Runs `work`; past one second `what` turns on standard error, where that is a terminal.
pub fn during<T>(what: &str, work: impl FnOnce() -> T) -> T {
    let (running, ended) = mpsc::channel::<()>();
    thread::scope(move |scope| {
        let running = running; // dropped when the work ends, by a panic too
        scope.spawn(move || {
            if ended.recv_timeout(SILENCE) == Err(mpsc::RecvTimeoutError::Timeout) {
                let spinner = ProgressBar::new_spinner().with_message(what.to_owned());
                spinner.enable_steady_tick(Duration::from_millis(100));
                let _ = ended.recv(); // only ever fails: nothing is sent, the sender is dropped
                spinner.finish_and_clear();
            }
        });
        let result = work();
        drop(running);
        result
    })
}
