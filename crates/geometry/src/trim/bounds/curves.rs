//! The trim curves of a face in a tree of boxes. A curve is cut into monotone pieces when a test first reaches it.
//!
//! ```text
//!                 all loops               a node is a run of consecutive curves of one loop, or several whole loops,
//!                 ╱       ╲               with the box of their control points
//!             loop 0      loop 1
//!             ╱    ╲       ╱   ╲          tests go down where a box holds the point, or meets the rectangle's border
//!          curve  curve   …     …
//! ```
//!
//! Answers are those of [`LoopIndex`](crate::trim::LoopIndex), which cuts all curves at once: it costs less than this
//! where most curves are reached.

use crate::model::Face;
use crate::spline::{Bezier, Control};
use crate::trim::RectSide;
use crate::trim::classify::piece_meets;
use crate::trim::climbs;
use crate::trim::piece::{Piece, append_pieces};
use glam::{DVec2, DVec3};
use std::cell::OnceCell;

/// See the module.
#[derive(Debug)]
pub(super) struct Curves<'a> {
    pub all: Vec<Curve<'a>>,
    pub nodes: Vec<Node>,
    /// `None` where there is no loop.
    pub root: Option<usize>,
    /// Bound of the rounding of evaluated curve points per coordinate.
    slack: DVec2,
}

/// A trim curve.
#[derive(Debug)]
pub(super) struct Curve<'a> {
    /// Homogeneous control points.
    pub points: &'a [DVec3],
    /// The end of the curve before.
    start: DVec2,
    monotone: OnceCell<(Bezier<DVec3>, Vec<Piece>)>,
}

/// See the module.
#[derive(Debug)]
pub(super) struct Node {
    /// Box of the control points.
    pub lo: DVec2,
    pub hi: DVec2,
    /// Ordinates of the first and last point of the run; equal for whole loops.
    ends: (f64, f64),
    pub link: Link,
}

#[derive(Clone, Copy, Debug)]
pub(super) enum Link {
    Curve(usize),
    Pair(usize, usize),
}

impl<'a> Curves<'a> {
    pub fn new(face: &'a Face) -> Self {
        let mut this = Self { all: Vec::new(), nodes: Vec::new(), root: None, slack: DVec2::ZERO };
        let mut loops = Vec::with_capacity(face.loops.len());
        for trim_loop in &face.loops {
            let first = this.all.len();
            let Some(last) = trim_loop.control_points().last().and_then(<[DVec3]>::last) else { continue };
            let mut start = last.point();
            for points in trim_loop.control_points() {
                this.all.push(Curve { points, start, monotone: OnceCell::new() });
                start = points.last().map_or(start, |p| p.point());
            }
            loops.push(this.run(first, this.all.len()));
        }
        this.root = (!loops.is_empty()).then(|| this.several(&mut loops));
        let degree = this.all.iter().map(|curve| curve.points.len()).max().unwrap_or(0);
        if let Some(root) = this.root {
            // Horner's scheme rounds by two units a degree; the cuts add as much again
            let Node { lo, hi, .. } = this.nodes[root];
            this.slack = lo.abs().max(hi.abs()) * (4.0 * degree as f64 * f64::EPSILON);
        }
        this
    }

    /// Box of all control points.
    pub fn around(&self) -> Option<(DVec2, DVec2)> {
        self.root.map(|root| (self.nodes[root].lo, self.nodes[root].hi))
    }

    /// The node of some curves of one loop.
    fn run(&mut self, first: usize, end: usize) -> usize {
        if end - first == 1 {
            let Curve { points, start, .. } = &self.all[first];
            let last = points.last().map_or(*start, |p| p.point());
            let all = points.iter().map(|p| p.point());
            let (lo, hi) = all.fold((*start, *start), |(lo, hi), p| (lo.min(p), hi.max(p)));
            return self.push(Node { lo, hi, ends: (start.y, last.y), link: Link::Curve(first) });
        }
        let middle = first + (end - first) / 2;
        let (a, b) = (self.run(first, middle), self.run(middle, end));
        self.pair(a, b, (self.nodes[a].ends.0, self.nodes[b].ends.1))
    }

