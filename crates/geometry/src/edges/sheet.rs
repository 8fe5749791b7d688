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
//! Pieces that are points in space (the poles of a sphere) are left out.

use crate::model::{EdgeRef, EdgeUse, Face};
use crate::spline::{BSpline, Bezier, Control, PatchGrid, Span, SplineError, Surface, arc};
use glam::{DVec2, DVec3, DVec4};

/// Pieces of a curve in space, end to end.
type Chain = Vec<Span<Bezier<DVec4>>>;

/// Halvings of one piece of a fit; the distance that they reach is reported.
const HALVINGS: u32 = 10;
/// A line of constant parameter, in shares of the domain.
const ISO: f64 = 1e-12;
/// Chords in a piece, to find where it is a point.
const CHORDS: u32 = 8;

/// A face with its surface cut for evaluation.
#[derive(Debug)]
pub struct Sheet<'a> {
    /// The face.
    pub face: &'a Face,
    /// Its surface's patches.
    pub grid: PatchGrid,
    /// `S = origin + a u + b v` for a plane of this form.
    pub plane: Option<[DVec3; 3]>,
}

/// A curve of a loop.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    /// Its number in the loop.
    pub index: usize,
    pub curve: Bezier<DVec3>,
    pub edge: Option<EdgeRef>,
}

/// Curves along one line of constant parameter, run through once.
struct Iso {
    along_v: bool,
    at: f64,
    from: f64,
    to: f64,
}

impl<'a> Sheet<'a> {
    /// Cuts the surface.
    pub fn new(face: &'a Face) -> Self {
        Self { face, grid: face.surface.patches(), plane: plane(&face.surface) }
    }

    /// The point in space under `t` of a curve in `(u, v)`.
    pub fn at(&self, curve: &Bezier<DVec3>, t: f64) -> DVec3 {
        let p = curve.point(t);
        self.grid.point(p.x, p.y)
    }

    /// The numbers of the face's loops; `None` is the border of a face without.
    pub(super) fn loops(&self) -> Vec<Option<usize>> {
        let count = self.face.loops.len();
        if count == 0 { vec![None] } else { (0..count).map(Some).collect() }
    }

    /// All curves of a loop, as [`EdgeUse::trim_loop`] numbers them.
    fn curves(&self, trim_loop: Option<usize>) -> Vec<Bezier<DVec3>> {
        if let Some(at) = trim_loop {
            return self.face.loops[at].curves().collect();
        }
        let ((a, b), (c, d)) = self.face.surface.domain();
        let corners = [(a, c), (b, c), (b, d), (a, d), (a, c)].map(DVec2::from);
        corners.windows(2).map(|w| Bezier::line(w[0], w[1])).collect()
    }

    /// The number of a loop's curves, and its curves that are longer than a point: not within `reach` of one.
    pub(super) fn pieces(&self, trim_loop: Option<usize>, reach: f64) -> (usize, Vec<Piece>) {
        let edges = trim_loop.map_or(&[][..], |at| self.face.loops[at].edges());
        let curves = self.curves(trim_loop);
        let count = curves.len();
        let piece = |(index, curve)| Piece { index, curve, edge: edges.get(index).copied().flatten() };
        (count, curves.into_iter().enumerate().filter(|(_, c)| !self.is_point(c, reach)).map(piece).collect())
    }

    fn is_point(&self, curve: &Bezier<DVec3>, reach: f64) -> bool {
        let start = self.at(curve, 0.0);
        (1..=CHORDS).all(|k| self.at(curve, f64::from(k) / f64::from(CHORDS)).distance(start) <= reach)
    }

