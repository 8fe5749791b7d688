//! Length and middle of an edge, and its line or circle.

use crate::math::gauss::integrate;
use crate::model::Edge;
use crate::spline::{Bezier, Span};
use glam::{DAffine3, DVec3, DVec4};

/// Points of a curve are on a line or circle within this share of its size: the rounding of numbers of 12 digits.
pub const SAME: f64 = 1e-9;
/// Points of each piece that are tested.
const LOOKS: usize = 8;
/// Aim of integrals of lengths, a share of the length.
const LENGTH: f64 = 1e-13;
/// Steps to the middle of an edge: halvings alone come down to the rounding of a parameter.
const STEPS: usize = 60;

/// A circle, or an arc of one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// Model coordinates.
    pub centre: DVec3,
    /// Unit normal of its plane.
    pub axis: DVec3,
    /// Model units.
    pub radius: f64,
}

/// The kind of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CurveShape {
    /// Straight, with its unit direction.
    Line(DVec3),
    /// Round.
    Circle(Circle),
    /// Neither.
    Other,
}

/// Point and derivative of a piece.
fn jet(piece: &Bezier<DVec4>, t: f64) -> (DVec3, DVec3) {
    let (p, d) = piece.jet(t);
    let at = p.truncate() / p.w;
    (at, (d.truncate() - at * d.w) / p.w)
}

/// Length of a placed edge, and an estimate of its error; model units.
pub fn length(edge: &Edge, transform: DAffine3) -> (f64, f64) {
    let mut total = (0.0, 0.0);
    for span in &edge.curve {
        let speed = |t: f64| [transform.transform_vector3(jet(&span.piece, t).1).length()];
        let ([sum], [error]) = integrate(&speed, (0.0, 1.0), LENGTH);
        total = (total.0 + sum, total.1 + error);
    }
    total
}

/// The point of a placed edge that has half of the length on each side, part coordinates. `None` for an edge without a
/// curve. Of a closed edge it is the middle of the way from its vertex back to it.
///
/// Accuracy: the lengths on its sides differ by some 1e-13 of the edge's length.
pub fn middle(edge: &Edge, transform: DAffine3) -> Option<DVec3> {
    let speed = |piece: &Bezier<DVec4>, t: f64| transform.transform_vector3(jet(piece, t).1).length();
    let along = |piece: &Bezier<DVec4>, end: f64| {
        let ([sum], _) = integrate(&|t: f64| [speed(piece, t)], (0.0, end), LENGTH);
        sum
    };
    let lengths: Vec<f64> = edge.curve.iter().map(|span| along(&span.piece, 1.0)).collect();
    let total: f64 = lengths.iter().sum();
    let (mut rest, mut number) = (0.5 * total, 0);
    while number + 1 < lengths.len() && rest > lengths[number] {
        rest -= lengths[number];
        number += 1;
    }
    let piece = &edge.curve.get(number)?.piece;
    // Newton's method within a bracket
    let (mut low, mut high, mut t) = (0.0, 1.0, 0.5);
    for _ in 0..STEPS {
        let off = along(piece, t) - rest;
        // sums of some roundings
        if off.abs() <= 4.0 * f64::EPSILON * total {
            break;
        }
        if off > 0.0 {
            high = t;
        } else {
            low = t;
        }
        let next = t - off / speed(piece, t);
        let next = if next > low && next < high { next } else { 0.5 * (low + high) };
        if next == t {
            break;
        }
        t = next;
    }
    Some(jet(piece, t).0)
}

/// The line or circle of a placed edge.
pub fn shape(edge: &Edge, transform: DAffine3) -> CurveShape {
    let looks = |span: &Span<Bezier<DVec4>>| {
        (0..=LOOKS).map(|i| transform.transform_point3(jet(&span.piece, i as f64 / LOOKS as f64).0)).collect::<Vec<_>>()
    };
    let points: Vec<DVec3> = edge.curve.iter().flat_map(looks).collect();
    shape_of(&points)
}

/// The line or circle through all of these points, in order along a curve.
pub fn shape_of(points: &[DVec3]) -> CurveShape {
    let [first, .., last] = points else { return CurveShape::Other };
    let size = points.iter().map(|p| p.distance(*first)).fold(0.0, f64::max);
    let along = (*last - *first).normalize_or_zero();
    let off = |p: &DVec3| (*p - *first).reject_from_normalized(along).length();
    if along != DVec3::ZERO && points.iter().all(|p| off(p) <= SAME * size) {
        return CurveShape::Line(along);
    }
    circle_through(points).map_or(CurveShape::Other, CurveShape::Circle)
}

