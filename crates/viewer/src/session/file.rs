//! Files read by a thread, with progress and previews; reading can be stopped.

use super::schedule::Schedule;
use selvedge::model::Model;
use selvedge_io::import::{self, Files, Folders, Import, Options, Preview, Stage, Stop, caught};
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::{self, JoinHandle};
use std::time::Instant;

/// A file that was read, or the beginning of one.
#[derive(Debug)]
pub struct Loaded {
    /// Where it is.
    pub path: PathBuf,
    /// Its content.
    pub import: Import,
    /// It is being read: parts that are not finished have no faces, or are missing.
    pub partial: bool,
}

/// Finds and reads parts of assemblies that stand in other files.
#[derive(Clone)]
pub struct Finder(
    /// Called by the threads that read.
    pub Arc<dyn Files + Send + Sync>,
);

impl fmt::Debug for Finder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Finder")
    }
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
    /// Its finished parts, more than before.
    Preview(Arc<Loaded>),
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
    stop: Stop,
    previews: Arc<Schedule>,
    thread: Option<JoinHandle<()>>,
}

/// Share of a stage between two reports of progress.
const STEP: f32 = 0.02;

impl Loader {
    /// Begins to read; `tell` is called by the thread. Without a finder, parts in other files are found beside the
    /// file.
    pub fn new(path: PathBuf, finder: Option<Finder>, tell: impl Fn(LoaderEvent) + Send + Sync + 'static) -> Self {
        let stop = Stop::default();
        let previews = Arc::new(Schedule::new(Instant::now()));
        let (stopped, file, schedule) = (stop.clone(), path.clone(), Arc::clone(&previews));
        let thread = thread::spawn(move || {
            let last = std::sync::Mutex::new(("", -1.0_f32));
            let progress = |stage: Stage| {
                stopped.check();
                let (stage, share) = told(stage);
                if let Ok(mut last) = last.lock() {
                    if last.0 == stage && share.is_none_or(|share| (share - last.1).abs() < STEP) {
                        return;
                    }
                    *last = (stage, share.unwrap_or_default());
                }
                tell(LoaderEvent::Progress { stage, share });
            };
            let beside = Folders::new(Vec::new());
            let files: &dyn Files = match &finder {
                Some(finder) => &*finder.0,
                None => &beside,
            };
            let begun = Begun { file: &file, schedule: &schedule, tell: &tell };
            let options = Options {
                progress: Some(&progress),
                preview: Some(&begun),
                files: Some(files),
                run_openscad: true,
                ..Options::default()
            };
            let read = caught(|| import::open_with(&file, &options));
            let event = match read {
                _ if stopped.is_set() => LoaderEvent::Cancelled,
                Ok(Ok(import)) => {
                    let summary = import.summary();
                    if summary.draws_nothing() {
                        LoaderEvent::Failed(format!("{}: {summary}", file.display()))
                    } else {
                        LoaderEvent::Loaded(Arc::new(Loaded { path: file.clone(), import, partial: false }))
                    }
                }
                Ok(Err(error)) => LoaderEvent::Failed(error.to_string()),
                Err(_) => LoaderEvent::Failed(format!("{}: the importer failed", file.display())),
            };
            tell(event);
        });
        Self { path, stop, previews, thread: Some(thread) }
    }

    /// Stops reading: the importer ends at its next report of progress, and sends only that it was stopped.
    pub fn cancel(&self) {
        self.stop.set();
    }

    /// The last preview is shown: the next one may be made after a while.
    pub fn shown(&self, now: Instant) {
        self.previews.shown(now);
    }

    /// Waits until the thread has ended.
    pub fn join(&mut self) {
        if let Some(thread) = self.thread.take() {
            // it has sent all its messages
            let _ = thread.join();
        }
    }
}

/// A file that is being read: it hands out its finished parts.
struct Begun<'a> {
    file: &'a Path,
    schedule: &'a Schedule,
    tell: &'a (dyn Fn(LoaderEvent) + Sync),
}

