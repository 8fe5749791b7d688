//! The distance of a point from the nearest trim curve: judges use it to excuse ties.

use super::LoopIndex;
use super::piece::{Piece, within};
use super::winding::Link;
use crate::spline::Bezier;
use glam::{DVec2, DVec3};

/// Stop when the bracket's box is this much smaller than the distance.
const RELATIVE: f64 = 1.0 / 1024.0;

/// A query in progress; lengths in scaled units.
struct Search<'a> {
    index: &'a LoopIndex,
    p: DVec2,
    scale: DVec2,
    /// Boxes smaller than this are points.
    floor: f64,
    best: f64,
}

impl LoopIndex {
    /// Distance in `(u, v)` from `p` to the nearest trim curve, at most `limit`; `limit` when there
    /// is none nearer.
    ///
    /// Never below the true distance, and above it by less than 0.1 % plus the rounding of curve
    /// points (a few ulp of the largest coordinate). Exact to rounding for straight curves. A small
    /// `limit` makes it fast.
    pub fn distance(&self, p: DVec2, limit: f64) -> f64 {
        self.distance_scaled(p, DVec2::ONE, limit)
    }

    /// [`LoopIndex::distance`] where one unit of `u` is `scale.x` long and one of `v` is `scale.y`,
    /// for example in pixels.
    pub fn distance_scaled(&self, p: DVec2, scale: DVec2, limit: f64) -> f64 {
        let floor = (self.slack * scale).max_element();
        let mut search = Search { index: self, p, scale, floor, best: limit };
        if let Some(root) = self.root {
            search.visit(root);
        }
        search.best
    }
}

impl Search<'_> {
    /// Distance from the point to a box.
    fn to_box(&self, lo: DVec2, hi: DVec2) -> f64 {
        ((self.p - self.p.clamp(lo, hi)) * self.scale).length()
    }

    fn to_point(&self, q: DVec2) -> f64 {
        ((self.p - q) * self.scale).length()
    }

    fn visit(&mut self, node: u32) {
        let index = self.index;
        match index.nodes[node as usize].link {
            Link::Piece(i) => {
                let piece = &index.pieces[i as usize];
                self.piece(piece, &index.curves[piece.curve as usize]);
            }
            Link::Pair(a, b) => {
                let near = |i: u32| {
                    let node = &index.nodes[i as usize];
                    (self.to_box(node.lo, node.hi), i)
                };
                let (a, b) = (near(a), near(b));
                for (least, i) in if a.0 <= b.0 { [a, b] } else { [b, a] } {
                    if least < self.best {
                        self.visit(i);
                    }
                }
            }
        }
    }

    fn piece(&mut self, piece: &Piece, curve: &Bezier<DVec3>) {
        if piece.straight {
            let (a, b) = ((piece.start - self.p) * self.scale, (piece.end - self.p) * self.scale);
            let along = b - a;
            let t = (-a.dot(along) / along.length_squared()).clamp(0.0, 1.0);
            self.best = self.best.min((a + along * t).length().min(a.length()).min(b.length()));
        } else {
            self.best = self.best.min(self.to_point(piece.start)).min(self.to_point(piece.end));
            self.arc(curve, (piece.t.0, piece.start), (piece.t.1, piece.end));
        }
    }

    /// Branch and bound; the ends are already counted.
    fn arc(&mut self, curve: &Bezier<DVec3>, a: (f64, DVec2), b: (f64, DVec2)) {
        let size = ((b.1 - a.1) * self.scale).length();
        let t = 0.5 * (a.0 + b.0);
        let least = self.to_box(a.1.min(b.1), a.1.max(b.1));
        // each point of the arc is within `size` of an end
        if least >= self.best || size <= self.floor.max(self.best * RELATIVE) || t == a.0 || t == b.0 {
            return;
        }
        let middle = (t, within(curve.point(t), a.1, b.1));
        self.best = self.best.min(self.to_point(middle.1));
        let left = self.to_box(a.1.min(middle.1), a.1.max(middle.1));
        let right = self.to_box(middle.1.min(b.1), middle.1.max(b.1));
        if left <= right {
            self.arc(curve, a, middle);
            self.arc(curve, middle, b);
        } else {
            self.arc(curve, middle, b);
            self.arc(curve, a, middle);
        }
    }
}
