//! `selvedge bench`: the cost of a frame, next to its error.
//!
//! Some frames of the path are judged against the exact model, so the same table shows speed and error.
//!
//! Frames are drawn as a viewer draws them: the warm-up builds the trim table that serves all views from about the same
//! distance, and later frames reuse it. A standing view (`--motion still`) is drawn in turn with every pass and with the
//! visibility of the frame before; rows of the latter begin with `reused:`.
//!
//! The first frame is not in the table: the driver compiles for it, and its time is reported separately.

use crate::args::{BenchArgs, Motion, Size};
use crate::model_renderer::{self, FirstFrame, ModelRenderer};
use crate::progress::during;
use crate::series::{Gathered, Row};
use crate::target::{self, CSV, JSON, Target};
use crate::{Outcome, camera, edit, output, path, reading, verdict};
use anyhow::Result;
use comfy_table::CellAlignment;
use selvedge::model::Camera;
use selvedge::picture::{FrameStats, Outputs};
use selvedge_check::{Judgement, Tracer};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Frames before the first measured one. In them buffers grow and the driver compiles; the report has the first one in a
/// line of its own.
const WARM_UP_FRAMES: usize = 3;
/// Pixels judged in each of them, beside those at which the face changes.
const JUDGED_SAMPLES: usize = 2_000;

/// Everything measured on one model.
#[derive(Debug, Serialize)]
struct Report {
    model: String,
    faces: usize,
    face_instances: usize,
    missing_faces: usize,
    size: [u32; 2],
    tolerance_px: f64,
    device: String,
    driver: String,
    first_frame: Option<FirstFrame>,
    /// Of the path.
    frames: usize,
    throughput: Option<Throughput>,
    rows: Vec<Row>,
    error: Error,
}

/// All frames of the path with several in flight: means of a picture.
#[derive(Clone, Copy, Debug, Serialize)]
struct Throughput {
    pictures_per_second: f64,
    /// Wall clock, with the copy of the picture by the CPU.
    wall_ms: f64,
    /// All passes on the GPU, without its copy to host memory.
    passes_ms: f64,
    wall_over_passes: f64,
}

/// The worst of the judged frames.
#[derive(Debug, Default, Serialize)]
struct Error {
    judged_frames: usize,
    judged_pixels: u64,
    wrong_pixels: u64,
    worst_shift_px: f64,
    worst_depth: f64,
    worst_normal_deg: f64,
}

/// Measures every model; prints a table each and writes them all.
pub fn run(args: &BenchArgs) -> Result<Outcome> {
    if args.edit {
        return edit::run(args);
    }
    let mut outputs = Vec::new();
    if let Some(dir) = &args.out {
        let files = [("bench.json", JSON), ("bench.csv", CSV)];
        outputs = target::folder(&inputs(args), dir, files.map(|(name, form)| (name.to_owned(), form)))?;
    }
    let mut reports = Vec::new();
    let mut outcome = Outcome::Good;
    for model in &args.models {
        let (report, complained) = measure(args, model, &outputs)?;
        output::print(&report.text())?;
        let clamped = report.rows.iter().any(|r| r.name == CLAMPS && r.largest > 0.0);
        if complained || clamped || report.error.wrong_pixels > 0 {
            outcome = Outcome::Broken;
        }
        reports.push(report);
    }
    if let Some(dir) = &args.out {
        output::json(&dir.join("bench.json"), &reports)?;
        csv(&dir.join("bench.csv"), &reports)?;
    }
    Ok(outcome)
}

/// The files that are read.
pub fn inputs(args: &BenchArgs) -> Vec<&Path> {
    args.models.iter().map(PathBuf::as_path).chain(args.cut.trim_by.as_deref()).collect()
}

