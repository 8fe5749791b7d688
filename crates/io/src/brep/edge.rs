//! One use of an edge by a loop: the curve run forward from one vertex to the other.

use super::curve::Curve;
use super::{BuildError, Edge};
use crate::model::Bounds;
use glam::DVec3;

/// A curve over `[t0, t1]`, `t0 < t1`, in the direction in which the loop runs it.
#[derive(Clone, Debug)]
pub(super) struct EdgeCurve {
    /// Number in the source.
    pub id: u32,
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

impl EdgeCurve {
    /// The edge as a loop uses it, or `None` when it is no longer than `eps`, mm: the rounding of
    /// its coordinates.
    ///
    /// # Errors
    /// [`BuildError::Curve`] when its numbers are impossible.
    pub fn new(edge: &Edge, forward: bool, eps: f64) -> Result<Option<Self>, BuildError> {
        let named = |reason| BuildError::Curve { edge: edge.id, reason };
        if !(edge.start.is_finite() && edge.end.is_finite()) {
            return Err(named("a vertex is not finite"));
        }
        let stated = Curve::new(&edge.curve, eps).map_err(named)?;
        let curve = if edge.same_sense == forward { stated } else { stated.reversed() };
        let vertices = if forward { [edge.start, edge.end] } else { [edge.end, edge.start] };
        let closed = edge.start.distance(edge.end) <= 1e-3 * eps;
        let (length, bounds, node_count) = (0.0, Bounds::EMPTY, 0);
        let mut this =
            Self { id: edge.id, curve, t0: 0.0, t1: 0.0, vertices, turned: false, length, bounds, node_count };
        if !this.set_range(closed, eps) {
            // an open curve met in the opposite order: the sense flag is wrong, the vertices are not
            this.curve = this.curve.reversed();
            this.turned = true;
            if !this.set_range(closed, eps) {
                return Ok(None);
            }
        }
        let points: Vec<DVec3> = this.nodes().iter().map(|s| this.point(*s)).collect();
        this.node_count = points.len();
        this.length = points.windows(2).map(|w| w[0].distance(w[1])).sum();
        this.bounds = points.into_iter().fold(Bounds::EMPTY, Bounds::with);
        Ok((this.length > eps).then_some(this))
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
                if self.curve.point(a).distance(start).max(self.curve.point(b).distance(start)) < 0.05 * reach {
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
        let speed = self.curve.jet(self.t0).1.length();
        let short = start.distance(end) <= 2.0 * eps && (period - ahead) * speed <= 4.0 * eps;
        self.t1 = self.t0 + ahead;
        ahead > 0.0 && !short
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
