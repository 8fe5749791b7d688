//! From an edge to strands: its pre-image in the support's parameters.
//!
//! ```text
//!   plane              affine image of the curve, exact
//!   border of a spline the line of constant parameter that it is
//!   curved surface     cut at poles; traced; a line of constant parameter where it is one
//! ```

use super::border::Border;
use super::curve::Curve;
use super::edge::EdgeCurve;
use super::law::nearest;
use super::lines::Lines;
use super::strand::{Part, Path, Strand};
use super::support::{Form, Support};
use super::trace::Trace;
use crate::spline::Bezier;
use glam::{DVec2, DVec3, DVec4};
use std::rc::Rc;

impl Strand {
    /// The strands of one edge use: several where it passes through poles, none where it stays at one.
    pub fn of_edge(support: &Support, edge: &Rc<EdgeCurve>, hint: Option<DVec2>, lines: &mut Lines) -> Vec<Self> {
        if let Form::Plane = support.form {
            return vec![Self::in_plane(support, edge)];
        }
        let stops = pole_stops(support, edge);
        if let (Form::Spline(s), [(_, None), (_, None)]) = (&support.form, &stops[..])
            && let Some(border) = Border::of(s, edge, support.target)
        {
            let trace = Rc::new(Trace::along(support, edge, &border));
            return vec![Self::of_trace(support, trace, Some((border.axis, border.value)))];
        }
        let mut out = Vec::new();
        let mut hint = hint;
        for w in stops.windows(2) {
            let ((from, pole0), (to, pole1)) = (w[0], w[1]);
            if pole0.is_some() && pole0 == pole1 && stays(support, edge, (from, to), pole0) {
                continue;
            }
            let trace = Trace::new(support, edge, (from, to), [pole0, pole1], hint);
            let line = constant_line(support, &trace, lines);
            let strand = Self::of_trace(support, Rc::new(trace), line);
            hint = Some(strand.end);
            out.push(Self { poles: [pole0, pole1], ..strand });
        }
        out
    }

