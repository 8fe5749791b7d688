//! The table of a run over many files: a row a picture, written as it is drawn.
//!
//! ```text
//!   old table ──facts of skipped pictures──▶ new table beside it ──the device is open──▶ renamed over the old one
//!                                                                                        ◀── a row a picture
//! ```
//!
//! A run that opens no device leaves the old table. A run that is killed leaves whole rows, and half a last one at
//! most.

use super::Drawn;
use super::task::{Shot, Task};
use crate::camera::CameraFile;
use crate::target::{self, CSV, Target, Waiting};
use anyhow::{Context, Result, bail};
use csv::StringRecord;
use selvedge_io::import::Summary;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::{HashMap, HashSet};
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

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
#[derive(Debug, Default, Serialize, Deserialize)]
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

/// The picture of a row: file, view and output.
type Key = [String; 3];

fn key(task: &Task, shot: &Shot) -> Key {
    let output = shot.output.as_ref().or(task.sheet.as_ref()).map(|path| path.display().to_string());
    let view = shot.direction.map_or(String::new(), |direction| direction.to_string());
    [task.model.display().to_string(), view, output.unwrap_or_default()]
}

/// The names of the columns.
fn columns() -> Result<StringRecord> {
    let mut to = csv::Writer::from_writer(Vec::new());
    to.serialize(Row::default())?;
    to.flush()?;
    let columns = csv::Reader::from_reader(to.get_ref().as_slice()).headers()?.clone();
    Ok(columns)
}

/// The rows of a table, without those of pictures that failed; none without a table.
///
/// A last row without its end, as a run that was killed may leave it, is left out with a warning. A table of other
/// columns is an error: its rows would be lost.
fn read(path: &Path) -> Result<HashMap<Key, StringRecord>> {
    if !path.is_file() {
        return Ok(HashMap::new());
    }
    let of = || format!("cannot read {}", path.display());
    let bytes = fs::read(path).with_context(of)?;
    let whole = bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |at| at + 1);
    let mut reader = csv::ReaderBuilder::new().has_headers(false).flexible(true).from_reader(&bytes[..whole]);
    let mut records = reader.records().collect::<csv::Result<Vec<_>>>().with_context(of)?;
    let columns = columns()?;
    // lines of a quoted field end before its row does
    let is_torn = records.len() > 1 && records.last().is_some_and(|last| last.len() != columns.len());
    if is_torn {
        records.pop();
    }
    if is_torn || whole < bytes.len() {
        tracing::warn!("{}: the last row has no end, as if a run was killed: it is left out", path.display());
    }
    let mut records = records.into_iter();
    if records.next().is_some_and(|first| first != columns) {
        bail!(
            "{}: the columns are not those of a manifest of this version, and --skip-existing would lose the rows: \
             move the file away or name another",
            path.display()
        );
    }
    let mut rows = HashMap::new();
    for record in records {
        let line = record.position().map_or(0, csv::Position::line);
        if record.len() != columns.len() {
            bail!("{}: line {line} has {} columns of {}", path.display(), record.len(), columns.len());
        }
        let row: Row = record.deserialize(None).with_context(of)?;
        if row.status != "failed" {
            rows.insert([row.file.to_owned(), row.view, row.output], record);
        }
    }
    Ok(rows)
}

pub struct Manifest {
    to: csv::Writer<File>,
    /// Its place, until it is there.
    waiting: Option<Waiting>,
    /// Rows of the old table that are not in this one.
    old: HashMap<Key, StringRecord>,
}

impl Manifest {
    /// A new table, which waits for [`Manifest::begin`]. With `reads_old`, pictures that are skipped keep the facts of
    /// the old table.
    pub fn new(path: &Path, inputs: &[&Path], reads_old: bool) -> Result<Self> {
        if target::is_standard(path) {
            bail!("a manifest has each row as soon as the picture is drawn: it is a file, not standard output");
        }
        target::check(inputs, &[Target::new(path, CSV)])?;
        let old = if reads_old { read(path)? } else { HashMap::new() };
        let (file, waiting) = target::begin(path)?;
        let mut to = csv::WriterBuilder::new().has_headers(false).from_writer(file);
        to.write_record(&columns()?)?;
        to.flush()?;
        Ok(Self { to, waiting, old })
    }

    /// Puts the table in the place of an old one; rows are added to it there. `todo` are the files that are not
    /// skipped.
    pub fn begin(&mut self, todo: &[&Task]) -> Result<()> {
        let again: HashSet<_> =
            todo.iter().flat_map(|task| task.shots.iter().map(move |shot| key(task, shot))).collect();
        let left = self.old.keys().filter(|key| !again.contains(*key)).count();
        if left > 0 {
            tracing::warn!(
                "{left} rows of the old manifest are of pictures that this call does not have: they are left out"
            );
        }
        let Some(waiting) = self.waiting.take() else { return Ok(()) };
        self.to.get_ref().sync_all()?;
        waiting.replace()
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

    /// Adds the pictures of a file that is skipped, with the facts of the old table.
    pub fn skipped(&mut self, task: &Task) -> Result<()> {
        for shot in &task.shots {
            let old = self.old.remove(&key(task, shot));
            let facts = old.as_ref().map_or(Ok(Row::default()), |record| record.deserialize(None))?;
            self.row(task, shot, Row { status: "skipped", error: "", ..facts })?;
        }
        Ok(())
    }

    /// Adds pictures of a file that failed.
    pub fn failed(&mut self, task: &Task, shots: &[Shot], error: &str) -> Result<()> {
        shots.iter().try_for_each(|shot| self.row(task, shot, Row { status: "failed", error, ..Row::default() }))
    }

    fn row(&mut self, task: &Task, shot: &Shot, row: Row<'_>) -> Result<()> {
        let [file, view, output] = key(task, shot);
        self.to.serialize(Row { file: &file, view, output, ..row })?;
        Ok(self.to.flush()?)
    }
}
