//! A sign of life for work that takes longer than a second.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

/// Nothing is shown before this: short work needs no comment.
const SILENCE: Duration = Duration::from_secs(1);

/// Runs `work`; past one second `what` turns on standard error, where that is a terminal.
pub fn during<T>(what: &str, work: impl FnOnce() -> T) -> T {
    spin(what, "{spinner} {msg}", |_| work())
}

/// As [`during`], for work that tells how many things it has done since it last told.
pub fn counting<T>(what: &str, work: impl FnOnce(&(dyn Fn(u64) + Sync)) -> T) -> T {
    spin(what, "{spinner} {msg}: {human_pos}", |bar| work(&|done| bar.inc(done)))
}

fn spin<T>(what: &str, template: &str, work: impl FnOnce(&ProgressBar) -> T) -> T {
    let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden()).with_message(what.to_owned());
    bar.set_style(ProgressStyle::with_template(template).expect("the templates above are well formed"));
    let (running, ended) = mpsc::channel::<()>();
    thread::scope(|scope| {
        let running = running; // dropped when the work ends, by a panic too
        scope.spawn(|| {
            let ended = ended;
            if ended.recv_timeout(SILENCE) == Err(mpsc::RecvTimeoutError::Timeout) {
                bar.set_draw_target(ProgressDrawTarget::stderr());
                bar.enable_steady_tick(Duration::from_millis(100));
                let _ = ended.recv(); // only ever fails: nothing is sent, the sender is dropped
                bar.finish_and_clear();
            }
        });
        let result = work(&bar);
        drop(running);
        result
    })
}
