//! Faces thinner than the tolerance of their body.
//!
//! ```text
//!       ╭──────▶──────╮        Each point of the border has another edge within the tolerance, which runs the other
//!     ╭─╯ ╭────◀────╮ ╰─╮      way: the face lies between the two. Edges no longer than the tolerance need none.
//!     ●───╯         ╰───●
//! ```
//!
//! A border that runs along one edge twice has the face on both sides of it: a seam, and no sliver. On a closed surface
//! the face may be all that is not between the two. There the directions of the loops must say that it is.
//!
//! *Accuracy.* Edges are compared at [`STEPS`] points each, and at the nodes where they bend; each point with the exact
//! curves of the other edges.

use super::edge::EdgeCurve;
use super::support::Support;
use super::{Boundary, Edge, FaceGeometry};
use crate::model::Bounds;
use glam::DVec3;

/// Points of an edge, beside its nodes.
const STEPS: u32 = 16;
/// A tolerance counts up to this share of the border's extent: one of the face's own size says nothing.
const THIN: f64 = 1e-2;
/// Nodes of all edges beyond which they are not compared, each with each.
const MOST_NODES: usize = 1024;

impl FaceGeometry {
    /// Whether the face is nowhere wider than the tolerance, mm, and a hundredth of its extent. A body that lacks such
    /// a face has no gap wider than its tolerance.
    pub fn is_sliver(&self, edges: &[Edge], tolerance: f64) -> bool {
        let borders: Option<Vec<Vec<EdgeCurve>>> = self.bounds.iter().map(|b| border(b, edges, tolerance)).collect();
        let Some(borders) = borders.filter(|all| !all.is_empty()) else { return false };
        let Ok(support) = Support::new(&self.surface, tolerance) else { return false };
        let nodes: usize = borders.iter().flatten().map(|e| e.node_count).sum();
        if nodes > MOST_NODES || (self.ambiguous && support.is_closed()) {
            return false;
        }
        let is_thin = |border: &[Vec<EdgeCurve>]| Strip::new(border, tolerance).is_some_and(|s| s.is_thin(&support));
        borders.chunks(1).all(is_thin) || (borders.len() == 2 && is_thin(&borders))
    }
}

/// The edges of a bound that have a length; `None` where it has none, or cannot be followed.
fn border(bound: &Boundary, edges: &[Edge], tolerance: f64) -> Option<Vec<EdgeCurve>> {
    let Boundary::Edges(list) = bound else { return None };
    let mut all = Vec::new();
    for &(index, forward) in list {
        let edge = EdgeCurve::new(edges.get(index)?, forward, 1e-3 * tolerance).ok()?;
        all.extend(edge.map(|e| EdgeCurve { used: (index, forward), ..e }));
    }
    (!all.is_empty()).then_some(all)
}

/// The edges of one border, or of two.
struct Strip<'a> {
    edges: Vec<&'a EdgeCurve>,
    tolerance: f64,
}

impl<'a> Strip<'a> {
    /// `None` where a border does not close, or an edge is a seam.
    fn new(borders: &'a [Vec<EdgeCurve>], tolerance: f64) -> Option<Self> {
        let edges: Vec<&EdgeCurve> = borders.iter().flatten().collect();
        let extent = edges.iter().fold(Bounds::EMPTY, |all, e| all.union(e.bounds)).diagonal();
        let tolerance = tolerance.min(THIN * extent);
        let closes = |border: &Vec<EdgeCurve>| {
            let next = border.iter().cycle().skip(1);
            border.iter().zip(next).all(|(e, next)| e.vertices[1].distance(next.vertices[0]) <= tolerance)
        };
        let mut uses: Vec<usize> = edges.iter().filter(|e| e.length > tolerance).map(|e| e.used.0).collect();
        uses.sort_unstable();
        let has_seam = uses.windows(2).any(|w| w[0] == w[1]);
        (borders.iter().all(closes) && !has_seam).then_some(Self { edges, tolerance })
    }

    fn is_thin(&self, support: &Support) -> bool {
        // widths to the left of the edges, where the face is, and all widths
        let (mut left, mut all) = (0.0, 0.0);
        for (i, edge) in self.edges.iter().enumerate().filter(|(_, e)| e.length > self.tolerance) {
            let even = (0..STEPS).map(|k| (f64::from(k) + 0.5) / f64::from(STEPS));
            for s in even.chain(edge.nodes()).filter(|s| *s > 0.0 && *s < 1.0) {
                let (p, along) = edge.curve.jet(edge.parameter(s));
                let across = |(j, other): (usize, &&EdgeCurve)| {
                    let (q, back) = nearest(other, p);
                    (j != i && q.distance(p) <= self.tolerance && along.dot(back) < 0.0).then_some(q - p)
                };
                let Some(width) = self.edges.iter().enumerate().find_map(across) else { return false };
                if support.is_closed() {
                    let jet = support.jet(support.nearest(p, None, 0.0).0);
                    left += jet.du.cross(jet.dv).cross(along).normalize_or_zero().dot(width);
                    all += width.length();
                }
            }
        }
        !support.is_closed() || left > 0.5 * all
    }
}

/// The point of an edge near `p`, and the derivative there.
fn nearest(edge: &EdgeCurve, p: DVec3) -> (DVec3, DVec3) {
    let t = edge.curve.closest(p);
    let t = edge.curve.period().map_or(t, |period| {
        let ahead = edge.t0 + (t - edge.t0).rem_euclid(period);
        // beyond the end, the nearer end
        if ahead - edge.t1 > edge.t0 + period - ahead { edge.t0 } else { ahead }
    });
    edge.curve.jet(t.clamp(edge.t0, edge.t1))
}