/// The circle that all points lie on.
pub fn circle_through(points: &[DVec3]) -> Option<Circle> {
    // three of them far apart: the first, the farthest from it, and the farthest from their line
    let a = *points.first()?;
    let farthest = |far: &dyn Fn(&DVec3) -> f64| points.iter().copied().max_by(|p, q| far(p).total_cmp(&far(q)));
    let b = farthest(&|p| p.distance_squared(a))?;
    let c = farthest(&|p| (*p - a).cross(b - a).length_squared())?;
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(ac);
    let area = normal.length_squared();
    if area <= 1e-24 * ab.length_squared() * ab.length_squared() {
        return None;
    }
    // the centre of the circle through three points
    let centre = a + (normal.cross(ab) * ac.length_squared() + ac.cross(normal) * ab.length_squared()) / (2.0 * area);
    let (radius, axis) = (centre.distance(a), normal.normalize());
    let on = |p: &DVec3| {
        let from = *p - centre;
        from.dot(axis).abs() <= SAME * radius && (from.length() - radius).abs() <= SAME * radius
    };
    points.iter().all(on).then_some(Circle { centre, axis, radius })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::EdgeKind;

    fn edge(pieces: Vec<Vec<DVec4>>) -> Edge {
        let curve = pieces.into_iter().map(|points| Span { start: 0.0, end: 1.0, piece: Bezier { points } }).collect();
        Edge { curve, ends: [0, 1], uses: Vec::new(), source: None, kind: EdgeKind::Sharp, turn: 1.0, deviation: 0.0 }
    }

    fn point(x: f64, y: f64, w: f64) -> DVec4 {
        DVec4::new(x * w, y * w, 0.0, w)
    }

    /// The parameter of each is not its length.
    #[test]
    fn the_middle_of_an_edge_halves_its_length() {
        let middle_of = |pieces| middle(&edge(pieces), DAffine3::IDENTITY).expect("a curve");
        // 3 along x, then 9 along y
        let [from, corner, to] = [(0.0, 0.0), (3.0, 0.0), (3.0, 9.0)].map(|(x, y)| point(x, y, 1.0));
        let bent = vec![vec![from, corner], vec![corner, to]];
        assert!(middle_of(bent.clone()).distance(DVec3::new(3.0, 3.0, 0.0)) < 1e-12);
        // x = 8 t²
        let slow = vec![vec![point(0.0, 0.0, 1.0), point(0.0, 0.0, 1.0), point(8.0, 0.0, 1.0)]];
        assert!(middle_of(slow).distance(DVec3::new(4.0, 0.0, 0.0)) < 1e-12);
        // a quarter of a circle about (1, 2), whose end weights are 1 and 2: its parameter's middle is elsewhere
        let arc = vec![vec![point(3.0, 2.0, 1.0), point(3.0, 4.0, 1.0), point(1.0, 4.0, 2.0)]];
        let expected = DVec3::new(1.0, 2.0, 0.0) + DVec3::new(1.0, 1.0, 0.0) * std::f64::consts::SQRT_2;
        let found = middle_of(arc.clone());
        assert!(found.distance(expected) < 1e-12, "{found}");
        assert!(jet(&edge(arc).curve[0].piece, 0.5).0.distance(expected) > 0.1);
        // 15 along x where it is placed
        let stretched = DAffine3::from_scale(DVec3::new(5.0, 1.0, 1.0));
        assert!(middle(&edge(bent), stretched).expect("a curve").distance(DVec3::new(2.4, 0.0, 0.0)) < 1e-12);
        assert_eq!(middle(&edge(Vec::new()), DAffine3::IDENTITY), None);
        let nowhere = edge(vec![vec![point(7.0, 0.0, 1.0); 3]]);
        assert_eq!(middle(&nowhere, DAffine3::IDENTITY), Some(DVec3::new(7.0, 0.0, 0.0)));
    }

    /// Arcs of 5 degrees and more about (1e3, 2), with the radius of a hole.
    #[test]
    fn the_centre_of_an_arc_is_that_of_its_formula() {
        for (turn, bound) in [(5.0_f64, 1e-9), (90.0, 1e-11), (170.0, 1e-11)] {
            let half = 0.5 * turn.to_radians();
            let (centre, radius) = (DVec3::new(1e3, 2.0, 0.0), 2.5);
            let at = |angle: f64, r: f64, w: f64| point(1e3 + r * angle.cos(), 2.0 + r * angle.sin(), w);
            let arc = vec![at(-half, radius, 1.0), at(0.0, radius / half.cos(), half.cos()), at(half, radius, 1.0)];
            let CurveShape::Circle(circle) = shape(&edge(vec![arc]), DAffine3::IDENTITY) else { panic!("{turn}") };
            assert!(circle.centre.distance(centre) < bound, "{turn}: {}", circle.centre);
        }
    }

    #[test]
    fn lines_circles_and_others_are_distinguished() {
        let at = |f: &dyn Fn(f64) -> DVec3| (0..=20).map(|i| f(f64::from(i) / 20.0)).collect::<Vec<_>>();
        let line = at(&|t| DVec3::new(1e3 + 3.0 * t, 4.0 * t, 0.0));
        assert!(matches!(shape_of(&line), CurveShape::Line(d) if d.distance(DVec3::new(0.6, 0.8, 0.0)) < 1e-12));
        for turn in [0.3, 3.0, std::f64::consts::TAU] {
            let arc = at(&|t| DVec3::new(5.0 + 2.5 * (turn * t).cos(), 1.0, 2.5 * (turn * t).sin()));
            let CurveShape::Circle(circle) = shape_of(&arc) else { panic!("{turn}") };
            assert!((circle.radius - 2.5).abs() < 1e-11 && circle.centre.distance(DVec3::new(5.0, 1.0, 0.0)) < 1e-11);
            assert!(circle.axis.y.abs() > 1.0 - 1e-12);
        }
        let ellipse = at(&|t| DVec3::new(3.0 * (6.0 * t).cos(), 3.00001 * (6.0 * t).sin(), 0.0));
        let helix = at(&|t| DVec3::new((6.0 * t).cos(), (6.0 * t).sin(), 1e-6 * t));
        assert_eq!([shape_of(&ellipse), shape_of(&helix)], [CurveShape::Other; 2]);
        assert_eq!(shape_of(&[DVec3::ONE; 9]), CurveShape::Other);
    }
}
