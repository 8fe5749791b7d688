//! The hard cases of trimming, shared with the tests of whole frames; and loops moved by one unit of
//! single precision.

use crate::model::TrimLoop;
use crate::spline::{Bezier, Control};
use glam::{DVec2, DVec3};

#[path = "../../tests/shapes/trims.rs"]
mod trims;

pub(super) use trims::all;

/// Every control point moved by so many units in the last place of single precision.
pub(super) fn moved(trim_loop: &TrimLoop, (du, dv): (i32, i32)) -> TrimLoop {
    let step = |x: f64, by: i32| {
        let rounded = x as f32;
        match by {
            0 => x,
            1 => x + f64::from(rounded.next_up()) - f64::from(rounded),
            _ => x - (f64::from(rounded) - f64::from(rounded.next_down())),
        }
    };
    let point = |p: &DVec3| {
        let q = p.point();
        DVec3::from_point(DVec2::new(step(q.x, du), step(q.y, dv)), p.z)
    };
    let curves = trim_loop.curves().map(|c| Bezier { points: c.points.iter().map(point).collect() });
    TrimLoop::new(curves.collect(), DVec2::splat(1e-12)).expect("as closed as before")
}
