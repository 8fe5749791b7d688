//! Progress of an import, reported to the caller.
//!
//! ```text
//!   Read ──▶ Program … ──▶ Parse ──▶ Records b/n … n/n ──▶ Bodies 0/n … ──▶ Faces 0/n ──▶ … ──▶ Faces n/n
//!            .scad alone            from one thread: records of         from any thread, in any order: of STEP
//!                                   STEP and OpenSCAD, bodies of STEP   and IGES
//! ```

use super::{Facets, Files, Preview};
use std::fmt;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// The stage of an import.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// The file is read, and decompressed if need be.
    Read {
        /// Size of the file.
        bytes: u64,
    },
    /// The installed `openscad` runs the file: see [`Options::run_openscad`].
    Program {
        /// Number of its process; what it starts descends from that.
        process: u32,
    },
    /// Text or binary data become records.
    Parse {
        /// Size of the data, decompressed.
        bytes: u64,
    },
    /// So far in the text.
    Records {
        /// Bytes read.
        read: u64,
        /// All of them.
        bytes: u64,
    },
    /// Records become bodies: their faces and edges are looked up.
    Bodies {
        /// Bodies done before this one.
        mapped: usize,
        /// All of them.
        total: usize,
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
    /// Called at the beginning of each stage, of STEP files before every body, after every face and some bytes of
    /// text, of OpenSCAD files between nodes, and a hundred times a second while `openscad` runs, from several
    /// threads. A stage is repeated as it is after each megabyte of a file on a disk that is read or decompressed, but
    /// not of a stream or of a file beside the model; and after some 65,000 entities, lines or triangles of STEP, IGES,
    /// OBJ, STL and OFF. It should return at once, or unwind to
    /// end the import, as [`Stop::check`](super::Stop::check) does. Files that a file names have stages of their own.
    pub progress: Option<&'a (dyn Fn(Stage) + Sync)>,
    /// Takes the finished parts of STEP and IGES files and of assemblies in several files, while the rest is read.
    pub preview: Option<&'a dyn Preview>,
    /// Most bytes of a file, before and after gzip is undone. Offsets are 32 bits wide: the limit is 4 GiB at most, and
    /// by default.
    pub most_bytes: Option<u64>,
    /// Finds parts of an assembly in other files; without it they are left out, each with a warning. Materials of OBJ,
    /// buffers of glTF and files that OpenSCAD imports are read from below the model's folder, else found by this.
    /// [`Folders`](super::Folders) looks on a disk.
    pub files: Option<&'a dyn Files>,
    /// Whether round solids of OpenSCAD's files are round.
    pub facets: Facets,
    /// Whether [`open_with`](super::open_with) runs a file that ends in `.scad` by the `openscad` on the path, and reads
    /// what that writes. `openscad` and all that it starts end with the import. Without this, such a file is read as
    /// flattened text.
    pub run_openscad: bool,
}

impl fmt::Debug for Options<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (progress, files) = (self.progress.map(|_| "Fn(Stage)"), self.files.map(|_| "Files"));
        let preview = self.preview.map(|_| "Preview");
        f.debug_struct("Options")
            .field("progress", &progress)
            .field("preview", &preview)
            .field("most_bytes", &self.most_bytes)
            .field("files", &files)
            .field("facets", &self.facets)
            .field("run_openscad", &self.run_openscad)
            .finish()
    }
}

impl Options<'_> {
    /// The limit that holds.
    pub(crate) fn most_bytes(&self) -> u64 {
        self.most_bytes.unwrap_or(u64::MAX).min(u32::MAX.into())
    }

    /// Reports the stage, if there is a callback.
    pub(crate) fn tell(&self, stage: Stage) {
        if let Some(progress) = self.progress {
            progress(stage);
        }
    }
}

/// Work between two repetitions of a stage by a [`Pulse`]: an entity that is looked up, a line or a triangle is one. So
/// much takes some hundredths of a second.
pub(crate) const BEAT: u64 = 1 << 16;

/// Repeats the stage while work goes on that tells nothing by itself, so that a callback can end that, too.
#[derive(Debug)]
pub(crate) struct Pulse<'a> {
    options: Options<'a>,
    stage: Mutex<Stage>,
    done: AtomicU64,
}

impl<'a> Pulse<'a> {
    /// Nothing of a stage is done, which the caller has told.
    pub fn new(options: &Options<'a>, stage: Stage) -> Self {
        Self { options: *options, stage: Mutex::new(stage), done: AtomicU64::new(0) }
    }

