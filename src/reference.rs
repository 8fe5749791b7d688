//! The slow exact renderer and the judge.

use crate::model::{Camera, Model};
use crate::picture::Picture;
use serde::Serialize;

/// Exact rays through a model.
#[derive(Debug)]
pub struct Tracer;

impl Tracer {
    /// Prepares `model`.
    pub fn new(_model: &Model) -> Self {
        Self
    }
}

/// How a picture is judged.
#[derive(Clone, Copy)]
#[allow(missing_docs)]
pub struct JudgeOptions<'a> {
    pub samples: Option<usize>,
    pub limit_px: f64,
    pub progress: Option<&'a (dyn Fn(u64) + Sync)>,
    pub listed: usize,
}

impl Default for JudgeOptions<'_> {
    fn default() -> Self {
        Self { samples: None, limit_px: 0.5, progress: None, listed: 16 }
    }
}

/// Mean and worst.
#[derive(Clone, Copy, Debug, Default, Serialize)]
#[allow(missing_docs)]
pub struct Errors {
    pub mean: f64,
    pub worst: f64,
}

/// Depth errors in two units.
#[derive(Clone, Copy, Debug, Default, Serialize)]
#[allow(missing_docs)]
pub struct DepthErrors {
    pub model: Errors,
    pub px: Errors,
}

/// Pixels whose face hides itself.
#[derive(Clone, Copy, Debug, Default, Serialize)]
#[allow(missing_docs)]
pub struct Folds {
    pub beyond: u64,
    pub wrong_depth: u64,
    pub worst_shift_px: f64,
}

/// What the judge found.
#[derive(Clone, Debug, Default, Serialize)]
#[allow(missing_docs)]
pub struct Judgement {
    pub sampled: u64,
    pub ties: u64,
    pub wrong: u64,
    pub worst_shift_px: f64,
    pub depth_regular: DepthErrors,
    pub normal_deg: Errors,
    pub folds: Folds,
    pub given_up: u64,
}

impl Judgement {
    /// The verdicts as a picture.
    pub fn paint(&self) -> Vec<[u8; 4]> {
        Vec::new()
    }
}

/// Compares a picture with the exact one.
pub fn judge(_: &Tracer, _: &Camera, _: &Picture, _: &JudgeOptions) -> Judgement {
    Judgement::default()
}
