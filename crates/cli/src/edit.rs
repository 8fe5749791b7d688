//! `selvedge bench --edit`: a trim loop dragged once a frame.
//!
//! The loop is one of the face with the most loops; it goes around a small circle. Some frames are drawn
//! again from a fresh upload of the edited model: every pixel must be the same.

use crate::args::{BenchArgs, Size};
use crate::model_renderer::ModelRenderer;
use crate::progress::during;
use crate::series::{Gathered, Row};
use crate::target::{self, JSON, Target};
use crate::{Outcome, bench, output, path, reading};
use anyhow::{Result, bail};
use glam::DVec2;
use selvedge::model::{LoopAt, Model, TrimLoop};
use selvedge::picture::Outputs;
use selvedge_io::import::Import;
use serde::Serialize;
use std::f64::consts::TAU;
use std::path::Path;
use std::time::Instant;

/// Edits, a frame each.
const FRAMES: usize = 100;
/// Every so many frames the picture is compared with that of a fresh upload.
const COMPARED: usize = 10;
/// Radius of the circle that the loop goes around, relative to its size.
const REACH: f64 = 0.1;

/// Everything measured on one model.
#[derive(Debug, Serialize)]
struct Report {
    model: String,
    part: usize,
    face: usize,
    loops: usize,
    curves: usize,
    compared: usize,
    different: usize,
    rows: Vec<Row>,
}

/// Drags a loop of every model; prints a table each and writes them all.
pub fn run(args: &BenchArgs) -> Result<Outcome> {
    let mut outputs = Vec::new();
    if let Some(dir) = &args.out {
        outputs = target::folder(&bench::inputs(args), dir, [("edit.json".to_owned(), JSON)])?;
    }
    let mut reports = Vec::new();
    let mut complained = false;
    for model in &args.models {
        let (report, complains) = drag(args, model, &outputs)?;
        output::print(&report.text())?;
        complained |= complains || report.different > 0;
        reports.push(report);
    }
    if let Some(dir) = &args.out {
        output::json(&dir.join("edit.json"), &reports)?;
    }
    Ok(if complained { Outcome::Broken } else { Outcome::Good })
}

fn drag(args: &BenchArgs, path: &Path, outputs: &[Target]) -> Result<(Report, bool)> {
    let mut import = reading::open(path, &args.read, &Default::default())?;
    target::check_read(&import, outputs)?;
    let Some(at) = busiest(&import.model) else { bail!("{}: no face has a loop", path.display()) };
    let Size(width, height) = args.size;
    let camera = path::camera(import.model.bounds(), (width, height), 0, FRAMES);
    let mut renderer = ModelRenderer::editable(&args.frame, &import)?;
    let start = loop_at(&import, at).clone();
    let (lo, hi) = start.bounds();
    let mut gathered = Gathered::default();
    let mut report = Report {
        model: path.display().to_string(),
        part: at.part,
        face: at.face,
        loops: import.model.parts[at.part].faces[at.face].loops.len(),
        curves: start.curves().len(),
        compared: 0,
        different: 0,
        rows: Vec::new(),
    };
    renderer.render(&camera, Outputs::default())?;
    for frame in 1..=FRAMES {
        let turn = DVec2::from_angle(TAU * frame as f64 / FRAMES as f64) - DVec2::X;
        let moved = start.translated(turn * (hi - lo) * REACH)?;
        let begun = Instant::now();
        renderer.edit(at, &moved)?;
        gathered.push("edit, on the CPU", "ms", begun.elapsed().as_secs_f64() * 1e3);
        let picture = renderer.render(&camera, Outputs::default())?;
        gathered.push("from the edit to the picture in memory", "ms", begun.elapsed().as_secs_f64() * 1e3);
        gathered.push("bytes sent for the edit", "", picture.stats.edit_bytes as f64);
        gathered.push("all passes", "ms", picture.stats.passes.iter().map(|p| p.gpu_ms).sum());
        for pass in picture.stats.passes.iter().filter(|p| p.name == "trim table") {
            gathered.push("pass: trim table", "ms", pass.gpu_ms);
        }
        import.model.parts[at.part].faces[at.face].loops[at.trim_loop] = moved;
        if frame % COMPARED == 0 {
            let fresh = during("uploading the edited model", || ModelRenderer::editable(&args.frame, &import))?
                .render(&camera, Outputs::default())?;
            report.compared += 1;
            report.different += usize::from(fresh.colour != picture.colour);
        }
    }
    report.rows = gathered.rows();
    Ok((report, renderer.complaints()))
}

fn loop_at(import: &Import, at: LoopAt) -> &TrimLoop {
    &import.model.parts[at.part].faces[at.face].loops[at.trim_loop]
}

/// The last loop of the placed face that has the most.
fn busiest(model: &Model) -> Option<LoopAt> {
    let placed = |part: usize| model.instances.iter().any(|i| i.part == part);
    let parts = model.parts.iter().enumerate().filter(|(part, _)| placed(*part));
    let faces =
        parts.flat_map(|(part, p)| p.faces.iter().enumerate().map(move |(face, f)| (part, face, f.loops.len())));
    let (part, face, loops) = faces.max_by_key(|&(_, _, loops)| loops)?;
    Some(LoopAt { part, face, trim_loop: loops.checked_sub(1)? })
}

impl Report {
    fn text(&self) -> String {
        let mut table = output::table(["", "unit", "median", "95 %", "largest"]);
        for row in &self.rows {
            let number = |x: f64| if row.unit == "ms" { format!("{x:.3}") } else { format!("{x:.0}") };
            table.add_row([&row.name, row.unit, &number(row.median), &number(row.p95), &number(row.largest)]);
        }
        let Self { model, part, face, loops, curves, compared, different, .. } = self;
        format!(
            "{model}: part {part}, face {face} of {loops} loops, the last of {curves} curves dragged for {FRAMES} frames\n\
             {table}\n{different} of {compared} pictures differ from a fresh upload"
        )
    }
}
