//! Closed control polygons in the plane, and their smooth closed curves.
//!
//! ```text
//!    p3 ───────── p2        approximating: uniform cubic B-spline, C², inside the hull
//!     │  ╭─────╮  │         interpolating: cubic Hermite with a tension, C¹, through every vertex
//!     │  │     │  │                        periodic cubic spline, C², through every vertex
//!     │  ╰─────╯  │         subdivided:    new polygons, ever nearer to a limit curve
//!    p0 ───────── p1        edge i runs from vertex i to vertex i + 1; so does parameter u in [i, i + 1]
//! ```
//!
//! | scheme | limit | as a spline |
//! |---|---|---|
//! | [`PolyLoop::cut_corners`] | uniform cubic B-spline, C² | exactly [`PolyLoop::approximating`] |
//! | [`PolyLoop::four_points`] | interpolates, C¹ for tensions up to 1/8 | none: its limit is not piecewise polynomial |
//! | | | [`PolyLoop::interpolating`] is the C¹ cubic of that kind |
//!
//! Sources: J. Lane, R. Riesenfeld, 1980 (corner cutting); N. Dyn, D. Levin, J. Gregory, *A 4-point interpolatory
//! subdivision scheme for curve design*, CAGD 4, 1987; E. Catmull, R. Rom, 1974 (tangents from neighbours).

use super::ConstructError;
use super::curve::{CurveEnds, Parameters, chain, interpolate};
use crate::math::orientation::orientation;
use crate::spline::{BSpline, Control};
use glam::{DVec2, DVec3};

/// Most vertices of a polygon, and of a subdivided one.
const MOST_VERTICES: usize = 1 << 20;
/// Largest tension of the four-point scheme with a proven C¹ limit for every polygon.
const TENSEST: f64 = 0.125;

/// A closed polygon of at least three vertices; neighbours differ.
#[derive(Clone, Debug, PartialEq)]
pub struct PolyLoop {
    vertices: Vec<DVec2>,
}

/// Which way a loop runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Winding {
    /// The inside is on the left.
    CounterClockwise,
    /// The inside is on the right.
    Clockwise,
    /// All vertices lie on one line, or the loop folds straight back at its leftmost vertex.
    Flat,
}

impl PolyLoop {
    /// # Errors
    /// Fewer than 3 vertices, more than 2^20, one that is not finite, neighbours that coincide (the last and the
    /// first are neighbours).
    pub fn new(vertices: Vec<DVec2>) -> Result<Self, ConstructError> {
        let n = vertices.len();
        if n < 3 {
            return Err(ConstructError::TooFew { what: "vertices", got: n, needed: 3 });
        }
        if n > MOST_VERTICES {
            return Err(ConstructError::TooMany { what: "vertices", got: n, most: MOST_VERTICES });
        }
        if vertices.iter().any(|p| !p.is_finite()) {
            return Err(ConstructError::NotFinite { what: "a vertex" });
        }
        if let Some(first) = (0..n).find(|i| vertices[*i] == vertices[(i + 1) % n]) {
            return Err(ConstructError::CoincidentPoints { first, second: (first + 1) % n });
        }
        Ok(Self { vertices })
    }

    /// The vertices in order.
    pub fn vertices(&self) -> &[DVec2] {
        &self.vertices
    }

    /// Inserts a vertex before number `index`; `index` may be the number of vertices. On errors the loop is unchanged.
    ///
    /// # Errors
    /// An index beyond the end; a vertex that is not finite or coincides with a neighbour.
    pub fn insert(&mut self, index: usize, vertex: DVec2) -> Result<(), ConstructError> {
        self.changed(index, self.vertices.len() + 1, |all| all.insert(index, vertex))
    }

    /// Takes vertex `index` out.
    ///
    /// # Errors
    /// An index beyond the end; a loop of three; neighbours that would coincide.
    pub fn remove(&mut self, index: usize) -> Result<(), ConstructError> {
        self.changed(index, self.vertices.len(), |all| {
            all.remove(index);
        })
    }

    /// Moves vertex `index`.
    ///
    /// # Errors
    /// An index beyond the end; a vertex that is not finite or coincides with a neighbour.
    pub fn move_to(&mut self, index: usize, vertex: DVec2) -> Result<(), ConstructError> {
        self.changed(index, self.vertices.len(), |all| all[index] = vertex)
    }

