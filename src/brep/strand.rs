//! Pieces of a loop in native parameters, before there is a carrier.

use super::curve::Curve;
use super::edge::EdgeCurve;
use super::law::nearest;
use super::support::{Form, Support};
use super::trace::Trace;
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
    /// Whatever the trace says.
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
}

/// A directed piece of a loop. Its ends are where the loop puts them; the path between follows,
/// shifted by whatever that takes at each end and linearly in between.
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
    /// Poles that its ends are.
    pub poles: [Option<usize>; 2],
    /// Its ends in space.
    pub vertices: [DVec3; 2],
}

/// Constant coordinates met so far on a face: `(axis, value)`. Edges on one line get one number.
pub(super) type Lines = Vec<(usize, f64)>;

impl Strand {
    /// A straight strand that no edge asked for.
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

    /// The strands of one edge use: several where it passes through poles, none where it stays at one.
    pub fn of_edge(support: &Support, edge: &Rc<EdgeCurve>, hint: Option<DVec2>, lines: &mut Lines) -> Vec<Self> {
        if let Form::Plane = support.form {
            return vec![Self::in_plane(support, edge)];
        }
        let stops = pole_stops(support, edge);
        let mut out = Vec::new();
        let mut hint = hint;
        for w in stops.windows(2) {
            let ((from, pole0), (to, pole1)) = (w[0], w[1]);
            if pole0.is_some() && pole0 == pole1 && stays(support, edge, (from, to), pole0) {
                continue;
            }
            let trace = Trace::new(support, edge, (from, to), [pole0, pole1], hint);
            let strand = Self::of_trace(support, Rc::new(trace), lines);
            hint = Some(strand.end);
            out.push(Self { poles: [pole0, pole1], ..strand });
        }
        out
    }

    fn in_plane(support: &Support, edge: &Rc<EdgeCurve>) -> Self {
        let f = &support.frame;
        // the affine image of a rational curve, control point by control point
        let image = |b: Bezier<glam::DVec4>| Bezier {
            points: b
                .points
                .iter()
                .map(|p| {
                    let arm = p.truncate() - f.origin * p.w;
                    DVec3::new(arm.dot(f.x), arm.dot(f.y), p.w)
                })
                .collect(),
        };
        let curves: Vec<_> = edge.curve.beziers(edge.t0, edge.t1).into_iter().map(|s| image(s.piece)).collect();
        let ends = [curves[0].point(0.0), curves[curves.len() - 1].point(1.0)];
        let samples: Vec<_> = edge.nodes().into_iter().map(|s| (s, f.local(edge.point(s)).truncate())).collect();
        let height = |s: &f64| f.local(edge.point(*s)).z.abs();
        let gap = edge.nodes().iter().map(height).fold(0.0, f64::max);
        let trace = Trace { edge: edge.clone(), samples, at_pole: [false; 2], gap };
        let straight = matches!(edge.curve, Curve::Line { .. });
        Self {
            start: ends[0],
            end: ends[1],
            path: if straight { Path::Line } else { Path::Exact(curves) },
            part: Some(Part { trace: Rc::new(trace), from: 0.0, to: 1.0 }),
            locked: [false; 2],
            poles: [None; 2],
            vertices: edge.vertices,
        }
    }

