//! Colours: eight standard numbers, or the red, green and blue percent of a 314.
//!
//! The standard names no colour space; writers store the values of their screen, sRGB. The model stores linear light.

use super::entity::Entity;
use super::geometry::Geometry;
use crate::import::colour::linear;
use crate::model::Colour;

/// Black, red, green, blue, yellow, magenta, cyan, white: numbers 1 to 8.
const STANDARD: [[f64; 3]; 8] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 1.0, 0.0],
    [1.0, 0.0, 1.0],
    [0.0, 1.0, 1.0],
    [1.0, 1.0, 1.0],
];

impl<'a> Geometry<'a> {
    /// The entity's own colour in linear light; an unreadable one counts as none, with a warning.
    pub fn colour(&self, entity: Entity<'a>) -> Option<Colour> {
        let number = entity.entry.colour;
        let rgb = match number {
            0 => return None,
            1..=8 => STANDARD[number as usize - 1],
            definition => {
                let read = || {
                    let definition = Entity::find(self.file, definition.unsigned_abs())?;
                    let definition = definition.of_kind(314, "314, a colour")?;
                    Ok::<_, super::entity::Fault>(definition.triple(1)?.to_array().map(|c| c / 100.0))
                };
                read().map_err(|fault| self.note("colour ignored", entity.id(), fault.to_string())).ok()?
            }
        };
        Some(linear(rgb, 1.0))
    }
}
