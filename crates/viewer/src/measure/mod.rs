//! Measuring, in `f64`, on the surfaces and curves of the model: nothing is read from a picture.
//!
//! | selected | measured |
//! |---|---|
//! | vertex | coordinates |
//! | edge | length; radius, diameter and centre of a circle |
//! | face | area; radius, diameter, axis, angle of its surface |
//! | part | area, volume, centre of mass |
//! | two of them | smallest distance and where; angle; distance of centres or axes |
//!
//! Values carry an estimate of their own error; the accuracy of the file is the limit.

pub mod cut;
pub mod distance;
pub mod mass;
pub mod surface;

use crate::describe;
use crate::session::Picked;
use crate::session::World;
use distance::{Distance, Sampled};
use glam::{DAffine3, DVec3};
use selvedge_geometry::edges::curve::{self, Circle, CurveShape};
use surface::SurfaceShape;

/// One measured number.
#[derive(Clone, Debug, PartialEq)]
pub struct Value {
    /// Its name.
    pub what: &'static str,
    /// The number.
    pub value: f64,
    /// Estimate of its error, in the same unit.
    pub error: f64,
    /// `mm`, `mm²`, `mm³`, `°`.
    pub unit: &'static str,
}

/// The measurement of a selection.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Measurement {
    /// The selected items.
    pub title: String,
    /// The numbers.
    pub values: Vec<Value>,
    /// Named points.
    pub points: Vec<(&'static str, DVec3)>,
    /// Lines that are drawn as dimensions, with their texts.
    pub dimensions: Vec<([DVec3; 2], String)>,
}

impl Measurement {
    fn add(&mut self, what: &'static str, value: f64, error: f64, unit: &'static str) {
        self.values.push(Value { what, value, error, unit });
    }

    fn dimension(&mut self, ends: [DVec3; 2], what: &str, value: f64) {
        self.dimensions.push((ends, format!("{what} {}", describe::number(value))));
    }

    /// As text, a line a number.
    pub fn text(&self) -> String {
        let values = self.values.iter().map(|v| format!("{}: {} {}", v.what, describe::number(v.value), v.unit));
        let points = self.points.iter().map(|(what, p)| format!("{what}: {}", describe::vector(*p)));
        std::iter::once(self.title.clone()).chain(values).chain(points).collect::<Vec<_>>().join("\n")
    }

    /// As rows of a table with the columns things, quantity, value, error, unit; numbers with all their digits.
    pub fn csv(&self) -> String {
        let title = format!("\"{}\"", self.title.replace('"', "\"\""));
        let row = |what: &str, value: f64, error: f64, unit: &str| format!("{title},{what},{value},{error},{unit}\n");
        let values = self.values.iter().map(|v| row(v.what, v.value, v.error, v.unit));
        let points = self.points.iter().flat_map(|(what, p)| {
            ["x", "y", "z"].into_iter().zip(p.to_array()).map(move |(axis, x)| (format!("{what} {axis}"), x))
        });
        values.chain(points.map(|(what, x)| row(&what, x, 0.0, "mm"))).collect()
    }
}

/// The first line of a table of measurements.
pub const CSV_HEADER: &str = "things,quantity,value,error,unit\n";

/// Measures one or two items; `None` for another number of items, and where nothing can be measured.
pub fn measure(world: &World, selection: &[Picked]) -> Option<Measurement> {
    let title = selection.iter().map(|picked| describe::short(world, picked)).collect::<Vec<_>>().join(" and ");
    let mut all = Measurement { title, ..Measurement::default() };
    match selection {
        [one] => single(world, one, &mut all)?,
        [a, b] => pair(world, a, b, &mut all)?,
        _ => return None,
    }
    Some(all)
}

/// An item in its place.
enum Thing<'a> {
    Point(DVec3),
    Edge(&'a selvedge::model::Edge, DAffine3),
    Face(&'a selvedge::model::Face, DAffine3),
}

fn thing<'a>(world: &'a World, picked: &Picked) -> Option<Thing<'a>> {
    let placed = world.model.instances.get(picked.instance()?)?;
    let edges = world.edges_of(placed.part);
    match *picked {
        Picked::Face { face, .. } => {
            Some(Thing::Face(world.model.parts[placed.part].faces.get(face)?, placed.transform))
        }
        Picked::Edge { edge, .. } => Some(Thing::Edge(edges?.edges.get(edge)?, placed.transform)),
        Picked::Vertex { vertex, .. } => {
            Some(Thing::Point(placed.transform.transform_point3(*edges?.vertices.get(vertex)?)))
        }
        Picked::Instance(_) | Picked::Number { .. } => None,
    }
}

fn round(all: &mut Measurement, circle: &Circle) {
    all.add("radius", circle.radius, 0.0, "mm");
    all.add("diameter", 2.0 * circle.radius, 0.0, "mm");
    all.points.push(("centre", circle.centre));
    let rim = circle.centre + circle.axis.any_orthonormal_vector() * circle.radius;
    all.dimension([circle.centre, rim], "R", circle.radius);
}

