//! `selvedge thumbnail`: a small picture for file managers.
//!
//! The call is that of a freedesktop thumbnailer (`Exec=selvedge thumbnail %i %o %s`): the output's name is a temporary
//! one with any ending, and the caller adds the fields of the thumbnail standard to the PNG.

use crate::args::ThumbnailArgs;
use crate::target::{self, ANY_NAME, Target};
use crate::{Outcome, device};
use anyhow::{Error, Result, bail};
use selvedge::picture::{FrameSettings, Outputs, Samples, SceneSettings};
use selvedge_jobs::{
    Backdrop, Drawer, Drawn, Job, JobError, Limits, Loaded, NAMED, ReadOptions, Source, Stop, Viewpoint, lines, read,
    write_png,
};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Draws the model from the first of the standard views.
pub fn run(args: &ThumbnailArgs) -> Result<Outcome> {
    let output = [Target::new(&args.output, ANY_NAME)];
    target::check(&[&args.model], &output)?;
    let stop = Stop::default();
    let loaded = read(Source::Path(&args.model), &ReadOptions::default(), &stop, &|_| ()).map_err(failure)?;
    let Loaded { file, model, summary, report, .. } = loaded;
    target::check(&report.files_read.iter().map(PathBuf::as_path).collect::<Vec<&Path>>(), &output)?;
    if !summary.is_complete() {
        tracing::warn!("{file}: {summary}");
    }
    let camera = Viewpoint::Standard(NAMED[0]).camera(&model, (args.size, args.size)).map_err(failure)?;
    let job = Job {
        model: Arc::clone(&model),
        camera,
        scene: SceneSettings {
            samples: Samples::Eight,
            edges: Some(lines(None, args.size)),
            ..SceneSettings::default()
        },
        frame: FrameSettings::default(),
        outputs: Outputs::default(),
        backdrop: Backdrop::Nothing,
        limits: Limits::default(),
    };
    let mut drawer = Drawer::new(&device::options(args.device.as_deref(), false)).map_err(failure)?;
    let Drawn { picture, blank, .. } = drawer.draw(&job, &stop).map_err(failure)?;
    if blank {
        bail!("{file}: nothing is seen with all of it in a picture of {0} x {0}", args.size);
    }
    target::write(&args.output, |to| Ok(write_png(to, picture.size, &picture.colour)?))?;
    Ok(Outcome::Good)
}

/// A device's error has an exit status of its own.
fn failure(error: JobError) -> Error {
    match error {
        JobError::Device(error) | JobError::Draw(error) => error.into(),
        error => error.into(),
    }
}
