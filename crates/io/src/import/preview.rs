//! Finished parts of a model, taken while the rest of it is read.
//!
//! ```text
//!   parts    1  2  3 │ 4  5  6  7      faces of 1 to 3 are built
//!                    ╰─▶ Preview::take: parts 1 to 3, four parts without faces, and all instances
//! ```
//!
//! STEP and IGES files state all parts and instances before the first face is built, so an instance has the same number
//! in each preview as at the end. An assembly in several files grows by a file at a time.

use super::Options;
use crate::model::{Model, Part};

/// Takes previews of a model that is being read.
pub trait Preview: Sync {
    /// Whether a preview is wanted now, which costs a copy of what is finished. The thread that reads calls it between
    /// parts.
    fn is_due(&self) -> bool;

    /// Takes the finished parts in their places. Of one file all instances are there, with the numbers that they have at
    /// the end, and parts that are not finished have no faces; Boolean solids are not there. Of several files the
    /// instances and the Boolean solids of those that are read are there. Such a model may have nothing to draw.
    fn take(&self, model: Model);
}

impl Options<'_> {
    /// Makes a preview if one is due.
    pub(super) fn preview(&self, make: impl FnOnce() -> Model) {
        if let Some(preview) = self.preview.filter(|preview| preview.is_due()) {
            preview.take(make());
        }
    }
}

/// Fewest faces between two places for previews. They take some milliseconds and occupy a dozen processors; at a place
/// all processors wait for the last face before it.
const FEWEST: usize = 256;
/// Between two places lies at least this share of the faces before them, so that their number grows only with the
/// logarithm of that of the faces.
const SHARE: f64 = 0.125;

/// Divides a row of parts at places for previews.
#[derive(Debug)]
pub(super) struct Division {
    /// Faces before the next place.
    next: usize,
}

impl Division {
    /// Without previews there is no place.
    pub fn new(options: &Options<'_>) -> Self {
        Self { next: if options.preview.is_some() { FEWEST } else { usize::MAX } }
    }

    /// Whether a place is behind the part that ends with so many faces of the row.
    pub fn is_behind(&mut self, faces: usize) -> bool {
        let is_behind = faces >= self.next;
        if is_behind {
            self.next = faces + FEWEST.max((faces as f64 * SHARE) as usize);
        }
        is_behind
    }
}

/// A model whose first `done` parts are finished, of the `parts` that it will have. The others are empty.
pub(super) fn beginning(model: &Model, done: usize, parts: usize) -> Model {
    let (finished, waiting) = model.parts[..parts].split_at(done);
    let waiting = waiting.iter().map(|part| Part { name: part.name.clone(), ..Part::default() });
    Model {
        name: model.name.clone(),
        unit: model.unit.clone(),
        parts: finished.iter().cloned().chain(waiting).collect(),
        instances: model.instances.clone(),
        ..Model::default()
    }
}