    /// The node of whole loops, halved at the median of their middles along the longer side.
    fn several(&mut self, loops: &mut [usize]) -> usize {
        if let [only] = loops {
            return *only;
        }
        let middle = |node: &usize| self.nodes[*node].lo + self.nodes[*node].hi;
        let none = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let (lo, hi) = loops.iter().map(middle).fold(none, |(lo, hi), p| (lo.min(p), hi.max(p)));
        let axis = usize::from(hi.y - lo.y > hi.x - lo.x);
        let half = loops.len() / 2;
        loops.select_nth_unstable_by(half, |a, b| middle(a)[axis].total_cmp(&middle(b)[axis]).then(a.cmp(b)));
        let (a, b) = loops.split_at_mut(half);
        let (a, b) = (self.several(a), self.several(b));
        self.pair(a, b, (0.0, 0.0))
    }

    fn pair(&mut self, a: usize, b: usize, ends: (f64, f64)) -> usize {
        let (x, y) = (&self.nodes[a], &self.nodes[b]);
        let (lo, hi) = (x.lo.min(y.lo), x.hi.max(y.hi));
        self.push(Node { lo, hi, ends, link: Link::Pair(a, b) })
    }

    fn push(&mut self, node: Node) -> usize {
        self.nodes.push(node);
        self.nodes.len() - 1
    }

    fn monotone(&self, curve: usize) -> &(Bezier<DVec3>, Vec<Piece>) {
        let Curve { points, start, monotone } = &self.all[curve];
        monotone.get_or_init(|| {
            let (curve, mut pieces) = (Bezier { points: points.to_vec() }, Vec::new());
            append_pieces(&mut pieces, 0, &curve, *start);
            (curve, pieces)
        })
    }

    #[cfg(test)]
    pub fn curves_cut(&self) -> usize {
        self.all.iter().filter(|curve| curve.monotone.get().is_some()).count()
    }

    /// Whether the loops keep a point.
    pub fn contains(&self, p: DVec2) -> bool {
        self.root.is_none_or(|root| self.winding(root, p) != 0)
    }

    fn winding(&self, node: usize, p: DVec2) -> i32 {
        let Node { lo, hi, ends, link } = &self.nodes[node];
        if !(p.y > lo.y && p.y <= hi.y && p.x < hi.x) {
            return 0;
        }
        if p.x < lo.x {
            return climbs(ends.0, ends.1, p.y);
        }
        match *link {
            Link::Curve(curve) => {
                let (curve, pieces) = self.monotone(curve);
                pieces.iter().map(|piece| piece.crossing(curve, p)).sum()
            }
            Link::Pair(a, b) => self.winding(a, p) + self.winding(b, p),
        }
    }

    /// Where a rectangle lies; `Inside` and `Outside` are certain.
    pub fn classify(&self, lo: DVec2, hi: DVec2) -> RectSide {
        let wide = (lo - self.slack, hi + self.slack);
        if self.root.is_some_and(|root| self.meets(root, wide)) {
            RectSide::Boundary
        } else if self.contains(lo) {
            RectSide::Inside
        } else {
            RectSide::Outside
        }
    }

    fn meets(&self, node: usize, rect: (DVec2, DVec2)) -> bool {
        let Node { lo, hi, link, .. } = &self.nodes[node];
        if lo.cmpgt(rect.1).any() || hi.cmplt(rect.0).any() {
            return false;
        }
        // straight curves of no length are not there
        if lo != hi && lo.cmpge(rect.0).all() && hi.cmple(rect.1).all() {
            return true;
        }
        match *link {
            Link::Curve(curve) => {
                let (curve, pieces) = self.monotone(curve);
                pieces.iter().any(|piece| piece_meets(piece, curve, rect))
            }
            Link::Pair(a, b) => self.meets(a, rect) || self.meets(b, rect),
        }
    }
}