    fn of_trace(support: &Support, trace: Rc<Trace>, lines: &mut Lines) -> Self {
        let (first, last) = (trace.samples[0], trace.samples[trace.samples.len() - 1]);
        let mut strand = Self {
            start: first.1,
            end: last.1,
            path: Path::Traced,
            locked: [false; 2],
            poles: [None; 2],
            vertices: [first.0, last.0].map(|s| match s {
                0.0 => trace.edge.vertices[0],
                1.0 => trace.edge.vertices[1],
                _ => trace.edge.point(s),
            }),
            part: None,
        };
        if let Some((axis, value)) = trace.constant(support, support.eps) {
            let speed = trace.regular().iter().map(|(_, p)| support.speed(*p)[axis]).fold(0.0, f64::max);
            let value = known_line(support, lines, axis, value, speed);
            strand.start[axis] = value;
            strand.end[axis] = value;
            strand.locked[axis] = true;
            strand.path = Path::Line;
        }
        strand.part = Some(Part { from: first.0, to: last.0, trace });
        strand
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
        }
        if let Path::Exact(curves) = &mut self.path {
            curves.reverse();
            curves.iter_mut().for_each(|c| c.points.reverse());
        }
        self
    }

    /// Where the strand is at `s` in `[0, 1]` of its part, in native parameters.
    ///
    /// For [`Path::Traced`] this is the path. For straight and exact paths it is the edge's own
    /// pre-image, carried along with the ends: what the path is compared with.
    pub fn at(&self, support: &Support, s: f64) -> DVec2 {
        let Some(part) = &self.part else { return self.start.lerp(self.end, s) };
        if s == 0.0 {
            return self.start;
        }
        if s == 1.0 {
            return self.end;
        }
        let raw = |s: f64| part.trace.at(support, part.from + (part.to - part.from) * s);
        raw(s) + (self.start - raw(0.0)) * (1.0 - s) + (self.end - raw(1.0)) * s
    }

    /// The point of the edge at `s`.
    pub fn edge_point(&self, s: f64) -> Option<DVec3> {
        self.part.as_ref().map(|p| p.trace.edge.point(p.from + (p.to - p.from) * s))
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

    /// The fraction between `a` and `b` at which coordinate `axis` is `value`, by bisection; the
    /// coordinate must pass it between the two.
    pub fn solve(&self, support: &Support, axis: usize, value: f64, (mut a, mut b): (f64, f64)) -> f64 {
        let rising = self.at(support, b)[axis] > value;
        for _ in 0..60 {
            let m = 0.5 * (a + b);
            if m <= a || m >= b {
                break;
            }
            if (self.at(support, m)[axis] > value) == rising { b = m } else { a = m }
        }
        0.5 * (a + b)
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
        }
        (left, right)
    }
}

/// The value of a line already known within `eps`, at the period nearest to `value`; borders of a
/// spline's domain are known from the start.
fn known_line(support: &Support, lines: &mut Lines, axis: usize, value: f64, speed: f64) -> f64 {
    let close = |x: f64| (x - value).abs() * speed <= support.eps;
    let near = |x: f64| support.periods[axis].map_or(x, |period| nearest(x, value, period));
    if let Form::Spline(s) = &support.form
        && let Some(x) = [s.domain[axis].0, s.domain[axis].1].into_iter().map(near).find(|x| close(*x))
    {
        return x;
    }
    if let Some(x) = lines.iter().filter(|l| l.0 == axis).map(|l| near(l.1)).find(|x| close(*x)) {
        return x;
    }
    lines.push((axis, value));
    value
}

/// Fractions at which the edge must be cut because it meets a pole there, with 0 and 1.
fn pole_stops(support: &Support, edge: &EdgeCurve) -> Vec<(f64, Option<usize>)> {
    // vertices miss poles by more than curves do
    let reach = 4.0 * support.eps;
    let end =
        |i: usize, s: f64| support.pole_at(edge.vertices[i], reach).or_else(|| support.pole_at(edge.point(s), reach));
    let mut stops = vec![(0.0, end(0, 0.0))];
    let nodes = edge.nodes();
    for (index, pole) in support.poles.iter().enumerate() {
        let distance = |s: f64| edge.point(s).distance(pole.point);
        let d: Vec<f64> = nodes.iter().map(|s| distance(*s)).collect();
        for i in 1..nodes.len() - 1 {
            if d[i] > d[i - 1] || d[i] > d[i + 1] {
                continue;
            }
            let (mut a, mut b) = (nodes[i - 1], nodes[i + 1]);
            for _ in 0..80 {
                let (c, e) = (a + (b - a) / 3.0, b - (b - a) / 3.0);
                if distance(c) <= distance(e) { b = e } else { a = c }
            }
            let s = 0.5 * (a + b);
            if distance(s) <= reach && s > 1e-6 && s < 1.0 - 1e-6 {
                stops.push((s, Some(index)));
            }
        }
    }
    stops.push((1.0, end(1, 1.0)));
    stops.sort_by(|a, b| a.0.total_cmp(&b.0));
    stops.dedup_by(|b, a| b.0 - a.0 < 1e-6);
    stops
}

/// The edge does not leave the pole between the two fractions.
fn stays(support: &Support, edge: &EdgeCurve, (from, to): (f64, f64), pole: Option<usize>) -> bool {
    let Some(pole) = pole.map(|i| support.poles[i].point) else { return false };
    (1..8).all(|i| edge.point(from + (to - from) * f64::from(i) / 8.0).distance(pole) <= 8.0 * support.eps)
}
