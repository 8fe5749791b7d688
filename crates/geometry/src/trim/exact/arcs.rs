//! Loops cut into arcs in the normalised domain, joints rounded once.

use super::Arc;
use super::conic::{Conic, append_conics};
use crate::model::TrimLoop;
use crate::spline::{Bezier, Control};
use crate::trim::piece::{Piece, append_pieces};
use glam::{DVec2, DVec3};

/// Arcs of all loops, and their order.
#[derive(Debug, Default)]
pub(super) struct Chains {
    pub arcs: Vec<Arc>,
    /// For each arc, the one before it in its loop, and the one after it.
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

/// Cuts the loops; a piece that rounds to a point is dropped, and its neighbours follow each other.
pub(super) fn chains(loops: &[TrimLoop], origin: DVec2, size: DVec2) -> Chains {
    let unit = |p: DVec2| (p - origin) / size;
    let mut all = Chains::default();
    let (mut pieces, mut conics) = (Vec::new(), Vec::new());
    for trim_loop in loops {
        let first = all.arcs.len();
        let curves: Vec<Bezier<DVec3>> = trim_loop.curves().collect();
        let Some(last) = curves.last() else { continue };
        let mut at = last.points[last.degree()].point();
        for curve in curves {
            pieces.clear();
            append_pieces(&mut pieces, 0, &curve, at);
            for piece in &pieces {
                conics.clear();
                cut(&mut conics, &curve, piece, unit);
                append_arcs(&mut all.arcs, &conics, (unit(piece.start), unit(piece.end)));
            }
            at = curve.points[curve.degree()].point();
        }
        let count = (all.arcs.len() - first) as u32;
        let (first, turn) = (first as u32, |i: u32| i % count.max(1));
        all.before.extend((0..count).map(|i| first + turn(i + count - 1)));
        all.after.extend((0..count).map(|i| first + turn(i + 1)));
    }
    all
}

/// The arcs of a piece, whose last end is that of the piece.
fn cut(conics: &mut Vec<Conic>, curve: &Bezier<DVec3>, piece: &Piece, unit: impl Fn(DVec2) -> DVec2) {
    let (start, end) = (unit(piece.start), unit(piece.end));
    if piece.straight || start.x == end.x || start.y == end.y {
        conics.push(Conic { end, corner: start, fullness: 0.0 });
        return;
    }
    let mut points = curve.segment(piece.t.0, piece.t.1).points;
    points.iter_mut().for_each(|p| *p = DVec3::from_point(unit(p.point()), p.z));
    let last = points.len() - 1;
    (points[0], points[last]) = (DVec3::from_point(start, points[0].z), DVec3::from_point(end, points[last].z));
    append_conics(conics, &Bezier { points });
}

/// In single precision, joints clamped to the box of the piece's ends: rounding must not undo its monotony.
fn append_arcs(arcs: &mut Vec<Arc>, conics: &[Conic], (start, end): (DVec2, DVec2)) {
    let mut from = start;
    for (k, conic) in conics.iter().enumerate() {
        let to = if k + 1 < conics.len() { conic.end.clamp(from.min(end), from.max(end)) } else { end };
        let joints = [from, to].map(|p| p.as_vec2().to_array());
        if joints[0] != joints[1] {
            let up = joints[0][1] <= joints[1][1];
            let (low, high) = if up { (joints[0], joints[1]) } else { (joints[1], joints[0]) };
            let bent = conic.fullness > 0.0 && low[0] != high[0] && low[1] != high[1];
            let base = DVec2::from(low.map(f64::from));
            let chord = DVec2::from(high.map(f64::from)) - base;
            let corner = (conic.corner - base).clamp(chord.min(DVec2::ZERO), chord.max(DVec2::ZERO));
            let (corner, fullness) = if bent { (corner, conic.fullness) } else { (DVec2::ZERO, 0.0) };
            arcs.push(Arc { low, high, corner: corner.as_vec2().to_array(), fullness: fullness as f32, up });
        }
        from = to;
    }
}
