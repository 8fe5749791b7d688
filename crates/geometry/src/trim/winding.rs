//! The exact trim test: winding numbers over a tree of chains.
//!
//! ```text
//!                 [all loops]                 a node is a run of consecutive pieces of one loop,
//!                 ╱         ╲                 or several whole loops, with its box
//!          [loop 0]         [loop 1]
//!          ╱      ╲          ╱     ╲          p outside the box, to its left: the run crosses the
//!     [p0 p1]   [p2 p3]    …        …         scan line as often as its two ends tell
//!                                             p outside on another side: no crossing right of p
//! ```
//!
//! Crossings telescope along a chain, so a query descends only into boxes that *contain* the point,
//! never into all pieces that its scan line meets: 10^4 holes on one face cost a few box tests.

use super::climbs;
use super::piece::{Piece, append_pieces};
use crate::model::TrimLoop;
use crate::spline::{Bezier, Control};
use glam::{DVec2, DVec3};

/// Trim loops, prepared for queries.
///
/// Straight curves (and curves of any degree whose control points are exactly collinear) are decided without rounding.
/// For other curves a point farther from the curve than a few ulp of the largest coordinate is decided right; nearer
/// points get one consistent answer, in which the loops are still closed. Straight curves of no length are dropped.
#[derive(Clone, Debug)]
pub struct LoopIndex {
    pub(super) curves: Vec<Bezier<DVec3>>,
    pub(super) pieces: Vec<Piece>,
    pub(super) nodes: Vec<Node>,
    /// Bound of the rounding of evaluated curve points per coordinate; 0 when all is straight.
    pub(super) slack: DVec2,
    /// Index of the top node.
    pub(super) root: Option<u32>,
    /// No loop at all: the whole domain.
    pub(super) whole: bool,
}

/// A box of consecutive pieces or of whole loops.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub lo: DVec2,
    pub hi: DVec2,
    /// Ordinates of the first and last point of the chain; equal for whole loops.
    ends: (f64, f64),
    pub link: Link,
}

/// The content of a node.
#[derive(Clone, Copy, Debug)]
pub(super) enum Link {
    Piece(u32),
    Pair(u32, u32),
}

impl LoopIndex {
    /// Prepares `loops`; `O(n log n)`, a few microseconds per bent curve.
    pub fn new(loops: &[TrimLoop]) -> Self {
        let mut index = Self {
            curves: Vec::new(),
            pieces: Vec::new(),
            nodes: Vec::new(),
            slack: DVec2::ZERO,
            root: None,
            whole: loops.is_empty(),
        };
        let mut tops = Vec::with_capacity(loops.len());
        for trim_loop in loops {
            let first = index.pieces.len();
            index.push_loop(trim_loop);
            if index.pieces.len() > first {
                tops.push(index.chain_node(first, index.pieces.len()));
            }
        }
        if !tops.is_empty() {
            index.root = Some(index.group_node(&mut tops));
        }
        index
    }

    /// Winding number of the loops around `p`, by the half-open rules of [`crate::trim`].
    ///
    /// 0 for a point that is not a number, and everywhere when there are no loops.
    pub fn winding(&self, p: DVec2) -> i32 {
        self.root.map_or(0, |root| self.node_winding(root, p))
    }

    /// Whether `p` belongs to the face: its winding number is not zero, or there are no loops.
    pub fn contains(&self, p: DVec2) -> bool {
        self.whole || self.winding(p) != 0
    }

    fn node_winding(&self, node: u32, p: DVec2) -> i32 {
        let node = &self.nodes[node as usize];
        if !(p.y > node.lo.y && p.y <= node.hi.y && p.x < node.hi.x) {
            return 0;
        }
        if p.x < node.lo.x {
            return climbs(node.ends.0, node.ends.1, p.y);
        }
        match node.link {
            Link::Piece(i) => {
                let piece = &self.pieces[i as usize];
                piece.crossing(&self.curves[piece.curve as usize], p)
            }
            Link::Pair(a, b) => self.node_winding(a, p) + self.node_winding(b, p),
        }
    }

    fn push_loop(&mut self, trim_loop: &TrimLoop) {
        let curves: Vec<Bezier<DVec3>> = trim_loop.curves().collect();
        let Some(last) = curves.last() else { return };
        let mut at = last.points[last.degree()].point();
        for curve in curves {
            let index = self.curves.len() as u32;
            let first = self.pieces.len();
            append_pieces(&mut self.pieces, index, &curve, at);
            if self.pieces[first..].iter().any(|p| !p.straight) {
                // Horner's scheme: 2n ulp of the largest coordinate; the cuts add as much again
                let largest = curve.points.iter().map(|p| p.point().abs()).fold(DVec2::ZERO, DVec2::max);
                self.slack = self.slack.max(largest * (4.0 * (curve.degree() + 1) as f64 * f64::EPSILON));
            }
            at = curve.points[curve.degree()].point();
            self.curves.push(curve);
        }
    }

    /// The node of pieces `first..end` of one loop, halved down to single pieces.
    fn chain_node(&mut self, first: usize, end: usize) -> u32 {
        if end - first == 1 {
            let piece = &self.pieces[first];
            let (lo, hi) = piece.bounds();
            let ends = (piece.start.y, piece.end.y);
            return self.push_node(Node { lo, hi, ends, link: Link::Piece(first as u32) });
        }
        let middle = first + (end - first) / 2;
        let (a, b) = (self.chain_node(first, middle), self.chain_node(middle, end));
        self.push_pair(a, b, (self.pieces[first].start.y, self.pieces[end - 1].end.y))
    }

    /// The node of whole loops, halved at the median of their centres along the longer side.
    fn group_node(&mut self, tops: &mut [u32]) -> u32 {
        if let [only] = tops {
            return *only;
        }
        let centre = |i: u32| self.nodes[i as usize].lo + self.nodes[i as usize].hi;
        let span = tops.iter().map(|&i| centre(i));
        let (lo, hi) = span.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), c| (lo.min(c), hi.max(c)));
        let axis = usize::from(hi.y - lo.y > hi.x - lo.x);
        let middle = tops.len() / 2;
        tops.select_nth_unstable_by(middle, |&a, &b| centre(a)[axis].total_cmp(&centre(b)[axis]).then(a.cmp(&b)));
        let (left, right) = tops.split_at_mut(middle);
        let (a, b) = (self.group_node(left), self.group_node(right));
        self.push_pair(a, b, (0.0, 0.0))
    }

    fn push_pair(&mut self, a: u32, b: u32, ends: (f64, f64)) -> u32 {
        let (x, y) = (&self.nodes[a as usize], &self.nodes[b as usize]);
        let (lo, hi) = (x.lo.min(y.lo), x.hi.max(y.hi));
        self.push_node(Node { lo, hi, ends, link: Link::Pair(a, b) })
    }

    fn push_node(&mut self, node: Node) -> u32 {
        self.nodes.push(node);
        (self.nodes.len() - 1) as u32
    }
}
