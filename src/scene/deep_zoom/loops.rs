//! A trim loop restricted to a window.
//!
//! ```text
//!        ╭────────╮                        curves on one side of the window become a chord on a frame around it;
//!    ╭───╯  ┌──┐  │         ┌──────┐       winding numbers within stay the same: curve, chord and moved chord lie
//!    │   ───┼╮ │  │  ─────▶ │ ┌──┐ │       in the same half plane
//!    ╰──────┴┴─┴──╯         ├─┼╮ │ │
//!           window          └─┴┴─┴─┘
//! ```

use crate::model::TrimLoop;
use crate::spline::{Bezier, Control};
use glam::{DVec2, DVec3};

/// Distance from the window to the frame, in widths of the window.
const FRAME: f64 = 1.0;
/// Most halvings of a curve: `f64` parameters resolve no more.
const MOST_DEPTH: u32 = 52;

/// The loop for the rectangle `lo..hi`: the same curves and winding numbers within, no point farther away than its
/// width. `None` if no curve is left.
pub(super) fn clipped(trim_loop: &TrimLoop, lo: DVec2, hi: DVec2) -> Option<TrimLoop> {
    let reach = (hi - lo) * FRAME;
    let mut clip = Clip { lo, hi, frame: (lo - reach, hi + reach), run: None, curves: Vec::new() };
    trim_loop.curves().for_each(|c| clip.add(&c, MOST_DEPTH));
    clip.end_run();
    if clip.curves.is_empty() {
        return None;
    }
    // both ends of a joint were moved alike, except for rounding; the whole loop is correct too, only less exact
    Some(TrimLoop::new(clip.curves, (hi - lo) * 1e-6).unwrap_or_else(|_| trim_loop.clone()))
}

struct Clip {
    lo: DVec2,
    hi: DVec2,
    frame: (DVec2, DVec2),
    /// The run of curves on the same side: its start, its end, and a bit for each side on which all of it lies.
    run: Option<(DVec2, DVec2, u32)>,
    curves: Vec<Bezier<DVec3>>,
}

impl Clip {
    fn add(&mut self, curve: &Bezier<DVec3>, depth: u32) {
        let points = || curve.points.iter().map(|p| p.point());
        let side = |p: DVec2| {
            [p.x <= self.lo.x, p.x >= self.hi.x, p.y <= self.lo.y, p.y >= self.hi.y]
                .iter()
                .enumerate()
                .fold(0, |bits, (i, &beyond)| bits | u32::from(beyond) << i)
        };
        let sides = points().fold(15, |all, p| all & side(p));
        let (start, end) = (curve.points[0].point(), curve.points[curve.degree()].point());
        if sides != 0 {
            self.run = match self.run {
                Some((from, _, before)) if before & sides != 0 => Some((from, end, before & sides)),
                _ => {
                    self.end_run();
                    Some((start, end, sides))
                }
            };
        } else if depth == 0 || points().all(|p| p.clamp(self.frame.0, self.frame.1) == p) {
            self.end_run();
            self.curves.push(curve.clone());
        } else {
            let (a, b) = curve.split(0.5);
            self.add(&a, depth - 1);
            self.add(&b, depth - 1);
        }
    }

    fn end_run(&mut self) {
        let Some((from, to, _)) = self.run.take() else { return };
        let [a, b] = [from, to].map(|p| p.clamp(self.frame.0, self.frame.1));
        if a != b {
            self.curves.push(Bezier::line(a, b));
        }
    }
}