    /// The curves of an edge's use in `(u, v)`, end to end in the loop's direction. Curves within `reach` of one point
    /// are left out.
    pub fn along(&self, used: &EdgeUse, reach: f64) -> Vec<Bezier<DVec3>> {
        let curves = self.curves(used.trim_loop);
        let (from, to) = used.range;
        let mut out = Vec::new();
        for k in from.floor() as usize..to.ceil() as usize {
            let curve = &curves[k % curves.len()];
            let (a, b) = ((from - k as f64).max(0.0), (to - k as f64).min(1.0));
            if b > a && !self.is_point(curve, reach) {
                out.push(curve.segment(a, b));
            }
        }
        out
    }

    /// Whether [`Sheet::in_space`] is exact.
    pub(super) fn is_exact(&self, pieces: &[Bezier<DVec3>]) -> bool {
        self.plane.is_some() || self.iso(pieces).is_some()
    }

    /// `pieces`, end to end, as one spline over the parameters of `Sheet::in_space`.
    ///
    /// # Errors
    /// [`SplineError`] where the pieces do not make a spline.
    pub fn in_plane(&self, pieces: &[Bezier<DVec3>]) -> Result<BSpline<DVec3>, SplineError> {
        if let Some(Iso { along_v, at, from, to }) = self.iso(pieces) {
            let end = |t: f64| if along_v { DVec2::new(at, t) } else { DVec2::new(t, at) };
            return BSpline::from_bezier(Bezier::line(end(from), end(to)), from.min(to), from.max(to));
        }
        let spans = pieces.iter().enumerate();
        let spans: Vec<_> =
            spans.map(|(k, c)| Span { start: k as f64, end: k as f64 + 1.0, piece: c.clone() }).collect();
        let (degree, knots, points) = arc::assemble(&spans);
        BSpline::new(degree, knots, points)
    }

    /// `pieces`, end to end, in space, and the largest distance found of a fit from the surface's points; fits aim at
    /// `reach`.
    ///
    /// # Errors
    /// [`SplineError`] where a line of constant parameter does not make a spline.
    pub(super) fn in_space(&self, pieces: &[Bezier<DVec3>], reach: f64) -> Result<(Chain, f64), SplineError> {
        if let Some(Iso { along_v, at, from, to }) = self.iso(pieces) {
            let whole = isocurve(&self.face.surface, at, along_v)?;
            let (a, b) = (from.min(to), from.max(to));
            let mut spans = whole.beziers_between(a, b);
            if from > to {
                spans.reverse();
                for s in &mut spans {
                    (s.start, s.end) = (a + (b - s.end), a + (b - s.start));
                    s.piece.points.reverse();
                }
            }
            return Ok((spans, 0.0));
        }
        let mut deviation: f64 = 0.0;
        let mut spans = Vec::new();
        for (k, c) in pieces.iter().enumerate() {
            let start = k as f64;
            if let Some([o, a, b]) = self.plane {
                let map = |p: &DVec3| (o * p.z + a * p.x + b * p.y).extend(p.z);
                let piece = Bezier { points: c.points.iter().map(map).collect() };
                spans.push(Span { start, end: start + 1.0, piece });
            } else {
                self.fit(c, (0.0, 1.0), start, reach, HALVINGS, &mut spans, &mut deviation);
            }
        }
        Ok((spans, deviation))
    }

    fn iso(&self, pieces: &[Bezier<DVec3>]) -> Option<Iso> {
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
        let at = if along_v { first.x } else { first.y };
        Some(Iso { along_v, at, from: from.clamp(lo, hi), to: to.clamp(lo, hi) })
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
        spans: &mut Chain,
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
        let (s, along) = self.frame(c, t);
        (s.point, along)
    }

    /// The surface under `t` of a curve in `(u, v)`, and the derivative of `S(c(t))`.
    pub(super) fn frame(&self, c: &Bezier<DVec3>, t: f64) -> (crate::spline::Jet, DVec3) {
        let (h, dh) = c.jet(t);
        let p = h.point();
        let slope = (dh.truncate() - p * dh.z) / h.z;
        let s = self.grid.jet(p.x, p.y);
        let along = s.du * slope.x + s.dv * slope.y;
        (s, along)
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
