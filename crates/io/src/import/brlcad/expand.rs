//! Expands combinations and their members into one expression.
//!
//! ```text
//!   assembly ─u─ region ─ - ─ solid          a member that cannot be read is empty; its combination may be too small
//!        ╰────── region ─ - ─ solid          and is not subtracted, so nothing beyond the file is drawn
//! ```
//!
//! Colours: the lower object wins, unless a combination states that its own colour holds; below a region no colour
//! counts. The table of colours overrides a region's own. Regions of air are not drawn.

use super::Fault;
use super::body::Bodies;
use super::object::{Database, Object};
use super::tree::Item;
use crate::csg::Op;
use crate::import::solid::Placed;
use crate::import::{Place, Warnings};
use crate::model::{Colour, Solid};
use glam::DAffine3;
use std::collections::HashSet;

/// Members of combinations that may be placed, each as often as it is used.
const MOST_PLACED: usize = 1 << 22;

/// A part of the expression.
#[derive(Clone, Copy)]
struct Value {
    node: u32,
    /// Nothing that belongs to it is left out.
    whole: bool,
}

/// What objects inherit.
#[derive(Clone, Copy)]
struct Above {
    transform: DAffine3,
    colour: Option<Colour>,
    /// Colours further down do not matter.
    holds: bool,
}

/// A combination in the middle of being worked out.
struct Frame<'d, 'a> {
    name: &'a str,
    items: &'d [Item<'a>],
    next: usize,
    above: Above,
    values: Vec<Value>,
}

/// A database on its way to one solid.
pub(super) struct Expansion<'d, 'a> {
    database: &'d Database<'a>,
    bodies: Bodies<'d, 'a>,
    budget: usize,
    roots: Vec<u32>,
    /// The first member that was left out, and why.
    first: Option<Fault>,
    told: HashSet<String>,
}

impl<'d, 'a> Expansion<'d, 'a> {
    pub fn new(database: &'d Database<'a>) -> Self {
        let bodies = Bodies::new(database);
        let told = HashSet::new();
        Self { database, bodies, budget: MOST_PLACED, roots: Vec::new(), first: None, told }
    }

    /// The union of all that was added; `None` when it is empty, or only air.
    ///
    /// # Errors
    /// The first fault, when nothing is left.
    pub fn finish(mut self) -> Result<Option<Solid>, Fault> {
        if self.roots.is_empty() {
            return Ok(None);
        }
        let root = self.bodies.to.nodes.fold(Op::Union, self.roots);
        let solid = self.bodies.to.finish(root).map_err(|message| Fault::new(1, message))?;
        match self.first {
            Some(fault) if solid.primitives().is_empty() => Err(fault),
            _ => Ok(Some(solid)),
        }
    }