/// One model along the path; true when the validation layer complained.
fn measure(args: &BenchArgs, model: &Path, outputs: &[Target]) -> Result<(Report, bool)> {
    let mut import = reading::open(model, &args.read, &Default::default())?;
    target::check_read(&import, outputs)?;
    args.cut.apply(&mut import.model, &args.read)?;
    let bounds = camera::bounds(&import.model);
    let Size(width, height) = args.size;
    let size = (width, height);
    let camera = |index| match args.motion {
        Motion::Path => path::camera(bounds, size, index, args.frames),
        Motion::Turn => path::turned(bounds, size, index),
        Motion::Corner => path::around_a_corner(bounds, size, index),
        Motion::Within => path::from_within(bounds, size, index),
        Motion::Still => path::turned(bounds, size, 0),
    };
    let mut renderer =
        ModelRenderer::smooth(model_renderer::opened(&args.frame, None)?, &args.frame, &import, &args.edges)?;
    let mut stats = FrameStats::default();
    let mut gathered = Gathered::default();
    renderer.record_all(args.motion == Motion::Still);
    during(&format!("{}: {} frames", model.display(), args.frames), || -> Result<()> {
        for _ in 0..WARM_UP_FRAMES {
            let picture = renderer.render(&camera(0), Outputs::default())?;
            if !renderer.shows(&camera(0), &picture)? {
                renderer.blank(model, &import.model, size, &args.read)?;
            }
        }
        for index in 0..args.frames {
            stats = timed(&mut renderer, &camera(index), &mut gathered)?;
            if args.motion == Motion::Still {
                renderer.record_all(false);
                timed(&mut renderer, &camera(index), &mut gathered)?;
                renderer.record_all(true);
            }
        }
        Ok(())
    })?;
    let throughput = args.throughput.then(|| {
        // the path is closed: its end warms up for its beginning, and its beginning is drawn on while its end is
        // measured
        let from_end = WARM_UP_FRAMES * (args.frames - 1);
        let cameras = (0..args.frames + 2 * WARM_UP_FRAMES).map(|nth| camera((nth + from_end) % args.frames));
        let cameras: Vec<Camera> = cameras.collect();
        during("drawing with several frames in flight", || throughput(&mut renderer, &cameras))
    });
    let throughput = throughput.transpose()?;
    let mut error = Error::default();
    let mut tracer = None;
    for index in judged(args.frames, args.judged) {
        let tracer = tracer.get_or_insert_with(|| during("preparing the exact model", || Tracer::new(&import.model)));
        let camera = camera(index);
        let picture = renderer.render(&camera, Outputs::ALL)?;
        let what = format!("frame {index}");
        error.add(&verdict::of(tracer, &camera, &picture, JUDGED_SAMPLES, args.frame.tolerance, 1.0, &what));
    }
    let report = Report {
        model: model.display().to_string(),
        faces: import.model.face_count(),
        face_instances: import.model.face_instance_count(),
        missing_faces: import.report.dropped.total(),
        size: [width, height],
        tolerance_px: args.frame.tolerance,
        device: stats.device,
        driver: stats.driver,
        first_frame: renderer.first_frame(),
        frames: args.frames,
        throughput,
        rows: gathered.rows(),
        error,
    };
    Ok((report, renderer.complaints()))
}

/// Draws pictures with several frames in flight, and measures all but [`WARM_UP_FRAMES`] at either end: as many frames
/// are in flight when the clock starts as when it stops. Each picture is copied, as a caller that stores it would.
fn throughput(renderer: &mut ModelRenderer, cameras: &[Camera]) -> Result<Throughput> {
    let measured = WARM_UP_FRAMES..cameras.len() - WARM_UP_FRAMES;
    let (mut start, mut wall_ms, mut passes_ms, mut kept) = (Instant::now(), 0.0, 0.0, Vec::new());
    renderer.render_sequence(cameras, Outputs::default(), |nth, picture| {
        output::clamps(&picture.stats);
        kept.clear();
        kept.extend_from_slice(picture.colour);
        if measured.contains(&nth) {
            passes_ms += all_passes(&picture.stats);
            wall_ms = start.elapsed().as_secs_f64() * 1e3;
        } else if nth < measured.start {
            start = Instant::now();
        }
        Ok(())
    })?;
    let [wall_ms, passes_ms] = [wall_ms, passes_ms].map(|ms| ms / measured.len() as f64);
    let wall_over_passes = wall_ms / passes_ms;
    Ok(Throughput { pictures_per_second: 1e3 / wall_ms, wall_ms, passes_ms, wall_over_passes })
}

fn all_passes(stats: &FrameStats) -> f64 {
    stats.passes.iter().map(|pass| pass.gpu_ms).sum()
}

/// Draws one frame, and records its cost.
fn timed(renderer: &mut ModelRenderer, camera: &Camera, gathered: &mut Gathered) -> Result<FrameStats> {
    let start = Instant::now();
    let stats = renderer.render(camera, Outputs::default())?.stats;
    let took = start.elapsed().as_secs_f64() * 1e3;
    let row = |name: &str| if stats.reused { format!("reused: {name}") } else { name.to_owned() };
    gathered.push(&row("wall clock, with read-back"), "ms", took);
    for pass in &stats.passes {
        gathered.push(&row(&format!("pass: {}", pass.name)), "ms", pass.gpu_ms);
    }
    gathered.push(&row("all passes"), "ms", all_passes(&stats));
    if !stats.reused {
        if stats.trim_rows > 0 && stats.passes.iter().all(|p| p.name != TRIM_TABLE) {
            gathered.push(&row(&format!("pass: {TRIM_TABLE}")), "ms", 0.0);
        }
        gather(gathered, &stats);
    }
    Ok(stats)
}

const CLAMPS: &str = "clamps";
/// A table for many views is made once.
const TRIM_TABLE: &str = "trim table";

/// The counts of a frame.
fn gather(to: &mut Gathered, stats: &FrameStats) {
    to.push("triangles", "", stats.triangles as f64);
    to.push("sub-patches", "", stats.sub_patches as f64);
    to.push("corner patches", "", stats.corner_patches as f64);
    to.push("hidden parts", "", stats.hidden_parts as f64);
    to.push("listed patches", "", stats.listed_patches as f64);
    to.push("hidden patches", "", stats.hidden_patches as f64);
    to.push("trim rows", "", stats.trim_rows as f64);
    to.push("trim intercepts", "", stats.trim_intercepts as f64);
    to.push("layers", "", stats.layers as f64);
    to.push("bands", "", f64::from(stats.bands));
    to.push(CLAMPS, "", stats.clamps as f64);
    to.push("retries", "", f64::from(stats.retries));
    for pool in &stats.pools {
        to.push(&format!("pool: {}", pool.name), "bytes", pool.bytes as f64);
    }
    for list in &stats.solid_bytes {
        to.push(&format!("solids: {}", list.name), "bytes", list.bytes as f64);
    }
}

