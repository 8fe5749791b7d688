//! The boundary of a face as curves: in its `(u, v)` and in space.
//!
//! ```text
//!      v                                       kinds of 3-D curves, best first
//!      ▲   ┌───────◀──────┐
//!      │   │  ╭───╮       │   natural sides     plane      control points mapped: exact
//!      │   ▼  │   ▼       ▲   or trim loops     iso line   row or column of the surface: exact
//!      │   │  ╰───╯       │                     other      cubic Hermite pieces, halved until the
//!      │   └───────▶──────┘                                distance at inner points is within reach
//!      └─────────────────────▶ u
//! ```
//!
//! Pieces that are points in space (the poles of a sphere) are left out: a STEP loop passes them silently.

use crate::model::Face;
use crate::spline::{BSpline, Bezier, Control, PatchGrid, Span, SplineError, Surface, arc};
use glam::{DVec2, DVec3, DVec4};

/// Halvings of one piece of a fit; beyond them the distance reached is what counts.
const HALVINGS: u32 = 10;
/// A line of constant parameter, in shares of the domain.
const ISO: f64 = 1e-12;
/// Chords in a piece, to find where it is a point.
const CHORDS: u32 = 8;

/// A face with its surface cut for evaluation.
pub(super) struct Sheet<'a> {
    pub face: &'a Face,
    pub grid: PatchGrid,
    /// `S = origin + a u + b v` when the surface is that.
    pub plane: Option<[DVec3; 3]>,
}

/// A curve in both spaces, over one domain.
pub(super) struct Both {
    pub flat: BSpline<DVec3>,
    pub space: BSpline<DVec4>,
    /// Largest distance found between the two, mm.
    pub deviation: f64,
}

impl<'a> Sheet<'a> {
    pub fn new(face: &'a Face) -> Self {
        Self { face, grid: face.surface.patches(), plane: plane(&face.surface) }
    }

    /// The point in space under `t` of a curve in `(u, v)`.
    pub fn at(&self, curve: &Bezier<DVec3>, t: f64) -> DVec3 {
        let p = curve.point(t);
        self.grid.point(p.x, p.y)
    }

    /// The loops, without pieces that stay within `reach` of one point.
    pub fn loops(&self, reach: f64) -> Vec<Vec<Bezier<DVec3>>> {
        let loops: Vec<Vec<_>> = if self.face.loops.is_empty() {
            let ((a, b), (c, d)) = self.face.surface.domain();
            let corners = [(a, c), (b, c), (b, d), (a, d), (a, c)].map(DVec2::from);
            vec![corners.windows(2).map(|w| Bezier::line(w[0], w[1])).collect()]
        } else {
            self.face.loops.iter().map(|l| l.curves().collect()).collect()
        };
        let is_point = |c: &Bezier<DVec3>| {
            let start = self.at(c, 0.0);
            (1..=CHORDS).all(|k| self.at(c, f64::from(k) / f64::from(CHORDS)).distance(start) <= reach)
        };
        let kept = loops.into_iter().map(|l| l.into_iter().filter(|c| !is_point(c)).collect::<Vec<_>>());
        kept.filter(|l| !l.is_empty()).collect()
    }

    /// `pieces`, end to end, in both spaces; the distance between the two aims at `reach`.
    pub fn curve(&self, pieces: &[Bezier<DVec3>], reach: f64) -> Result<Both, SplineError> {
        if let Some(both) = self.iso(pieces) {
            return both;
        }
        let mut deviation: f64 = 0.0;
        let (mut flat, mut space) = (Vec::new(), Vec::new());
        for (k, c) in pieces.iter().enumerate() {
            let (start, end) = (k as f64, k as f64 + 1.0);
            flat.push(Span { start, end, piece: c.clone() });
            if let Some([o, a, b]) = self.plane {
                let map = |p: &DVec3| (o * p.z + a * p.x + b * p.y).extend(p.z);
                space.push(Span { start, end, piece: Bezier { points: c.points.iter().map(map).collect() } });
            } else {
                self.fit(c, (0.0, 1.0), start, reach, HALVINGS, &mut space, &mut deviation);
            }
        }
        let (degree, knots, points) = arc::assemble(&flat);
        let flat = BSpline::new(degree, knots, points)?;
        let (degree, knots, points) = arc::assemble(&space);
        Ok(Both { flat, space: BSpline::new(degree, knots, points)?, deviation })
    }

