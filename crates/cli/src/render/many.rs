//! Many files: the next one is read while this one is drawn.
//!
//! ```text
//!   thread   read a ─▶ read b ───────▶ waits ─▶ read c …         at most two models in memory
//!   main              draw a: iso, top ─▶ draw b: iso, top …     one device for all
//! ```
//!
//! A file that fails is reported, and the others are drawn; a device that fails ends the run.

use super::manifest::{Known, Manifest};
use super::task::Task;
use super::{Drawn, drawn};
use crate::args::RenderArgs;
use crate::progress::{Files, files};
use crate::session::{self, Session};
use crate::{Outcome, explained, target};
use anyhow::{Error, Result};
use selvedge::headless::{HeadlessError, HeadlessRenderer};
use selvedge_io::import::Import;
use std::path::Path;
use std::sync::mpsc;
use std::thread;
use std::time::Instant;

/// Draws all files.
pub fn run(args: &RenderArgs, tasks: &[Task]) -> Result<Outcome> {
    let inputs: Vec<&Path> = tasks.iter().map(|task| task.model.as_path()).collect();
    let mut manifest = args.many.manifest.as_ref().map(|path| Manifest::new(path, &inputs)).transpose()?;
    let (done, todo): (Vec<&Task>, Vec<&Task>) = tasks.iter().partition(|t| args.many.skip_existing && t.is_done());
    for task in &done {
        manifest.iter_mut().try_for_each(|manifest| manifest.others(task, &task.shots, None))?;
    }
    let mut run = Run { args, manifest, device: None, failed: 0, complained: false };
    if !todo.is_empty() {
        run.device = Some(session::opened(&args.frame)?);
        run.all(&todo)?;
    }
    let complained = run.device.take().is_some_and(session::close) | run.complained;
    let drawn = todo.len() - run.failed;
    eprintln!("{drawn} of {} files drawn, {} skipped, {} failed", tasks.len(), done.len(), run.failed);
    Ok(if complained || run.failed > 0 { Outcome::Broken } else { Outcome::Good })
}

struct Run<'a> {
    args: &'a RenderArgs,
    manifest: Option<Manifest>,
    /// `None` after a file that failed on the device: the next file opens it again.
    device: Option<HeadlessRenderer>,
    failed: usize,
    complained: bool,
}

impl Run<'_> {
    fn all(&mut self, todo: &[&Task]) -> Result<()> {
        let args = self.args;
        let bar = files(todo.len());
        let hashed = self.manifest.is_some();
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

    /// Draws one file; an error ends the run.
    fn one(&mut self, task: &Task, import: Result<(Import, Known)>, bar: &Files) -> Result<()> {
        let mut count = 0;
        let result = import.and_then(|(import, known)| self.drawn(task, import, &known, &mut count));
        bar.one(&session::named(&task.model));
        let Err(error) = result else { return Ok(()) };
        self.failed += 1;
        let told = explained(&error);
        let left = &task.shots[count.min(task.shots.len())..];
        self.manifest.iter_mut().try_for_each(|manifest| manifest.others(task, left, Some(&told)))?;
        if self.args.many.fail_fast || of_device(&error) {
            return Err(error);
        }
        bar.tell(&format!("selvedge: {told}"));
        Ok(())
    }

    fn drawn(&mut self, task: &Task, import: Import, known: &Known, count: &mut usize) -> Result<()> {
        let (args, manifest) = (self.args, &mut self.manifest);
        target::check(&args.cut.inputs(&task.model), &task.outputs())?;
        let kept = self.device.take();
        let device = || kept.map_or_else(|| session::device(&args.frame), Ok);
        let mut record = |drawn: &Drawn| -> Result<()> {
            let shot = &task.shots[*count];
            *count += 1;
            manifest.iter_mut().try_for_each(|manifest| manifest.drawn(task, shot, known, drawn))
        };
        let session = drawn(args, task, import, device, &mut record)?;
        self.complained |= session.complaints();
        self.device = Some(Session::into_renderer(session));
        Ok(())
    }
}

/// Reads a file, with the facts for a manifest.
fn imported(args: &RenderArgs, task: &Task, hashed: bool) -> Result<(Import, Known)> {
    let begun = Instant::now();
    let import = session::open(&task.model, &args.read, &args.subdivide)?;
    let read_s = begun.elapsed().as_secs_f64();
    let of = || Known::new(&task.model, &import.summary(), import.warnings.len(), import.model.instances.len(), read_s);
    let known = if hashed { of()? } else { Known::default() };
    Ok((import, known))
}

/// Whether the error is the device's, so that no later file can be drawn.
fn of_device(error: &Error) -> bool {
    let own = |error: &HeadlessError| matches!(error, HeadlessError::Render(_) | HeadlessError::NeverComplete);
    error.downcast_ref::<HeadlessError>().is_some_and(|error| !own(error))
}
