//! The smallest distance between points, edges and faces, with a proven bound of its error.
//!
//! ```text
//!   face = its surface inside the loops  ∪  its trim curves on the surface  (edges and corners among them)
//!
//!   pairs of pieces, the least bound first        ╭──────╮   bound   ╭──────╮
//!     bound >= the best distance: closed          │ A_i  │◀─────────▶│  B_j │   hulls of control points
//!     no minimum inside: dropped                  ╰──────╯           ╰──────╯
//!     else Newton from the middles, and halves       ●───────────────●           a pair of points: the best so far
//! ```
//!
//! Bernstein pieces lie in the hulls of their control points, so the distance of two hulls is a lower bound of the
//! distance of the pieces; it converges as the square of their size. Every pair of points on both items is an upper
//! bound. The search ends when no pair of pieces is nearer than the best pair of points, less a share of 1e-10 and
//! rounding; else after a number of pairs that takes about a second. [`Distance::error`] is what is then between the
//! best pair of points and the least bound of all pairs of pieces that were ever left, and rounding. It is an upper
//! bound of the error in both cases.
//!
//! A minimum inside a face counts when its (u, v) is inside the loops; every other minimum lies on a trim curve. Pieces
//! of a surface that the loops exclude are dropped, and so is each pair in which a derivative of the distance along a
//! face has one sign (module `piece`): without that, pieces across a border would stay near until they are tiny.
//!
//! The exact item is that of the model's `f64` numbers: the trim curve in (u, v) on its surface. The accuracy of the
//! source file is not part of the error.
//!
//! Source: branch and bound with hulls as in D. Johnson, E. Cohen, *A framework for efficient minimum distance
//! computations*, 1998.

mod compose;
mod hull;
mod local;
mod piece;
mod search;
#[cfg(test)]
mod tests;

use crate::edges::curve::circle_through;
use crate::measure::surface::shape;
use crate::model::{Edge, Face, TrimLoop};
use crate::spline::{Bezier, Patch, Surface, SurfacePatch};
use crate::trim::{LoopIndex, RectSide};
use compose::Cell;
use glam::{DAffine3, DVec2, DVec3, DVec4};
use piece::{Datum, Part};

/// The nearest pair of points of two items.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// Model units; 0 where the items touch but for rounding.
    pub distance: f64,
    /// On the first and on the second item, model coordinates.
    pub points: [DVec3; 2],
    /// The true distance is no farther from [`Distance::distance`] than this, in model units: a proven bound. It holds
    /// the rounding of the coordinates, and what the search left open.
    pub error: f64,
}

/// Pairs of pieces that are looked at, most: a second, about. Items that are nearest along whole curves or areas need
/// more, and are known less exactly, where neither flat pieces nor a profile decides: two cones or tori about one axis,
/// a free-form face and its offset.
const MOST_PAIRS: usize = 50_000;
/// Points of a curve by which it is known as a circle.
const LOOKS: usize = 8;

/// An item cut into Bézier pieces.
pub struct Pieces<'a> {
    sources: Vec<Source<'a>>,
    parts: Vec<Part>,
    datum: Option<Datum>,
}

/// What pieces are pieces of.
enum Source<'a> {
    Point(DVec3),
    /// Homogeneous control points, model coordinates.
    Curve(Vec<DVec4>),
    Face(DAffine3, &'a Surface, LoopIndex),
}

/// A point, model coordinates, and its derivatives by the parameters of its source.
struct Jet {
    point: DVec3,
    d: [DVec3; 2],
    /// By u twice, by both, by v twice.
    dd: [DVec3; 3],
}

impl Source<'_> {
    /// Parameters in use.
    fn dimension(&self) -> usize {
        match self {
            Self::Point(_) => 0,
            Self::Curve(_) => 1,
            Self::Face(..) => 2,
        }
    }

    fn jet(&self, at: DVec2) -> Jet {
        match self {
            Self::Point(point) => Jet { point: *point, d: [DVec3::ZERO; 2], dd: [DVec3::ZERO; 3] },
            Self::Curve(points) => {
                let [p, d, dd] = derivatives(points, at.x);
                let point = p.truncate() / p.w;
                let first = (d.truncate() - point * d.w) / p.w;
                let second = (dd.truncate() - 2.0 * d.w * first - point * dd.w) / p.w;
                Jet { point, d: [first, DVec3::ZERO], dd: [second, DVec3::ZERO, DVec3::ZERO] }
            }
            Self::Face(transform, surface, _) => {
                let jet = surface.jet2(at.x, at.y);
                let turned = |d: DVec3| transform.transform_vector3(d);
                let (d, dd) = ([jet.du, jet.dv].map(turned), [jet.duu, jet.duv, jet.dvv].map(turned));
                Jet { point: transform.transform_point3(jet.point), d, dd }
            }
        }
    }

    /// Whether a point of it belongs to the item.
    fn contains(&self, at: DVec2) -> bool {
        match self {
            Self::Face(_, _, loops) => loops.contains(at),
            _ => true,
        }
    }

    /// How much of a rectangle belongs to the item.
    fn side(&self, low: DVec2, high: DVec2) -> RectSide {
        match self {
            Self::Face(_, _, loops) => loops.classify(low, high),
            _ => RectSide::Inside,
        }
    }
}

