//! `selvedge render`: pictures of views, one or several, of files, one or many, and the images beside them. Several views of
//! a file are drawn with frames in flight: the GPU draws the next ones while this one is written.

mod manifest;
mod many;
mod task;

pub use task::named_for;

use crate::args::{Aov, RenderArgs};
use crate::heap;
use crate::model_renderer::{self, Measured, ModelRenderer};
use crate::progress::during;
use crate::sheet::Sheet;
use crate::{Outcome, output, reading, target};
use anyhow::{Error, Result};
use selvedge::gpu::{BudgetOwner, GpuError};
use selvedge::headless::{HeadlessError, HeadlessRenderer};
use selvedge::model::Camera;
use selvedge::picture::{Outputs, Picture};
use selvedge_io::import::Import;
use selvedge_jobs::{Backdrop, Image, Limits, MOST_IN_FLIGHT, Work, legend};
use std::fmt;
use std::sync::Arc;
use std::time::Instant;
use task::{Shot, Task};

/// Draws the pictures and writes all output files.
pub fn run(args: &RenderArgs) -> Result<Outcome> {
    let tasks = Task::all(args)?;
    match tasks.as_slice() {
        [task] if !args.many.any() => alone(args, task),
        tasks => many::run(args, tasks),
    }
}

/// Draws one file: its error is the error of the call.
fn alone(args: &RenderArgs, task: &Task) -> Result<Outcome> {
    target::check(&args.cut.inputs(&task.model), &task.outputs())?;
    let limits = args.read.limits(&reading::named(&task.model));
    let (import, device) = rayon::join(
        || reading::open_within(&task.model, &args.read, &args.subdivide, &limits),
        || model_renderer::device(&args.frame, args.read.most_memory()),
    );
    let renderer = drawn(args, task, (import?, &limits), || device, &mut |_| Ok(()))?;
    Ok(if renderer.close() { Outcome::Broken } else { Outcome::Good })
}

/// The source and the cost of a picture.
struct Drawn {
    camera: Camera,
    clamps: u64,
    /// Of the model, before its first picture.
    upload_s: f64,
    draw_s: f64,
}

/// Draws all pictures of a file that has been read, within its limits, and reports each one when its files are written.
fn drawn(
    args: &RenderArgs,
    task: &Task,
    (import, limits): (Import, &Limits),
    device: impl FnOnce() -> Result<HeadlessRenderer>,
    record: &mut dyn FnMut(&Drawn) -> Result<()>,
) -> Result<ModelRenderer> {
    pictures(args, task, (import, limits), device, record).map_err(|error| {
        let is_over = gpu(&error).is_some_and(is_over_limit);
        if is_over { error.context("more than --limit-mib allows") } else { error }
    })
}

fn pictures(
    args: &RenderArgs,
    task: &Task,
    (mut import, limits): (Import, &Limits),
    device: impl FnOnce() -> Result<HeadlessRenderer>,
    record: &mut dyn FnMut(&Drawn) -> Result<()>,
) -> Result<ModelRenderer> {
    let preparing = limits.begin(Work::Preparing);
    heap::trim(); // what the import has freed
    let outputs = task.outputs();
    target::check_read(&import, &outputs)?;
    args.shown.apply(&mut import.model)?;
    args.cut.apply(&mut import.model, &args.read)?;
    let size = args.camera.pixels(&import);
    let sheet = args.contact_sheet.then(|| Sheet::new(size, task.shots.len())).transpose()?;
    let size = sheet.as_ref().map_or(size, Sheet::tile);
    let camera = |shot: &Shot| match shot.direction {
        Some(direction) => args.camera.standard(direction, &import, size),
        None => args.camera.of(&import),
    };
    let cameras = during("framing the views", || task.shots.iter().map(camera).collect::<Result<Vec<_>>>())?;
    // the renderer shares it: large models are there once
    let model = Arc::new(std::mem::take(&mut import.model));
    let begun = Instant::now();
    let look = &args.look;
    let looks = (&args.edges, look, args.lines.settings(look.style)?);
    let images = task.shots.first().map_or(Outputs::default(), |shot| wanted(&shot.aovs));
    let mut device = device()?;
    device.expect(images);
    let mut renderer = ModelRenderer::of_one(device, &args.frame, &import, (&model, &preparing), looks)?;
    let upload_s = begun.elapsed().as_secs_f64();
    let backdrop = look.backdrop(&import);
    let range = if look.style.is_curvature() { look.range(&model) } else { 1.0 };
    renderer.look(backdrop.colour(), look.style, range);
    let cameras = &cameras;
    let mut pictures = Pictures { args, task, cameras, backdrop, range, sheet, upload_s, all: Vec::new(), record };
    let mut next = 0;
    let is_small = u64::from(size.0) * u64::from(size.1) <= MOST_IN_FLIGHT;
    // a picture that is measured is drawn again before the next one
    let mut in_flight = is_small && cameras.len() > 1 && task.shots.iter().all(|shot| shot.stats.is_none());
    drop(preparing);
    let drawing = Arc::new(limits.begin(Work::Drawing));
    renderer.watch(&drawing);
    while next < cameras.len() {
        drawing.test().map_err(reading::beyond)?;
        if in_flight {
            let (first, mut begun) = (next, Instant::now());
            let taken = renderer.render_sequence(&cameras[first..], images, |nth, picture| {
                if model_renderer::is_of_one_colour(picture.colour) {
                    return Err(Alone.into());
                }
                drawing.test().map_err(reading::beyond)?;
                output::clamps(&picture.stats);
                pictures.take(first + nth, picture.to_picture(), begun.elapsed().as_secs_f64(), None)?;
                (next, begun) = (first + nth + 1, Instant::now());
                Ok(())
            });
            match taken {
                Err(error) if error.is::<Alone>() => {}
                // one at a time may fit
                Err(error) if is_out_of_memory(&error) => in_flight = false,
                taken => taken?,
            }
        }
        let Some(camera) = cameras.get(next) else { break };
        let begun = Instant::now();
        let picture = renderer.render(camera, images)?;
        let draw_s = begun.elapsed().as_secs_f64();
        if !renderer.shows(camera, &picture)? {
            renderer.blank(&task.model, &model, camera.size, &args.read)?;
        }
        drawing.test().map_err(reading::beyond)?;
        let stats = task.shots[next].stats.as_ref().map(|_| renderer.measured(camera, images, &picture.stats));
        pictures.take(next, picture, draw_s, stats.transpose()?.as_ref())?;
        next += 1;
    }
    pictures.finish()?;
    Ok(renderer)
}

