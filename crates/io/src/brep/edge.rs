//! One use of an edge by a loop: the curve run forward from one vertex to the other.

use super::curve::Curve;
use super::{BuildError, CurveGeometry, Edge};
use crate::model::Bounds;
use glam::DVec3;

/// A curve over `[t0, t1]`, `t0 < t1`, in the direction in which the loop runs it.
#[derive(Clone, Debug)]
pub(super) struct EdgeCurve {
    /// Number in the source.
    pub id: u32,
    /// Its index among the body's edges, and whether the loop runs it from start to end.
    pub used: (usize, bool),
    /// Turned around where the loop runs it backwards.
    pub curve: Curve,
    /// Parameter at the start.
    pub t0: f64,
    /// Parameter at the end.
    pub t1: f64,
    /// The vertices, which the loop's other edges share.
    pub vertices: [DVec3; 2],
    /// The stated sense contradicted the order of the vertices on the curve.
    pub turned: bool,
    /// Length of the polygon through the nodes, mm.
    pub length: f64,
    /// Box of the nodes.
    pub bounds: Bounds,
    /// How many nodes there are.
    pub node_count: usize,
}

/// Share of a curve's width by which the ends of a loop of one edge may miss each other.
const OPEN: f64 = 0.05;

impl EdgeCurve {
    /// The edge as a loop uses it, or `None` when it is no longer than `eps`, mm: the rounding of
    /// its coordinates.
    ///
    /// # Errors
    /// [`BuildError::Curve`] when its numbers are impossible.
    pub fn new(edge: &Edge, forward: bool, eps: f64) -> Result<Option<Self>, BuildError> {
        let mut this = Self::without_range(edge, forward, eps)?;
        let closed = edge.start.distance(edge.end) <= 1e-3 * eps;
        if !this.set_range(closed, eps) {
            // on an open curve the order of the vertices outweighs the sense flag
            this.curve = this.curve.reversed();
            this.turned = true;
            if !this.set_range(closed, eps) {
                return Ok(None);
            }
        }
        this.measure();
        Ok((this.length > eps).then_some(this))
    }

    /// The edges of a bound of `face`, in the direction of the bound; those no longer than `eps` are left out. A single
    /// edge whose vertices make it bound nothing is taken once around its curve.
    ///
    /// # Errors
    /// As [`EdgeCurve::new`]; [`BuildError::EdgeIndex`] for an edge that does not exist.
    pub fn of_bound(list: &[(usize, bool)], edges: &[Edge], face: u32, eps: f64) -> Result<Vec<Self>, BuildError> {
        let mut all = Vec::new();
        for &(index, forward) in list {
            let edge = edges.get(index).ok_or(BuildError::EdgeIndex { face, index })?;
            let of_edge = Self::new(edge, forward, eps)?;
            all.extend(of_edge.map(|e| Self { used: (index, forward), ..e }));
        }
        if all.len() < 2 && all.first().is_none_or(Self::is_sliver) {
            let around = |&(index, forward): &(usize, bool)| {
                let whole = Self::around(&edges[index], forward, eps)?;
                Ok(whole.map(|e| Self { used: (index, forward), ..e }))
            };
            let whole = list.iter().filter_map(|e| around(e).transpose()).collect::<Result<Vec<_>, _>>()?;
            if whole.len() == 1 {
                all = whole;
            }
        }
        Ok(all)
    }

    /// The edge as a whole loop: once around its curve, or along all of a curve whose ends nearly meet, whatever the
    /// order of the vertices. `None` where it closes no loop.
    ///
    /// # Errors
    /// As [`EdgeCurve::new`].
    pub fn around(edge: &Edge, forward: bool, eps: f64) -> Result<Option<Self>, BuildError> {
        let mut curve = &edge.curve;
        while let CurveGeometry::Composite(segments) = curve
            && let [only] = &segments[..]
        {
            curve = only;
        }
        let edge = Edge { curve: curve.clone(), ..*edge };
        let mut this = Self::without_range(&edge, forward, eps)?;
        let Some((a, b)) = this.curve.domain() else { return Ok(None) };
        let [start, end] = this.vertices;
        let gap = start.distance(end).max(eps);
        let from_end = this.curve.period().is_none() || this.curve.point(a).distance(start) <= gap;
        this.t0 = if from_end { a } else { this.curve.closest(start) };
        this.t1 = this.t0 + (b - a);
        let reach = this.point(0.5).distance(start);
        let apart = start.distance(end).max(this.point(0.0).distance(start)).max(this.point(1.0).distance(end));
        this.measure();
        Ok((apart <= OPEN * reach && this.length > eps).then_some(this))
    }

