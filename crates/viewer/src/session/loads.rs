//! Files that are being read, and open files that were written since.
//!
//! ```text
//!   begin a ─▶ load 1 ──give_up──▶ whatever its thread still sends has no load any more
//!   begin a ─▶ load 2 ────────────────────────▶ a is read ─▶ begin a, since it was written meanwhile
//!                          a is written ──REST──┘
//! ```

use super::{Finder, Loaded, Loader, LoaderEvent};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// A file that was written is read again when it has been unchanged so long.
const REST: Duration = Duration::from_millis(300);

/// A file that is being read.
#[derive(Debug)]
struct Load {
    number: u64,
    loader: Loader,
    stage: &'static str,
    share: Option<f32>,
    /// Its finished parts.
    preview: Option<Arc<Loaded>>,
}

/// The end of a load.
#[derive(Debug)]
pub struct Ended {
    /// The file.
    pub path: PathBuf,
    /// What was read, or why nothing was, with the file's name.
    pub result: Result<Arc<Loaded>, String>,
}

/// News of a load that was not given up.
#[derive(Debug)]
pub enum News {
    /// More parts are finished: [`Loads::previews`] has them.
    Preview(Arc<Loaded>),
    /// It has ended.
    Ended(Ended),
}

/// All files that are being read, each by a thread.
#[derive(Debug, Default)]
pub struct Loads {
    all: Vec<Load>,
    /// Where parts in other files are found.
    finder: Option<Finder>,
    /// Counts loads: the events of one that was given up have a number that is in `all` no more.
    begun: u64,
    /// Files that were written, and when.
    written: BTreeMap<PathBuf, Instant>,
}

impl Loads {
    /// No file yet. Without a finder, parts in other files are found beside the file that names them.
    pub fn new(finder: Option<Finder>) -> Self {
        Self { finder, ..Self::default() }
    }

    /// Begins to read a file, unless it is being read. The thread calls `tell` with the number of the load, for
    /// [`take`](Self::take).
    pub fn begin(&mut self, path: PathBuf, tell: impl Fn(u64, LoaderEvent) + Send + Sync + 'static) {
        if self.is_reading(&path) {
            return;
        }
        self.begun += 1;
        let number = self.begun;
        let loader = Loader::new(path, self.finder.clone(), move |event| tell(number, event));
        self.all.push(Load { number, loader, stage: "reading", share: None, preview: None });
    }

    /// Takes an event of a load; returns the news of one that was not given up. The previews of a load go with its end.
    pub fn take(&mut self, number: u64, event: LoaderEvent) -> Option<News> {
        let nth = self.all.iter().position(|load| load.number == number)?;
        let result = match event {
            LoaderEvent::Progress { stage, share } => {
                (self.all[nth].stage, self.all[nth].share) = (stage, share);
                return None;
            }
            LoaderEvent::Preview(loaded) => {
                self.all[nth].preview = Some(Arc::clone(&loaded));
                return Some(News::Preview(loaded));
            }
            LoaderEvent::Loaded(loaded) => Some(Ok(loaded)),
            LoaderEvent::Failed(why) => Some(Err(why)),
            LoaderEvent::Cancelled => None,
        };
        let path = self.all.remove(nth).loader.path;
        Some(News::Ended(Ended { path, result: result? }))
    }

    /// The finished parts of files that are being read.
    pub fn previews(&self) -> impl Iterator<Item = &Arc<Loaded>> {
        self.all.iter().filter_map(|load| load.preview.as_ref())
    }

    /// All previews are shown.
    pub fn shown(&self, now: Instant) {
        self.all.iter().for_each(|load| load.loader.shown(now));
    }

    /// Stops reading; returns the files. The threads end at their importers' next signs of progress; nothing waits for
    /// them.
    pub fn give_up(&mut self) -> Vec<PathBuf> {
        let files: Vec<_> = self.all.iter().map(|load| load.loader.path.clone()).collect();
        files.iter().for_each(|file| self.forget(file));
        files
    }

    /// Stops reading a file, and does not read it again.
    pub fn forget(&mut self, path: &Path) {
        self.all.iter().filter(|load| load.loader.path == path).for_each(|load| load.loader.cancel());
        self.all.retain(|load| load.loader.path != path);
        self.written.remove(path);
    }

    /// Whether a file is being read.
    pub fn is_reading(&self, path: &Path) -> bool {
        self.all.iter().any(|load| load.loader.path == path)
    }

    /// No file is being read, and none is to be read again.
    pub fn is_idle(&self) -> bool {
        self.all.is_empty() && self.written.is_empty()
    }

    /// Each file that is being read: its stage, and a share of that from 0 to 1 where it is known.
    pub fn iter(&self) -> impl Iterator<Item = (&Path, &'static str, Option<f32>)> {
        self.all.iter().map(|load| (load.loader.path.as_path(), load.stage, load.share))
    }

    /// A file was written.
    pub fn written(&mut self, path: PathBuf, now: Instant) {
        self.written.insert(path, now);
    }

    /// Takes the files that were written and rest. A file that is being read is taken after the end of that.
    pub fn rested(&mut self, now: Instant) -> Vec<PathBuf> {
        let rests = |(path, at): &(&PathBuf, &Instant)| **at + REST <= now && !self.is_reading(path);
        let rested: Vec<_> = self.written.iter().filter(rests).map(|(path, _)| path.clone()).collect();
        self.written.retain(|path, _| !rested.contains(path));
        rested
    }