fn single(world: &World, picked: &Picked, all: &mut Measurement) -> Option<()> {
    if let Picked::Instance(instance) = *picked {
        let placed = world.model.instances.get(instance)?;
        let part = world.model.parts.get(placed.part)?;
        if part.faces.is_empty() {
            return None;
        }
        let mass = mass::mass(part, placed);
        all.add("area", mass.area.area, mass.area.error, "mm²");
        if part.closed {
            all.add("volume", mass.volume, mass.error, "mm³");
            all.points.push(("centre of mass", mass.centre));
        }
        return Some(());
    }
    match thing(world, picked)? {
        Thing::Point(p) => all.points.push(("point", p)),
        Thing::Edge(edge, transform) => {
            let (length, error) = curve::length(edge, transform);
            all.add("length", length, error, "mm");
            match curve::shape(edge, transform) {
                CurveShape::Circle(circle) => round(all, &circle),
                CurveShape::Line(direction) => all.points.push(("direction", direction)),
                CurveShape::Other => {}
            }
        }
        Thing::Face(face, transform) => {
            let area = mass::area(face, transform);
            all.add("area", area.area, area.error, "mm²");
            match surface::shape(face, transform) {
                SurfaceShape::Plane { normal, .. } => all.points.push(("normal", normal)),
                SurfaceShape::Cylinder { axis, point, radius } => {
                    round(all, &Circle { centre: point, axis, radius });
                    all.points.push(("axis", axis));
                }
                SurfaceShape::Sphere { centre, radius } => {
                    round(all, &Circle { centre, axis: DVec3::Z, radius });
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
    Some(())
}

/// A direction to measure angles to, whether it is a normal, and a middle: a point or a line.
type Frame = (Option<(DVec3, bool)>, Option<(DVec3, Option<DVec3>)>);

fn frame(thing: &Thing<'_>) -> Frame {
    match thing {
        Thing::Point(p) => (None, Some((*p, None))),
        Thing::Edge(edge, transform) => match curve::shape(edge, *transform) {
            CurveShape::Line(direction) => (Some((direction, false)), None),
            CurveShape::Circle(circle) => (Some((circle.axis, false)), Some((circle.centre, None))),
            CurveShape::Other => (None, None),
        },
        Thing::Face(face, transform) => {
            let shape = surface::shape(face, *transform);
            let is_normal = matches!(shape, SurfaceShape::Plane { .. });
            (shape.direction().map(|d| (d, is_normal)), shape.middle())
        }
    }
}

fn pieces<'a>(thing: &Thing<'a>) -> Vec<Sampled<'a>> {
    match *thing {
        Thing::Point(p) => Sampled::point(p),
        Thing::Edge(edge, transform) => Sampled::edge(edge, transform),
        Thing::Face(face, transform) => Sampled::face(face, transform),
    }
}

fn pair(world: &World, a: &Picked, b: &Picked, all: &mut Measurement) -> Option<()> {
    let (a, b) = (thing(world, a)?, thing(world, b)?);
    let Distance { distance, points: [p, q], error } = distance::smallest(&pieces(&a), &pieces(&b))?;
    all.add("distance", distance, error, "mm");
    for (what, x) in ["along x", "along y", "along z"].into_iter().zip((q - p).to_array()) {
        all.add(what, x, error, "mm");
    }
    all.points.extend([("from", p), ("to", q)]);
    all.dimension([p, q], "", distance);
    let ((turn_a, middle_a), (turn_b, middle_b)) = (frame(&a), frame(&b));
    if let (Some((d, d_is_normal)), Some((e, e_is_normal))) = (turn_a, turn_b) {
        let angle = d.cross(e).length().atan2(d.dot(e).abs()).to_degrees();
        // a plane's angle to a line is that of its normal, less a right angle
        let angle = if d_is_normal == e_is_normal { angle } else { 90.0 - angle };
        all.add("angle", angle, 0.0, "°");
    }
    if let (Some((c, along_c)), Some((d, along_d))) = (middle_a, middle_b)
        && let Some((p, q)) = between(c, along_c, d, along_d)
    {
        let what = if along_c.is_some() || along_d.is_some() { "between axes" } else { "between centres" };
        all.add(what, p.distance(q), 0.0, "mm");
        all.dimension([p, q], "axes", p.distance(q));
    }
    Some(())
}

/// The nearest points of two points or lines.
fn between(p: DVec3, along_p: Option<DVec3>, q: DVec3, along_q: Option<DVec3>) -> Option<(DVec3, DVec3)> {
    let foot = |on: DVec3, along: DVec3, of: DVec3| on + along * (of - on).dot(along);
    Some(match (along_p, along_q) {
        (None, None) => (p, q),
        (Some(d), None) => (foot(p, d, q), q),
        (None, Some(e)) => (p, foot(q, e, p)),
        (Some(d), Some(e)) => {
            let cross = d.cross(e);
            if cross.length() < 1e-9 {
                return Some((p, foot(q, e, p)));
            }
            let (apart, square) = (q - p, cross.length_squared());
            (p + d * (apart.cross(e).dot(cross) / square), q + e * (apart.cross(d).dot(cross) / square))
        }
    })
}

#[cfg(test)]
mod tests;