    /// The edge bounds nothing by itself: it is about as long as its vertices are apart.
    pub fn is_sliver(&self) -> bool {
        self.length <= 4.0 * self.vertices[0].distance(self.vertices[1])
    }

    fn without_range(edge: &Edge, forward: bool, eps: f64) -> Result<Self, BuildError> {
        let named = |reason| BuildError::Curve { edge: edge.id, reason };
        if !(edge.start.is_finite() && edge.end.is_finite()) {
            return Err(named("a vertex is not finite"));
        }
        let stated = Curve::new(&edge.curve, eps).map_err(named)?;
        let curve = if edge.same_sense == forward { stated } else { stated.reversed() };
        let vertices = if forward { [edge.start, edge.end] } else { [edge.end, edge.start] };
        let (length, bounds, node_count) = (0.0, Bounds::EMPTY, 0);
        let used = (0, forward);
        Ok(Self { id: edge.id, used, curve, t0: 0.0, t1: 0.0, vertices, turned: false, length, bounds, node_count })
    }

    /// Length and box, once the range is known.
    fn measure(&mut self) {
        let points: Vec<DVec3> = self.nodes().iter().map(|s| self.point(*s)).collect();
        self.node_count = points.len();
        self.length = points.windows(2).map(|w| w[0].distance(w[1])).sum();
        self.bounds = points.into_iter().fold(Bounds::EMPTY, Bounds::with);
    }

    /// Finds `t0 < t1`; false when the vertices come in the wrong order or coincide.
    fn set_range(&mut self, closed: bool, eps: f64) -> bool {
        let [start, end] = self.vertices;
        self.t0 = self.curve.at_vertex(start, eps);
        self.t1 = self.curve.at_vertex(end, eps);
        let Some(period) = self.curve.period() else {
            // one vertex, and a curve whose ends miss each other by more than eps: all of it
            if let (true, Some((a, b))) = (closed, self.curve.domain()) {
                let reach = self.curve.point(0.5 * (a + b)).distance(start);
                if self.curve.point(a).distance(start).max(self.curve.point(b).distance(start)) < OPEN * reach {
                    (self.t0, self.t1) = (a, b);
                }
            }
            return self.t1 > self.t0;
        };
        if closed {
            self.t1 = self.t0 + period;
            return true;
        }
        // a vertex within eps of the other one's parameter, seen from the wrong side, must not
        // turn a short edge into a whole turn
        let ahead = (self.t1 - self.t0).rem_euclid(period);
        if ahead < 0.5 * period && !self.turned && self.spans_its_gap() {
            (self.t0, self.t1) = self.curve.domain().unwrap_or((self.t0, self.t1));
            return true;
        }
        let speed = self.curve.jet(self.t0).1.length();
        let short = start.distance(end) <= 2.0 * eps && (period - ahead) * speed <= 4.0 * eps;
        self.t1 = self.t0 + ahead;
        ahead > 0.0 && !short
    }

    /// The curve closes except for a gap, and the vertices are its two ends: the edge is the whole curve.
    fn spans_its_gap(&self) -> bool {
        let (Curve::Pieces(_), Some((a, b))) = (&self.curve, self.curve.domain()) else { return false };
        let [first, last] = [a, b].map(|t| self.curve.point(t));
        let near = 0.25 * first.distance(last);
        near > 0.0 && self.vertices[0].distance(first) <= near && self.vertices[1].distance(last) <= near
    }

    /// Curve parameter at the fraction `s` of the range.
    pub fn parameter(&self, s: f64) -> f64 {
        if s == 1.0 { self.t1 } else { self.t0 + (self.t1 - self.t0) * s }
    }

    fn fraction(&self, t: f64) -> f64 {
        (t - self.t0) / (self.t1 - self.t0)
    }

    /// Point at the fraction `s` of the parameter range.
    pub fn point(&self, s: f64) -> DVec3 {
        self.curve.point(self.parameter(s))
    }

    /// Increasing fractions from 0 to 1, dense where the curve bends.
    pub fn nodes(&self) -> Vec<f64> {
        let mut nodes: Vec<f64> =
            self.curve.nodes(self.t0, self.t1).into_iter().map(|t| self.fraction(t).clamp(0.0, 1.0)).collect();
        nodes.dedup();
        nodes
    }

    /// Fractions strictly inside `(0, 1)` where the second derivative may jump.
    pub fn creases(&self) -> Vec<f64> {
        self.curve.creases(self.t0, self.t1).into_iter().map(|t| self.fraction(t)).collect()
    }
}
