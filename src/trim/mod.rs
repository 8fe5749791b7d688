//! Inside or outside: the winding number of trim loops around a point of the domain.
//!
//! A ray runs from the point towards `+u`. A curve whose control points all lie to the right of the
//! point crosses that ray, net, as often as its two ends say; one that lies above, below or left of
//! it does not cross; any other curve is halved.
//!
//! ```text
//!       end above            up    +1      half-open rule: "above" is v > p.v, so an end that lies
//!    p ────────●──▶ u        down  -1      on the ray belongs to the part below, for both curves
//!       start not above      else   0      that share it, and touching contributes nothing
//! ```

use crate::model::TrimLoop;
use crate::spline::Control;
use glam::{DVec2, DVec3};

/// Halvings before a curve that still surrounds the point is taken for its chord: 2⁻⁵² of the
/// parameter range, where the halves of an `f64` curve coincide.
const DEEPEST: u32 = 52;

/// The trim loops of one face, ready for point queries.
#[derive(Clone, Debug, Default)]
pub struct LoopIndex {
    curves: Vec<Boxed>,
}

#[derive(Clone, Debug)]
struct Boxed {
    min: DVec2,
    max: DVec2,
    points: Vec<DVec3>,
}

impl LoopIndex {
    /// Prepares `loops`; no loop at all means that every point is inside.
    pub fn new(loops: &[TrimLoop]) -> Self {
        let boxed = |points: Vec<DVec3>| {
            let (min, max) = bounds(&points);
            Boxed { min, max, points }
        };
        Self { curves: loops.iter().flat_map(|l| l.curves().collect::<Vec<_>>()).map(|c| boxed(c.points)).collect() }
    }

    /// `p` belongs to the face.
    pub fn contains(&self, p: DVec2) -> bool {
        self.curves.is_empty() || self.winding(p) != 0
    }

    /// How often the loops turn around `p`, counter-clockwise positive.
    pub fn winding(&self, p: DVec2) -> i32 {
        let relevant = |c: &&Boxed| c.max.y > p.y && c.min.y <= p.y && c.max.x > p.x;
        self.curves.iter().filter(relevant).map(|c| crossings(&c.points, p, 0)).sum()
    }
}

fn bounds(points: &[DVec3]) -> (DVec2, DVec2) {
    let first = points[0].point();
    points.iter().map(|p| p.point()).fold((first, first), |(lo, hi), p| (lo.min(p), hi.max(p)))
}

/// Net upward crossings of the ray from `p` to `+u`.
fn crossings(points: &[DVec3], p: DVec2, depth: u32) -> i32 {
    let (min, max) = bounds(points);
    if max.y <= p.y || min.y > p.y || max.x <= p.x {
        return 0;
    }
    if min.x > p.x || depth == DEEPEST {
        let above = |q: DVec3| i32::from(q.point().y > p.y);
        return above(points[points.len() - 1]) - above(points[0]);
    }
    let (left, right) = crate::spline::Bezier { points: points.to_vec() }.split(0.5);
    crossings(&left.points, p, depth + 1) + crossings(&right.points, p, depth + 1)
}
