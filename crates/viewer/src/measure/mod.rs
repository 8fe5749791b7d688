//! What a selection measures, and its text.
//!
//! Numbers are those of [`selvedge_geometry::measure`].

pub mod cut;

use crate::describe;
use crate::session::Picked;
use crate::session::World;
use glam::DVec3;
use selvedge_geometry::measure::{self, Dimension, Item};

pub use selvedge_geometry::measure::Value;

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
    let measured = match selection {
        [one] => measure::one(&item(world, one)?)?,
        [a, b] => measure::two(&item(world, a)?, &item(world, b)?)?,
        _ => return None,
    };
    let text = |d: Dimension| (d.ends, format!("{} {}", d.what, describe::number(d.value)));
    let dimensions = measured.dimensions.into_iter().map(text).collect();
    Some(Measurement { title, values: measured.values, points: measured.points, dimensions })
}

/// The geometry of an item, in its place.
fn item<'a>(world: &'a World, picked: &Picked) -> Option<Item<'a>> {
    let placed = world.model.instances.get(picked.instance()?)?;
    let part = world.model.parts.get(placed.part)?;
    let edges = world.edges_of(placed.part);
    match *picked {
        Picked::Face { face, .. } => Some(Item::Face(part.faces.get(face)?, placed.transform)),
        Picked::Edge { edge, .. } => Some(Item::Edge(vec![edges?.edges.get(edge)?], placed.transform)),
        Picked::Vertex { vertex, .. } => {
            Some(Item::Point(placed.transform.transform_point3(*edges?.vertices.get(vertex)?)))
        }
        Picked::Instance(_) => Some(Item::Part(part, placed.transform)),
        Picked::Number { .. } => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_measurement_is_text_and_a_table() {
        let all = Measurement {
            title: "edge \"1\"".to_owned(),
            values: vec![Value { what: "length", value: 1.0 / 3.0, error: 1e-16, unit: "mm" }],
            points: vec![("centre", DVec3::new(1.0, 2.5, -3.0))],
            dimensions: Vec::new(),
        };
        assert_eq!(all.text(), "edge \"1\"\nlength: 0.333333333333 mm\ncentre: 1, 2.5, -3");
        let title = "\"edge \"\"1\"\"\"";
        let rows = ["length,0.3333333333333333,0.0000000000000001", "centre x,1,0", "centre y,2.5,0", "centre z,-3,0"];
        assert_eq!(all.csv(), rows.map(|row| format!("{title},{row},mm\n")).concat());
    }
}