/// A picture that may show nothing: another frame says so, and none is drawn in the middle of a sequence.
#[derive(Debug)]
struct Alone;

impl fmt::Display for Alone {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the picture has one colour")
    }
}

impl std::error::Error for Alone {}

/// The error of Vulkan or of memory on the device.
fn gpu(error: &Error) -> Option<&GpuError> {
    error.downcast_ref::<HeadlessError>().and_then(HeadlessError::gpu)
}

fn is_out_of_memory(error: &Error) -> bool {
    gpu(error).is_some_and(GpuError::is_out_of_memory)
}

/// Whether an object exceeds what `--limit-mib` lets the engine take, and not what the device has.
fn is_over_limit(error: &GpuError) -> bool {
    matches!(error, GpuError::OverBudget { of: BudgetOwner::Host, .. })
}

/// Where the pictures of a file go, one after the other.
struct Pictures<'a> {
    args: &'a RenderArgs,
    task: &'a Task,
    cameras: &'a [Camera],
    backdrop: Backdrop,
    /// Of curvature, in styles that show it.
    range: f64,
    sheet: Option<Sheet>,
    upload_s: f64,
    /// On the sheet so far.
    all: Vec<Drawn>,
    record: &'a mut dyn FnMut(&Drawn) -> Result<()>,
}

impl Pictures<'_> {
    /// One more, which took so long, or came so long after the one before.
    fn take(&mut self, index: usize, mut picture: Picture, draw_s: f64, stats: Option<&Measured>) -> Result<()> {
        tell(self.args, &picture);
        let (camera, upload_s) = (self.cameras[index], self.upload_s);
        let drawn = Drawn { camera, clamps: picture.stats.clamps, upload_s, draw_s };
        match &mut self.sheet {
            Some(sheet) => {
                sheet.put(index, &picture);
                self.all.push(drawn);
            }
            None => {
                self.backdrop.under(picture.size, &mut picture.colour);
                legend(self.args.look.style, self.range, picture.size, &mut picture.colour);
                self.task.shots[index].write(&camera, &picture, stats)?;
                (self.record)(&drawn)?;
            }
        }
        Ok(())
    }

    /// The contact sheet is whole.
    fn finish(mut self) -> Result<()> {
        for (sheet, path) in self.sheet.iter_mut().zip(&self.task.sheet) {
            self.backdrop.under(sheet.size, &mut sheet.pixels);
            legend(self.args.look.style, self.range, sheet.size, &mut sheet.pixels);
            output::png(path, sheet.size, &sheet.pixels)?;
        }
        self.all.iter().try_for_each(self.record)
    }
}

/// Prints the frame's cost, and the counts of marked pixels.
fn tell(args: &RenderArgs, picture: &Picture) {
    let stats = &picture.stats;
    if args.frame.highlight {
        tracing::warn!("{} pixels show contact, {} overlap", stats.contact_pixels, stats.overlap_pixels);
    }
    let gpu_ms: f64 = stats.passes.iter().map(|p| p.gpu_ms).sum();
    let trimmed = stats.trim.map_or(String::new(), |way| format!(", trimmed by way {}", way.name()));
    tracing::info!("{gpu_ms:.1} ms in {} passes on {}{trimmed}", stats.passes.len(), stats.device);
}

fn wanted(aovs: &[Aov]) -> Outputs {
    Image::outputs(aovs.iter().map(|aov| aov.image))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A device that is full is not told as the user's limit.
    #[test]
    fn only_the_users_limit_is_told_as_such() {
        let resource = || "colour".to_owned();
        let over = |of| GpuError::OverBudget { resource: resource(), bytes: 3, left: 2, most: 4, of };
        let too_large = GpuError::TooLarge { resource: resource(), bytes: 3, limit: 2 };
        assert!([over(BudgetOwner::Heap), over(BudgetOwner::Host)].iter().all(GpuError::is_out_of_memory));
        assert!(is_over_limit(&over(BudgetOwner::Host)));
        assert!(!is_over_limit(&over(BudgetOwner::Heap)) && !is_over_limit(&too_large));
        let error = Error::from(HeadlessError::Gpu(too_large)).context("a.step");
        assert!(is_out_of_memory(&error), "found below the file's name");
    }
}
