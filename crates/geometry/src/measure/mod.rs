//! Measuring, in `f64`, on the surfaces and curves of a model: nothing is read from a picture.
//!
//! | item | measured |
//! |---|---|
//! | point | coordinates |
//! | edge | length; radius, diameter and centre of a circle |
//! | face | area; radius, diameter, axis, angle of its surface |
//! | part | area, volume, centre of mass |
//! | two of the first three | smallest distance and where; angle; distance of centres or axes |
//! | two points | distance, also along x, y and z |
//!
//! Values carry an estimate of their own error, smallest distances a proven bound of it; the accuracy of the file is
//! the limit. [`Face::area`], [`Face::radius`] and [`Edge::length`] are single numbers in the coordinates of the part.

pub mod distance;
pub mod mass;
mod size;
pub mod surface;

use crate::edges::curve::{self, Circle, CurveShape, SAME};
use crate::model::{Edge, Face, Part};
use distance::{Distance, Pieces};
use glam::{DAffine3, DVec3};
use surface::SurfaceShape;

/// An item in its place: part coordinates to model coordinates.
#[derive(Clone, Debug)]
pub enum Item<'a> {
    /// Model coordinates.
    Point(DVec3),
    /// Edges that are one in the source: several where the seam of a face cuts it.
    Edge(Vec<&'a Edge>, DAffine3),
    /// A trimmed face.
    Face(&'a Face, DAffine3),
    /// A whole part.
    Part(&'a Part, DAffine3),
}

/// One measured number.
#[derive(Clone, Debug, PartialEq)]
pub struct Value {
    /// Its name.
    pub what: &'static str,
    /// The number.
    pub value: f64,
    /// Estimate of its error, in the same unit; of a smallest distance a bound that is proven; of its
    /// parts along x, y and z the same number, which bounds nothing where several pairs of points are as near.
    pub error: f64,
    /// `mm`, `mm²`, `mm³`, `°`.
    pub unit: &'static str,
}

/// A line to draw as a dimension.
#[derive(Clone, Debug, PartialEq)]
pub struct Dimension {
    /// From where to where, model coordinates.
    pub ends: [DVec3; 2],
    /// What is written before the number; may be empty.
    pub what: &'static str,
    /// The number, mm.
    pub value: f64,
}

/// The numbers of an item, or of two.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Measured {
    /// The numbers.
    pub values: Vec<Value>,
    /// Named points and directions.
    pub points: Vec<(&'static str, DVec3)>,
    /// Lines that say it in a picture.
    pub dimensions: Vec<Dimension>,
}

impl Measured {
    fn add(&mut self, what: &'static str, value: f64, error: f64, unit: &'static str) {
        self.values.push(Value { what, value, error, unit });
    }

    fn dimension(&mut self, ends: [DVec3; 2], what: &'static str, value: f64) {
        self.dimensions.push(Dimension { ends, what, value });
    }

    fn round(&mut self, circle: &Circle) {
        self.add("radius", circle.radius, 0.0, "mm");
        self.add("diameter", 2.0 * circle.radius, 0.0, "mm");
        self.points.push(("centre", circle.centre));
        let rim = circle.centre + circle.axis.any_orthonormal_vector() * circle.radius;
        self.dimension([circle.centre, rim], "R", circle.radius);
    }
}

/// The line or circle that all of some edges lie on.
fn shape_of_edges(edges: &[&Edge], transform: DAffine3) -> CurveShape {
    let is_same = |a: &CurveShape, b: &CurveShape| match (a, b) {
        (CurveShape::Circle(a), CurveShape::Circle(b)) => {
            let reach = SAME * a.radius;
            (a.radius - b.radius).abs() <= reach
                && a.centre.distance(b.centre) <= reach
                && a.axis.cross(b.axis).length() <= SAME
        }
        (CurveShape::Line(a), CurveShape::Line(b)) => a.cross(*b).length() <= SAME,
        _ => false,
    };
    let mut shapes = edges.iter().map(|edge| curve::shape(edge, transform));
    let Some(first) = shapes.next() else { return CurveShape::Other };
    if shapes.all(|shape| is_same(&first, &shape)) { first } else { CurveShape::Other }
}

/// Measures one item; `None` where nothing can be measured: a part without faces.
pub fn one(item: &Item<'_>) -> Option<Measured> {
    let mut all = Measured::default();
    match item {
        Item::Part(part, transform) => {
            if part.faces.is_empty() {
                return None;
            }
            let mass = mass::mass(part, *transform);
            all.add("area", mass.area.area, mass.area.error, "mm²");
            if part.closed {
                all.add("volume", mass.volume, mass.error, "mm³");
                all.points.push(("centre of mass", mass.centre));
            }
        }
        Item::Point(p) => all.points.push(("point", *p)),
        Item::Edge(edges, transform) => {
            let lengths = edges.iter().map(|edge| curve::length(edge, *transform));
            let (length, error) = lengths.fold((0.0, 0.0), |sum, one| (sum.0 + one.0, sum.1 + one.1));
            all.add("length", length, error, "mm");
            match shape_of_edges(edges, *transform) {
                CurveShape::Circle(circle) => all.round(&circle),
                CurveShape::Line(direction) => all.points.push(("direction", direction)),
                CurveShape::Other => {}
            }
        }
        Item::Face(face, transform) => {
            let area = mass::area(face, *transform);
            all.add("area", area.area, area.error, "mm²");
            match surface::shape(face, *transform) {
                SurfaceShape::Plane { normal, .. } => all.points.push(("normal", normal)),
                SurfaceShape::Cylinder { axis, point, radius } => {
                    all.round(&Circle { centre: point, axis, radius });
                    all.points.push(("axis", axis));
                }
                SurfaceShape::Sphere { centre, radius } => {
                    all.round(&Circle { centre, axis: DVec3::Z, radius });
                }
                SurfaceShape::Cone { axis, apex, half_angle } => {
                    all.add("half angle", half_angle.to_degrees(), 0.0, "°");
                    all.points.extend([("apex", apex), ("axis", axis)]);
                }
                SurfaceShape::Torus { axis, centre, major, minor } => {
                    all.add("major radius", major, 0.0, "mm");
                    all.add("minor radius", minor, 0.0, "mm");
                    all.points.extend([("centre", centre), ("axis", axis)]);
                }
                SurfaceShape::Other => {}
            }
        }
    }
    Some(all)
}

/// A direction to measure angles to, whether it is a normal, and a middle: a point or a line.
type Frame = (Option<(DVec3, bool)>, Option<(DVec3, Option<DVec3>)>);

fn frame(item: &Item<'_>) -> Frame {
    match item {
        Item::Point(p) => (None, Some((*p, None))),
        Item::Edge(edges, transform) => match shape_of_edges(edges, *transform) {
            CurveShape::Line(direction) => (Some((direction, false)), None),
            CurveShape::Circle(circle) => (Some((circle.axis, false)), Some((circle.centre, None))),
            CurveShape::Other => (None, None),
        },
        Item::Face(face, transform) => {
            let shape = surface::shape(face, *transform);
            let is_normal = matches!(shape, SurfaceShape::Plane { .. });
            (shape.direction().map(|d| (d, is_normal)), shape.middle())
        }
        Item::Part(..) => (None, None),
    }
}

fn pieces<'a>(item: &Item<'a>) -> Option<Pieces<'a>> {
    match item {
        Item::Point(p) => Some(Pieces::point(*p)),
        Item::Edge(edges, transform) => Some(Pieces::edges(edges, *transform)),
        Item::Face(face, transform) => Some(Pieces::face(face, *transform)),
        Item::Part(..) => None,
    }
}

