//! Open files put together by a thread.
//!
//! ```text
//!   files ─▶ 1 ─▶ World ─▶ Joined 1 ┊ its edges, unless other files came: the newest of them are next
//!   files ─▶ 2 (left out)           ┊
//!   files ─▶ 3 ─────────────────────╯▶ World ─▶ Joined 3 ─▶ its picture is shown ─▶ its edges ─▶ EdgesFound 3
//! ```
//!
//! The upload finds edges, too: found at the same time, both would be later, and so would the picture.

use super::{Loaded, World};
use selvedge_io::import::{Stop, Unwound, caught};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{self, Sender};
use std::thread;
use std::time::Duration;

/// Longest wait for the picture of a model, which may not come.
const PICTURE: Duration = Duration::from_secs(3);

/// A message of the thread, with the number of the list of files.
#[derive(Debug)]
pub enum JoinerEvent {
    /// The files as one model. Edges are not found yet.
    Joined(u64, Arc<World>),
    /// The edges of that are found, unless it has previews.
    EdgesFound(u64),
    /// One of both failed, by a defect of the program: its panic.
    Failed(u64, String),
}

/// A thread that puts lists of files together, one after another. It leaves out lists that are not the newest. If a newer
/// list comes, it ends the work on the old one before the next part.
#[derive(Debug)]
pub struct Joiner {
    newest: Arc<AtomicU64>,
    to: Sender<(u64, Vec<Arc<Loaded>>)>,
    /// The thread waits for a picture no more.
    go_on: Sender<()>,
    /// The last list whose model was taken, or that failed.
    joined: u64,
    /// The last list that is done with, edges and all.
    done: u64,
}

impl Joiner {
    /// Starts the thread, which calls `tell`. It ends after the list in work when the joiner is dropped.
    pub fn new(tell: impl Fn(JoinerEvent) + Send + 'static) -> Self {
        Self::with(World::telling, tell)
    }

    fn with(
        join: impl Fn(&[Arc<Loaded>], &(dyn Fn() + Sync)) -> World + Send + 'static,
        tell: impl Fn(JoinerEvent) + Send + 'static,
    ) -> Self {
        let (to, from) = mpsc::channel::<(u64, Vec<Arc<Loaded>>)>();
        let (go_on, shown) = mpsc::channel();
        let newest = Arc::new(AtomicU64::new(0));
        let wanted = Arc::clone(&newest);
        thread::spawn(move || {
            let is_old = |number: u64| number != wanted.load(Ordering::Relaxed);
            let stop = Stop::default();
            stop.set();
            for (number, files) in from {
                if is_old(number) {
                    continue;
                }
                let end_old = || {
                    if is_old(number) {
                        stop.check();
                    }
                };
                let worked = caught(|| {
                    let world = Arc::new(join(&files, &end_old));
                    // of models before
                    shown.try_iter().for_each(drop);
                    tell(JoinerEvent::Joined(number, Arc::clone(&world)));
                    if !is_old(number) && !world.is_partial() && !world.is_empty() {
                        // whether it is shown or not
                        let _ = shown.recv_timeout(PICTURE);
                    }
                    if !is_old(number) {
                        // another model follows a preview soon
                        if !world.is_partial() {
                            world.find_edges_telling(&end_old);
                        }
                        tell(JoinerEvent::EdgesFound(number));
                    }
                });
                match worked {
                    // the newest list is next
                    Ok(()) | Err(Unwound::Stopped) => {}
                    Err(unwound) => tell(JoinerEvent::Failed(number, reason(&unwound))),
                }
            }
        });
        Self { newest, to, go_on, joined: 0, done: 0 }
    }

    /// Starts to put these files together. Lists that still wait are dropped.
    pub fn join(&mut self, files: Vec<Arc<Loaded>>) {
        let number = self.newest() + 1;
        self.newest.store(number, Ordering::Relaxed);
        // the thread runs as long as this is there
        drop(self.to.send((number, files)));
        let _ = self.go_on.send(());
    }

    /// A picture of the newest list's model is shown.
    pub fn shown(&self) {
        if !self.is_idle() {
            let _ = self.go_on.send(());
        }
    }

    /// Takes an event of the thread. Returns the model of the newest list, or the failure in words.
    pub fn take(&mut self, event: JoinerEvent) -> Option<Result<Arc<World>, String>> {
        match event {
            JoinerEvent::Joined(number, world) => {
                self.joined = number;
                (number == self.newest()).then_some(Ok(world))
            }
            JoinerEvent::EdgesFound(number) => {
                self.done = number;
                None
            }
            JoinerEvent::Failed(number, why) => {
                let failed =
                    if self.joined == number { "Edges are not found" } else { "The files are not put together" };
                (self.joined, self.done) = (number, number);
                (number == self.newest()).then(|| Err(format!("{failed}: {why}")))
            }
        }
    }

    /// The model of the newest list is not there yet.
    pub fn is_busy(&self) -> bool {
        self.joined != self.newest()
    }

