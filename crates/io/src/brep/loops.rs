//! From the strands of one bound to a loop in the unrolled domain.
//!
//! Strands are shifted by whole periods so that each begins where the one before it ends. Where
//! two meet at a pole, a straight side along the pole joins them:
//!
//! ```text
//!   v ▲   pole: one point in space            a loop that keeps its face on the left runs
//!     │  ◀───────────────── side              along an upper pole towards smaller u,
//!     │  │               ▲                    along a lower one towards larger u
//!     │  ▼    face       │
//!     └──●───────────────●──▶ u
//! ```

use super::strand::{Path, Strand};
use super::support::{Form, Support};
use super::{BuildError, law};
use crate::math::golden::section;
use crate::spline::Control;
use glam::{DVec2, DVec3};

/// A closed chain of strands; its end is its start plus `winding` periods.
#[derive(Clone, Debug)]
pub(super) struct Loop {
    /// In order.
    pub strands: Vec<Strand>,
    /// Times around in `u` and in `v`.
    pub winding: [i32; 2],
}

/// The face's number and size, for errors and limits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// Face number.
    pub face: u32,
    /// Diagonal of the face, mm.
    pub size: f64,
}

impl Loop {
    /// Chains `strands`; `notes` receives what was repaired.
    ///
    /// # Errors
    /// [`BuildError::EmptyLoop`], [`BuildError::OpenLoop`].
    pub fn close(
        support: &Support,
        mut strands: Vec<Strand>,
        limits: Limits,
        notes: &mut Vec<String>,
    ) -> Result<Self, BuildError> {
        let n = strands.len();
        if n == 0 {
            return Err(BuildError::EmptyLoop { face: limits.face });
        }
        let next = |k: usize| (k + 1) % n;
        let pole_joint = |s: &[Strand], k: usize| s[k].poles[1].filter(|p| s[next(k)].poles[0] == Some(*p));
        // begin after the last pole: the side there is then found by closing, without a choice
        if let Some(k) = (0..n).rev().find(|k| pole_joint(&strands, *k).is_some()) {
            strands.rotate_left(k + 1);
        }
        for k in 1..n {
            let (before, here) = (&strands[k - 1], &strands[k]);
            let shift = match pole_joint(&strands, k - 1) {
                Some(pole) => side_along_pole(support, before, here, pole) - here.start,
                None => support.unwrap(here.start, before.end) - here.start,
            };
            strands[k] = strands[k].clone().shifted(shift);
        }
        let closing = (strands[n - 1].end, strands[0].start);
        let closing_pole = pole_joint(&strands, n - 1);
        let mut winding = [0; 2];
        for (i, turns) in winding.iter_mut().enumerate() {
            if let (Some(period), None) = (support.periods[i], closing_pole) {
                *turns = ((closing.0[i] - closing.1[i]) / period).round() as i32;
            }
        }
        let turn = periods(support, winding);
        let mut out = Vec::with_capacity(n + 2);
        for k in 0..n {
            let onward = if k == n - 1 { turn } else { DVec2::ZERO };
            let (from, to) = (strands[k].end, strands[next(k)].start + onward);
            if pole_joint(&strands, k).is_some() {
                out.push(strands[k].clone());
                if from != to {
                    out.push(Strand::inserted(from, to));
                }
                continue;
            }
            let gap = strands[k].vertices[1].distance(strands[next(k)].vertices[0]);
            if gap > 0.05 * limits.size {
                let edge = strands[next(k)].part.as_ref().map_or(0, |p| p.trace.edge.id);
                return Err(BuildError::OpenLoop { face: limits.face, edge, gap });
            }
            let joint = joint(support, &strands[k], &strands[next(k)], onward);
            let (pull_end, pull_start) = (
                may_pull(support, &strands[k], from, joint),
                may_pull(support, &strands[next(k)], to - onward, joint - onward),
            );
            if pull_start {
                strands[next(k)].start = joint - onward;
                if k == n - 1 && n > 1 {
                    out[0].start = joint - onward; // the first strand is already out
                }
            }
            if pull_end {
                strands[k].end = joint;
            }
            out.push(strands[k].clone());
            if !pull_end {
                out.push(Strand::inserted(from, joint));
            }
            if !pull_start {
                out.push(Strand::inserted(joint, to));
            }
            if gap > 50.0 * support.eps {
                notes.push(format!("face #{}: a gap of {gap:.3e} mm between edges was closed", limits.face));
            }
        }
        Ok(Self { strands: out, winding })
    }

