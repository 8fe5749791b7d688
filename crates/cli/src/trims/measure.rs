//! One measurement: a way, a view, its cost and its error.
//!
//! ```text
//!   trim time = passes that the way has of its own                    "trim table", "trim texture"
//!             + "visibility" - "visibility untested"                  the cost of the tests in the pixels
//! ```
//!
//! Each frame draws the same sub-patches twice, first without a test, so faces behind holes count for neither drawing.
//! Without a test no pixel is discarded, so the difference can be below zero.
//!
//! Each view is measured with every pass recorded, and once more as a turning view, which reuses a table that serves it.

use super::way::{Contender, Way};
use crate::args::TrimsArgs;
use crate::progress::during;
use crate::{device, verdict};
use anyhow::Result;
use glam::DQuat;
use selvedge::baselines::{SceneOptions, pretessellated::pretessellated, texture};
use selvedge::gpu::GpuError;
use selvedge::headless::{HeadlessError, HeadlessRenderer};
use selvedge::model::{Camera, Model};
use selvedge::picture::{FrameSettings, FrameStats, Outputs};
use selvedge_check::Tracer;
use serde::Serialize;
use std::time::Instant;

/// Frames before the first measured one: buffers have grown, pipelines are compiled.
const WARM_UP_FRAMES: usize = 2;

/// The pass that draws without a test: it is not part of the frame.
const UNTESTED: &str = "visibility untested";

/// Which of the plots a row belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Sweep {
    Zoom,
    Size,
    Knob,
}

/// One measurement.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    pub model: String,
    pub way: Way,
    pub sweep: Sweep,
    pub knob: &'static str,
    pub knob_at: f64,
    pub zoom: f64,
    pub size: [u32; 2],
    /// Work on the CPU before the first frame: upload, and the triangulation where there is one.
    pub prepare_ms: f64,
    /// Bytes that the way needs for this view, whether the device has them or not.
    pub trim_bytes: f64,
    /// `None`: the device has no room for the memory.
    pub cost: Option<Cost>,
    pub error: Option<Error>,
    pub device: String,
}

/// The cost of a frame.
#[derive(Clone, Debug, Serialize)]
pub struct Cost {
    pub trim_ms: f64,
    pub own_passes_ms: f64,
    pub gaps_ms: f64,
    pub frame_ms: f64,
    /// The first and the last of these, for a turning view.
    pub turning_trim_ms: f64,
    pub turning_frame_ms: f64,
    pub passes: Vec<(String, f64)>,
    pub bytes: u64,
    pub objects: Vec<(String, u64)>,
    pub trim_rows: u64,
    pub trim_segments: u64,
    pub trim_intercepts: u64,
    pub triangles: u64,
    pub clamps: u64,
}

/// The error of a picture.
#[derive(Clone, Debug, Serialize)]
pub struct Error {
    pub judged: u64,
    /// Beyond half a pixel.
    pub wrong: u64,
    pub worst_shift_px: f64,
}

/// A contender with its renderers: one that is timed, one that also writes the images to judge.
pub struct Entered {
    contender: Contender,
    prepare_ms: f64,
    timed: HeadlessRenderer,
    judged: HeadlessRenderer,
}

/// The measurements of one model.
pub struct Bench<'a> {
    args: &'a TrimsArgs,
    name: &'a str,
    model: &'a Model,
    tracer: &'a Tracer,
}

impl<'a> Bench<'a> {
    pub fn new(args: &'a TrimsArgs, name: &'a str, model: &'a Model, tracer: &'a Tracer) -> Self {
        Self { args, name, model, tracer }
    }

    fn renderer(&self, model: &Model, contender: Contender, untested: bool) -> Result<HeadlessRenderer> {
        let options = device::options(self.args.device.as_deref(), false);
        let mut renderer = HeadlessRenderer::new(&options)?;
        let (settings, options) = contender.scene();
        renderer.upload_baseline(model, settings, SceneOptions { untested, ..options })?;
        Ok(renderer)
    }