    /// An object with everything below it joins the rest.
    ///
    /// # Errors
    /// An object that is part of itself; more members than are placed.
    pub fn add(&mut self, top: &'d Object<'a>, warnings: &mut Warnings) -> Result<(), Fault> {
        let mut stack: Vec<Frame<'d, 'a>> = Vec::new();
        let mut open: HashSet<&str> = HashSet::new();
        let start = Above { transform: DAffine3::IDENTITY, colour: None, holds: false };
        let mut call = Some((top, start));
        loop {
            let mut result = None;
            if let Some((object, above)) = call.take() {
                let (line, name) = (object.record.line, object.record.name);
                self.budget = self
                    .budget
                    .checked_sub(1)
                    .ok_or_else(|| Fault::new(line, format!("more than {MOST_PLACED} placed members")))?;
                let above = self.seen_from_below(object, above);
                match &object.combination {
                    Some(all) if all.region && all.air => {
                        if self.told.insert(name.to_owned()) {
                            warnings.push("region of air not drawn", || Place::Line(line), || name.to_owned());
                        }
                        result = Some(Value { node: self.bodies.to.nothing(), whole: true });
                    }
                    Some(all) => {
                        if !open.insert(name) {
                            return Err(Fault::new(line, format!("`{name}` is part of itself")));
                        }
                        stack.push(Frame { name, items: &all.items, next: 0, above, values: Vec::new() });
                    }
                    None => result = Some(self.solid(object, above, warnings)),
                }
            } else if let Some(frame) = stack.last_mut() {
                let Some(item) = frame.items.get(frame.next) else {
                    let nothing = Value { node: self.bodies.to.nothing(), whole: true };
                    result = Some(frame.values.pop().unwrap_or(nothing));
                    open.remove(frame.name);
                    stack.pop();
                    if give(&mut stack, result) {
                        continue;
                    }
                    self.roots.extend(result.map(|v| v.node));
                    return Ok(());
                };
                frame.next += 1;
                match item {
                    Item::Member { name, matrix, line } => match self.database.objects.get(name) {
                        Some(object) => {
                            call = Some((object, Above { transform: frame.above.transform * *matrix, ..frame.above }));
                        }
                        None => {
                            let what = if name.is_empty() {
                                format!("a member of `{}` without operation or matrix", frame.name)
                            } else {
                                format!("`{name}` does not exist")
                            };
                            result = Some(self.left_out(Fault::new(*line, what), warnings));
                        }
                    },
                    Item::Not => {
                        let a = frame.values.pop().expect("counted by the parser");
                        let nodes = &mut self.bodies.to.nodes;
                        let node = if a.whole { nodes.complement(a.node) } else { self.bodies.to.nothing() };
                        result = Some(Value { node, ..a });
                    }
                    Item::Pair(op) => {
                        let b = frame.values.pop().expect("counted by the parser");
                        let a = frame.values.pop().expect("counted by the parser");
                        result = Some(self.joined(*op, a, b));
                    }
                }
            }
            if result.is_some() && !give(&mut stack, result) {
                self.roots.extend(result.map(|v| v.node));
                return Ok(());
            }
        }
    }

    /// What an object's members inherit from it, given what it inherits itself.
    fn seen_from_below(&self, object: &Object<'a>, above: Above) -> Above {
        let mut below = above;
        if !above.holds {
            below.colour = object.colour.or(above.colour);
        }
        if let Some(all) = &object.combination {
            if all.region && !above.holds {
                below.colour = self.database.of_table(all.number).or(below.colour);
            }
            below.holds |= all.region || all.holds && object.colour.is_some();
        }
        below
    }

    fn solid(&mut self, object: &Object<'a>, above: Above, warnings: &mut Warnings) -> Value {
        let placed = Placed { transform: above.transform, colour: above.colour, id: object.id };
        match self.bodies.node(&object.record, &placed, warnings) {
            Ok(node) => Value { node, whole: true },
            Err(fault) => self.left_out(fault, warnings),
        }
    }

    fn left_out(&mut self, fault: Fault, warnings: &mut Warnings) -> Value {
        if self.told.insert(format!("{} {}", fault.line, fault.message)) {
            warnings.push("solid left out", || Place::Line(fault.line), || fault.message.clone());
        }
        self.first.get_or_insert(fault);
        Value { node: self.bodies.to.nothing(), whole: false }
    }

    /// `a` and `b` under an operation: `b` is subtracted only if it is whole.
    fn joined(&mut self, op: Op, a: Value, b: Value) -> Value {
        let whole = a.whole && b.whole;
        let grows = match op {
            Op::Union | Op::Intersection => true,
            Op::Difference => b.whole,
            Op::SymmetricDifference => whole,
        };
        let node = if grows { self.bodies.to.nodes.pair(op, a.node, b.node) } else { self.bodies.to.nothing() };
        Value { node, whole }
    }
}

/// Hands a value to the combination that waits for it; false when none does.
fn give(stack: &mut [Frame<'_, '_>], value: Option<Value>) -> bool {
    let Some(frame) = stack.last_mut() else { return false };
    frame.values.extend(value);
    true
}