    /// Pieces along one line of constant parameter, run through once.
    fn iso(&self, pieces: &[Bezier<DVec3>]) -> Option<Result<Both, SplineError>> {
        let ((u0, u1), (v0, v1)) = self.face.surface.domain();
        let points = || pieces.iter().flat_map(|c| &c.points).map(|p| p.point());
        let (first, last) = (points().next()?, points().next_back()?);
        let along_v = points().all(|p| (p.x - first.x).abs() <= ISO * (u1 - u0));
        if !along_v && !points().all(|p| (p.y - first.y).abs() <= ISO * (v1 - v0)) {
            return None;
        }
        let (from, to) = if along_v { (first.y, last.y) } else { (first.x, last.x) };
        let along: Vec<f64> = points().map(|p| if along_v { p.y } else { p.x }).collect();
        let rising = along.windows(2).all(|w| w[0] <= w[1]);
        let (lo, hi) = if along_v { (v0, v1) } else { (u0, u1) };
        let slack = ISO * (hi - lo);
        let inside = from.min(to) >= lo - slack && from.max(to) <= hi + slack;
        if from == to || !inside || !(rising || along.windows(2).all(|w| w[0] >= w[1])) {
            return None;
        }
        let whole = isocurve(&self.face.surface, if along_v { first.x } else { first.y }, along_v);
        Some(whole.and_then(|whole| {
            let spans = whole.beziers_between(from.min(to).max(lo), from.max(to).min(hi));
            let (degree, knots, points) = arc::assemble(&spans);
            let part = BSpline::new(degree, knots, points)?;
            let (a, b) = part.domain();
            let end = |t: f64| if along_v { DVec2::new(first.x, t) } else { DVec2::new(t, first.y) };
            let flat = BSpline::from_bezier(Bezier::line(end(a), end(b)), a, b)?;
            let turned = from > to;
            let (flat, space) = if turned { (flat.reversed(), part.reversed()) } else { (flat, part) };
            Ok(Both { flat, space, deviation: 0.0 })
        }))
    }

    /// Cubic Hermite pieces of `S(c(t))` over `range`.
    #[expect(clippy::too_many_arguments, reason = "one recursion")]
    fn fit(
        &self,
        c: &Bezier<DVec3>,
        (a, b): (f64, f64),
        start: f64,
        reach: f64,
        halvings: u32,
        spans: &mut Vec<Span<Bezier<DVec4>>>,
        deviation: &mut f64,
    ) {
        let [p, q] = [a, b].map(|t| self.jet(c, t));
        let third = (b - a) / 3.0;
        let points = [p.0, p.0 + p.1 * third, q.0 - q.1 * third, q.0].map(|x| x.extend(1.0)).to_vec();
        let piece = Bezier { points };
        let off = (1..8).map(|k| f64::from(k) / 8.0);
        let off = off.map(|s| piece.point(s).distance(self.at(c, a + (b - a) * s))).fold(0.0, f64::max);
        if off > reach && halvings > 0 {
            let middle = 0.5 * (a + b);
            self.fit(c, (a, middle), start, reach, halvings - 1, spans, deviation);
            self.fit(c, (middle, b), start, reach, halvings - 1, spans, deviation);
            return;
        }
        *deviation = deviation.max(off);
        spans.push(Span { start: start + a, end: start + b, piece });
    }

    /// Point and derivative of `S(c(t))`.
    fn jet(&self, c: &Bezier<DVec3>, t: f64) -> (DVec3, DVec3) {
        let (h, dh) = c.jet(t);
        let p = h.point();
        let slope = (dh.truncate() - p * dh.z) / h.z;
        let s = self.grid.jet(p.x, p.y);
        (s.point, s.du * slope.x + s.dv * slope.y)
    }
}

/// The curve `u = at` (along `v`) or `v = at`.
fn isocurve(surface: &Surface, at: f64, along_v: bool) -> Result<BSpline<DVec4>, SplineError> {
    let turned;
    let across = if along_v {
        surface
    } else {
        turned = surface.transposed();
        &turned
    };
    let points = across.rows().iter().map(|row| row.homogeneous(at)).collect();
    BSpline::new(across.degrees().1, across.knots().1.to_vec(), points)
}

/// Origin and derivatives of a bilinear surface that is a plane with straight, evenly divided sides.
fn plane(surface: &Surface) -> Option<[DVec3; 3]> {
    let ((u0, u1), (v0, v1)) = surface.domain();
    let [p, q, r, s] = surface.points() else { return None };
    let points = [p, q, r, s].map(|x| x.point());
    let size = points[0].distance(points[3]).max(points[1].distance(points[2]));
    let even = (points[0] + points[3]).distance(points[1] + points[2]) <= 1e-14 * size;
    if surface.degrees() != (1, 1) || !surface.is_polynomial() || !even {
        return None;
    }
    let (a, b) = ((points[1] - points[0]) / (u1 - u0), (points[2] - points[0]) / (v1 - v0));
    (a.cross(b).length() > 0.0).then(|| [points[0] - a * u0 - b * v0, a, b])
}
