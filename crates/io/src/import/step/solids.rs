//! Boolean solids between their expressions and the model.
//!
//! ```text
//!   Expression ──operands of faces──▶ bodies, built with all others ──▶ parts ──┐
//!              ──leaves, tree───────────────────────────────────────────────────┴─▶ one Solid a placement
//! ```

use super::body::{Body, Looks};
use super::csg::{self, Expression, Leaf, Operand};
use super::geometry::{Geometry, Ledger, Notes};
use super::part21::Places;
use super::walk::Placed;
use crate::model::{Colour, GREY, Model, Part, Primitive, Shape, Solid};
use glam::DAffine3;
use std::collections::HashMap;
use std::sync::Arc;

const LOST: &str = "Boolean solid left out";

/// The Boolean solids of a file.
#[derive(Debug, Default)]
pub(super) struct Solids {
    all: Vec<Waiting>,
    by_id: HashMap<u32, usize>,
}

/// An expression whose faces are not built yet.
#[derive(Debug)]
struct Waiting {
    expression: Expression,
    /// Tolerance of its representation.
    tolerance: f64,
    /// Where it stands, and the colour that it has there.
    places: Vec<(DAffine3, Option<Colour>)>,
    /// Its first operand among the parts.
    first: usize,
}

impl Solids {
    /// Reads the expression `#id` of a representation, once.
    pub fn read(&mut self, geometry: &Geometry<'_>, id: u32, looks: Looks<'_>, representation: u32) {
        if self.by_id.contains_key(&id) {
            return;
        }
        match csg::read(geometry, id, looks, looks.colours.of_item(representation)) {
            Ok(expression) => {
                self.by_id.insert(id, self.all.len());
                let tolerance = geometry.units.tolerance;
                self.all.push(Waiting { expression, tolerance, places: Vec::new(), first: 0 });
            }
            Err(fault) => geometry.ledger.note(LOST, id, fault.to_string()),
        }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.all.len()
    }

    /// Types of entities in the expressions.
    pub fn kinds(&self) -> impl Iterator<Item = (&str, usize)> {
        self.all.iter().flat_map(|w| &w.expression.kinds).map(|(k, n)| (k.as_str(), *n))
    }

    /// Notes a placement if it is one of a Boolean solid.
    pub fn place(&mut self, placed: &Placed, ledger: &Ledger<'_>) -> bool {
        let Some(&index) = self.by_id.get(&placed.body) else { return false };
        let waiting = &mut self.all[index];
        match ledger.spend(placed.body, waiting.expression.tree.nodes().len()) {
            Ok(()) => waiting.places.push((placed.transform, placed.colour)),
            Err(fault) => ledger.note(LOST, placed.body, fault.to_string()),
        }
        true
    }

    /// Takes the operands of faces out; they become parts from `first` on. Id, body and tolerance of each.
    pub fn operands(&mut self, mut first: usize) -> Vec<(u32, Body, f64)> {
        let mut all = Vec::new();
        for waiting in &mut self.all {
            waiting.first = first;
            first += waiting.expression.bodies.len();
            let tolerance = waiting.tolerance;
            all.extend(waiting.expression.bodies.drain(..).map(|(id, body)| (id, body, tolerance)));
        }
        all
    }

    /// Adds the solids to the model and takes their operands, the parts behind `parts`, from it.
    pub fn finish(self, parts: usize, model: &mut Model, (places, notes): (&Places<'_>, &mut Notes)) {
        let operands: Vec<Arc<Part>> = model.parts.split_off(parts).into_iter().map(Arc::new).collect();
        for Waiting { expression, places: stands, first, .. } in self.all {
            let id = expression.id;
            let operands = &operands[first.saturating_sub(parts)..];
            match primitives(&expression, operands) {
                Ok(primitives) => {
                    for (transform, colour) in stands {
                        let placed = |p: &Primitive| Primitive {
                            transform: transform * p.transform,
                            colour: colour.unwrap_or(p.colour),
                            ..p.clone()
                        };
                        match Solid::new(primitives.iter().map(placed).collect(), expression.tree.clone()) {
                            Ok(solid) => model.solids.push(solid),
                            Err(e) => notes.push(LOST, || places.of(id), e.to_string()),
                        }
                    }
                }
                Err(why) => notes.push(LOST, || places.of(id), why),
            }
        }
    }
}

fn primitives(expression: &Expression, operands: &[Arc<Part>]) -> Result<Vec<Primitive>, String> {
    let primitive = |leaf: &Leaf| {
        let shape = match &leaf.operand {
            Operand::Shape(shape) => shape.clone(),
            Operand::Body(index) => {
                let part = &operands[*index];
                if part.faces.is_empty() && part.meshes.is_empty() {
                    return Err(format!("its operand #{} has no face left", leaf.id));
                }
                if !part.closed {
                    return Err(format!("its operand #{} is not closed, so it has no inside", leaf.id));
                }
                Shape::Part(part.clone())
            }
        };
        Ok(Primitive { shape, transform: leaf.place, colour: leaf.colour.unwrap_or(GREY), id: leaf.id })
    };
    expression.leaves.iter().map(primitive).collect()
}