    fn in_plane(support: &Support, edge: &Rc<EdgeCurve>) -> Self {
        let f = &support.frame;
        // the affine image of a rational curve, control point by control point
        let image = |b: Bezier<DVec4>| Bezier {
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
        let trace = Trace::of_samples(edge, samples, gap);
        let straight = matches!(edge.curve, Curve::Line { .. });
        Self {
            start: ends[0],
            end: ends[1],
            path: if straight { Path::Line } else { Path::Exact(curves) },
            part: Some(Part::new(support, Rc::new(trace), 0.0, 1.0)),
            locked: [false; 2],
            poles: [None; 2],
            vertices: edge.vertices,
        }
    }

    /// `line`: the coordinate that is constant along the trace, if one is, and its value.
    fn of_trace(support: &Support, trace: Rc<Trace>, line: Option<(usize, f64)>) -> Self {
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
        if let Some((axis, value)) = line {
            strand.start[axis] = value;
            strand.end[axis] = value;
            strand.locked[axis] = true;
            strand.path = Path::Line;
        }
        strand.part = Some(Part::new(support, trace, first.0, last.0));
        strand
    }
}

/// The line of constant coordinate that a trace follows within the target: its axis and value.
///
/// Lines met before on the face keep their number, at the period nearest to this trace. The border of a spline counts
/// within ten times the target: edges along it are often approximations of it, and a fit would only follow their noise.
fn constant_line(support: &Support, trace: &Trace, lines: &mut Lines) -> Option<(usize, f64)> {
    let (axis, value, off, speed) = trace.constant(support)?;
    let close = |x: f64, reach: f64| (x - value).abs() * speed <= reach;
    let near = |x: f64| support.periods[axis].map_or(x, |period| nearest(x, value, period));
    let border = 10.0 * support.target;
    if let (Form::Spline(s), true) = (&support.form, off <= border)
        && let Some(x) = [s.domain[axis].0, s.domain[axis].1].into_iter().map(near).find(|x| close(*x, border))
    {
        return Some((axis, x));
    }
    if off > support.target {
        return None;
    }
    let (period, reach) = (support.periods[axis], support.target / speed);
    let known = lines.first((axis, value), period, reach, |x| close(near(x), support.target)).map(near);
    if known.is_none() {
        lines.push(axis, value, period);
    }
    Some((axis, known.unwrap_or(value)))
}

/// Fractions at which the edge must be cut because it meets a pole there, with 0 and 1.
fn pole_stops(support: &Support, edge: &EdgeCurve) -> Vec<(f64, Option<usize>)> {
    let end = |i: usize, s: f64| support.pole_of(edge.vertices[i]).or_else(|| support.pole_of(edge.point(s)));
    let mut stops = vec![(0.0, end(0, 0.0))];
    stops.extend(passed_poles(support, edge));
    stops.push((1.0, end(1, 1.0)));
    stops.sort_by(|a, b| a.0.total_cmp(&b.0));
    stops.dedup_by(|b, a| b.0 - a.0 < 1e-6);
    stops
}

/// Share of the face's size by which edges may run past a pole: how far files miss the tip of a cone.
const BEHIND: f64 = 1e-4;

/// Widens the reach of a pole to the edges that pass through it and end behind it. They then meet at the pole; a note
/// says so.
pub(super) fn widen_poles(
    support: &mut Support,
    uses: &[Vec<EdgeCurve>],
    (face, size): (u32, f64),
    notes: &mut Vec<String>,
) {
    let mut behind = vec![0.0_f64; support.poles.len()];
    for edge in uses.iter().flatten() {
        for index in passed_poles(support, edge).into_iter().filter_map(|stop| stop.1) {
            let ends = edge.vertices.map(|p| p.distance(support.poles[index].point));
            for end in ends.into_iter().filter(|d| *d <= BEHIND * size) {
                behind[index] = behind[index].max(end);
            }
        }
    }
    for (pole, behind) in support.poles.iter_mut().zip(behind) {
        if behind > pole.reach {
            notes.push(format!("face #{face}: edges end {behind:.3e} mm behind the tip of the surface, and now at it"));
            // the neighbouring edge ends at the same distance, up to rounding
            pole.reach = 1.01 * behind;
        }
    }
}

/// Share of the face's size by which edges may end before a pole or beside it.
const BESIDE: f64 = 5e-3;

/// Widens the reach of poles to the edges that end before or beside them. A point where a turned profile passes its
/// axis without meeting it is such a pole. The edges then meet there; a note says so.
pub(super) fn tips_beside(
    support: &mut Support,
    uses: &[Vec<EdgeCurve>],
    (face, size): (u32, f64),
    notes: &mut Vec<String>,
) {
    support.poles.extend(support.near_axis(BESIDE * size));
    for pole in &mut support.poles {
        let ends = uses.iter().flatten().flat_map(|edge| edge.vertices).map(|p| p.distance(pole.point));
        let farthest = ends.filter(|d| *d <= BESIDE * size).fold(0.0, f64::max);
        if farthest > pole.reach {
            notes.push(format!(
                "face #{face}: edges end {farthest:.3e} mm beside the tip of the surface, and now at it"
            ));
            // the neighbouring edge ends at the same distance, up to rounding
            pole.reach = 1.01 * farthest;
        }
    }
}

/// Share of an edge's greatest distance from a pole within which its end may lie behind the pole.
const CLOSE: f64 = 1e-2;

/// Fractions strictly between the ends of an edge at which it passes a pole.
fn passed_poles(support: &Support, edge: &EdgeCurve) -> Vec<(f64, Option<usize>)> {
    let mut stops = Vec::new();
    if support.poles.is_empty() {
        return stops;
    }
    let nodes = edge.nodes();
    for (index, pole) in support.poles.iter().enumerate() {
        let distance = |s: f64| edge.point(s).distance(pole.point);
        let d: Vec<f64> = nodes.iter().map(|s| distance(*s)).collect();
        let (last, most) = (nodes.len() - 1, d.iter().copied().fold(0.0, f64::max));
        for i in 0..=last {
            let (before, after) = (i.saturating_sub(1), (i + 1).min(last));
            // an end at the pole does not pass it, and an end far from the pole lies before it
            let end = (i == 0 || i == last) && (d[i] <= pole.reach || d[i] > CLOSE * most);
            if end || d[i] > d[before] || d[i] > d[after] {
                continue;
            }
            let (mut a, mut b) = (nodes[before], nodes[after]);
            for _ in 0..80 {
                let (c, e) = (a + (b - a) / 3.0, b - (b - a) / 3.0);
                if distance(c) <= distance(e) { b = e } else { a = c }
            }
            let s = 0.5 * (a + b);
            if distance(s) <= pole.reach && s > 1e-6 && s < 1.0 - 1e-6 {
                stops.push((s, Some(index)));
            }
        }
    }
    stops
}

/// The edge does not leave the pole between the two fractions.
fn stays(support: &Support, edge: &EdgeCurve, (from, to): (f64, f64), pole: Option<usize>) -> bool {
    let Some(pole) = pole.map(|i| &support.poles[i]) else { return false };
    let away = |i: i32| edge.point(from + (to - from) * f64::from(i) / 8.0).distance(pole.point);
    (1..8).all(|i| away(i) <= 2.0 * pole.reach)
}
