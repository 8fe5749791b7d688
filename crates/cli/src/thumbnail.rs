//! `selvedge thumbnail`: a small picture for file managers.
//!
//! The call is that of a freedesktop thumbnailer (`Exec=selvedge thumbnail %i %o %s`): the output's name is a temporary
//! one with any ending, and the caller adds the fields of the thumbnail standard to the PNG.

use crate::args::ThumbnailArgs;
use crate::{Outcome, device, target};
use anyhow::{Error, Result};
use selvedge::picture::{FrameSettings, Outputs, Samples, SceneSettings};
use selvedge_jobs::{
    Backdrop, Drawer, Job, JobError, Limits, Loaded, NAMED, ReadOptions, Source, Stop, Viewpoint, lines, read,
    write_png,
};
use std::sync::Arc;

/// Draws the model from the first of the standard views.
pub fn run(args: &ThumbnailArgs) -> Result<Outcome> {
    let stop = Stop::default();
    let Loaded { model, .. } =
        read(Source::Path(&args.model), &ReadOptions::default(), &stop, &|_| ()).map_err(failure)?;
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
    let picture = drawer.draw(&job, &stop).map_err(failure)?.picture;
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