    /// Moved.
    pub fn shifted(mut self, by: DVec2) -> Self {
        self.strands = self.strands.into_iter().map(|s| s.shifted(by)).collect();
        self
    }

    /// Run backwards.
    pub fn reversed(mut self) -> Self {
        self.strands = self.strands.into_iter().rev().map(Strand::reversed).collect();
        self.winding = self.winding.map(|w| -w);
        self
    }

    /// A polygon close to the loop, without its closing point; a loop that winds is open.
    pub fn polygon(&self, support: &Support) -> Vec<DVec2> {
        let mut points = Vec::new();
        for s in &self.strands {
            let polygon = s.polygon(support);
            points.extend_from_slice(&polygon[..polygon.len() - 1]);
        }
        points
    }

    /// Box of the loop: exact for straight strands; curved ones by samples, refined at each extreme
    /// to `1e-12` of a period or of the curve's own box.
    pub fn bounds(&self, support: &Support) -> (DVec2, DVec2) {
        self.bounds_with(support, (DVec2::INFINITY, DVec2::NEG_INFINITY))
    }

    /// The box grown to hold the loop.
    pub fn bounds_with(&self, support: &Support, mut bounds: (DVec2, DVec2)) -> (DVec2, DVec2) {
        let mut hold = |p: DVec2| bounds = (bounds.0.min(p), bounds.1.max(p));
        for s in &self.strands {
            hold(s.start);
            hold(s.end);
        }
        for s in &self.strands {
            match &s.path {
                Path::Line => {}
                Path::Exact(_) => {
                    let nodes: Vec<f64> = (0..=16).map(|i| f64::from(i) / 16.0).collect();
                    for c in s.exact_curves().unwrap_or_default() {
                        // most curves lie deep inside what the others span
                        let margin = 1e-9 * (bounds.1 - bounds.0);
                        let (lo, hi) = (bounds.0 + margin, bounds.1 - margin);
                        let deep = |p: &DVec3| (p.point().cmpge(lo) & p.point().cmple(hi)).all();
                        if !c.points.iter().all(deep) {
                            extremes(&nodes, |t| c.homogeneous(t).point(), &mut bounds);
                        }
                    }
                }
                Path::Traced => extremes(&s.nodes(), |t| s.at(support, t), &mut bounds),
            }
        }
        bounds
    }
}

/// `winding` as a vector of parameters.
pub(super) fn periods(support: &Support, winding: [i32; 2]) -> DVec2 {
    let one = |i: usize| f64::from(winding[i]) * support.periods[i].unwrap_or(0.0);
    DVec2::new(one(0), one(1))
}

/// Twice the signed area of a closed polygon.
pub(super) fn area(polygon: &[DVec2]) -> f64 {
    let origin = polygon.first().copied().unwrap_or(DVec2::ZERO);
    polygon.windows(2).map(|w| (w[0] - origin).perp_dot(w[1] - origin)).sum()
}

