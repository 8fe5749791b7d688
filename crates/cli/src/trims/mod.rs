//! `selvedge trims`: compares the ways to trim on the same views: time, memory and error.
//!
//! ```text
//!                   over zoom        time, memory, error       of each way at its usual accuracy
//!   each model  ──  over sizes       time, memory, error
//!                   over accuracy    time against error        each way's own knob, at one view
//! ```
//!
//! `measure` makes the measurements. The output is a table on standard output, and in `--out` all figures as
//! JSON and CSV, and the plots of R. Wu and J. Peters, *Correct resolution rendering of trimmed spline
//! surfaces*, 2014: time over zoom, time over picture size, memory over zoom; and time over error.

mod fit;
mod measure;
mod plot;
mod report;
mod way;

pub use way::Way;

use crate::args::{Size, TrimsArgs};
use crate::camera::zoomed;
use crate::progress::during;
use crate::target::{self, CSV, JSON};
use crate::{Outcome, output, reading, remains};
use anyhow::Result;
use measure::{Bench, Row, Sweep};
use selvedge::baselines::many_holes;
use selvedge::model::Model;
use selvedge_check::Tracer;
use std::path::PathBuf;
use way::Contender;

/// Measures everything; prints and writes it.
pub fn run(args: &TrimsArgs) -> Result<Outcome> {
    let paths = models(args);
    let mut outputs = Vec::new();
    if let Some(dir) = &args.out {
        let tables = [("trims.json".to_owned(), JSON), ("trims.csv".to_owned(), CSV)];
        outputs = target::folder(&paths.iter().map(PathBuf::as_path).collect::<Vec<_>>(), dir, tables)?;
    }
    let mut rows = Vec::new();
    if args.holes > 0 {
        let model = many_holes(args.holes);
        rows.extend(measured(args, &model.name.clone(), model)?);
    }
    for path in &paths {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let import = reading::open(path, &args.read, &Default::default())?;
        remains::judge(path, &import.model)?;
        target::check_read(&import, &outputs)?;
        rows.extend(measured(args, &name, import.model)?);
    }
    output::print(&report::table(&rows))?;
    output::print(&fit::text(&rows))?;
    if let Some(dir) = &args.out {
        output::json(&dir.join("trims.json"), &rows)?;
        report::csv(&dir.join("trims.csv"), &rows)?;
        plot::all(dir, &rows)?;
    }
    let broken = rows.iter().any(|row| row.way.promises() && row.error.as_ref().is_some_and(|e| e.wrong > 0));
    Ok(if broken { Outcome::Broken } else { Outcome::Good })
}

/// The named models; without any, a sample, and two of the folder that `SELVEDGE_MODELS` names, if they exist.
fn models(args: &TrimsArgs) -> Vec<PathBuf> {
    if !args.models.is_empty() {
        return args.models.clone();
    }
    let mut usual = vec![PathBuf::from("samples/panel.step")];
    if let Some(folder) = std::env::var_os("SELVEDGE_MODELS").map(PathBuf::from) {
        usual.extend(["nist_pmi_2.stp", "m6_countersunk_screw.step"].map(|name| folder.join(name)));
    }
    let (there, missing): (Vec<_>, Vec<_>) = usual.into_iter().partition(|path| path.exists());
    missing.iter().for_each(|path| tracing::warn!("{} is not there", path.display()));
    there
}

/// All sweeps over one model.
fn measured(args: &TrimsArgs, name: &str, model: Model) -> Result<Vec<Row>> {
    let tracer = during("preparing the exact model", || Tracer::new(&model));
    let bench = Bench::new(args, name, &model, &tracer);
    let mut rows = Vec::new();
    let Size(width, height) = args.size;
    let view = |zoom| zoomed(&model, (width, height), zoom);
    for &way in &args.ways {
        let mut contender = bench.enter(Contender::usual(way))?;
        for &zoom in &args.zooms {
            rows.push(bench.row(&mut contender, Sweep::Zoom, zoom, &view(zoom))?);
        }
        for &Size(width, height) in &args.sizes {
            let camera = zoomed(&model, (width, height), args.zoom);
            rows.push(bench.row(&mut contender, Sweep::Size, args.zoom, &camera)?);
        }
        for knob in Contender::knobs(way).into_iter().filter(|_| !args.no_knobs) {
            let mut contender = bench.enter(knob)?;
            rows.push(bench.row(&mut contender, Sweep::Knob, args.zoom, &view(args.zoom))?);
        }
    }
    Ok(rows)
}
