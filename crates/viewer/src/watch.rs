//! Watches open files on the disk for changes.
//!
//! Folders are watched, not files: many programs write a new file and rename it over the old one.

use notify::{EventKind, RecommendedWatcher, RecursiveMode, Watcher as _};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// Watched files: the given name by the path.
type Watched = Arc<Mutex<BTreeMap<PathBuf, PathBuf>>>;

/// Watches files.
#[derive(Debug)]
pub struct Watcher {
    inner: RecommendedWatcher,
    files: Watched,
}

impl Watcher {
    /// `changed` is called by a thread, with the name under which a file was added; several times for one change.
    ///
    /// # Errors
    /// When the system has no more room for watchers.
    pub fn new(changed: impl Fn(PathBuf) + Send + 'static) -> notify::Result<Self> {
        let files = Watched::default();
        let known = Arc::clone(&files);
        let inner = notify::recommended_watcher(move |event: notify::Result<notify::Event>| {
            let Ok(event) = event else { return };
            if !matches!(event.kind, EventKind::Create(_) | EventKind::Modify(_)) {
                return;
            }
            let known = known.lock().unwrap_or_else(PoisonError::into_inner);
            event.paths.iter().filter_map(|path| known.get(path)).for_each(|name| changed(name.clone()));
        })?;
        Ok(Self { inner, files })
    }

    /// Watches a file, too.
    ///
    /// # Errors
    /// When its folder cannot be watched.
    pub fn add(&mut self, file: &Path) -> notify::Result<()> {
        let place = file.canonicalize()?;
        let folder = place.parent().unwrap_or(Path::new("/")).to_owned();
        self.files.lock().unwrap_or_else(PoisonError::into_inner).insert(place, file.to_owned());
        self.inner.watch(&folder, RecursiveMode::NonRecursive)
    }

    /// Watches it no more.
    pub fn remove(&mut self, file: &Path) {
        self.files.lock().unwrap_or_else(PoisonError::into_inner).retain(|_, name| name != file);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc;
    use std::time::Duration;

    #[test]
    fn written_and_replaced_files_are_reported_and_others_are_not() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = |name: &str| folder.path().join(name);
        std::fs::write(path("a"), "1").expect("written");
        let (to, from) = mpsc::channel();
        let mut watcher = Watcher::new(move |path| drop(to.send(path))).expect("a watcher");
        watcher.add(&path("a")).expect("watched");
        let told = |wait| from.recv_timeout(Duration::from_millis(wait)).ok();
        std::fs::write(path("b"), "1").expect("written");
        assert_eq!(told(200), None);
        std::fs::write(path("a"), "2").expect("written");
        assert_eq!(told(5000), Some(path("a")));
        while told(100).is_some() {}
        std::fs::rename(path("b"), path("a")).expect("renamed");
        assert_eq!(told(5000), Some(path("a")));
        while told(100).is_some() {}
        watcher.remove(&path("a"));
        std::fs::write(path("a"), "3").expect("written");
        assert_eq!(told(200), None);
    }
}
