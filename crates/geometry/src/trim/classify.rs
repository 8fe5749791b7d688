//! Rectangles of the domain against the trim curves.
//!
//! ```text
//!    ┌───────────────┐
//!    │ ┌──┐  ╭────╮  │      most sub-patches of a face meet no trim curve: they are kept or
//!    │ │in│  │out │ ┌┼─┐    dropped whole, and only the others pay for a trim test per pixel
//!    │ └──┘  ╰────╯ └┼─┘
//!    └───────────────┘ boundary
//! ```

use super::LoopIndex;
use super::piece::{Piece, within};
use super::winding::Link;
use crate::math::orientation::orientation;
use crate::spline::Bezier;
use glam::{DVec2, DVec3};

/// Halvings of a bi-monotone piece before it counts as meeting the rectangle: a curve that passes
/// nearer than about a millionth of the piece's size is `Boundary`.
const MAX_HALVINGS: u32 = 20;

/// Where a rectangle of the domain lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RectSide {
    /// Every point belongs to the face, and no trim curve touches the rectangle.
    Inside,
    /// No point belongs to the face, and no trim curve touches the rectangle.
    Outside,
    /// A trim curve meets the closed rectangle, or comes too near to decide.
    Boundary,
}

impl LoopIndex {
    /// Classifies the closed rectangle from `lo` to `hi` (`lo <= hi` in both coordinates).
    ///
    /// Conservative: `Inside` and `Outside` are certain. A curve that only touches the border counts
    /// as `Boundary`, so do curves that cancel each other, and rectangles that are not numbers.
    pub fn classify(&self, lo: DVec2, hi: DVec2) -> RectSide {
        let ordered = lo.cmple(hi).all() && lo.is_finite() && hi.is_finite();
        let wide = (lo - self.slack, hi + self.slack);
        if !ordered || self.root.is_some_and(|root| self.meets(root, wide)) {
            RectSide::Boundary
        } else if self.contains(lo) {
            RectSide::Inside
        } else {
            RectSide::Outside
        }
    }

    fn meets(&self, node: u32, rect: (DVec2, DVec2)) -> bool {
        let node = &self.nodes[node as usize];
        if apart((node.lo, node.hi), rect) {
            return false;
        }
        match node.link {
            Link::Piece(i) => {
                let piece = &self.pieces[i as usize];
                piece_meets(piece, &self.curves[piece.curve as usize], rect)
            }
            Link::Pair(a, b) => self.meets(a, rect) || self.meets(b, rect),
        }
    }
}

/// Whether a piece meets a rectangle that meets its box.
pub(super) fn piece_meets(piece: &Piece, curve: &Bezier<DVec3>, rect: (DVec2, DVec2)) -> bool {
    if piece.straight {
        // boxes overlap: only the line itself can still separate two convex shapes
        let (lo, hi) = rect;
        let corners = [lo, DVec2::new(hi.x, lo.y), hi, DVec2::new(lo.x, hi.y)];
        let sides = corners.map(|c| orientation(piece.start, piece.end, c));
        return !(sides.iter().all(|&s| s > 0.0) || sides.iter().all(|&s| s < 0.0));
    }
    arc_meets(curve, (piece.t.0, piece.start), (piece.t.1, piece.end), rect, MAX_HALVINGS)
}

fn arc_meets(curve: &Bezier<DVec3>, a: (f64, DVec2), b: (f64, DVec2), rect: (DVec2, DVec2), left: u32) -> bool {
    let inside = |p: DVec2| p.cmpge(rect.0).all() && p.cmple(rect.1).all();
    if apart((a.1.min(b.1), a.1.max(b.1)), rect) {
        return false;
    }
    if left == 0 || inside(a.1) || inside(b.1) {
        return true;
    }
    let t = 0.5 * (a.0 + b.0);
    let middle = (t, within(curve.point(t), a.1, b.1));
    arc_meets(curve, a, middle, rect, left - 1) || arc_meets(curve, middle, b, rect, left - 1)
}

/// Two closed boxes have no common point.
fn apart(a: (DVec2, DVec2), b: (DVec2, DVec2)) -> bool {
    a.0.cmpgt(b.1).any() || b.0.cmpgt(a.1).any()
}
