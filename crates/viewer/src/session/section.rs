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

/// Cosine of the angle between normals of planes that count as parallel: a millionth of a radian.
const PARALLEL: f64 = 1.0 - 5e-13;

impl Section {
    /// How far below a plane face it is cut, as a share of the model's diagonal: faces in the plane of a section are cut
    /// or not by rounding, which is some 1e-16 of it.
    pub const BELOW: f64 = 1e-6;

    /// Across an axis, through the middle of the model.
    pub fn across(axis: DVec3, bounds: Bounds) -> Self {
        let middle = if bounds.is_empty() { DVec3::ZERO } else { bounds.centre() };
        Self { normal: axis, offset: axis.dot(middle), on: true }
    }

    /// The same plane, the other side stays.
    pub fn flipped(self) -> Self {
        Self { normal: -self.normal, offset: -self.offset, ..self }
    }

    /// The offset of the nearest parallel plane that is no farther than `reach` from an offset, else that offset. Planes
    /// are unit normals and offsets along them.
    pub fn snapped(&self, offset: f64, planes: &[(DVec3, f64)], reach: f64) -> f64 {
        let along = |(normal, at): &(DVec3, f64)| {
            let cosine = self.normal.dot(*normal);
            (cosine.abs() > PARALLEL).then_some(*at * cosine.signum())
        };
        let near = planes.iter().filter_map(along).filter(|at| (*at - offset).abs() <= reach);
        near.min_by(|a, b| (*a - offset).abs().total_cmp(&(*b - offset).abs())).unwrap_or(offset)
    }

    /// Smallest and largest offset at which it passes through the box.
    pub fn range(&self, bounds: Bounds) -> (f64, f64) {
        let along = bounds.corners().map(|corner| self.normal.dot(corner));
        along.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plane_snaps_to_the_nearest_parallel_one_of_either_side() {
        let section = Section { normal: DVec3::Z, offset: 0.0, on: true };
        let planes = [(DVec3::Z, 5.0), (DVec3::NEG_Z, -5.5), (DVec3::X, 5.2), (DVec3::Z, 9.0)];
        assert_eq!(section.snapped(5.2, &planes, 1.0), 5.0);
        assert_eq!(section.snapped(5.4, &planes, 1.0), 5.5);
        assert_eq!(section.snapped(7.0, &planes, 1.0), 7.0);
    }
}
