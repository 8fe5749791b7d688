//! A sign of life for work that takes longer than a second.

use indicatif::{HumanBytes, ProgressBar, ProgressDrawTarget, ProgressStyle};
use selvedge_io::import::Stage;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{OnceLock, mpsc};
use std::thread;
use std::time::{Duration, Instant};

/// Nothing is shown before this since the first work began: short work needs no comment.
const SILENCE: Duration = Duration::from_secs(1);
/// The same of work after that: a line that comes and goes at once is no comment.
const NEXT: Duration = Duration::from_millis(100);

/// When the first work began.
static BEGUN: OnceLock<Instant> = OnceLock::new();

/// Work of unknown length.
const SPINNER: &str = "{spinner} {msg}, {elapsed_precise}";
/// Work that counts.
const COUNTER: &str = "{spinner} {msg}: {human_pos}, {elapsed_precise}";
/// Work of known length. The last step may have no length: the time goes on.
const BAR: &str = "{spinner} {msg} {bar:30} {human_pos} of {human_len}, {elapsed_precise}, {eta} left";

/// Files, whose times differ.
const FILES: &str = "{bar:30} {human_pos} of {human_len} files, {per_sec}, {eta} left; {msg}";

/// The same of bytes.
const BYTES: &str = "{spinner} {msg} {bar:30} {bytes} of {total_bytes}, {elapsed_precise}, {eta} left";

/// Runs `work`; past one second of all work `what` turns on standard error, with the seconds that it takes, where that
/// is a terminal.
pub fn during<T>(what: &str, work: impl FnOnce() -> T) -> T {
    spin(what, SPINNER, |_| work())
}

/// As [`during`], for work that reports how many things it has done since its last report.
pub fn counting<T>(what: &str, work: impl FnOnce(&(dyn Fn(u64) + Sync)) -> T) -> T {
    spin(what, COUNTER, |bar| work(&|done| bar.inc(done)))
}

/// As [`during`], for work of `total` things, which reports how many it has done since its last report.
pub fn advancing<T>(what: &str, total: usize, work: impl FnOnce(&(dyn Fn(usize) + Sync)) -> T) -> T {
    spin(what, BAR, |bar| {
        bar.set_length(total as u64);
        work(&|done| bar.inc(done as u64))
    })
}

/// As [`during`], for an import of `file`: its stages, each with a bar where its length is known.
pub fn importing<T>(file: &str, work: impl FnOnce(&(dyn Fn(Stage) + Sync)) -> T) -> T {
    spin(&format!("reading {file}"), SPINNER, |bar| work(&|stage| show(bar, file, stage)))
}

fn show(bar: &ProgressBar, file: &str, stage: Stage) {
    match stage {
        Stage::Read { bytes } => bar.set_message(format!("reading {file}, {}", HumanBytes(bytes))),
        Stage::Program { .. } => bar.set_message(format!("{file}: openscad runs")),
        Stage::Parse { bytes } => bar.set_message(format!("parsing {file}, {}", HumanBytes(bytes))),
        Stage::Records { read, bytes } => {
            if bar.length() != Some(bytes) {
                begin(bar, BYTES, format!("{file}: records"), bytes);
            }
            bar.set_position(read);
        }
        Stage::Bodies { mapped: 0, total } => begin(bar, BAR, format!("{file}: bodies"), total as u64),
        Stage::Bodies { mapped, .. } => bar.set_position(mapped as u64),
        Stage::Faces { built: 0, total } => begin(bar, BAR, format!("{file}: faces"), total as u64),
        Stage::Faces { .. } => bar.inc(1),
    }
}

/// Begins the bar of a stage.
fn begin(bar: &ProgressBar, template: &str, message: String, length: u64) {
    bar.set_style(style(template));
    bar.set_message(message);
    bar.set_length(length);
    bar.set_position(0);
}

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).expect("the templates above are well formed")
}

fn spin<T>(what: &str, template: &str, work: impl FnOnce(&ProgressBar) -> T) -> T {
    let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden()).with_message(what.to_owned());
    bar.set_style(style(template));
    let (running, ended) = mpsc::channel::<()>();
    thread::scope(|scope| {
        let running = running; // dropped when the work ends, by a panic too
        scope.spawn(|| {
            let ended = ended;
            let alone = !MANY.load(Ordering::Relaxed);
            let silence = SILENCE.saturating_sub(BEGUN.get_or_init(Instant::now).elapsed()).max(NEXT);
            if alone && ended.recv_timeout(silence) == Err(mpsc::RecvTimeoutError::Timeout) {
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

/// Many files: one line for all of them, instead of a line for each.
pub struct Files(ProgressBar);

/// Set while a [`Files`] is shown.
static MANY: AtomicBool = AtomicBool::new(false);

/// Begins a line of so many files.
pub fn files(count: usize) -> Files {
    MANY.store(true, Ordering::Relaxed);
    let bar = ProgressBar::new(count as u64).with_style(style(FILES));
    bar.enable_steady_tick(Duration::from_millis(500));
    Files(bar)
}

impl Files {
    /// Counts a file.
    pub fn one(&self, name: &str) {
        self.0.set_message(name.to_owned());
        self.0.inc(1);
    }

    /// Prints a line on standard error, above the bar.
    pub fn tell(&self, line: &str) {
        self.0.suspend(|| eprintln!("{line}"));
    }
}

impl Drop for Files {
    fn drop(&mut self) {
        self.0.finish_and_clear();
        MANY.store(false, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bar_follows_the_stages() {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
        show(&bar, "a.step", Stage::Read { bytes: 2048 });
        assert_eq!(bar.message(), "reading a.step, 2.00 KiB");
        show(&bar, "a.scad", Stage::Program { process: 7 });
        assert_eq!(bar.message(), "a.scad: openscad runs");
        show(&bar, "a.step", Stage::Parse { bytes: 4096 });
        assert_eq!(bar.message(), "parsing a.step, 4.00 KiB");
        for read in [1024, 4096] {
            show(&bar, "a.step", Stage::Records { read, bytes: 4096 });
            assert_eq!((bar.position(), bar.length()), (read, Some(4096)));
        }
        for mapped in [0, 2] {
            show(&bar, "a.step", Stage::Bodies { mapped, total: 3 });
            assert_eq!((bar.position(), bar.length()), (mapped as u64, Some(3)));
        }
        // threads may report out of order; the number of calls counts
        for built in [0, 2, 1] {
            show(&bar, "a.step", Stage::Faces { built, total: 7 });
        }
        assert_eq!((bar.position(), bar.length()), (2, Some(7)));
    }
}
