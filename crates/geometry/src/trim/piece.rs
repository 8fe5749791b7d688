//! Trim curves cut where they turn back in `u` or `v`.
//!
//! ```text
//!      ╭──╮
//!     ╱    ╲         each piece is bi-monotone: it runs from one corner of its box
//!    ●      ●        to the opposite one, so the box of any two of its points
//!     ╲    ╱         contains all of it between them
//!      ╰──╯
//! ```

use super::climbs;
use crate::math::{bernstein, orientation::orientation};
use crate::model::TrimLoop;
use crate::spline::{Bezier, Control, binomial};
use glam::{DVec2, DVec3};

/// Bisections of a piece before a point counts as on it. The bracket is then 2^-64 of the curve's
/// parameter range: below the rounding of every evaluated point, also for a cubic that starts flat.
const MAX_BISECTIONS: u32 = 64;

/// A bi-monotone part of a trim curve.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    /// Index of the curve in its [`LoopIndex`](super::LoopIndex).
    pub curve: u32,
    /// Parameters of the curve at the two ends.
    pub t: (f64, f64),
    /// First point; bit for bit the last of the piece before.
    pub start: DVec2,
    /// Last point.
    pub end: DVec2,
    /// The image is the line segment from `start` to `end`.
    pub straight: bool,
}

impl Piece {
    /// Box of the piece.
    pub fn bounds(&self) -> (DVec2, DVec2) {
        (self.start.min(self.end), self.start.max(self.end))
    }

    /// Signed crossings right of `p` on its scan line: -1, 0 or 1.
    pub fn crossing(&self, curve: &Bezier<DVec3>, p: DVec2) -> i32 {
        let sign = climbs(self.start.y, self.end.y, p.y);
        if sign == 0 {
            return 0;
        }
        let up = sign > 0;
        let (bottom, top) = if up { (self.start, self.end) } else { (self.end, self.start) };
        let right = if p.y == top.y {
            top.x > p.x
        } else if self.straight {
            orientation(bottom, top, p) > 0.0
        } else {
            let (t_bottom, t_top) = if up { self.t } else { (self.t.1, self.t.0) };
            lies_right(curve, (t_bottom, bottom), (t_top, top), p)
        };
        if right { sign } else { 0 }
    }
}

/// A part of a trim curve that turns back in neither coordinate, as a curve of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct MonotonePiece {
    /// First point; bit for bit the last of the piece before.
    pub start: DVec2,
    /// Last point.
    pub end: DVec2,
    /// The image is the line segment from `start` to `end`.
    pub straight: bool,
    /// The piece over `[0, 1]`; its ends are `start` and `end` within rounding.
    pub curve: Bezier<DVec3>,
}

/// The monotone pieces of a loop, in its order.
pub fn monotone_pieces(trim_loop: &TrimLoop) -> Vec<MonotonePiece> {
    let curves: Vec<Bezier<DVec3>> = trim_loop.curves().collect();
    let Some(last) = curves.last() else { return Vec::new() };
    let mut at = last.points[last.degree()].point();
    let mut pieces = Vec::new();
    for (index, curve) in curves.iter().enumerate() {
        append_pieces(&mut pieces, index as u32, curve, at);
        at = curve.points[curve.degree()].point();
    }
    let cut = |p: Piece| MonotonePiece {
        start: p.start,
        end: p.end,
        straight: p.straight,
        curve: curves[p.curve as usize].segment(p.t.0, p.t.1),
    };
    pieces.into_iter().map(cut).collect()
}

/// Whether the piece that climbs from `a` to `b` passes `p.y` at some `u > p.x`: bisection in the
/// parameter until the box of the bracket lies on one side of `p`, usually after a few steps.
fn lies_right(curve: &Bezier<DVec3>, mut a: (f64, DVec2), mut b: (f64, DVec2), p: DVec2) -> bool {
    for _ in 0..MAX_BISECTIONS {
        if p.x < a.1.x.min(b.1.x) {
            return true;
        }
        if p.x >= a.1.x.max(b.1.x) {
            return false;
        }
        let t = 0.5 * (a.0 + b.0);
        if t == a.0 || t == b.0 {
            break;
        }
        let middle = within(curve.point(t), a.1, b.1);
        if middle.y >= p.y {
            b = (t, middle);
        } else {
            a = (t, middle);
        }
    }
    b.1.x > p.x // the first parameter found whose v reaches the scan line
}

/// `p` clamped to the box of `a` and `b`: rounding must not undo the monotony.
pub(super) fn within(p: DVec2, a: DVec2, b: DVec2) -> DVec2 {
    p.clamp(a.min(b), a.max(b))
}

