//! How far an import has come, told to whoever waits for it.
//!
//! ```text
//!   Read ──▶ Parse ──▶ Faces 0/n ──▶ ... ──▶ Faces n/n
//!            from one thread      from any thread, in any order
//! ```

use super::Facets;
use std::fmt;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What an import is busy with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// The file is read, and decompressed if need be.
    Read {
        /// Size of the file.
        bytes: u64,
    },
    /// Text or binary data become records.
    Parse {
        /// Size of the data, decompressed.
        bytes: u64,
    },
    /// Surfaces and trims are made, most of the work in most files.
    Faces {
        /// Faces done, whether or not they could be built.
        built: usize,
        /// All of them.
        total: usize,
    },
}

/// How to import.
#[derive(Clone, Copy, Default)]
pub struct Options<'a> {
    /// Called at the beginning of each stage and after every face, from several threads: it should
    /// return at once.
    pub progress: Option<&'a (dyn Fn(Stage) + Sync)>,
    /// Whether round solids of OpenSCAD's files are round.
    pub facets: Facets,
}

impl fmt::Debug for Options<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let progress = self.progress.map(|_| "Fn(Stage)");
        f.debug_struct("Options").field("progress", &progress).field("facets", &self.facets).finish()
    }
}

impl Options<'_> {
    /// Tells the stage, if anybody listens.
    pub(crate) fn tell(&self, stage: Stage) {
        if let Some(progress) = self.progress {
            progress(stage);
        }
    }
}

/// Counts faces as they are done, for [`Stage::Faces`].
pub(crate) struct FaceCount<'a> {
    options: Options<'a>,
    built: AtomicUsize,
    total: usize,
}

impl<'a> FaceCount<'a> {
    /// None of `total` is done.
    pub fn new(options: &Options<'a>, total: usize) -> Self {
        options.tell(Stage::Faces { built: 0, total });
        Self { options: *options, built: AtomicUsize::new(0), total }
    }

    /// One more is done.
    pub fn one(&self) {
        let built = self.built.fetch_add(1, Ordering::Relaxed) + 1;
        self.options.tell(Stage::Faces { built, total: self.total });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::{open, open_with};
    use std::path::Path;
    use std::sync::Mutex;

    #[test]
    fn every_stage_and_every_face_is_told_once() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples/bracket.step");
        let stages = Mutex::new(Vec::new());
        let tell = |stage| stages.lock().unwrap().push(stage);
        let import = open_with(&path, &Options { progress: Some(&tell), ..Options::default() }).unwrap();
        let bytes = std::fs::metadata(&path).unwrap().len();
        let stages = stages.into_inner().unwrap();
        let total = import.report.faces;
        assert_eq!(stages[..3], [Stage::Read { bytes }, Stage::Parse { bytes }, Stage::Faces { built: 0, total }]);
        let mut built: Vec<_> = stages[3..].to_vec();
        built.sort_by_key(|stage| if let Stage::Faces { built, .. } = stage { *built } else { 0 });
        assert_eq!(built, (1..=total).map(|built| Stage::Faces { built, total }).collect::<Vec<_>>());
        assert_eq!(import.model, open(&path).unwrap().model);
    }
}