/// Measures two items together; `None` where one of them has no points, or is a part.
pub fn two(a: &Item<'_>, b: &Item<'_>) -> Option<Measured> {
    let mut all = Measured::default();
    let Distance { distance, points: [p, q], error } = distance::smallest(&pieces(a)?, &pieces(b)?)?;
    all.add("distance", distance, error, "mm");
    for (what, x) in ["along x", "along y", "along z"].into_iter().zip((q - p).to_array()) {
        all.add(what, x, error, "mm");
    }
    all.points.extend([("from", p), ("to", q)]);
    all.dimension([p, q], "", distance);
    let ((turn_a, middle_a), (turn_b, middle_b)) = (frame(a), frame(b));
    if let (Some((d, d_is_normal)), Some((e, e_is_normal))) = (turn_a, turn_b) {
        let angle = d.cross(e).length().atan2(d.dot(e).abs()).to_degrees();
        // a plane's angle to a line is that of its normal, less a right angle
        let angle = if d_is_normal == e_is_normal { angle } else { 90.0 - angle };
        all.add("angle", angle, 0.0, "°");
    }
    // of two points this is the distance above
    if let (Some((c, along_c)), Some((d, along_d))) = (middle_a, middle_b)
        && !matches!((a, b), (Item::Point(_), Item::Point(_)))
    {
        let (p, q) = between(c, along_c, d, along_d);
        let what = if along_c.is_some() || along_d.is_some() { "between axes" } else { "between centres" };
        all.add(what, p.distance(q), 0.0, "mm");
        all.dimension([p, q], "axes", p.distance(q));
    }
    Some(all)
}

/// The nearest points of two points or lines.
fn between(p: DVec3, along_p: Option<DVec3>, q: DVec3, along_q: Option<DVec3>) -> (DVec3, DVec3) {
    let foot = |on: DVec3, along: DVec3, of: DVec3| on + along * (of - on).dot(along);
    match (along_p, along_q) {
        (None, None) => (p, q),
        (Some(d), None) => (foot(p, d, q), q),
        (None, Some(e)) => (p, foot(q, e, p)),
        (Some(d), Some(e)) => {
            let cross = d.cross(e);
            if cross.length() < 1e-9 {
                return (p, foot(q, e, p));
            }
            let (apart, square) = (q - p, cross.length_squared());
            (p + d * (apart.cross(e).dot(cross) / square), q + e * (apart.cross(d).dot(cross) / square))
        }
    }
}

#[cfg(test)]
mod tests;