    /// When [`rested`](Self::rested) has the next file; `None` if none was written, or only files that are being read.
    pub fn wake(&self) -> Option<Instant> {
        self.written.iter().filter(|(path, _)| !self.is_reading(path)).map(|(_, at)| *at + REST).min()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge_io::import::{Files, Import};
    use std::io;
    use std::sync::mpsc::{self, Receiver, Sender};
    use std::sync::{Mutex, PoisonError};

    /// Longest time that giving up may take.
    const GIVEN_UP: Duration = Duration::from_millis(200);

    /// A slow disk: says when a part's file is read, and holds the thread that reads it.
    struct Held {
        reads: Mutex<Sender<()>>,
        go_on: Mutex<Receiver<()>>,
    }

    impl Files for Held {
        fn find(&self, name: &str, _: &str) -> Option<String> {
            Some(name.to_owned())
        }

        fn read(&self, _: &str, _: u64) -> io::Result<Vec<u8>> {
            let reads = self.reads.lock().unwrap_or_else(PoisonError::into_inner);
            reads.send(()).map_err(io::Error::other)?;
            let go_on = self.go_on.lock().unwrap_or_else(PoisonError::into_inner);
            go_on.recv().map_err(io::Error::other)?;
            Err(io::ErrorKind::NotFound.into())
        }
    }

    #[test]
    fn giving_up_waits_for_no_thread() {
        let (reads, reading) = mpsc::channel();
        let (release, go_on) = mpsc::channel::<()>();
        let held = Held { reads: Mutex::new(reads), go_on: Mutex::new(go_on) };
        let mut loads = Loads::new(Some(Finder(Arc::new(held))));
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../io/src/import/external/tests/pair.stp");
        loads.begin(path, |_, _| ());
        reading.recv().expect("a part in another file");
        // the disk answers after a second
        std::thread::spawn(move || {
            std::thread::sleep(Duration::from_secs(1));
            drop(release);
        });
        let start = Instant::now();
        loads.give_up();
        assert!(loads.is_idle() && start.elapsed() < GIVEN_UP, "{:?}", start.elapsed());
    }

    /// The first thread may end at any time after the file is opened again.
    #[test]
    fn a_load_that_was_given_up_ends_no_later_one() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples/bracket.step");
        let (to, from) = mpsc::channel();
        let mut loads = Loads::default();
        loads.begin(path.clone(), |_, _| ());
        assert_eq!(loads.give_up(), std::slice::from_ref(&path));
        loads.begin(path.clone(), move |number, event| to.send((number, event)).expect("the test waits"));
        let old = [
            LoaderEvent::Progress { stage: "old", share: None },
            LoaderEvent::Failed("old".to_owned()),
            LoaderEvent::Cancelled,
        ];
        for event in old {
            assert!(loads.take(1, event).is_none());
            assert!(loads.is_reading(&path) && loads.iter().all(|(_, stage, _)| stage != "old"));
        }
        let ends: Vec<_> = from.iter().filter_map(|(number, event)| loads.take(number, event)).collect();
        assert!(matches!(ends.last(), Some(News::Ended(Ended { path: of, result: Ok(_) })) if *of == path), "{ends:?}");
        assert!(loads.is_idle());
    }

    #[test]
    fn finished_parts_go_with_the_load() {
        let path = PathBuf::from("no_such.step");
        let parts = Arc::new(Loaded { path: path.clone(), import: Import::default(), partial: true });
        let preview = || LoaderEvent::Preview(Arc::clone(&parts));
        let ends: [fn(&mut Loads); 3] = [
            |loads| drop(loads.give_up()),
            |loads| loads.forget(Path::new("no_such.step")),
            |loads| drop(loads.take(1, LoaderEvent::Failed("half of it".to_owned()))),
        ];
        for end in ends {
            let mut loads = Loads::default();
            loads.begin(path.clone(), |_, _| ());
            assert!(matches!(loads.take(1, preview()), Some(News::Preview(_))) && loads.is_reading(&path));
            assert_eq!(loads.previews().count(), 1);
            end(&mut loads);
            assert_eq!(loads.previews().count(), 0);
            assert!(loads.take(1, preview()).is_none(), "too late");
        }
    }

    #[test]
    fn a_file_that_is_written_while_it_is_read_is_read_again() {
        let (path, now) = (PathBuf::from("no_such.step"), Instant::now());
        let mut loads = Loads::default();
        loads.written(path.clone(), now);
        assert_eq!((loads.wake(), loads.rested(now)), (Some(now + REST), Vec::new()));
        assert_eq!((loads.rested(now + REST), loads.wake()), (vec![path.clone()], None));
        loads.begin(path.clone(), |_, _| ());
        loads.written(path.clone(), now);
        assert_eq!((loads.rested(now + REST), loads.wake(), loads.is_idle()), (Vec::new(), None, false));
        let ended = loads.take(1, LoaderEvent::Failed("half of it".to_owned())).expect("the end");
        assert!(matches!(&ended, News::Ended(Ended { path: of, result: Err(_) }) if *of == path), "{ended:?}");
        assert_eq!((loads.wake(), loads.rested(now + REST)), (Some(now + REST), vec![path.clone()]));
        loads.begin(path.clone(), |_, _| ());
        loads.written(path.clone(), now);
        assert_eq!(loads.give_up(), [path]);
        assert!(loads.is_idle(), "what was given up is not begun again");
    }
}
