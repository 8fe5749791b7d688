//! Files and bytes to models that have something to draw.

use crate::error::{JobError, Stop, guarded};
use crate::limits::{Limits, Step, Work};
use selvedge::model::Model;
use selvedge_io::import::{
    self, Facets, Folders, Import, ImportError, ImportReport, NamedCamera, Options, PictureSettings, Stage, Summary,
    Warning,
};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// Where a model comes from.
#[derive(Clone, Copy, Debug)]
pub enum Source<'a> {
    /// A file. Files that it names are looked for beside it.
    Path(&'a Path),
    /// The content of one.
    Bytes {
        /// All of it, gzip or not.
        bytes: &'a [u8],
        /// The file's name in messages; its ending gives the format where the content does not.
        name: &'a str,
    },
}

/// How to read.
#[derive(Clone, Debug, Default)]
pub struct ReadOptions {
    /// Most bytes of a file, gzip undone; three quarters of the machine's memory without it.
    pub most_bytes: Option<u64>,
    /// Most time for reading the file, tested where reading reports progress, and at its end; no limit without it.
    pub most_time: Option<Duration>,
    /// Folders in which other files are looked for, too.
    pub search: Vec<PathBuf>,
}

/// A model, and the report of reading it.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The file's name in messages.
    pub file: String,
    /// Shared with the renderer.
    pub model: Arc<Model>,
    /// The drawn and the missing items.
    pub summary: Summary,
    /// What was left out or repaired.
    pub warnings: Vec<Warning>,
    /// Cameras that a scene names.
    pub cameras: Vec<NamedCamera>,
    /// A scene's picture settings.
    pub picture: PictureSettings,
    /// Counts for readers of the report.
    pub report: ImportReport,
}

/// Reads a model that has something to draw. `progress` as in [`Options::progress`].
///
/// # Errors
/// [`JobError::Import`], [`JobError::Nothing`], [`JobError::Stopped`], [`JobError::Limit`].
pub fn read(
    source: Source<'_>,
    how: &ReadOptions,
    stop: &Stop,
    progress: &(dyn Fn(Stage) + Sync),
) -> Result<Loaded, JobError> {
    let file = match source {
        Source::Path(path) => path.display().to_string(),
        Source::Bytes { name, .. } => name.to_owned(),
    };
    let step = Limits::new(&file, how.most_time, None).begin(Work::Reading);
    let folders = Folders::new(how.search.clone());
    let options = Options {
        progress: Some(progress),
        most_bytes: Some(how.most_bytes.unwrap_or_else(|| memory() / 4 * 3)),
        files: Some(&folders),
        facets: Facets::Round,
        // a library starts no program
        run_openscad: false,
        ..Options::default()
    };
    let import = import_within(&step, stop, &options, |options| match source {
        Source::Path(path) => import::open_with(path, options),
        Source::Bytes { mut bytes, name } => import::read_from(&mut bytes, name, options),
    });
    Loaded::new(file, import?)
}

