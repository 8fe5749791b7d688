//! The way from one view to another, over a fifth of a second.
//!
//! ```text
//!   target   along a line           distance, height   by a constant factor
//!   axes     about one axis         time               3 t² - 2 t³: begins and ends at rest
//! ```

use super::{other_projection, settle};
use glam::{DMat3, DQuat};
use selvedge::model::{Bounds, Camera, Projection};
use std::time::Duration;

/// How long it takes.
pub const DURATION: Duration = Duration::from_millis(200);

/// A way between two cameras.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transition {
    from: Camera,
    to: Camera,
}

fn axes(camera: &Camera) -> DQuat {
    let (right, up, forward) = camera.axes();
    DQuat::from_mat3(&DMat3::from_cols(right, up, -forward))
}

fn is_parallel(camera: &Camera) -> bool {
    matches!(camera.projection, Projection::Orthographic { .. })
}

impl Transition {
    /// From one view to another, which has the projection from the start.
    pub fn new(from: Camera, to: Camera, bounds: Bounds) -> Self {
        let from = if is_parallel(&from) == is_parallel(&to) { from } else { settle(&other_projection(&from), bounds) };
        Self { from: Camera { size: to.size, ..from }, to }
    }

    /// The view after a share of the time, from 0 to 1; at 1 it is the last one, bit for bit.
    pub fn at(&self, share: f64, bounds: Bounds) -> Camera {
        if share.is_nan() || share >= 1.0 {
            return self.to;
        }
        let t = share.max(0.0);
        let t = t * t * (3.0 - 2.0 * t);
        let between = |a: f64, b: f64| (a.ln() + (b.ln() - a.ln()) * t).exp();
        let turn = axes(&self.from).slerp(axes(&self.to), t);
        let distance = between(self.from.eye.distance(self.from.target), self.to.eye.distance(self.to.target));
        let target = self.from.target.lerp(self.to.target, t);
        let projection = match (self.from.projection, self.to.projection) {
            (Projection::Orthographic { height: a }, Projection::Orthographic { height: b }) => {
                Projection::Orthographic { height: between(a, b) }
            }
            (_, to) => to,
        };
        let camera = Camera {
            eye: target + turn * glam::DVec3::Z * distance,
            target,
            up: turn * glam::DVec3::Y,
            projection,
            ..self.to
        };
        settle(&camera, bounds)
    }

    /// Where it ends.
    pub fn end(&self) -> Camera {
        self.to
    }
}

#[cfg(test)]
mod tests {
    use super::super::{FOV, fit, looking};
    use super::*;
    use glam::DVec3;

    #[test]
    fn it_begins_and_ends_where_it_says_and_never_jumps() {
        let bounds = Bounds { min: DVec3::ZERO, max: DVec3::new(30.0, 20.0, 10.0) };
        let from = Camera::around(bounds, DVec3::new(1.0, -1.6, 1.1), DVec3::Z, FOV, (640, 480));
        let top = settle(&fit(&looking(&from, DVec3::Z, DVec3::Y), &bounds.corners()), bounds);
        for to in [top, settle(&other_projection(&top), bounds)] {
            let way = Transition::new(from, to, bounds);
            assert_eq!(way.at(1.0, bounds), to);
            let start = way.at(0.0, bounds);
            let pixel = |c: &Camera, p: DVec3| c.project(p).expect("in front").0;
            let middle = bounds.centre();
            assert!(pixel(&start, middle).distance(pixel(&from, middle)) < 1e-6);
            let mut last = start;
            for i in 1..=200 {
                let next = way.at(f64::from(i) / 200.0, bounds);
                assert_eq!(next.check(), Ok(()));
                let corners = bounds.corners();
                let moved = corners.iter().map(|p| pixel(&next, *p).distance(pixel(&last, *p))).fold(0.0, f64::max);
                assert!(moved < 12.0, "a corner jumps by {moved} pixels at step {i}");
                last = next;
            }
        }
    }
}