    /// The thread has nothing to do: edges are found, too.
    pub fn is_idle(&self) -> bool {
        self.done == self.newest()
    }

    fn newest(&self) -> u64 {
        self.newest.load(Ordering::Relaxed)
    }
}

/// What a panic says.
pub(crate) fn reason(unwound: &Unwound) -> String {
    unwound.message().unwrap_or_else(|| "no reason".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::PathBuf;

    /// The thread is held after its first model until two more lists wait.
    #[test]
    fn only_the_newest_of_waiting_lists_is_put_together() {
        let (to, from) = mpsc::channel();
        let (go_on, held) = mpsc::channel::<()>();
        let mut joiner = Joiner::new(move |event| {
            let is_first = matches!(event, JoinerEvent::Joined(1, _));
            to.send(event).expect("the test waits");
            if is_first {
                held.recv().expect("the test lets it go on");
            }
        });
        assert!(!joiner.is_busy() && joiner.is_idle());
        joiner.join(Vec::new());
        let first = from.recv().expect("an event");
        assert!(joiner.is_busy());
        joiner.join(Vec::new());
        joiner.join(Vec::new());
        assert!(joiner.take(first).is_none(), "others are wanted by now");
        go_on.send(()).expect("the thread waits");
        let third = from.recv().expect("an event");
        assert!(matches!(third, JoinerEvent::Joined(3, _)), "{third:?}");
        assert!(matches!(joiner.take(third), Some(Ok(_))) && !joiner.is_busy() && !joiner.is_idle());
        let found = from.recv().expect("an event");
        assert!(matches!(found, JoinerEvent::EdgesFound(3)), "{found:?}");
        assert!(joiner.take(found).is_none() && joiner.is_idle());
        drop(joiner);
        assert!(from.recv().is_err(), "the thread ends");
    }

    /// They would be found again for the model that follows.
    #[test]
    fn edges_of_previews_are_not_found() {
        let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../samples/bracket.step");
        let import = selvedge_io::import::open(&path).expect("a sample");
        let (to, from) = mpsc::channel();
        let mut joiner = Joiner::new(move |event| to.send(event).expect("the test waits"));
        for partial in [true, false] {
            joiner.join(vec![Arc::new(Loaded { path: path.clone(), import: import.clone(), partial })]);
            let joined = joiner.take(from.recv().expect("an event"));
            let Some(Ok(world)) = joined else { panic!("{joined:?}") };
            assert!(world.edges_of(0).is_none(), "no picture of it is shown yet");
            joiner.shown();
            assert!(joiner.take(from.recv().expect("an event")).is_none() && joiner.is_idle());
            assert_eq!((world.is_partial(), world.edges_of(0).is_none()), (partial, partial));
        }
    }

    /// Of the first list one part is put in place, whatever it has; then another list comes.
    #[test]
    fn a_list_that_is_not_the_newest_ends_before_its_next_part() {
        let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../samples/assembly.step");
        let import = selvedge_io::import::open(&path).expect("a sample");
        assert!(import.model.parts.len() > 4);
        let file = Arc::new(Loaded { path, import, partial: false });
        let (to, from) = mpsc::channel();
        let (begins, begun) = mpsc::channel();
        let (go_on, held) = mpsc::channel::<()>();
        let parts = Arc::new(AtomicU64::new(0));
        let counted = Arc::clone(&parts);
        let held = std::sync::Mutex::new(held);
        let join = move |files: &[Arc<Loaded>], end_old: &(dyn Fn() + Sync)| {
            World::telling(files, &|| {
                if files.len() == 1 {
                    if counted.fetch_add(1, Ordering::Relaxed) == 1 {
                        begins.send(()).expect("the test waits");
                        held.lock().expect("one thread").recv().expect("the test lets it go on");
                    }
                    end_old();
                }
            })
        };
        let mut joiner = Joiner::with(join, move |event| drop(to.send(event)));
        joiner.join(vec![Arc::clone(&file)]);
        begun.recv().expect("a part is in place");
        joiner.join(vec![Arc::clone(&file), file]);
        go_on.send(()).expect("the thread waits");
        let event = from.recv().expect("an event");
        assert!(matches!(event, JoinerEvent::Joined(2, _)), "{event:?}");
        assert_eq!(parts.load(Ordering::Relaxed), 2, "the first part, and the call that ended it");
    }

    #[test]
    fn a_panic_ends_the_work_and_not_the_thread() {
        let (to, from) = mpsc::channel();
        let join = |files: &[Arc<Loaded>], _: &(dyn Fn() + Sync)| {
            if files.is_empty() { panic!("on purpose") } else { World::new(files) }
        };
        let mut joiner = Joiner::with(join, move |event| to.send(event).expect("the test waits"));
        for _ in 0..2 {
            joiner.join(Vec::new());
            let failed = joiner.take(from.recv().expect("an event"));
            assert!(
                matches!(&failed, Some(Err(why)) if why == "The files are not put together: on purpose"),
                "{failed:?}"
            );
            assert!(!joiner.is_busy() && joiner.is_idle());
        }
    }
}
