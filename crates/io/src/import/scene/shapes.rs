//! Ready-made solids: gears, pipes, the pieces of a teapot; and primitives as trimmed faces instead of equations.

use super::items::Scene;
use super::text::{Outcome, Table, Value};
use crate::construct::shapes::{Body, GearBlank, Keyway, SpurGear, block, cone, cylinder, sphere, teapot, torus, tube};
use crate::construct::{ConstructError, capped_solid};
use crate::model::{Part, Shape};

/// Most teeth that a scene asks for.
const MOST_TEETH: usize = 1024;

/// Names of the shapes of this file.
pub(super) const READY: &[&str] = &["tube", "gear", "gear-blank", "teapot", "capped"];

/// A closed part and its deviation, in the file's unit; `None` for other shapes.
pub(super) fn ready<'a>(
    scene: &mut Scene<'a>,
    shape: Value<'a>,
    table: &mut Table<'a>,
) -> Outcome<Option<(Part, f64)>> {
    let mut number = |key: &'static str| table.need(key)?.number();
    let body = match shape.text()? {
        "tube" => tube(number("outer")?, number("inner")?, number("height")?),
        "gear" => {
            let (module, width) = (number("module")?, number("width")?);
            let teeth = table.need("teeth")?.count(4, MOST_TEETH)? as u32;
            let gear = SpurGear::new(module, teeth, width, table.number_or("bore", 0.0)?);
            let pressure_angle = table.number_or("pressure_angle", 20.0)?.to_radians();
            let tolerance = table.read("tolerance", Value::positive)?.unwrap_or(gear.tolerance);
            SpurGear { pressure_angle, tolerance, ..gear }.build()
        }
        "gear-blank" => {
            let blank = GearBlank {
                radius: number("radius")?,
                width: number("width")?,
                hub_radius: number("hub_radius")?,
                hub_width: number("hub_width")?,
                bore: number("bore")?,
                keyway: None,
            };
            let keyway = table.read("keyway", |v| {
                let mut table = v.table()?;
                let key = Keyway { width: table.need("width")?.number()?, depth: table.need("depth")?.number()? };
                table.finish()?;
                Ok(key)
            })?;
            GearBlank { keyway, ..blank }.build()
        }
        "teapot" => {
            let piece = table.need("piece")?;
            let piece = piece.word(&[("pot", 0), ("lid", 1), ("handle", 2), ("spout", 3)])?;
            teapot().map(|t| {
                let [mut pot, lid, handle, spout] = [t.pot, t.lid, t.handle, t.spout];
                match piece {
                    0 => {}
                    1 => pot = lid,
                    2 => pot = handle,
                    _ => pot = spout,
                }
                pot
            })
        }
        "capped" => {
            let names = table.need("walls")?.names()?;
            let mut walls = Vec::new();
            let mut deviation: f64 = 0.0;
            for name in names {
                let wall = scene.surface(name)?;
                if !wall.loops.is_empty() {
                    return Err(name.fault("a wall is a surface without loops"));
                }
                deviation = deviation.max(wall.deviation);
                walls.push(wall.surface.clone());
            }
            capped_solid(&walls).map(|part| Body { part, shape: None, deviation })
        }
        _ => return Ok(None),
    };
    let body = body.map_err(|e| shape.fault(e))?;
    Ok(Some((body.part, body.deviation)))
}

/// The faces of a primitive; `None` where it has no end.
pub(super) fn faces(shape: &Shape) -> Option<Result<Part, ConstructError>> {
    let body = match *shape {
        Shape::Block { min, max } => block(min, max),
        Shape::Sphere { radius } => sphere(radius),
        Shape::Cylinder { radius, height } => cylinder(radius, height),
        Shape::Cone { bottom, top, height } => cone(bottom, top, height),
        Shape::Torus { major, minor } => torus(major, minor),
        _ => return None,
    };
    Some(body.map(|b| b.part))
}