/// Value and derivatives of a Bézier curve of any degree, by de Casteljau's algorithm.
fn derivatives(points: &[DVec4], t: f64) -> [DVec4; 3] {
    let n = points.len() - 1;
    let mixed = |a: DVec4, b: DVec4| a * (1.0 - t) + b * t;
    let mut work = points.to_vec();
    while work.len() > 3 {
        (0..work.len() - 1).for_each(|i| work[i] = mixed(work[i], work[i + 1]));
        work.pop();
    }
    match work[..] {
        [a, b] => [mixed(a, b), b - a, DVec4::ZERO],
        [a, b, c] => {
            let (ab, bc) = (mixed(a, b), mixed(b, c));
            [mixed(ab, bc), (bc - ab) * n as f64, (a - b * 2.0 + c) * (n * (n - 1)) as f64]
        }
        _ => [points[0], DVec4::ZERO, DVec4::ZERO],
    }
}

impl<'a> Pieces<'a> {
    /// A point, model coordinates.
    pub fn point(point: DVec3) -> Self {
        let mut all = Self::empty();
        let net = Patch { degree_u: 0, degree_v: 0, points: vec![point.extend(1.0)] };
        all.add(Source::Point(point), net, 0.0);
        all
    }

    /// Placed edges.
    pub fn edges(edges: &[&Edge], transform: DAffine3) -> Self {
        let mut all = Self::empty();
        for span in edges.iter().flat_map(|edge| &edge.curve) {
            let points: Vec<DVec4> = span.piece.points.iter().map(|p| placed(*p, &transform)).collect();
            all.add_curve(points, rounding(&span.piece.points, span.piece.degree(), &transform));
        }
        all.datum = all.circle();
        all
    }

    /// A placed face. Loops beyond the surface's domain are taken as on its border.
    pub fn face(face: &'a Face, transform: DAffine3) -> Self {
        let mut all = Self::empty();
        let grid = face.surface.patches();
        let cells: Vec<Cell> = grid.patches.iter().map(|patch| cell(patch, &transform)).collect();
        let ((u0, u1), (v0, v1)) = face.surface.domain();
        let (mut low, mut high) = (DVec2::new(u0, v0), DVec2::new(u1, v1));
        let mut borders: Vec<Bezier<DVec3>> = face.loops.iter().flat_map(TrimLoop::curves).collect();
        if face.loops.is_empty() {
            let corners = [low, DVec2::new(u1, v0), high, DVec2::new(u0, v1)];
            borders.extend((0..4).map(|i| Bezier::line(corners[i], corners[(i + 1) % 4])));
        } else {
            let none = (DVec2::INFINITY, DVec2::NEG_INFINITY);
            let reach = face.loops.iter().map(TrimLoop::bounds).fold(none, |(l, h), (a, b)| (l.min(a), h.max(b)));
            (low, high) = (low.max(reach.0), high.min(reach.1));
        }
        for border in &borders {
            for curve in compose::on_surface(border, &grid, &cells) {
                all.add_curve(curve.points, curve.noise);
            }
        }
        let shape = shape(face, transform);
        all.datum = match shape.middle() {
            Some((point, Some(axis))) => axis.try_normalize().map(|axis| Datum::Line(point, axis)),
            Some((point, None)) => Some(Datum::Point(point)),
            None => all.circle(),
        };
        let source = all.sources.len();
        all.sources.push(Source::Face(transform, &face.surface, LoopIndex::new(&face.loops)));
        let parts = cells.iter().filter_map(|cell| part(cell, face, (low, high), source));
        let sides = parts.filter_map(|part| match all.sources[source].side(part.low, part.high) {
            RectSide::Inside => Some(Part { is_whole: true, ..part }),
            RectSide::Boundary => Some(part),
            RectSide::Outside => None,
        });
        let sides: Vec<Part> = sides.collect();
        all.parts.extend(sides);
        all
    }

    fn empty() -> Self {
        Self { sources: Vec::new(), parts: Vec::new(), datum: None }
    }

    fn add_curve(&mut self, points: Vec<DVec4>, noise: f64) {
        let net = Patch { degree_u: points.len() - 1, degree_v: 0, points: points.clone() };
        self.add(Source::Curve(points), net, noise);
    }

    fn add(&mut self, source: Source<'a>, net: Patch, noise: f64) {
        let rounding = rounding(&net.points, net.degree_u, &DAffine3::IDENTITY);
        self.parts.push(Part {
            source: self.sources.len(),
            low: DVec2::ZERO,
            high: DVec2::ONE,
            folds: [false; 4],
            is_whole: true,
            noise: noise + rounding,
            step: step(&net),
            net,
        });
        self.sources.push(source);
    }