    fn changed(&mut self, index: usize, end: usize, f: impl FnOnce(&mut Vec<DVec2>)) -> Result<(), ConstructError> {
        if index >= end {
            let what = "the index of the vertex";
            return Err(ConstructError::Range { what, value: index as f64, must: "that of a vertex" });
        }
        let mut vertices = self.vertices.clone();
        f(&mut vertices);
        *self = Self::new(vertices)?;
        Ok(())
    }

    /// Vertex `i`, counted around.
    fn at(&self, i: isize) -> DVec2 {
        self.vertices[i.rem_euclid(self.vertices.len() as isize) as usize]
    }

    /// With `A`, `B`, `C` vertex `i` and its neighbours, `cross(AB, BC)`: positive for a left turn, 0 straight on or
    /// straight back. The sign is exact, the size rounded.
    pub fn turn(&self, i: usize) -> f64 {
        let i = i as isize;
        orientation(self.at(i - 1), self.at(i), self.at(i + 1))
    }

    /// Which way the loop runs, exactly, if it does not cross itself: the turn at its leftmost (of these the lowest)
    /// vertex.
    pub fn winding(&self) -> Winding {
        let n = self.vertices.len();
        let first = (0..n)
            .min_by(|a, b| {
                let (p, q) = (self.vertices[*a], self.vertices[*b]);
                p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y))
            })
            .unwrap_or(0);
        let turn = self.turn(first);
        if turn > 0.0 {
            Winding::CounterClockwise
        } else if turn < 0.0 {
            Winding::Clockwise
        } else {
            Winding::Flat
        }
    }

    /// The same loop the other way, from the same vertex.
    pub fn reversed(mut self) -> Self {
        self.vertices[1..].reverse();
        self
    }

    /// Edges where the turn changes sides: edge `i` between opposite turns at vertices `i` and `i + 1`, or, where
    /// vertices with no turn lie between, the first edge after the last turn on the old side.
    pub fn inflection_edges(&self) -> Vec<usize> {
        let turns: Vec<(usize, bool)> = (0..self.vertices.len())
            .map(|i| (i, self.turn(i)))
            .filter(|(_, t)| *t != 0.0)
            .map(|(i, t)| (i, t > 0.0))
            .collect();
        let next = turns.iter().cycle().skip(1);
        turns.iter().zip(next).filter(|(a, b)| a.1 != b.1).map(|(a, _)| a.0).collect()
    }

    /// The loop is the boundary of a convex region, run through once: all turns to one side (or none), and the
    /// direction goes around once. Exact. Vertices straight on are allowed, turning straight back is not.
    pub fn is_convex(&self) -> bool {
        let n = self.vertices.len() as isize;
        let mut side = 0.0f64;
        let mut flips = 0;
        for i in 0..n {
            let (a, b, c) = (self.at(i - 1), self.at(i), self.at(i + 1));
            let turn = orientation(a, b, c);
            if turn * side < 0.0 && turn != 0.0 {
                return false;
            }
            if turn != 0.0 {
                side = turn.signum();
            }
            // a direction to the right, or straight up, is forward: a convex loop changes that twice
            let forward = |p: DVec2, q: DVec2| q.x > p.x || (q.x == p.x && q.y > p.y);
            flips += i32::from(forward(a, b) != forward(b, c));
        }
        side != 0.0 && flips == 2
    }

    /// The uniform cubic B-spline of the polygon: C², inside its hull, near vertex `i` at the parameter `i`, where it
    /// is `(p_{i-1} + 4 p_i + p_{i+1}) / 6`. As a closed chain of Bézier segments over `[0, n]`.
    ///
    /// # Errors
    /// None for a valid loop.
    pub fn approximating(&self) -> Result<BSpline<DVec3>, ConstructError> {
        let joint = |i: isize| (self.at(i - 1) + self.at(i) * 4.0 + self.at(i + 1)) / 6.0;
        self.segments(joint, |i| {
            let (p, q) = (self.at(i), self.at(i + 1));
            [(p * 2.0 + q) / 3.0, (p + q * 2.0) / 3.0]
        })
    }

    /// The C¹ cubic through every vertex, vertex `i` at the parameter `i`, with tangents `(1 - tension) (p_{i+1} -
    /// p_{i-1}) / 2`: 0 is Catmull's and Rom's curve, 1 the polygon itself.
    ///
    /// # Errors
    /// A tension outside of `[-1, 1]`.
    pub fn interpolating(&self, tension: f64) -> Result<BSpline<DVec3>, ConstructError> {
        if !(-1.0..=1.0).contains(&tension) {
            return Err(ConstructError::Range { what: "the tension", value: tension, must: "between -1 and 1" });
        }
        let third = |i: isize| (self.at(i + 1) - self.at(i - 1)) * ((1.0 - tension) / 6.0);
        self.segments(|i| self.at(i), |i| [self.at(i) + third(i), self.at(i + 1) - third(i + 1)])
    }

    /// The C² periodic cubic spline through every vertex, by `parameters`.
    ///
    /// # Errors
    /// Parameters that do not fit, see [`interpolate`].
    pub fn interpolating_smoothly(&self, parameters: &Parameters) -> Result<BSpline<DVec3>, ConstructError> {
        let points: Vec<DVec3> = self.vertices.iter().map(|p| p.extend(0.0)).collect();
        let curve = interpolate(&points, parameters, CurveEnds::Closed)?;
        let flat = curve.points().iter().map(|p| DVec3::new(p.x, p.y, p.w)).collect();
        Ok(BSpline::new(curve.degree(), curve.knots().to_vec(), flat)?)
    }

    /// One cubic an edge from its joints and inner control points; the last ends in the first one's start.
    fn segments(
        &self,
        joint: impl Fn(isize) -> DVec2,
        inner: impl Fn(isize) -> [DVec2; 2],
    ) -> Result<BSpline<DVec3>, ConstructError> {
        let n = self.vertices.len() as isize;
        let all = (0..n).flat_map(|i| {
            let [a, b] = inner(i);
            [joint(i), a, b]
        });
        chain(3, all.chain([joint(0)]).map(|p| DVec3::from_point(p, 1.0)).collect())
    }

    /// The polygon after `rounds` of cubic corner cutting, each with twice the vertices: control polygons of
    /// [`PolyLoop::approximating`], a quarter as far from it after each round.
    ///
    /// # Errors
    /// More than 2^20 vertices.
    pub fn cut_corners(&self, rounds: u32) -> Result<Self, ConstructError> {
        self.subdivided(rounds, |[a, b, c, _]| [(a + b * 6.0 + c) / 8.0, (b + c) * 0.5])
    }

    /// The polygon after `rounds` of the four-point scheme: old vertices stay, and a new one between `b` and `c` is
    /// `(1/2 + tension) (b + c) - tension (a + d)`. 0 gives the polygon, 1/16 reproduces cubics.
    ///
    /// # Errors
    /// A tension outside of `[0, 1/8]`, where the limit may not be smooth; more than 2^20 vertices.
    pub fn four_points(&self, tension: f64, rounds: u32) -> Result<Self, ConstructError> {
        if !(0.0..=TENSEST).contains(&tension) {
            return Err(ConstructError::Range { what: "the tension", value: tension, must: "between 0 and 1/8" });
        }
        self.subdivided(rounds, |[a, b, c, d]| [b, (b + c) * (0.5 + tension) - (a + d) * tension])
    }

    /// Replaces each vertex `b` of `a, b, c, d` by two.
    fn subdivided(&self, rounds: u32, rule: impl Fn([DVec2; 4]) -> [DVec2; 2]) -> Result<Self, ConstructError> {
        let got = 1usize.checked_shl(rounds).and_then(|f| f.checked_mul(self.vertices.len())).unwrap_or(usize::MAX);
        if got > MOST_VERTICES {
            return Err(ConstructError::TooMany { what: "vertices", got, most: MOST_VERTICES });
        }
        let mut now = self.clone();
        for _ in 0..rounds {
            let n = now.vertices.len() as isize;
            let four = |i: isize| [now.at(i - 1), now.at(i), now.at(i + 1), now.at(i + 2)];
            now = Self { vertices: (0..n).flat_map(|i| rule(four(i))).collect() };
        }
        Ok(now)
    }
}
