//! Faces thinner than the tolerance of their body.
//!
//! ```text
//!       ╭──────▶──────╮        Each point of the border has another edge within the tolerance, which runs the other
//!     ╭─╯ ╭────◀────╮ ╰─╮      way: the face lies between the two. Edges no longer than the tolerance need none.
//!     ●───╯         ╰───●
//! ```
//!
//! One edge may run there and back: then its points are compared with the edge itself, where it runs the other way.
//! Where it turns around within the tolerance, it needs nothing beside it. A border whose edges are all one point
//! leaves nothing of a surface that neither closes nor has a pole.
//!
//! A border that runs along one edge twice has the face on both sides of it: a seam, and no sliver. On a closed surface
//! the face may be all that is not between the two. There the directions of the loops must say that it is.
//!
//! *Accuracy.* Edges are compared at [`STEPS`] points each, and at the nodes where they bend; each point with the exact
//! curves of the other edges, and with its own beginning at the nearest [`SEEDS`] nodes.

use super::curve::Curve;
use super::edge::EdgeCurve;
use super::support::Support;
use super::{Boundary, Edge, FaceGeometry};
use crate::model::Bounds;
use glam::DVec3;

/// Points of an edge, beside its nodes.
const STEPS: u32 = 16;
/// A tolerance counts up to this share of the border's extent: one of the face's own size says nothing.
const THIN: f64 = 1e-2;
/// Nodes from which the nearest point of the same edge is searched, at most.
const SEEDS: usize = 4;
/// Steps of that search.
const MOST_STEPS: usize = 20;
/// Halvings of a sixteenth of an edge, after which it counts as straight.
const HALVINGS: u32 = 30;
/// Nodes of all edges beyond which they are not compared, each with each.
const MOST_NODES: usize = 1024;

impl FaceGeometry {
    /// Whether the face is nowhere wider than the tolerance, mm, and a hundredth of its extent. A body that lacks such
    /// a face has no gap wider than its tolerance.
    pub fn is_sliver(&self, edges: &[Edge], tolerance: f64) -> bool {
        let borders = self.bounds.iter().map(|bound| border(bound, edges, self.id, tolerance));
        let Some(mut borders) = borders.collect::<Option<Vec<_>>>().filter(|all| !all.is_empty()) else { return false };
        let Ok(support) = Support::new(&self.surface, tolerance) else { return false };
        borders.retain(|border| !border.is_empty());
        if borders.is_empty() {
            return !support.is_closed() && support.poles.is_empty();
        }
        let nodes: usize = borders.iter().flatten().map(|e| e.node_count).sum();
        if nodes > MOST_NODES || (self.ambiguous && support.is_closed()) {
            return false;
        }
        let is_thin = |border: &[Vec<EdgeCurve>]| Strip::new(border, tolerance).is_some_and(|s| s.is_thin(&support));
        borders.chunks(1).all(is_thin) || (borders.len() == 2 && is_thin(&borders))
    }
}

/// The edges of a bound that have a length, none where all of it is a point; `None` where it cannot be followed.
fn border(bound: &Boundary, edges: &[Edge], face: u32, tolerance: f64) -> Option<Vec<EdgeCurve>> {
    let Boundary::Edges(list) = bound else { return None };
    let eps = 1e-3 * tolerance;
    let all = EdgeCurve::of_bound(list, edges, face, eps).ok()?;
    let at = edges.get(list.first()?.0)?.start;
    let is_point = || list.iter().all(|(index, _)| is_point(&edges[*index], at, eps));
    (!all.is_empty() || is_point()).then_some(all)
}

/// Whether an edge lies within `eps`, mm, of a point. Part of a curve that ends counts as all of it.
fn is_point(edge: &Edge, at: DVec3, eps: f64) -> bool {
    let near = |p: DVec3| p.distance(at) <= eps;
    let Ok(curve) = Curve::new(&edge.curve, eps) else { return false };
    let all = |(a, b): (f64, f64)| curve.nodes(a, b).into_iter().all(|t| near(curve.point(t)));
    near(edge.start) && near(edge.end) && curve.domain().is_none_or(all)
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
            let own = stations(edge);
            let even = (0..STEPS).map(|k| (f64::from(k) + 0.5) / f64::from(STEPS));
            for s in even.chain(edge.nodes()).filter(|s| *s > 0.0 && *s < 1.0) {
                let (p, along) = edge.curve.jet(edge.parameter(s));
                let across = |(j, other): (usize, &&EdgeCurve)| {
                    let (q, back) = nearest(other, p);
                    (j != i && q.distance(p) <= self.tolerance && along.dot(back) < 0.0).then_some(q - p)
                };
                let others = self.edges.iter().enumerate().find_map(across);
                let Some(width) = others.or_else(|| self.back(edge, &own, (p, along))) else {
                    if self.turns(edge, edge.parameter(s), p) {
                        continue;
                    }
                    return false;
                };
                if support.is_closed() {
                    let jet = support.jet(support.nearest(p, None, 0.0).0);
                    left += jet.du.cross(jet.dv).cross(along).normalize_or_zero().dot(width);
                    all += width.length();
                }
            }
        }
        !support.is_closed() || left > 0.5 * all
    }

    /// The way from a point of an edge to the same edge where it runs the other way, within the tolerance.
    fn back(&self, edge: &EdgeCurve, own: &[Station], (p, along): (DVec3, DVec3)) -> Option<DVec3> {
        let mut seeds: Vec<usize> = (0..own.len()).filter(|k| own[*k].along.dot(along) < 0.0).collect();
        let from = |k: &usize| own[*k].point.distance_squared(p);
        seeds.sort_by(|a, b| from(a).total_cmp(&from(b)));
        seeds.into_iter().take(SEEDS).find_map(|k| {
            let (first, last) = (own[k.saturating_sub(1)].t, own[(k + 1).min(own.len() - 1)].t);
            let mut t = own[k].t;
            for _ in 0..MOST_STEPS {
                let (c, d) = edge.curve.jet(t);
                t = (t + (p - c).dot(d) / d.length_squared().max(f64::MIN_POSITIVE)).clamp(first, last);
            }
            let (q, back) = edge.curve.jet(t);
            (q.distance(p) <= self.tolerance && along.dot(back) < 0.0).then_some(q - p)
        })
    }

    /// Whether an edge turns around within the tolerance of its point `p` at `t`.
    fn turns(&self, edge: &EdgeCurve, t: f64, p: DVec3) -> bool {
        let length = edge.t1 - edge.t0;
        let goes_on = edge.curve.period().is_some_and(|period| length > (1.0 - 1e-9) * period);
        let jet = |t: f64| edge.curve.jet(if goes_on { t } else { t.clamp(edge.t0, edge.t1) });
        // the direction as far away as the tolerance, or half as far
        let direction = |sign: f64| {
            let mut step = sign * length / 16.0;
            for _ in 0..HALVINGS {
                let near = |k: u32| jet(t + step * (0.25 * f64::from(k))).0.distance(p) <= self.tolerance;
                if (1..=4).all(near) {
                    break;
                }
                step *= 0.5;
            }
            jet(t + step).1
        };
        direction(-1.0).dot(direction(1.0)) < 0.0
    }
}

/// A node of an edge.
struct Station {
    t: f64,
    point: DVec3,
    along: DVec3,
}

fn stations(edge: &EdgeCurve) -> Vec<Station> {
    let station = |s: f64| {
        let t = edge.parameter(s);
        let (point, along) = edge.curve.jet(t);
        Station { t, point, along }
    };
    edge.nodes().into_iter().map(station).collect()
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