    /// The axis of the first round curve.
    fn circle(&self) -> Option<Datum> {
        self.sources.iter().find_map(|source| {
            let Source::Curve(points) = source else { return None };
            if points.len() < 3 {
                return None;
            }
            let looks: Vec<DVec3> =
                (0..LOOKS).map(|i| source.jet(DVec2::new(i as f64 / (LOOKS - 1) as f64, 0.0)).point).collect();
            circle_through(&looks).map(|circle| Datum::Line(circle.centre, circle.axis))
        })
    }
}

/// The smallest distance between two items; `None` where one of them has no points.
///
/// Cost: some milliseconds for a pair of faces of CAD files, at most a few seconds.
pub fn smallest(a: &Pieces<'_>, b: &Pieces<'_>) -> Option<Distance> {
    search::smallest(a, b, MOST_PAIRS)
}

/// A homogeneous point in its place.
fn placed(p: DVec4, transform: &DAffine3) -> DVec4 {
    (transform.matrix3 * p.truncate() + transform.translation * p.w).extend(p.w)
}

/// Bound of the rounding of points of a net of a degree, once it is placed.
fn rounding(points: &[DVec4], degree: usize, transform: &DAffine3) -> f64 {
    let m = transform.matrix3;
    let scale = (m.x_axis.length_squared() + m.y_axis.length_squared() + m.z_axis.length_squared()).sqrt();
    let size = |p: &DVec4| scale * p.truncate().length() + transform.translation.length() * p.w;
    let largest = points.iter().map(size).fold(0.0, f64::max);
    let least = points.iter().map(|p| p.w).fold(f64::INFINITY, f64::min);
    f64::EPSILON * (2 * degree + 16) as f64 * largest / least
}

/// What a halving adds to it: each point is at most `degree` means of two others.
fn step(net: &Patch) -> f64 {
    let largest = net.points.iter().map(|p| p.truncate().length()).fold(0.0, f64::max);
    let least = net.points.iter().map(|p| p.w).fold(f64::INFINITY, f64::min);
    2.0 * f64::EPSILON * net.degree_u.max(net.degree_v) as f64 * largest / least
}

/// A patch of a face in its place.
fn cell(of: &SurfacePatch, transform: &DAffine3) -> Cell {
    let patch = &of.patch;
    let mut noise = rounding(&patch.points, patch.degree_u + patch.degree_v, transform);
    let points = patch.points.iter().map(|p| placed(*p, transform)).collect();
    let patch = Patch { points, ..*patch };
    // how far a rounding of the parameters moves a point: speeds are at most degree (w_max / w_min)² times the size
    let fine = |(from, to): (f64, f64)| 8.0 * f64::EPSILON * (from.abs() + to.abs()) / (to - from);
    let fine = DVec2::new(fine(of.u), fine(of.v));
    let (low, high) = patch.bounds();
    let weights = patch.points.iter().map(|p| p.w);
    let (least, most) = weights.fold((f64::INFINITY, 0.0_f64), |(a, b), w| (a.min(w), b.max(w)));
    let speed = (most / least).powi(2) * low.distance(high);
    noise += speed * (fine.x * patch.degree_u as f64 + fine.y * patch.degree_v as f64);
    Cell { of: SurfacePatch { u: of.u, v: of.v, patch }, noise, fine }
}

/// The part of a patch between two corners of the domain; `None` where there is none.
fn part(cell: &Cell, face: &Face, (low, high): (DVec2, DVec2), source: usize) -> Option<Part> {
    let (from, to) = (DVec2::new(cell.of.u.0, cell.of.v.0), DVec2::new(cell.of.u.1, cell.of.v.1));
    let (low, high) = (low.max(from), high.min(to));
    if !low.cmplt(high).all() {
        return None;
    }
    let share = |x: DVec2| ((x - from) / (to - from)).clamp(DVec2::ZERO, DVec2::ONE);
    let (a, b) = (share(low), share(high));
    let net = cell.of.patch.rectangle((a.x, b.x), (a.y, b.y));
    let ((knots_u, knots_v), (degree_u, degree_v)) = (face.surface.knots(), face.surface.degrees());
    // a surface may fold at a knot as often as its degree
    let folds = |knots: &[f64], degree: usize, at: f64| knots.iter().filter(|k| **k == at).count() >= degree;
    let folds = [
        low.x == from.x && folds(knots_u, degree_u, low.x),
        high.x == to.x && folds(knots_u, degree_u, high.x),
        low.y == from.y && folds(knots_v, degree_v, low.y),
        high.y == to.y && folds(knots_v, degree_v, high.y),
    ];
    let step = step(&net);
    Some(Part { source, low, high, folds, is_whole: false, noise: cell.noise + 4.0 * step, step, net })
}