/// Appends the pieces of `curve`, which starts at `start` (the end of the curve before; it replaces
/// the curve's own first point, so that the chain is closed bit for bit).
pub(super) fn append_pieces(pieces: &mut Vec<Piece>, index: u32, curve: &Bezier<DVec3>, start: DVec2) {
    let points: Vec<DVec2> = curve.points.iter().map(|p| DVec2::new(p.x / p.z, p.y / p.z)).collect();
    let end = points[points.len() - 1];
    let straight = is_segment(&points[1..points.len() - 1], start, end);
    let mut cuts = Vec::new();
    if !straight {
        cuts.extend(turning_points(curve, &points, |p| p.x));
        cuts.extend(turning_points(curve, &points, |p| p.y));
        cuts.sort_by(f64::total_cmp);
        cuts.retain(|&t| t > 0.0 && t < 1.0);
        cuts.dedup();
    }
    let mut from = (0.0, start);
    let stops = cuts.into_iter().map(|t| (t, curve.point(t))).chain([(1.0, end)]);
    for to in stops {
        if !(straight && start == end) {
            pieces.push(Piece { curve: index, t: (from.0, to.0), start: from.1, end: to.1, straight });
        }
        from = to;
    }
}

/// The inner control points lie exactly on the segment: so does the curve, whatever its weights.
fn is_segment(inner: &[DVec2], start: DVec2, end: DVec2) -> bool {
    let (lo, hi) = (start.min(end), start.max(end));
    inner.iter().all(|&p| p.cmpge(lo).all() && p.cmple(hi).all() && orientation(start, end, p) == 0.0)
}

/// Parameters where one coordinate `x = X / W` of the curve turns back.
///
/// With `a`, `b` the degree `n - 1` values of the first and last `n` control points, `X' W - X W' =
/// n (W_a X_b - X_a W_b)`, a polynomial of degree `2n - 2`. Its Bernstein coefficients are sums of
/// `w_i w_j+1 (x_j+1 - x_i)`. These are differences of Euclidean coordinates, so an offset of the
/// domain costs no accuracy.
fn turning_points(curve: &Bezier<DVec3>, points: &[DVec2], axis: impl Fn(DVec2) -> f64) -> Vec<f64> {
    let n = curve.degree();
    // each Euclidean coordinate is one rounded quotient, each coefficient a short sum
    let rounding = 4.0 * f64::EPSILON * points.iter().map(|&p| axis(p).abs()).fold(0.0, f64::max);
    let mut coefficients = vec![0.0; 2 * n - 1];
    let mut noise = vec![0.0; 2 * n - 1];
    for k in 0..2 * n - 1 {
        for i in k.saturating_sub(n - 1)..=k.min(n - 1) {
            let j = k - i;
            let share = binomial(n - 1, i) * binomial(n - 1, j) / binomial(2 * n - 2, k);
            let weight = share * curve.points[i].z * curve.points[j + 1].z;
            coefficients[k] += weight * (axis(points[j + 1]) - axis(points[i]));
            noise[k] += weight * rounding;
        }
    }
    bernstein::sign_changes(&coefficients, &noise)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pieces(points: &[(f64, f64)]) -> Vec<Piece> {
        let curve = Bezier { points: points.iter().map(|&(u, v)| DVec3::new(u, v, 1.0)).collect() };
        let mut pieces = Vec::new();
        append_pieces(&mut pieces, 0, &curve, points[0].into());
        pieces
    }

    #[test]
    fn a_wave_is_cut_at_its_extrema() {
        // v = t (1 - t) (1 - 2t), extrema at (1 ± 1/sqrt 3) / 2
        let cuts: Vec<f64> = pieces(&[(0.0, 0.0), (1.0, 1.0 / 3.0), (2.0, -1.0 / 3.0), (3.0, 0.0)])
            .windows(2)
            .map(|w| {
                assert_eq!((w[0].end, w[0].t.1), (w[1].start, w[1].t.0));
                w[0].t.1
            })
            .collect();
        let root = 0.5 / 3f64.sqrt();
        assert!(cuts.len() == 2 && (cuts[0] - 0.5 + root).abs() < 1e-15 && (cuts[1] - 0.5 - root).abs() < 1e-15);
    }

    #[test]
    fn ripples_of_an_ulp_are_no_extrema() {
        let v: f64 = 0.1;
        assert_eq!(pieces(&[(0.0, v), (1.0, v.next_up()), (2.0, v.next_down()), (3.0, v)]).len(), 1);
    }

    #[test]
    fn straight_curves_stay_whole_and_points_vanish() {
        assert!(pieces(&[(0.0, 0.0), (0.5, 0.25), (1.5, 0.75), (2.0, 1.0)])[0].straight);
        assert!(!pieces(&[(0.0, 0.0), (0.5, 0.25), (4.0, 2.0), (2.0, 1.0)])[0].straight); // overshoots its end
        assert_eq!(pieces(&[(0.3, 0.7), (0.3, 0.7), (0.3, 0.7)]).len(), 0);
        assert_eq!(pieces(&[(0.0, 0.0), (1.0, 1.0), (0.0, 0.0)]).len(), 2); // there and back
    }
}
