//! The table of a run over many files: a row a picture, written as it is drawn.

use super::Drawn;
use super::task::{Shot, Task};
use crate::camera::CameraFile;
use crate::target::{self, CSV, Target};
use anyhow::{Context, Result};
use selvedge_io::import::Summary;
use serde::Serialize;
use sha2::{Digest, Sha256};
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// Facts about a file that was read.
#[derive(Clone, Debug, Default)]
pub struct Known {
    pub sha256: String,
    pub faces: usize,
    pub instances: usize,
    pub warnings: usize,
    pub complete: bool,
    pub read_s: f64,
}

impl Known {
    /// The facts about a file: its summary, how many seconds it took to read, and its hash in hexadecimal digits.
    pub fn new(path: &Path, summary: &Summary, warnings: usize, instances: usize, read_s: f64) -> Result<Self> {
        let what = || format!("{}: its SHA-256", path.display());
        let hash = hashed(path).with_context(what)?;
        let sha256 = hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect();
        Ok(Self { sha256, faces: summary.faces.drawn, instances, warnings, complete: summary.is_complete(), read_s })
    }
}

/// The hash of a file, read in pieces.
fn hashed(path: &Path) -> io::Result<Sha256> {
    let (mut file, mut hash) = (File::open(path)?, Sha256::new());
    let mut piece = vec![0; 1 << 20];
    loop {
        match file.read(&mut piece)? {
            0 => return Ok(hash),
            count => hash.update(&piece[..count]),
        }
    }
}

/// One line.
#[derive(Debug, Default, Serialize)]
struct Row<'a> {
    file: &'a str,
    sha256: &'a str,
    view: String,
    output: String,
    status: &'a str,
    error: &'a str,
    camera: String,
    faces: Option<usize>,
    instances: Option<usize>,
    warnings: Option<usize>,
    complete: Option<bool>,
    clamps: Option<u64>,
    read_s: Option<f64>,
    upload_s: Option<f64>,
    draw_s: Option<f64>,
}

pub struct Manifest {
    to: csv::Writer<File>,
}

impl Manifest {
    /// Begins a new table in the place of an old one.
    pub fn new(path: &PathBuf, inputs: &[&Path]) -> Result<Self> {
        target::check(inputs, &[Target::new(path, CSV)])?;
        let file = File::create(path).with_context(|| format!("cannot write {}", path.display()))?;
        Ok(Self { to: csv::Writer::from_writer(file) })
    }

    /// Adds a picture that was drawn.
    pub fn drawn(&mut self, task: &Task, shot: &Shot, known: &Known, drawn: &Drawn) -> Result<()> {
        let row = Row {
            sha256: &known.sha256,
            status: "drawn",
            camera: serde_json::to_string(&CameraFile::from(&drawn.camera))?,
            faces: Some(known.faces),
            instances: Some(known.instances),
            warnings: Some(known.warnings),
            complete: Some(known.complete),
            clamps: Some(drawn.clamps),
            read_s: Some(known.read_s),
            upload_s: Some(drawn.upload_s),
            draw_s: Some(drawn.draw_s),
            ..Row::default()
        };
        self.row(task, shot, row)
    }

    /// Adds pictures of a file that are not drawn now: they exist, or the file failed.
    pub fn others<'s>(
        &mut self,
        task: &Task,
        shots: impl IntoIterator<Item = &'s Shot>,
        error: Option<&str>,
    ) -> Result<()> {
        for shot in shots {
            let status = if error.is_some() { "failed" } else { "skipped" };
            self.row(task, shot, Row { status, error: error.unwrap_or_default(), ..Row::default() })?;
        }
        Ok(())
    }

    fn row(&mut self, task: &Task, shot: &Shot, row: Row<'_>) -> Result<()> {
        let output = shot.output.as_ref().or(task.sheet.as_ref()).map(|path| path.display().to_string());
        let view = shot.direction.map_or(String::new(), |direction| direction.to_string());
        let file = task.model.display().to_string();
        self.to.serialize(Row { file: &file, view, output: output.unwrap_or_default(), ..row })?;
        Ok(self.to.flush()?)
    }
}
