//! Reads models within the limits of the options; progress and warnings go to standard error.

use crate::args::{ReadArgs, SubdivideArgs};
use crate::progress::importing;
use crate::{output, target};
use anyhow::{Error, Result, bail};
use selvedge_io::import::{self, Facets, Folders, Import, ImportError, Options, Stage};
use selvedge_jobs::{Bound, Exceeded, JobError, Limits, Step, Stop, Work, import_within};
use std::io;
use std::path::Path;
use std::time::Instant;

/// Reads a file with something to draw, its polygons as `subdivide` says, and prints its warnings.
pub fn open(path: &Path, read: &ReadArgs, subdivide: &SubdivideArgs) -> Result<Import> {
    open_within(path, read, subdivide, &read.limits(&named(path)))
}

/// The same as a part of the work on the file.
pub fn open_within(path: &Path, read: &ReadArgs, subdivide: &SubdivideArgs, limits: &Limits) -> Result<Import> {
    let import = described_within(path, read, subdivide, limits)?;
    judge(path, &import, read)?;
    Ok(import)
}

/// Reads a file, whether or not there is anything to draw in it.
pub fn described(path: &Path, read: &ReadArgs, subdivide: &SubdivideArgs) -> Result<Import> {
    described_within(path, read, subdivide, &read.limits(&named(path)))
}

fn described_within(path: &Path, read: &ReadArgs, subdivide: &SubdivideArgs, limits: &Limits) -> Result<Import> {
    let start = Instant::now();
    let name = named(path);
    let step = limits.begin(Work::Reading);
    let import = importing(&name, |tell| imported(path, &name, read, subdivide, (&step, tell)))?;
    tracing::info!("read {name} in {:.1?}", start.elapsed());
    if subdivide.subdivide.is_some() {
        let (faces, off) = (import.report.faces, import.report.made);
        tracing::info!("{faces} faces within {off:.2e} mm of the limit surface");
    }
    output::warnings(&import);
    Ok(import)
}

/// The file's name in messages.
pub fn named(path: &Path) -> String {
    if target::is_standard(path) { "standard input".to_owned() } else { path.display().to_string() }
}

fn imported(
    path: &Path,
    name: &str,
    read: &ReadArgs,
    subdivide: &SubdivideArgs,
    (step, tell): (&Step, &(dyn Fn(Stage) + Sync)),
) -> Result<Import> {
    let folders = Folders::new(read.search.clone());
    let options = Options {
        progress: Some(tell),
        most_bytes: Some(read.most_bytes()),
        files: Some(&folders),
        facets: if subdivide.as_openscad { Facets::AsWritten } else { Facets::Round },
        run_openscad: true,
        ..Options::default()
    };
    if subdivide.subdivide.is_some() && target::is_standard(path) {
        bail!("--subdivide reads a file, not standard input");
    }
    let import = import_within(step, &Stop::default(), &options, |options| match subdivide.subdivide {
        Some(smooth) => import::open_subdivided(path, smooth.scheme(), subdivide.within, options),
        None if target::is_standard(path) => import::read_from(&mut io::stdin().lock(), name, options),
        None => import::open_with(path, options),
    });
    import.map_err(|error| failure(error, name))
}

/// Why the work on something failed. An error of the device keeps its type, which has an exit status of its own. A limit
/// is named by its option.
pub fn failure(error: JobError, what: &str) -> Error {
    match error {
        JobError::Device(error) | JobError::Draw(error) => error.into(),
        JobError::Import(error @ (ImportError::TooLarge { .. } | ImportError::Expansion { .. })) => {
            Error::from(error).context("more than --limit-mib allows")
        }
        JobError::Import(error) => error.into(),
        JobError::Limit(exceeded) => beyond(exceeded),
        error => Error::from(error).context(what.to_owned()),
    }
}

/// The same of a limit.
pub fn beyond(exceeded: Exceeded) -> Error {
    let option = match exceeded.bound {
        Bound::Time(_) => "--limit-s",
        Bound::Memory { .. } => "--limit-mib",
    };
    Error::from(exceeded).context(format!("more than {option} allows"))
}

/// Refuses a file without anything to draw. `--strict` refuses a file that lost anything; without it, the losses are
/// printed.
pub fn judge(path: &Path, import: &Import, read: &ReadArgs) -> Result<()> {
    let summary = import.summary();
    let message = format!("{}: {summary}", named(path));
    if summary.draws_nothing() {
        bail!("{message}");
    }
    if summary.is_complete() {
        return Ok(());
    }
    if read.strict {
        bail!("--strict: {message}");
    }
    tracing::warn!("{message}");
    Ok(())
}