    /// Tells the next stage.
    pub fn tell(&self, stage: Stage) {
        *self.stage.lock().unwrap_or_else(PoisonError::into_inner) = stage;
        self.options.tell(stage);
    }

    /// So much more is done, by any thread; tells the stage where a multiple of [`BEAT`] is passed.
    pub fn work(&self, amount: usize) {
        let before = self.done.fetch_add(amount as u64, Ordering::Relaxed);
        if before / BEAT != (before + amount as u64) / BEAT {
            // the callback may unwind: the lock is free by then
            let stage = *self.stage.lock().unwrap_or_else(PoisonError::into_inner);
            self.options.tell(stage);
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

    /// Counts a face.
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

    #[test]
    fn every_stage_and_every_face_is_reported_once() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../samples/bracket.step");
        let stages = Mutex::new(Vec::new());
        let tell = |stage| stages.lock().unwrap().push(stage);
        let import = open_with(&path, &Options { progress: Some(&tell), ..Options::default() }).unwrap();
        let bytes = std::fs::metadata(&path).unwrap().len();
        let stages = stages.into_inner().unwrap();
        let total = import.report.faces;
        let text = [0, bytes].map(|read| Stage::Records { read, bytes });
        let bodies = [Stage::Bodies { mapped: 0, total: 1 }];
        let first = [Stage::Read { bytes }, Stage::Parse { bytes }];
        let begun = [&first[..], &text, &bodies, &[Stage::Faces { built: 0, total }]].concat();
        assert_eq!(stages[..6], begun);
        let mut built: Vec<_> = stages[6..].to_vec();
        built.sort_by_key(|stage| if let Stage::Faces { built, .. } = stage { *built } else { 0 });
        assert_eq!(built, (1..=total).map(|built| Stage::Faces { built, total }).collect::<Vec<_>>());
        assert_eq!(import.model, open(&path).unwrap().model);
    }

    /// By four threads, whose amounts pass a multiple one after another.
    #[test]
    fn a_stage_is_repeated_after_so_much_work() {
        let told = AtomicUsize::new(0);
        let tell = |stage| {
            assert_eq!(stage, Stage::Parse { bytes: 7 });
            told.fetch_add(1, Ordering::Relaxed);
        };
        let options = Options { progress: Some(&tell), ..Options::default() };
        let pulse = Pulse::new(&options, Stage::Parse { bytes: 7 });
        let (times, amount) = (500, 1000);
        let work = || (0..times).for_each(|_| pulse.work(amount));
        std::thread::scope(|scope| (0..4).for_each(|_| _ = scope.spawn(work)));
        assert_eq!(told.load(Ordering::Relaxed), 4 * times * amount / BEAT as usize);
    }

    /// Each hull, and a place in every so many bytes of text.
    #[test]
    fn the_text_of_openscad_is_reported() {
        let stages = Mutex::new(Vec::new());
        let tell = |stage| stages.lock().unwrap().push(stage);
        let options = Options { progress: Some(&tell), ..Options::default() };
        let text = format!("{}cube(size = 1);", "cube(size = 1);\n".repeat(10_000));
        crate::import::scad_with(text.as_bytes(), "t.csg", &options).unwrap();
        let long = stages.lock().unwrap().split_off(0);
        assert!((2..4).contains(&long.len()), "{long:?}");
        let all = text.len() as u64;
        assert!(long.iter().all(|s| matches!(s, Stage::Records { read, bytes } if read <= bytes && *bytes == all)));
        if cfg!(feature = "scad-facets") {
            let hull = "hull() { cube(size = 1); }\n".repeat(5);
            crate::import::scad_with(hull.as_bytes(), "t.csg", &options).unwrap();
            assert_eq!(stages.lock().unwrap().len(), 5);
        }
    }

    /// IGES has no bodies that are mapped first.
    #[test]
    fn faces_of_iges_are_reported() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/import/iges/tests/cylinder.igs");
        let stages = Mutex::new(Vec::new());
        let tell = |stage| stages.lock().unwrap().push(stage);
        let import = open_with(&path, &Options { progress: Some(&tell), ..Options::default() }).unwrap();
        let total = import.report.faces;
        let mut built: Vec<_> = stages.into_inner().unwrap()[2..].to_vec();
        built.sort_by_key(|stage| if let Stage::Faces { built, .. } = stage { *built } else { usize::MAX });
        assert_eq!(built, (0..=total).map(|built| Stage::Faces { built, total }).collect::<Vec<_>>());
        assert!(total > 1);
    }
}