/// Grows `bounds` to hold a sampled curve, by golden section around its extreme samples.
///
/// No search where the curve stays inside: beyond an extreme sample it goes no farther than its
/// neighbours are away, else it is not sampled at all.
fn extremes(nodes: &[f64], at: impl Fn(f64) -> DVec2, bounds: &mut (DVec2, DVec2)) {
    let samples: Vec<DVec2> = nodes.iter().map(|t| at(*t)).collect();
    let hold = |b: (DVec2, DVec2), p: &DVec2| (b.0.min(*p), b.1.max(*p));
    *bounds = samples.iter().fold(*bounds, hold);
    for axis in 0..2 {
        for sign in [1.0, -1.0] {
            let value = |p: DVec2| sign * p[axis];
            let Some(i) = (0..samples.len()).max_by(|a, b| value(samples[*a]).total_cmp(&value(samples[*b]))) else {
                continue;
            };
            let (before, after) = (i.saturating_sub(1), (i + 1).min(nodes.len() - 1));
            let limit = if sign > 0.0 { bounds.1[axis] } else { -bounds.0[axis] };
            let least = value(samples[before]).min(value(samples[after]));
            if value(samples[i]) + (value(samples[i]) - least) < limit - 1e-9 * limit.abs() {
                continue;
            }
            const STEPS: usize = 38;
            let inner = section((nodes[before], nodes[after]), STEPS, |t| -value(at(t)));
            *bounds = inner.map(&at).iter().fold(*bounds, hold);
        }
    }
}

/// Where the strand after a pole begins: at its own angle, reached from the end of the strand before
/// in the direction that keeps the face on the left. A side without length is a whole turn.
fn side_along_pole(support: &Support, before: &Strand, here: &Strand, pole: usize) -> DVec2 {
    let axis = support.poles[pole].axis;
    let free = 1 - axis;
    let mut start = here.start;
    start[axis] = before.end[axis];
    let Some(period) = support.periods[free] else { return start };
    // counter-clockwise: +u below, +v on the right, -u above, -v on the left
    let upper = before.end[axis] > before.start[axis];
    let rising = upper == (axis == 0);
    let ahead = if rising { start[free] - before.end[free] } else { before.end[free] - start[free] };
    let mut ahead = ahead.rem_euclid(period);
    if ahead < 1e-6 * period || ahead > (1.0 - 1e-6) * period {
        // a slit into the pole and back, or all the way around it: two uses of one meridian go around
        ahead = period;
    }
    start[free] = law::nearest(start[free], before.end[free] + if rising { ahead } else { -ahead }, period);
    start
}

/// Whether an end of a strand may move to the joint, and the strand with it. It may move along its own line, or by at
/// most ten times the target and a quarter of the tolerance. Otherwise the strand stays true to its edge, which another
/// face shares, and a straight piece leads to the vertex.
fn may_pull(support: &Support, strand: &Strand, from: DVec2, to: DVec2) -> bool {
    let speed = support.speed(from);
    let mut step = (to - from) * speed;
    if let Path::Line = strand.path {
        let along = ((strand.end - strand.start) * speed).normalize_or_zero();
        step -= along * step.dot(along);
    }
    step.length() <= support.pull
}

/// The shared point of two strands: the pre-image of their vertex, on the lines that they follow.
fn joint(support: &Support, a: &Strand, b: &Strand, onward: DVec2) -> DVec2 {
    let (end, start) = (a.end, b.start + onward);
    let guess = 0.5 * (end + start);
    let vertex: DVec3 = 0.5 * (a.vertices[1] + b.vertices[0]);
    let mut joint = support.invert(vertex, Some(guess), vertex.distance(support.point(guess)));
    // far off the surface, or near a pole, the curves' ends are more accurate than the vertex
    let speed = support.speed(guess);
    let apart = |p: DVec2, q: DVec2| ((p - q) * speed).length();
    let reach = apart(end, start) + vertex.distance(support.point(guess)) + support.eps;
    let meaningful = apart(joint, guess) <= 4.0 * reach;
    let flat = matches!(support.form, Form::Plane);
    if !(flat || meaningful) {
        joint = guess;
    }
    for i in 0..2 {
        if a.locked[i] {
            joint[i] = end[i];
        } else if b.locked[i] {
            joint[i] = start[i];
        }
    }
    joint
}