/// Imports as a step of the work on a file: the step is tested where the import reports progress, and at its end, and
/// the flag where it reports progress. `import` gets the options with a progress callback that does so.
///
/// # Errors
/// [`JobError::Import`], [`JobError::Stopped`], [`JobError::Limit`], [`JobError::Panicked`].
pub fn import_within(
    step: &Step,
    stop: &Stop,
    options: &Options<'_>,
    import: impl FnOnce(&Options<'_>) -> Result<Import, ImportError>,
) -> Result<Import, JobError> {
    let progress = options.progress;
    let tell = |stage: Stage| {
        stop.check();
        step.check_at(stage);
        if let Some(progress) = progress {
            progress(stage);
        }
    };
    let import = guarded(|| Ok(import(&Options { progress: Some(&tell), ..*options })?))?;
    step.test()?;
    Ok(import)
}

impl Loaded {
    /// From an import.
    ///
    /// # Errors
    /// [`JobError::Nothing`].
    pub fn new(file: String, import: Import) -> Result<Self, JobError> {
        let summary = import.summary();
        if summary.draws_nothing() {
            return Err(JobError::Nothing { file, summary: Box::new(summary) });
        }
        let Import { model, warnings, report, cameras, picture } = import;
        Ok(Self { file, model: Arc::new(model), summary, warnings, cameras, picture, report })
    }
}

/// Bytes of memory: the machine's, or the limit of the group of processes.
pub fn memory() -> u64 {
    let mut system = sysinfo::System::new();
    system.refresh_memory();
    let group = system.cgroup_limits().map_or(u64::MAX, |limits| limits.total_memory);
    system.total_memory().min(group)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::ErrorKind;

    const BRACKET: &[u8] = include_bytes!("../../../samples/bracket.step");

    fn bytes<'a>(bytes: &'a [u8], name: &'a str) -> Result<Loaded, JobError> {
        read(Source::Bytes { bytes, name }, &ReadOptions::default(), &Stop::default(), &|_| ())
    }

    #[test]
    fn bytes_and_paths_hold_the_same() {
        let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../samples/bracket.step"));
        let of_path = read(Source::Path(path), &ReadOptions::default(), &Stop::default(), &|_| ()).expect("a model");
        let of_bytes = bytes(BRACKET, "bracket.step").expect("a model");
        assert_eq!(of_path.model, of_bytes.model);
        assert_eq!(of_bytes.file, "bracket.step");
    }

    #[test]
    fn what_cannot_be_drawn_is_an_error_that_names_the_file() {
        let path = Source::Path(Path::new("no/such/file.step"));
        let missing = read(path, &ReadOptions::default(), &Stop::default(), &|_| ()).expect_err("no file");
        assert!(missing.to_string().contains("no/such/file.step"), "{missing}");
        let kind = match &missing {
            JobError::Import(ImportError::Read { source, .. }) => Some(source.kind()),
            _ => None,
        };
        assert_eq!(kind, Some(ErrorKind::NotFound));
        let damaged = bytes(b"ISO-10303-21;", "cut.step").expect_err("no data");
        assert!(matches!(damaged, JobError::Import(_)) && damaged.to_string().starts_with("cut.step:"), "{damaged}");
        let empty = bytes(b"group();", "none.csg").expect_err("nothing");
        assert!(matches!(empty, JobError::Nothing { .. }), "{empty}");
        assert!(empty.to_string().starts_with("none.csg: nothing of it can be drawn"), "{empty}");
        let few = ReadOptions { most_bytes: Some(100), ..ReadOptions::default() };
        let source = Source::Bytes { bytes: BRACKET, name: "bracket.step" };
        let large = read(source, &few, &Stop::default(), &|_| ()).expect_err("too large");
        assert!(large.to_string().contains("100 bytes"), "{large}");
    }

    /// From the first face on: the import has passed all earlier stages then.
    #[test]
    fn a_flag_ends_an_import() {
        let stop = Stop::default();
        let at_a_face = |stage: Stage| {
            if matches!(stage, Stage::Faces { built: 1.., .. }) {
                stop.set();
            }
        };
        let source = Source::Bytes { bytes: BRACKET, name: "bracket.step" };
        let ended = read(source, &ReadOptions::default(), &stop, &at_a_face).expect_err("stopped");
        assert!(matches!(ended, JobError::Stopped), "{ended}");
    }

    #[test]
    fn a_file_has_its_time() {
        let within = |time: Duration| {
            let how = ReadOptions { most_time: Some(time), ..ReadOptions::default() };
            read(Source::Bytes { bytes: BRACKET, name: "bracket.step" }, &how, &Stop::default(), &|_| ())
        };
        let late = within(Duration::from_nanos(1)).expect_err("too late");
        assert!(matches!(late, JobError::Limit(_)), "{late}");
        assert_eq!(late.to_string(), "bracket.step: reading it takes longer than the limit of 1ns");
        assert!(within(Duration::MAX).is_ok());
    }
}
