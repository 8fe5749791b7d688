//! The accuracy promise, tested on one picture.
//!
//! The promise: a pixel shows what the exact model shows at a point at most `tolerance` pixels away.
//! The judge is [`selvedge_check`]: it intersects rays with the exact surfaces and classifies the
//! hits against the exact trim curves in double precision, and shares no code with the GPU passes.

use crate::camera::CameraFile;
use crate::error::{JobError, Stop, guarded};
use selvedge::model::{Camera, Model};
use selvedge::picture::Picture;
use selvedge_check::{JudgeOptions, Judgement, Tracer, judge};
use serde::Serialize;

/// Pixels that break the promise: the wrong face, or the right face's wrong sheet.
pub fn wrong(judgement: &Judgement) -> u64 {
    judgement.wrong + judgement.folds.beyond + judgement.folds.wrong_depth
}

/// The largest distance at which a pixel is right, of faces and sheets of faces.
pub fn worst_shift_px(judgement: &Judgement) -> f64 {
    judgement.worst_shift_px.max(judgement.folds.worst_shift_px)
}

/// The verdict on one picture.
#[derive(Clone, Debug, Serialize)]
pub struct Verdict {
    /// No pixel is wrong, and the frame counted no clamp.
    pub kept: bool,
    /// Whether some pixel shows the model: if not, there was nothing to judge.
    pub seen: bool,
    /// Pixels compared.
    pub judged: u64,
    /// Of them, those that break the promise.
    pub wrong: u64,
    /// The largest distance at which a pixel is right, pixels.
    pub worst_shift_px: f64,
    /// The promise, pixels.
    pub tolerance_px: f64,
    /// Places where the frame could not keep the promise.
    pub clamps: u64,
    /// The camera.
    pub camera: CameraFile,
    /// The whole judgement.
    pub judgement: Judgement,
}

impl Verdict {
    /// Judges about `samples` pixels of a picture with the images of faces, depth and normals, and every pixel at which the
    /// face changes.
    ///
    /// # Errors
    /// [`JobError::Stopped`].
    pub fn new(
        model: &Model,
        camera: &Camera,
        picture: &Picture,
        samples: usize,
        tolerance_px: f64,
        stop: &Stop,
    ) -> Result<Self, JobError> {
        let progress = |_| stop.check();
        let options = JudgeOptions {
            samples: Some(samples),
            limit_px: tolerance_px,
            progress: Some(&progress),
            ..JudgeOptions::default()
        };
        let judgement = guarded(|| Ok(judge(&Tracer::new(model), camera, &picture.images(), &options)))?;
        let (wrong, clamps) = (wrong(&judgement), picture.stats.clamps);
        Ok(Self {
            kept: wrong == 0 && clamps == 0,
            seen: picture.face.iter().any(|face| *face != 0),
            judged: judgement.sampled,
            wrong,
            worst_shift_px: worst_shift_px(&judgement),
            tolerance_px,
            clamps,
            camera: camera.into(),
            judgement,
        })
    }
}
