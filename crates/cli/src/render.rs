//! `selvedge render`: pictures of views, one or several, of files, one or many, and the images beside them.

mod manifest;
mod many;
mod task;

pub use task::named_for;

use crate::args::{Aov, RenderArgs};
use crate::session::{self, Session};
use crate::sheet::Sheet;
use crate::{Outcome, output, target};
use anyhow::Result;
use selvedge::headless::HeadlessRenderer;
use selvedge::model::Camera;
use selvedge::picture::{Outputs, Picture};
use selvedge_io::import::Import;
use selvedge_session::{Image, legend};
use std::sync::Arc;
use std::time::Instant;
use task::{Shot, Task};

/// Draws the pictures and writes all output files.
pub fn run(args: &RenderArgs) -> Result<Outcome> {
    let tasks = Task::all(args)?;
    match tasks.as_slice() {
        [task] if !args.many.is_asked() => alone(args, task),
        tasks => many::run(args, tasks),
    }
}

/// Draws one file: its error is the error of the call.
fn alone(args: &RenderArgs, task: &Task) -> Result<Outcome> {
    target::check(&args.cut.inputs(&task.model), &task.outputs())?;
    let (import, device) =
        rayon::join(|| session::open(&task.model, &args.read, &args.subdivide), || session::device(&args.frame));
    let session = drawn(args, task, import?, || device, &mut |_| Ok(()))?;
    Ok(if session.close() { Outcome::Broken } else { Outcome::Good })
}

/// The source and the cost of a picture.
struct Drawn {
    camera: Camera,
    clamps: u64,
    /// Of the model, before its first picture.
    upload_s: f64,
    draw_s: f64,
}

/// Draws all pictures of a file that has been read, and reports each one when its files are written.
fn drawn(
    args: &RenderArgs,
    task: &Task,
    mut import: Import,
    device: impl FnOnce() -> Result<HeadlessRenderer>,
    record: &mut dyn FnMut(&Drawn) -> Result<()>,
) -> Result<Session> {
    let outputs = task.outputs();
    target::check_read(&import, &outputs)?;
    args.cut.apply(&mut import.model, &args.read)?;
    let size = args.camera.pixels(&import);
    let mut sheet = args.contact_sheet.then(|| Sheet::new(size, task.shots.len())).transpose()?;
    let size = sheet.as_ref().map_or(size, Sheet::tile);
    let camera = |shot: &Shot| match shot.direction {
        Some(direction) => args.camera.standard(direction, &import, size),
        None => args.camera.of(&import),
    };
    let cameras = task.shots.iter().map(camera).collect::<Result<Vec<_>>>()?;
    // the renderer shares it: large models are there once
    let model = Arc::new(std::mem::take(&mut import.model));
    let begun = Instant::now();
    let look = &args.look;
    let looks = (&args.edges, look, args.lines.settings(look.style)?);
    let mut session = Session::of_one(device()?, &args.frame, &import, &model, looks)?;
    let upload_s = begun.elapsed().as_secs_f64();
    let backdrop = look.backdrop(&import);
    let range = if look.style.is_curvature() { look.range(&model) } else { 1.0 };
    session.look(backdrop.colour(), look.style, range);
    let mut all = Vec::new();
    for (index, (shot, camera)) in task.shots.iter().zip(&cameras).enumerate() {
        let begun = Instant::now();
        let mut picture = session.render(camera, wanted(&shot.aovs))?;
        let draw_s = begun.elapsed().as_secs_f64();
        tell(args, &picture);
        if !session.shows(camera, &picture)? {
            session.blank(&task.model, &model, camera.size, &args.read)?;
        }
        let drawn = Drawn { camera: *camera, clamps: picture.stats.clamps, upload_s, draw_s };
        match &mut sheet {
            Some(sheet) => {
                sheet.put(index, &picture);
                all.push(drawn);
            }
            None => {
                backdrop.under(picture.size, &mut picture.colour);
                legend(look.style, range, picture.size, &mut picture.colour);
                let stats = shot.stats.as_ref().map(|_| session.measured(camera, wanted(&shot.aovs), &picture.stats));
                shot.write(camera, &picture, stats.transpose()?.as_ref())?;
                record(&drawn)?;
            }
        }
    }
    for (sheet, path) in sheet.iter_mut().zip(&task.sheet) {
        backdrop.under(sheet.size, &mut sheet.pixels);
        legend(look.style, range, sheet.size, &mut sheet.pixels);
        output::png(path, sheet.size, &sheet.pixels)?;
    }
    all.iter().try_for_each(record)?;
    Ok(session)
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