impl Preview for Begun<'_> {
    fn is_due(&self) -> bool {
        self.schedule.is_due(Instant::now())
    }

    fn take(&self, model: Model) {
        let now = Instant::now();
        self.schedule.made(now);
        let import = Import { model, ..Import::default() };
        if import.summary().draws_nothing() {
            self.schedule.shown(now);
        } else {
            let path = self.file.to_owned();
            (self.tell)(LoaderEvent::Preview(Arc::new(Loaded { path, import, partial: true })));
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
    use std::io;
    use std::sync::Mutex;
    use std::sync::mpsc::{self, Receiver};
    use std::time::Duration;

    fn sample(name: &str) -> PathBuf {
        PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../samples").join(name)
    }

    /// The last event, and the number of reports of progress before it.
    fn read(path: PathBuf, cancel: bool) -> (LoaderEvent, usize) {
        let (last, mut before) = events(path, cancel);
        before.retain(|event| matches!(event, LoaderEvent::Progress { .. }));
        (last, before.len())
    }

    /// The last event, and all before it.
    fn events(path: PathBuf, cancel: bool) -> (LoaderEvent, Vec<LoaderEvent>) {
        let (to, from) = mpsc::channel();
        let mut loader = Loader::new(path, None, move |event| to.send(event).expect("the test waits"));
        if cancel {
            loader.cancel();
        }
        loader.join();
        let mut all: Vec<_> = from.iter().collect();
        let last = all.pop().expect("an end");
        assert!(all.iter().all(|e| matches!(e, LoaderEvent::Progress { .. } | LoaderEvent::Preview(_))));
        (last, all)
    }

    #[test]
    fn a_file_is_read_with_progress() {
        let (last, signs) = read(sample("bracket.step"), false);
        let LoaderEvent::Loaded(loaded) = last else { panic!("{last:?}") };
        assert!(loaded.import.model.face_count() > 5 && signs >= 3, "{signs}");
    }

    /// The bolt takes longer than a file without a preview, and the nut waits for the test.
    struct Slow(Mutex<Receiver<()>>);

    impl Files for Slow {
        fn find(&self, name: &str, _: &str) -> Option<String> {
            ["bolt.stp", "nut.stp"].contains(&name).then(|| name.to_owned())
        }

        fn read(&self, found: &str, _: u64) -> io::Result<Vec<u8>> {
            if found == "bolt.stp" {
                thread::sleep(Duration::from_millis(400));
            } else {
                self.0.lock().expect("one thread").recv().expect("the test lets it go on");
            }
            std::fs::read(sample("bracket.step"))
        }
    }

    #[test]
    fn finished_parts_come_before_the_rest_is_read() {
        let ((to, from), (go_on, held)) = (mpsc::channel(), mpsc::channel());
        let finder = Finder(Arc::new(Slow(Mutex::new(held))));
        let path = sample("../crates/io/src/import/external/tests/pair.stp");
        let mut loader = Loader::new(path, Some(finder), move |event| to.send(event).expect("the test waits"));
        let next = || loop {
            let event = from.recv_timeout(Duration::from_secs(60)).expect("an event");
            if !matches!(event, LoaderEvent::Progress { .. }) {
                return event;
            }
        };
        let preview = next();
        let LoaderEvent::Preview(bolt) = preview else { panic!("{preview:?}") };
        assert!(bolt.partial && bolt.import.model.instances.len() == 1);
        go_on.send(()).expect("the thread waits");
        let end = next();
        let LoaderEvent::Loaded(pair) = end else { panic!("{end:?}") };
        assert!(!pair.partial && pair.import.model.instances.len() == 2);
        loader.join();
    }

    #[test]
    fn what_is_no_file_is_named() {
        let (last, _) = read(sample("no_such.step"), false);
        assert!(matches!(&last, LoaderEvent::Failed(why) if why.contains("no_such.step")), "{last:?}");
    }

    /// The importer stands still before its first face until the file is given up.
    #[test]
    fn nothing_more_comes_of_a_file_that_is_given_up() {
        let ((to, from), (go_on, held)) = (mpsc::channel(), mpsc::channel::<()>());
        let held = Mutex::new(held);
        let mut loader = Loader::new(sample("assembly.step"), None, move |event| {
            let is_at_faces = matches!(event, LoaderEvent::Progress { stage: "faces", .. });
            to.send(event).expect("the test waits");
            if is_at_faces {
                // it ends when the other side is dropped
                let _ = held.lock().expect("no panic").recv();
            }
        });
        while !matches!(from.recv().expect("faces"), LoaderEvent::Progress { stage: "faces", .. }) {}
        loader.cancel();
        drop(go_on);
        loader.join();
        let rest: Vec<_> = from.iter().collect();
        assert!(matches!(rest[..], [LoaderEvent::Cancelled]), "{rest:?}");
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