    /// Makes a contender ready.
    pub fn enter(&self, contender: Contender) -> Result<Entered> {
        let what = format!("{}: preparing {}", self.name, contender.way());
        let start = Instant::now();
        let mesh = match contender {
            Contender::Pretessellated { deflection } => {
                let chord = deflection * self.model.bounds().diagonal();
                let (mesh, made) = during(&what, || pretessellated(self.model, chord));
                if made.missing > 0 || made.beyond > 0 {
                    tracing::warn!("{}: {} faces missing, {} triangles bulge", self.name, made.missing, made.beyond);
                }
                Some(mesh)
            }
            _ => None,
        };
        let model = mesh.as_ref().unwrap_or(self.model);
        let timed = during(&what, || self.renderer(model, contender, true))?;
        let prepare_ms = start.elapsed().as_secs_f64() * 1e3;
        Ok(Entered { contender, prepare_ms, timed, judged: self.renderer(model, contender, false)? })
    }

    /// Measures and judges one view.
    pub fn row(&self, entered: &mut Entered, sweep: Sweep, zoom: f64, camera: &Camera) -> Result<Row> {
        let contender = entered.contender;
        let (way, (knob, knob_at)) = (contender.way(), contender.knob());
        let what = format!("{}: {way}, {zoom} times, {} x {}", self.name, camera.size.0, camera.size.1);
        tracing::info!("{what}");
        let mut row = Row {
            model: self.name.to_owned(),
            way,
            sweep,
            knob,
            knob_at,
            zoom,
            size: camera.size.into(),
            prepare_ms: entered.prepare_ms,
            trim_bytes: 0.0,
            cost: None,
            error: None,
            device: String::new(),
        };
        if let Contender::Texture { eighths } = contender {
            row.trim_bytes = texture::wanted_bytes(self.model, camera, eighths)?;
        }
        let settings =
            FrameSettings { tolerance_px: contender.tolerance_px(), all_passes: true, ..FrameSettings::default() };
        let frames = self.args.frames;
        let Some(stats) = during(&what, || quickest(&mut entered.timed, &settings, frames, |_| *camera))? else {
            return Ok(row);
        };
        let turning = during(&what, || turning(&mut entered.timed, camera, &settings, frames))?.unwrap_or_default();
        row.device = format!("{} ({})", stats.device, stats.driver);
        let objects = entered.timed.object_bytes();
        if !matches!(contender, Contender::Texture { .. }) {
            row.trim_bytes = objects.iter().filter(|(name, _)| is_for_trims(way, name)).map(|(_, b)| *b as f64).sum();
        }
        row.cost = Some(cost(&stats, &turning, objects));
        let picture = entered.judged.render(camera, &settings, Outputs::ALL)?;
        let j = verdict::of(self.tracer, camera, &picture, self.args.samples, 0.5, zoom, &what);
        row.error =
            Some(Error { judged: j.sampled, wrong: verdict::wrong(&j), worst_shift_px: verdict::worst_shift_px(&j) });
        Ok(row)
    }
}

/// The view turned around its target by so little that the picture hardly changes.
fn turned(camera: &Camera, nth: usize) -> Camera {
    let turn = DQuat::from_axis_angle(camera.up.normalize(), nth as f64 * 1e-5);
    Camera { eye: camera.target + turn * (camera.eye - camera.target), ..*camera }
}

/// The least time of each pass of a view that turns, drawn as a viewer draws it.
fn turning(
    renderer: &mut HeadlessRenderer,
    camera: &Camera,
    settings: &FrameSettings,
    frames: usize,
) -> Result<Option<FrameStats>> {
    quickest(renderer, &FrameSettings { all_passes: false, ..*settings }, frames, |nth| turned(camera, nth))
}

