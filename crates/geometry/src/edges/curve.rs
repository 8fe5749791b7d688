//! Length of an edge, and its line or circle.

use crate::math::gauss::integrate;
use crate::model::Edge;
use crate::spline::{Bezier, Span};
use glam::{DAffine3, DVec3, DVec4};

/// Points of a curve are on a line or circle within this share of its size: the rounding of numbers of 12 digits.
pub const SAME: f64 = 1e-9;
/// Points of each piece that are tested.
const LOOKS: usize = 8;

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

/// Length of a placed edge, and an estimate of its error.
pub fn length(edge: &Edge, transform: DAffine3) -> (f64, f64) {
    let mut total = (0.0, 0.0);
    for span in &edge.curve {
        let speed = |t: f64| [transform.transform_vector3(jet(&span.piece, t).1).length()];
        let ([sum], [error]) = integrate(&speed, (0.0, 1.0), 1e-13);
        total = (total.0 + sum, total.1 + error);
    }
    total
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
