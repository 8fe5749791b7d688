//! Many files: the next one is read while this one is drawn.
//!
//! ```text
//!   thread   read a ─▶ read b ───────▶ waits ─▶ read c …         at most two models in memory
//!   main              draw a: iso, top ─▶ draw b: iso, top …     one device for all
//! ```
//!
//! A file that fails is reported, and the others are drawn; a device that fails ends the run. With a limit of memory no
//! file is read ahead, and each has a device of its own: the process holds what one file takes, whatever came before.

use super::manifest::{Known, Manifest};
use super::task::Task;
use super::{Drawn, drawn};
use crate::args::RenderArgs;
use crate::model_renderer::{self, ModelRenderer};
use crate::progress::{Files, files};
use crate::{Outcome, explained, heap, reading, target};
use anyhow::{Error, Result};
use selvedge::gpu::GpuError;
use selvedge::headless::{HeadlessError, HeadlessRenderer};
use selvedge_io::import::Import;
use selvedge_jobs::Limits;
use std::path::Path;
use std::sync::mpsc;
use std::thread;
use std::time::Instant;

/// Draws all files.
pub fn run(args: &RenderArgs, tasks: &[Task]) -> Result<Outcome> {
    let inputs: Vec<&Path> = tasks.iter().map(|task| task.model.as_path()).collect();
    let (done, todo): (Vec<&Task>, Vec<&Task>) = tasks.iter().partition(|t| args.many.skip_existing && t.is_done());
    let table = args.many.manifest.as_ref();
    let mut manifest = table.map(|path| Manifest::new(path, &inputs, args.many.skip_existing)).transpose()?;
    for task in &done {
        manifest.iter_mut().try_for_each(|manifest| manifest.skipped(task))?;
    }
    let open = || model_renderer::opened(&args.frame, args.read.most_memory());
    let device = (!todo.is_empty()).then(open).transpose()?;
    manifest.iter_mut().try_for_each(|manifest| manifest.begin(&todo))?;
    let mut run = Run { args, manifest, device, failed: 0, complained: false };
    if !todo.is_empty() {
        run.all(&todo)?;
    }
    let complained = run.device.take().is_some_and(model_renderer::close) | run.complained;
    let drawn = todo.len() - run.failed;
    eprintln!("{drawn} of {} files drawn, {} skipped, {} failed", tasks.len(), done.len(), run.failed);
    Ok(if complained || run.failed > 0 { Outcome::Broken } else { Outcome::Good })
}

struct Run<'a> {
    args: &'a RenderArgs,
    manifest: Option<Manifest>,
    /// `None` after a file that failed on the device, and after each file with a limit of memory: the next opens it.
    device: Option<HeadlessRenderer>,
    failed: usize,
    complained: bool,
}

/// A file that was read, its facts, and its limits.
type Opened = (Import, Known, Limits);

impl Run<'_> {
    fn all(&mut self, todo: &[&Task]) -> Result<()> {
        let args = self.args;
        let bar = files(todo.len());
        let hashed = self.manifest.is_some();
        if args.read.most_memory().is_some() {
            for task in todo {
                let opened = self.open().and_then(|()| imported(args, task, hashed));
                self.one(task, opened, &bar)?;
                self.free();
            }
            return Ok(());
        }
        thread::scope(|scope| {
            let (send, read) = mpsc::sync_channel(0);
            scope.spawn(move || {
                for task in todo {
                    if send.send((*task, imported(args, task, hashed))).is_err() {
                        break; // the run ended
                    }
                }
            });
            for (task, import) in read {
                self.one(task, import, &bar)?;
            }
            Ok(())
        })
    }

    /// Opens the device, if it is not open.
    fn open(&mut self) -> Result<()> {
        if self.device.is_none() {
            self.device = Some(model_renderer::device(&self.args.frame, self.args.read.most_memory())?);
        }
        Ok(())
    }

    /// Frees the device, and with it the model that was drawn.
    fn free(&mut self) {
        self.complained |= self.device.take().is_some_and(model_renderer::close);
        heap::trim();
    }

    /// Draws one file; an error ends the run.
    fn one(&mut self, task: &Task, opened: Result<Opened>, bar: &Files) -> Result<()> {
        let (name, mut count) = (reading::named(&task.model), 0);
        let result = opened.and_then(|opened| self.drawn(task, opened, &mut count));
        bar.one(&name);
        let Err(error) = result else { return Ok(()) };
        self.failed += 1;
        // errors of the renderer name no file
        let error = if explained(&error).contains(&name) { error } else { error.context(name) };
        let message = explained(&error);
        let left = &task.shots[count.min(task.shots.len())..];
        self.manifest.iter_mut().try_for_each(|manifest| manifest.failed(task, left, &message))?;
        if self.args.many.fail_fast || of_device(&error) {
            return Err(error);
        }
        bar.tell(&format!("selvedge: {message}"));
        Ok(())
    }

    fn drawn(&mut self, task: &Task, (import, known, limits): Opened, count: &mut usize) -> Result<()> {
        let (args, manifest) = (self.args, &mut self.manifest);
        target::check(&args.cut.inputs(&task.model), &task.outputs())?;
        let kept = self.device.take();
        let device = || kept.map_or_else(|| model_renderer::device(&args.frame, args.read.most_memory()), Ok);
        let mut record = |drawn: &Drawn| -> Result<()> {
            let shot = &task.shots[*count];
            *count += 1;
            manifest.iter_mut().try_for_each(|manifest| manifest.drawn(task, shot, &known, drawn))
        };
        let renderer = drawn(args, task, (import, &limits), device, &mut record)?;
        self.complained |= renderer.complaints();
        self.device = Some(ModelRenderer::into_headless(renderer));
        Ok(())
    }
}

/// Reads a file, with the facts for a manifest.
fn imported(args: &RenderArgs, task: &Task, hashed: bool) -> Result<Opened> {
    let begun = Instant::now();
    let limits = args.read.limits(&reading::named(&task.model));
    let import = reading::open_within(&task.model, &args.read, &args.subdivide, &limits)?;
    let read_s = begun.elapsed().as_secs_f64();
    let of = || Known::new(&task.model, &import.summary(), import.warnings.len(), import.model.instances.len(), read_s);
    let known = if hashed { of()? } else { Known::default() };
    Ok((import, known, limits))
}

/// Whether the error is the device's, so that no later file can be drawn.
fn of_device(error: &Error) -> bool {
    let own = |error: &HeadlessError| {
        matches!(error, HeadlessError::Render(_) | HeadlessError::NeverComplete)
            || error.gpu().is_some_and(GpuError::is_out_of_memory)
    };
    error.downcast_ref::<HeadlessError>().is_some_and(|error| !own(error))
}
