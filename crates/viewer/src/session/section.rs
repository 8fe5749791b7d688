//! Planes that cut the model open.

use glam::DVec3;
use selvedge::model::Bounds;
use serde::{Deserialize, Serialize};

/// A plane that cuts the model open: the side `normal · p <= offset` stays.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Section {
    /// Unit length.
    pub normal: DVec3,
    /// Model units.
    pub offset: f64,
    /// It cuts.
    pub on: bool,
}

impl Section {
    /// Across an axis, through the middle of the model.
    pub fn across(axis: DVec3, bounds: Bounds) -> Self {
        let middle = if bounds.is_empty() { DVec3::ZERO } else { bounds.centre() };
        Self { normal: axis, offset: axis.dot(middle), on: true }
    }

    /// The same plane, the other side stays.
    pub fn flipped(self) -> Self {
        Self { normal: -self.normal, offset: -self.offset, ..self }
    }

    /// Smallest and largest offset at which it passes through the box.
    pub fn range(&self, bounds: Bounds) -> (f64, f64) {
        let along = bounds.corners().map(|corner| self.normal.dot(corner));
        along.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)))
    }
}