/// The least time of each pass over some frames; `None` when the device has no room. A pass that a frame skips counts
/// as zero.
fn quickest(
    renderer: &mut HeadlessRenderer,
    settings: &FrameSettings,
    frames: usize,
    camera: impl Fn(usize) -> Camera,
) -> Result<Option<FrameStats>> {
    let mut best: Option<FrameStats> = None;
    for frame in 0..WARM_UP_FRAMES + frames {
        let stats = match renderer.render(&camera(frame), settings, Outputs::default()) {
            Ok(picture) => picture.stats,
            Err(error) if no_room(&error) => return Ok(None),
            Err(error) => return Err(error.into()),
        };
        match &mut best {
            Some(best) if frame > WARM_UP_FRAMES => {
                for pass in &mut best.passes {
                    pass.gpu_ms = pass.gpu_ms.min(time(&stats, &pass.name));
                }
            }
            _ => best = Some(stats),
        }
    }
    Ok(best)
}

/// Whether the frame needs more memory than the device has.
fn no_room(error: &HeadlessError) -> bool {
    error.gpu().is_some_and(GpuError::is_out_of_memory)
}

fn time(stats: &FrameStats, pass: &str) -> f64 {
    stats.passes.iter().filter(|p| p.name == pass).map(|p| p.gpu_ms).sum()
}

fn cost(stats: &FrameStats, turning: &FrameStats, objects: Vec<(String, u64)>) -> Cost {
    let own_passes_ms = |stats: &FrameStats| -> f64 {
        stats.passes.iter().filter(|p| p.name.starts_with("trim")).map(|p| p.gpu_ms).sum()
    };
    // a mesh has no tests
    let tests_ms = |stats: &FrameStats| match time(stats, UNTESTED) {
        0.0 => 0.0,
        untested => time(stats, "visibility") - untested,
    };
    let trim_ms = |stats: &FrameStats| own_passes_ms(stats) + tests_ms(stats);
    let frame_ms = |stats: &FrameStats| stats.passes.iter().filter(|p| p.name != UNTESTED).map(|p| p.gpu_ms).sum();
    Cost {
        trim_ms: trim_ms(stats),
        own_passes_ms: own_passes_ms(stats),
        gaps_ms: time(stats, "gaps"),
        frame_ms: frame_ms(stats),
        turning_trim_ms: trim_ms(turning),
        turning_frame_ms: frame_ms(turning),
        passes: stats.passes.iter().map(|p| (p.name.clone(), p.gpu_ms)).collect(),
        bytes: objects.iter().map(|(_, bytes)| bytes).sum(),
        objects,
        trim_rows: stats.trim_rows,
        trim_segments: stats.trim_segments,
        trim_intercepts: stats.trim_intercepts,
        triangles: stats.triangles,
        clamps: stats.clamps,
    }
}

/// The object exists because faces are trimmed this way; the list of gap candidates exists for every way.
fn is_for_trims(way: Way, object: &str) -> bool {
    match way {
        Way::Pretessellated => object.starts_with("mesh"),
        _ => object.starts_with("trim"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use selvedge::picture::PassTime;
    use selvedge::picture::TrimWay;

    #[test]
    fn trim_time_is_own_passes_and_the_difference() {
        let pass = |name: &str, gpu_ms| PassTime { name: name.into(), gpu_ms };
        let passes = [("trim table", 2.0), (UNTESTED, 5.5), ("visibility", 7.0), ("gaps", 1.0), ("resolve", 3.0)];
        let passes: Vec<_> = passes.map(|(name, ms)| pass(name, ms)).into();
        let (mut turning, mut all) = (FrameStats::default(), FrameStats::default());
        turning.passes = passes[1..].to_vec();
        all.passes = passes;
        let cost = cost(&all, &turning, vec![("trim rows".into(), 12)]);
        assert_eq!((cost.trim_ms, cost.own_passes_ms, cost.gaps_ms, cost.frame_ms), (3.5, 2.0, 1.0, 13.0));
        assert_eq!((cost.turning_trim_ms, cost.turning_frame_ms), (1.5, 11.0));
        assert_eq!(cost.bytes, 12);
    }

    #[test]
    fn objects_of_trims() {
        let table = Way::Own(TrimWay::Table);
        assert!(is_for_trims(table, "trim intercepts") && !is_for_trims(table, "gap candidates"));
        assert!(!is_for_trims(table, "visibility") && is_for_trims(Way::Pretessellated, "mesh positions"));
    }
}
