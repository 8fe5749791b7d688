//! Files read by a thread, with progress; reading can be stopped.

use selvedge_io::import::{self, Folders, Import, Options, Stage};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};

/// A file that was read.
#[derive(Debug)]
pub struct Loaded {
    /// Where it is.
    pub path: PathBuf,
    /// Its content.
    pub import: Import,
}

/// A message of the thread.
#[derive(Debug)]
pub enum LoaderEvent {
    /// How far the file has come: stage, and a share of it from 0 to 1 where it is known.
    Progress {
        /// As in the bar.
        stage: &'static str,
        /// Of the stage.
        share: Option<f32>,
    },
    /// It is read.
    Loaded(Arc<Loaded>),
    /// It cannot be read, or nothing of it can be drawn: the reason, with the file's name.
    Failed(String),
    /// Reading was stopped.
    Cancelled,
}

/// A file that is being read.
#[derive(Debug)]
pub struct Loader {
    /// The file.
    pub path: PathBuf,
    cancelled: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

/// Ends an import that was stopped; it unwinds through the importer without a message.
struct GivenUp;

/// Share of a stage between two reports of progress.
const STEP: f32 = 0.02;

impl Loader {
    /// Begins to read; `tell` is called by the thread.
    pub fn new(path: PathBuf, tell: impl Fn(LoaderEvent) + Send + Sync + 'static) -> Self {
        let cancelled = Arc::new(AtomicBool::new(false));
        let (stop, file) = (Arc::clone(&cancelled), path.clone());
        let thread = thread::spawn(move || {
            let last = std::sync::Mutex::new(("", -1.0_f32));
            let progress = |stage: Stage| {
                if stop.load(Ordering::Relaxed) {
                    resume_unwind(Box::new(GivenUp));
                }
                let (stage, share) = told(stage);
                if let Ok(mut last) = last.lock() {
                    if last.0 == stage && share.is_none_or(|share| (share - last.1).abs() < STEP) {
                        return;
                    }
                    *last = (stage, share.unwrap_or_default());
                }
                tell(LoaderEvent::Progress { stage, share });
            };
            let folders = Folders::new(Vec::new());
            let options =
                Options { progress: Some(&progress), files: Some(&folders), run_openscad: true, ..Options::default() };
            let read = catch_unwind(AssertUnwindSafe(|| import::open_with(&file, &options)));
            let event = match read {
                _ if stop.load(Ordering::Relaxed) => LoaderEvent::Cancelled,
                Ok(Ok(import)) => {
                    let summary = import.summary();
                    if summary.draws_nothing() {
                        LoaderEvent::Failed(format!("{}: {summary}", file.display()))
                    } else {
                        LoaderEvent::Loaded(Arc::new(Loaded { path: file.clone(), import }))
                    }
                }
                Ok(Err(error)) => LoaderEvent::Failed(error.to_string()),
                Err(_) => LoaderEvent::Failed(format!("{}: the importer failed", file.display())),
            };
            tell(event);
        });
        Self { path, cancelled, thread: Some(thread) }
    }

    /// Stops reading: the importer ends at its next report of progress, and sends only that it was stopped.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// Waits until the thread has ended.
    pub fn join(&mut self) {
        if let Some(thread) = self.thread.take() {
            // it has sent all its messages
            let _ = thread.join();
        }
    }
}

/// A stage in words, and how much of it is done.
fn told(stage: Stage) -> (&'static str, Option<f32>) {
    let share = |done: f64, of: f64| Some(if of > 0.0 { (done / of) as f32 } else { 0.0 });
    match stage {
        Stage::Read { .. } => ("reading", None),
        Stage::Program { .. } => ("running OpenSCAD", None),
        Stage::Parse { .. } => ("parsing", None),
        Stage::Records { read, bytes } => ("parsing", share(read as f64, bytes as f64)),
        Stage::Bodies { mapped, total } => ("bodies", share(mapped as f64, total as f64)),
        Stage::Faces { built, total } => ("faces", share(built as f64, total as f64)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc;
    use std::time::{Duration, Instant};

    fn sample(name: &str) -> PathBuf {
        PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../samples").join(name)
    }

    /// The last event, and the number of reports of progress before it.
    fn read(path: PathBuf, cancel: bool) -> (LoaderEvent, usize) {
        let (to, from) = mpsc::channel();
        let mut loader = Loader::new(path, move |event| to.send(event).expect("the test waits"));
        if cancel {
            loader.cancel();
        }
        loader.join();
        let mut all: Vec<_> = from.iter().collect();
        let last = all.pop().expect("an end");
        assert!(all.iter().all(|e| matches!(e, LoaderEvent::Progress { .. })));
        (last, all.len())
    }

    #[test]
    fn a_file_is_read_with_progress() {
        let (last, signs) = read(sample("bracket.step"), false);
        let LoaderEvent::Loaded(loaded) = last else { panic!("{last:?}") };
        assert!(loaded.import.model.face_count() > 5 && signs >= 3, "{signs}");
    }

    #[test]
    fn what_is_no_file_is_named() {
        let (last, _) = read(sample("no_such.step"), false);
        assert!(matches!(&last, LoaderEvent::Failed(why) if why.contains("no_such.step")), "{last:?}");
    }

    /// A fifth of a second, for files of any size; the thread may have read it before it stops.
    #[test]
    fn a_file_is_given_up_at_once() {
        let start = Instant::now();
        let (last, _) = read(sample("assembly.step"), true);
        assert!(matches!(last, LoaderEvent::Cancelled), "{last:?}");
        assert!(start.elapsed() < Duration::from_secs(5));
    }
}
