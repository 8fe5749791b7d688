//! Loops cut into arcs in the normalised domain, joints rounded once.

use super::Arc;
use crate::model::TrimLoop;
use crate::spline::{Bezier, Control};
use crate::trim::piece::{Piece, append_pieces};
use glam::{DVec2, DVec3};

/// Arcs of all loops, and which follows which.
#[derive(Debug, Default)]
pub(super) struct Chains {
    pub arcs: Vec<Arc>,
    /// Of each arc the one that its loop runs through before it, and after it.
    pub before: Vec<u32>,
    pub after: Vec<u32>,
}

impl Chains {
    /// The arc on the other side of an arc's lower or higher end.
    pub(super) fn beyond(&self, arc: usize, high: bool) -> usize {
        let along = self.arcs[arc].up == high;
        (if along { self.after[arc] } else { self.before[arc] }) as usize
    }
}

/// Cuts the loops; what rounds to a point is left out, and its neighbours follow each other.
pub(super) fn chains(loops: &[TrimLoop], origin: DVec2, size: DVec2) -> Chains {
    let unit = |p: DVec2| (p - origin) / size;
    let mut all = Chains::default();
    for trim_loop in loops {
        let first = all.arcs.len();
        let curves: Vec<Bezier<DVec3>> = trim_loop.curves().collect();
        let Some(last) = curves.last() else { continue };
        let mut at = last.points[last.degree()].point();
        for curve in curves {
            let mut pieces = Vec::new();
            append_pieces(&mut pieces, 0, &curve, at);
            all.arcs.extend(pieces.iter().filter_map(|piece| arc(&curve, piece, unit)));
            at = curve.points[curve.degree()].point();
        }
        let count = (all.arcs.len() - first) as u32;
        let (first, turn) = (first as u32, |i: u32| i % count.max(1));
        all.before.extend((0..count).map(|i| first + turn(i + count - 1)));
        all.after.extend((0..count).map(|i| first + turn(i + 1)));
    }
    all
}

/// `None` when both ends round to the same point.
fn arc(curve: &Bezier<DVec3>, piece: &Piece, unit: impl Fn(DVec2) -> DVec2) -> Option<Arc> {
    let joint = |p: DVec2| unit(p).as_vec2().to_array();
    let (start, end) = (joint(piece.start), joint(piece.end));
    if start == end {
        return None;
    }
    let up = start[1] <= end[1];
    let (low, high) = if up { (start, end) } else { (end, start) };
    let mut arc = Arc { low, high, hull: [0.0; 2], up, points: Vec::new() };
    if piece.straight || low[0] == high[0] || low[1] == high[1] {
        return Some(arc);
    }
    let mut points = curve.segment(piece.t.0, piece.t.1).points;
    if !up {
        points.reverse();
    }
    let base = DVec2::from(low.map(f64::from));
    let chord = DVec2::from(high.map(f64::from)) - base;
    let weight = points[0].z;
    let local = |p: &DVec3| DVec3::from_point(unit(p.point()) - base, p.z / weight);
    let mut local: Vec<DVec3> = points.iter().map(local).collect();
    let last = local.len() - 1;
    local[0] = DVec3::from_point(DVec2::ZERO, local[0].z);
    local[last] = DVec3::from_point(chord, local[last].z);
    let crosses = || local.iter().map(|p| chord.perp_dot(p.point()));
    // a cross product in the shader rounds two products and a difference
    let rounding = 4.0 * f64::from(f32::EPSILON) * (chord.x * chord.y).abs();
    arc.hull[0] = (crosses().fold(0.0, f64::min) - rounding) as f32;
    arc.hull[1] = (crosses().fold(0.0, f64::max) + rounding) as f32;
    arc.points = local.iter().map(|p| p.as_vec3().to_array()).collect();
    Some(arc)
}
