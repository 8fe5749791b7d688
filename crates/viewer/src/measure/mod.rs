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

/// A number with its unit and the estimate of its error, where it has one.
pub fn stated(value: &Value) -> String {
    let number = format!("{} {}", describe::number(value.value), value.unit);
    if value.error > 0.0 { format!("{number} ± {:.1e}", value.error) } else { number }
}

impl Measurement {
    /// As text, a line a number.
    pub fn text(&self) -> String {
        let values = self.values.iter().map(|v| format!("{}: {}", v.what, stated(v)));
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
    let between_points = selection.len() == 2 && selection.iter().all(Picked::is_point);
    let text = |d: Dimension| (d.ends, label(&d, between_points));
    let dimensions = measured.dimensions.into_iter().map(text).collect();
    Some(Measurement { title, values: measured.values, points: measured.points, dimensions })
}

/// The text of a dimension. Of one between points it says how far they are apart along the axes, too.
fn label(dimension: &Dimension, between_points: bool) -> String {
    let mut text = format!("{} {}", dimension.what, describe::number(dimension.value)).trim_start().to_owned();
    if between_points {
        let [x, y, z] = (dimension.ends[1] - dimension.ends[0]).to_array().map(describe::number);
        text += &format!("\ndx {x}  dy {y}  dz {z}");
    }
    text
}

/// The geometry of an item, in its place.
fn item<'a>(world: &'a World, picked: &Picked) -> Option<Item<'a>> {
    let placed = world.model.instances.get(picked.instance()?)?;
    let part = world.model.parts.get(placed.part)?;
    let edges = world.edges_of(placed.part);
    match *picked {
        Picked::Face { face, .. } => Some(Item::Face(part.faces.get(face)?, placed.transform)),
        Picked::Edge { edge, .. } => Some(Item::Edge(vec![edges?.edges.get(edge)?], placed.transform)),
        Picked::Vertex { .. } | Picked::Point { .. } => world.point_of(picked).map(Item::Point),
        Picked::Instance(_) => Some(Item::Part(part, placed.transform)),
        Picked::Number { .. } => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::PointKind;
    use glam::{DAffine3, DQuat};
    use selvedge::construct::shapes;
    use selvedge::model::{Instance, Model};

    #[test]
    fn a_dimension_between_points_says_how_far_they_are_apart_along_the_axes() {
        let ends = [DVec3::new(1.0, 2.0, 3.0), DVec3::new(3.0, 5.0, -3.0)];
        let of = |what, between_points| label(&Dimension { ends, what, value: 7.0 }, between_points);
        assert_eq!([of("", true), of("", false), of("R", false)], ["7\ndx 2  dy 3  dz -6", "7", "R 7"]);
    }

    /// A part that is turned and moved: its points are measured where they are.
    #[test]
    fn picked_points_are_measured_in_their_place() {
        let block = shapes::block(DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0)).expect("a block").part;
        let turn = DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2);
        let transform = DAffine3::from_rotation_translation(turn, DVec3::new(10.0, 0.0, 0.0));
        let placed = Instance { part: 0, transform, colour: None, name: String::new() };
        let mut world = World::default();
        world.model = Model { parts: vec![block], instances: vec![placed], ..Model::default() };
        world.find_edges();
        let vertices = &world.edges_of(0).expect("found").vertices;
        let vertex = vertices.iter().position(|p| p.length() < 1e-12).expect("a corner at the origin");
        let at = DVec3::new(1.0, 1.0, 1.5);
        let selection =
            [Picked::Vertex { instance: 0, vertex }, Picked::Point { instance: 0, kind: PointKind::OnFace, of: 0, at }];
        let measured = measure(&world, &selection).expect("two points");
        let all = measured.values.iter().map(|v| (v.what, v.value));
        // x is y of the part, turned around
        let expected = [("distance", 4.25_f64.sqrt()), ("along x", -1.0), ("along y", 1.0), ("along z", 1.5)];
        for ((what, value), (name, number)) in all.clone().zip(expected) {
            assert!(what == name && (value - number).abs() < 1e-14, "{what}: {value}");
        }
        assert_eq!(all.len(), expected.len());
        let [(ends, text)] = &measured.dimensions[..] else { panic!("{:?}", measured.dimensions) };
        assert!(ends[1].distance(DVec3::new(9.0, 1.0, 1.5)) < 1e-14 && text.contains("dx -1  dy 1  dz 1.5"), "{text}");
        assert!(measured.csv().contains(",along x,-1"), "{}", measured.csv());
        assert!(measured.text().contains("along z: 1.5 mm"), "{}", measured.text());
    }

    #[test]
    fn a_measurement_is_text_and_a_table() {
        let all = Measurement {
            title: "edge \"1\"".to_owned(),
            values: vec![
                Value { what: "length", value: 1.0 / 3.0, error: 1e-16, unit: "mm" },
                Value { what: "radius", value: 2.5, error: 0.0, unit: "mm" },
            ],
            points: vec![("centre", DVec3::new(1.0, 2.5, -3.0))],
            dimensions: Vec::new(),
        };
        assert_eq!(all.text(), "edge \"1\"\nlength: 0.333333333333 mm ± 1.0e-16\nradius: 2.5 mm\ncentre: 1, 2.5, -3");
        let title = "\"edge \"\"1\"\"\"";
        let rows = [
            "length,0.3333333333333333,0.0000000000000001",
            "radius,2.5,0",
            "centre x,1,0",
            "centre y,2.5,0",
            "centre z,-3,0",
        ];
        assert_eq!(all.csv(), rows.map(|row| format!("{title},{row},mm\n")).concat());
    }
}
