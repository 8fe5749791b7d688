//! Pieces of a loop in native parameters, before there is a carrier.

use super::support::Support;
use super::trace::Trace;
use crate::math::root::bracketed;
use crate::model::EdgeRef;
use crate::spline::Bezier;
use glam::{DVec2, DVec3};
use std::rc::Rc;

/// How a strand runs from its start to its end.
#[derive(Clone, Debug)]
pub(super) enum Path {
    /// Straight: a line of constant `u` or `v`, a line in a plane, a side at a pole, a cut.
    Line,
    /// Exact rational curves (planes only).
    Exact(Vec<Bezier<DVec3>>),
    /// Along the trace.
    Traced,
}

/// The part of a trace that a strand follows; `from > to` runs it backwards.
#[derive(Clone, Debug)]
pub(super) struct Part {
    /// The edge's pre-image.
    pub trace: Rc<Trace>,
    /// Fraction of the edge at the strand's start.
    pub from: f64,
    /// Fraction of the edge at the strand's end.
    pub to: f64,
    /// The pre-image at both ends, native; every point between needs it.
    ends: [DVec2; 2],
}

impl Part {
    pub fn new(support: &Support, trace: Rc<Trace>, from: f64, to: f64) -> Self {
        let ends = [from, to].map(|s| trace.at(support, s));
        Self { trace, from, to, ends }
    }

    /// The edge, and whether the part runs along it.
    pub fn edge(&self) -> EdgeRef {
        let (index, forward) = self.trace.edge.used;
        EdgeRef { edge: index as u32, forward: forward == (self.from < self.to) }
    }

    /// Native parameters at the fraction `s` of the part.
    fn at(&self, support: &Support, s: f64) -> DVec2 {
        self.trace.at(support, self.from + (self.to - self.from) * s)
    }
}

/// A directed piece of a loop. The loop sets its ends; the path between them is shifted with the ends, linearly.
#[derive(Clone, Debug)]
pub(super) struct Strand {
    /// First point, native.
    pub start: DVec2,
    /// Last point, native.
    pub end: DVec2,
    /// Way between.
    pub path: Path,
    /// The edge it came from; `None` for sides at poles and cuts.
    pub part: Option<Part>,
    /// Coordinates that are constant along it.
    pub locked: [bool; 2],
    /// The poles at its ends.
    pub poles: [Option<usize>; 2],
    /// Its ends in space.
    pub vertices: [DVec3; 2],
}

impl Strand {
    /// A straight strand that belongs to no edge.
    pub fn inserted(start: DVec2, end: DVec2) -> Self {
        Self {
            start,
            end,
            path: Path::Line,
            part: None,
            locked: [start.x == end.x, start.y == end.y],
            poles: [None; 2],
            vertices: [DVec3::NAN; 2],
        }
    }

    /// Moves both ends.
    pub fn shifted(mut self, by: DVec2) -> Self {
        self.start += by;
        self.end += by;
        self
    }

    /// The same strand run backwards.
    pub fn reversed(mut self) -> Self {
        std::mem::swap(&mut self.start, &mut self.end);
        self.poles.reverse();
        self.vertices.reverse();
        if let Some(part) = &mut self.part {
            std::mem::swap(&mut part.from, &mut part.to);
            part.ends.reverse();
        }
        if let Path::Exact(curves) = &mut self.path {
            curves.reverse();
            curves.iter_mut().for_each(|c| c.points.reverse());
        }
        self
    }

    /// Where the strand is at `s` in `[0, 1]` of its part, in native parameters.
    ///
    /// For [`Path::Traced`] this is the path. For straight and exact paths it is the edge's own pre-image, shifted with
    /// the ends: the path is compared with it.
    pub fn at(&self, support: &Support, s: f64) -> DVec2 {
        let Some(part) = &self.part else { return self.start.lerp(self.end, s) };
        if s == 0.0 {
            return self.start;
        }
        if s == 1.0 {
            return self.end;
        }
        self.pulled(part, s, part.at(support, s))
    }

    /// The pre-image at `s`, shifted with the ends.
    fn pulled(&self, part: &Part, s: f64, raw: DVec2) -> DVec2 {
        raw + (self.start - part.ends[0]) * (1.0 - s) + (self.end - part.ends[1]) * s
    }

