//! The accuracy promise, tested on one picture.
//!
//! The promise: a pixel shows what the exact model shows at a point at most `tolerance` pixels away.
//! The judge is [`selvedge_check`]: it intersects rays with the exact surfaces and classifies the
//! hits against the exact trim curves in double precision, and shares no code with the GPU passes.

use crate::progress::counting;
use anyhow::Result;
use selvedge::model::{Camera, Model};
use selvedge::picture::{EdgeSettings, Picture};
use selvedge_check::drawing::{DrawingSettings, LineImage, LineJudgement, judge_lines};
use selvedge_check::{JudgeOptions, Judgement, SunJudgement, SunTracer, Tracer, judge, judge_sun};

pub use selvedge_jobs::{worst_shift_px, wrong};

/// Judges about `samples` pixels of a picture, and every one at which the face changes. In a view `times` closer than
/// the whole model, the depth of a tie is as much smaller.
pub fn of(
    tracer: &Tracer,
    camera: &Camera,
    picture: &Picture,
    samples: usize,
    tolerance: f64,
    times: f64,
    what: &str,
) -> Judgement {
    counting(&format!("judging {what}, pixels"), |tick| {
        let options = JudgeOptions {
            samples: Some(samples),
            limit_px: tolerance,
            tie: JudgeOptions::default().tie / times,
            progress: Some(tick),
            ..JudgeOptions::default()
        };
        judge(tracer, camera, &picture.images(), &options)
    })
}

/// Judges the light of about `samples` pixels, and of every one at which it or the face changes.
pub fn of_sun(
    tracer: &Tracer,
    sun: &SunTracer,
    camera: &Camera,
    picture: &Picture,
    samples: usize,
    tolerance: f64,
) -> SunJudgement {
    let options = JudgeOptions { samples: Some(samples), limit_px: tolerance, ..JudgeOptions::default() };
    judge_sun(tracer, sun, camera, &picture.images(), &options)
}

/// Judges the lines of a picture: along edges, and of Boolean solids.
pub fn of_lines(
    model: &Model,
    tracer: &Tracer,
    camera: &Camera,
    picture: &Picture,
    drawn: &EdgeSettings,
) -> Result<LineJudgement> {
    let (silhouettes, hidden) = (drawn.silhouettes, drawn.hidden);
    let settings = DrawingSettings { silhouettes, hidden, ..DrawingSettings::default() };
    let [width, section_width] =
        [drawn.width, drawn.section_width].map(|width| width * f64::from(camera.size.1) / EdgeSettings::HEIGHT);
    let image = LineImage { lines: &picture.edge, width, section_width };
    Ok(judge_lines(model, tracer, camera, &settings, image)?)
}