/// Indices of the frames to judge, spread evenly; judging takes much longer than drawing.
fn judged(frames: usize, most: usize) -> impl Iterator<Item = usize> {
    let count = most.min(frames);
    (0..count).map(move |i| i * frames / count)
}

impl Error {
    fn add(&mut self, j: &Judgement) {
        self.judged_frames += 1;
        self.judged_pixels += j.sampled;
        self.wrong_pixels += verdict::wrong(j);
        self.worst_shift_px = self.worst_shift_px.max(verdict::worst_shift_px(j));
        self.worst_depth = self.worst_depth.max(j.depth_regular.model.worst);
        self.worst_normal_deg = self.worst_normal_deg.max(j.normal_deg.worst);
    }
}

impl Throughput {
    /// Quantity, unit and value.
    fn rows(&self) -> [(&'static str, &'static str, f64); 4] {
        [
            ("in flight: pictures per second", "1/s", self.pictures_per_second),
            ("in flight: mean wall clock", "ms", self.wall_ms),
            ("in flight: mean of all passes", "ms", self.passes_ms),
            ("in flight: wall clock over passes", "", self.wall_over_passes),
        ]
    }
}

impl Report {
    fn text(&self) -> String {
        let mut table = output::table(["", "unit", "median", "95 %", "largest"]);
        for row in &self.rows {
            let number = |x: f64| if row.unit == "ms" { format!("{x:.2}") } else { format!("{x:.0}") };
            let (median, p95, largest) = (number(row.median), number(row.p95), number(row.largest));
            table.add_row([&row.name, row.unit, &median, &p95, &largest]);
        }
        table.column_iter_mut().skip(2).for_each(|c| c.set_cell_alignment(CellAlignment::Right));
        let Self { model, faces, face_instances, missing_faces, size: [w, h], device, driver, error: e, .. } = self;
        let first = self.first_frame.map_or_else(String::new, |first| {
            format!(
                "first frame, not in the table: {:.0} ms; pipelines for it: {:.0} ms of the driver's\n",
                first.wall_ms, first.pipelines_ms
            )
        });
        let flight = self.throughput.map_or_else(String::new, |t| {
            format!(
                "several frames in flight: {:.1} pictures per second; {:.2} ms each, {:.2} times the {:.2} ms of all passes\n",
                t.pictures_per_second, t.wall_ms, t.wall_over_passes, t.passes_ms
            )
        });
        format!(
            "{model}: {faces} faces, {face_instances} placed, {missing_faces} missing; {w} x {h} on {device} ({driver})\n{table}\n{first}{flight}\
             error in {} judged frames: {} of {} pixels wrong, worst shift {:.3} px, depth {:.2e} mm, normal {:.3} deg",
            e.judged_frames, e.wrong_pixels, e.judged_pixels, e.worst_shift_px, e.worst_depth, e.worst_normal_deg
        )
    }
}

/// One line for each quantity of each model; the errors are quantities too.
fn csv(path: &Path, reports: &[Report]) -> Result<()> {
    target::write(path, |to| {
        let mut lines = csv::Writer::from_writer(to);
        lines.write_record(["model", "quantity", "unit", "median", "p95", "largest", "frames"])?;
        for Report { model, rows, first_frame, throughput, frames, error: e, .. } in reports {
            for (name, unit, value) in throughput.iter().flat_map(Throughput::rows) {
                lines.serialize((model, name, unit, value, "", "", frames))?;
            }
            for (name, ms) in
                first_frame.iter().flat_map(|f| [("first frame", f.wall_ms), ("pipelines", f.pipelines_ms)])
            {
                lines.serialize((model, name, "ms", ms, ms, ms, 1))?;
            }
            for r in rows {
                lines.serialize((model, &r.name, r.unit, r.median, r.p95, r.largest, r.frames))?;
            }
            let worst = [
                ("wrong pixels", "", e.wrong_pixels as f64),
                ("worst shift", "px", e.worst_shift_px),
                ("worst depth error", "mm", e.worst_depth),
                ("worst normal error", "deg", e.worst_normal_deg),
            ];
            for (name, unit, value) in worst {
                lines.serialize((model, name, unit, "", "", value, e.judged_frames))?;
            }
        }
        Ok(lines.flush()?)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn judged_frames_are_distinct_and_within_the_path() {
        for frames in [1, 2, 3, 5, 24] {
            assert_eq!(judged(frames, 0).count(), 0);
            let indices: Vec<usize> = judged(frames, 4).collect();
            assert_eq!(indices.len(), frames.min(4));
            assert!(indices.windows(2).all(|w| w[0] < w[1]) && indices.iter().all(|&i| i < frames));
        }
    }
}