    /// [`Strand::at`] and the pre-image that it was pulled from, strictly between the ends.
    pub fn at_and_raw(&self, support: &Support, s: f64) -> (DVec2, Option<DVec2>) {
        let Some(part) = &self.part else { return (self.at(support, s), None) };
        let raw = part.at(support, s);
        (self.pulled(part, s, raw), Some(raw))
    }

    /// The pre-image of the edge at `s`, wherever the strand's ends were pulled.
    pub fn raw(&self, support: &Support, s: f64) -> Option<DVec2> {
        self.part.as_ref().map(|part| part.at(support, s))
    }

    /// Fractions at which the trace was sampled, from 0 to 1.
    pub fn nodes(&self) -> Vec<f64> {
        let Some(part) = &self.part else { return vec![0.0, 1.0] };
        let inside = part.trace.samples.iter().map(|(t, _)| (t - part.from) / (part.to - part.from));
        let mut nodes: Vec<f64> = inside.filter(|s| *s > 1e-9 && *s < 1.0 - 1e-9).collect();
        nodes.sort_by(f64::total_cmp);
        nodes.insert(0, 0.0);
        nodes.push(1.0);
        nodes
    }

    /// The rational curves of an exact path, pulled to the strand's ends.
    pub fn exact_curves(&self) -> Option<Vec<Bezier<DVec3>>> {
        let Path::Exact(curves) = &self.path else { return None };
        let ends = [curves[0].point(0.0), curves[curves.len() - 1].point(1.0)];
        let pull = [self.start - ends[0], self.end - ends[1]];
        let count: usize = curves.iter().map(Bezier::degree).sum();
        let mut before = 0;
        let moved = curves.iter().map(|c| {
            let points = c.points.iter().enumerate().map(|(i, p)| {
                let s = (before + i) as f64 / count as f64;
                let d = pull[0] * (1.0 - s) + pull[1] * s;
                DVec3::new(p.x + d.x * p.z, p.y + d.y * p.z, p.z)
            });
            let bezier = Bezier { points: points.collect() };
            before += c.degree();
            bezier
        });
        Some(moved.collect())
    }

    /// A polygon close to the path, for areas and containment; from start to end.
    pub fn polygon(&self, support: &Support) -> Vec<DVec2> {
        const PER_CURVE: usize = 12;
        match &self.path {
            Path::Line => vec![self.start, self.end],
            Path::Exact(_) => {
                let curves = self.exact_curves().unwrap_or_default();
                let inside = |c: &Bezier<DVec3>| {
                    let n = if c.degree() == 1 { 1 } else { PER_CURVE };
                    (1..=n).map(|i| c.point(i as f64 / n as f64)).collect::<Vec<_>>()
                };
                std::iter::once(self.start).chain(curves.iter().flat_map(inside)).collect()
            }
            Path::Traced => self.nodes().into_iter().map(|s| self.at(support, s)).collect(),
        }
    }

    /// The fraction between `a` and `b` at which coordinate `axis` is `value`, to `1e-13` of the way between
    /// them; it must be below on one side and not below on the other.
    pub fn solve(&self, support: &Support, axis: usize, value: f64, (a, b): (f64, f64)) -> f64 {
        bracketed(|s| self.at(support, s)[axis] - value, a, b, 1e-13 * (b - a))
    }

    /// The two parts before and after `s`; at the cut coordinate `axis` is exactly `value`.
    pub fn split(&self, support: &Support, s: f64, axis: usize, value: f64) -> (Self, Self) {
        let mut middle = self.at(support, s);
        for i in 0..2 {
            if self.locked[i] {
                middle[i] = self.start[i];
            }
        }
        if let (Path::Line, None) = (&self.path, &self.part) {
            let f = (value - self.start[axis]) / (self.end[axis] - self.start[axis]);
            middle = self.start.lerp(self.end, f);
        }
        middle[axis] = value;
        let point = support.point(middle);
        let (mut left, mut right) = (self.clone(), self.clone());
        left.end = middle;
        left.poles[1] = None;
        left.vertices[1] = point;
        right.start = middle;
        right.poles[0] = None;
        right.vertices[0] = point;
        if let (Some(l), Some(r)) = (&mut left.part, &mut right.part) {
            let cut = l.from + (l.to - l.from) * s;
            (l.to, r.from) = (cut, cut);
            l.ends[1] = l.trace.at(support, cut);
            r.ends[0] = l.ends[1];
        }
        (left, right)
    }
}
