//! BRL-CAD databases as text, version 5: what `g2asc` writes.
//!
//! ```text
//!   put rod tgc V {0 0 0} H {0 0 9} A {1 0 0} B {0 1 0} C {1 0 0} D {0 1 0}     a solid
//!   put all comb region yes rgb {255 0 0} tree {- {l box} {l rod {1 0 0 ...}}}  a combination
//!
//!   text ──words──▶ objects by name ──from those that nobody names──▶ Assembly ──▶ one Solid
//! ```
//!
//! Lengths are millimetres, whatever `units` says. An object that has no exact counterpart refuses the file
//! by name and line, if anything that is drawn needs it. Combinations may share others; the expansion is bounded.

mod body;
#[cfg(test)]
mod tests;
mod tree;
mod words;

use super::colour::linear;
use super::solid::{Assembly, Placed};
use super::{Import, ImportError, ImportReport, Warnings};
use crate::csg::Op;
use crate::model::{Colour, Model};
use glam::DAffine3;
use std::collections::{BTreeMap, HashSet};
use tree::Item;
use words::Statement;

/// Why the text is not read, and where.
#[derive(Debug)]
pub(super) struct Fault {
    line: usize,
    message: String,
}

impl Fault {
    fn new(line: usize, message: impl Into<String>) -> Self {
        Self { line, message: message.into() }
    }
}

/// Members of combinations that may be placed, each as often as it is used.
const MOST_PLACED: usize = 1 << 22;

/// One `put`.
struct Object<'a> {
    statement: Statement<'a>,
    id: u32,
    /// Of a combination.
    items: Option<Vec<Item<'a>>>,
    colour: Option<Colour>,
}

/// Whether a line of the text's beginning is one that such files have.
pub(super) fn recognise(text: &str) -> bool {
    let start = text.lines().take(20).map(str::trim_start);
    start
        .take_while(|l| !l.is_empty() || text.starts_with('\n'))
        .any(|l| l.starts_with("put {") || l.starts_with("put ") || l.starts_with("title {"))
}

/// Reads the text; `name` is the file's name in messages.
pub(super) fn read(text: &str, name: &str) -> Result<Import, ImportError> {
    let failed = |fault: Fault| ImportError::Solid { file: name.to_owned(), line: fault.line, message: fault.message };
    let mut report = ImportReport { format: "BRL-CAD asc".to_owned(), ..ImportReport::default() };
    let objects = objects(text, &mut report).map_err(failed)?;
    let named: HashSet<&str> =
        objects.values().filter_map(|o| o.items.as_ref()).flatten().filter_map(Item::name).collect();
    let mut assembly = Assembly::default();
    let mut model = Model { name: super::stem(name), unit: report.units.join(", "), ..Model::default() };
    let mut roots = Vec::new();
    let mut budget = MOST_PLACED;
    for (top, object) in objects.iter().filter(|(top, _)| !named.contains(*top)) {
        report.occurrences.push((*top).to_owned());
        roots.push(expand(&objects, object, &mut assembly, &mut budget).map_err(failed)?);
    }
    if roots.is_empty() && !objects.is_empty() {
        return Err(failed(Fault::new(1, "every combination is part of another")));
    }
    if let Some(object) = circular(&objects, &named) {
        let name = object.statement.words[1];
        return Err(failed(Fault::new(object.statement.line, format!("`{name}` is part of itself"))));
    }
    if !roots.is_empty() {
        let root = assembly.nodes.fold(Op::Union, roots);
        model.solids.push(assembly.finish(root).map_err(|message| failed(Fault::new(1, message)))?);
    }
    report.bodies = model.solids.len();
    let warnings = Warnings::new(name).finish(&mut report);
    Ok(Import { model, warnings, report, ..Import::default() })
}

/// An object that only what it is part of leads to, if there is one: nothing that is drawn would show it.
fn circular<'o, 'a>(objects: &'o BTreeMap<&'a str, Object<'a>>, named: &HashSet<&str>) -> Option<&'o Object<'a>> {
    let members = |name: &str| objects.get(name).and_then(|o| o.items.as_ref()).into_iter().flatten();
    let mut todo: Vec<&str> = objects.keys().copied().filter(|name| !named.contains(name)).collect();
    let mut reached: HashSet<&str> = todo.iter().copied().collect();
    while let Some(name) = todo.pop() {
        todo.extend(members(name).filter_map(Item::name).filter(|member| reached.insert(member)));
    }
    // whoever names one that is not reached is not reached either: going on so comes round
    let mut owner: BTreeMap<&str, &str> = BTreeMap::new();
    for name in objects.keys().copied().filter(|name| !reached.contains(name)) {
        owner.extend(members(name).filter_map(Item::name).map(|member| (member, name)));
    }
    let mut at = *owner.keys().find(|name| objects.contains_key(*name))?;
    let mut seen = HashSet::new();
    while seen.insert(at) {
        at = owner.get(at)?;
    }
    // the cycle once more, for the one that stands first in the file
    let mut first = at;
    loop {
        at = owner.get(at)?;
        if objects[at].statement.line < objects[first].statement.line {
            first = at;
        }
        if !seen.remove(at) {
            return objects.get(first);
        }
    }
}

/// All objects by name.
fn objects<'a>(text: &'a str, report: &mut ImportReport) -> Result<BTreeMap<&'a str, Object<'a>>, Fault> {
    let mut objects = BTreeMap::new();
    for statement in words::statements(text)? {
        match statement.words[0] {
            "put" if statement.words.len() >= 3 => {
                let (name, kind) = (statement.words[1], statement.words[2]);
                *report.nodes.entry(kind.to_owned()).or_default() += 1;
                let items = match (kind, statement.value("tree")) {
                    ("comb", Some(tree)) => Some(tree::parse(tree, statement.line)?),
                    ("comb", None) => Some(Vec::new()),
                    _ => None,
                };
                let (id, colour) = (objects.len() as u32 + 1, statement.value("rgb").and_then(colour));
                objects.insert(name, Object { statement, id, items, colour });
            }
            "put" => return Err(Fault::new(statement.line, "`put` without name and kind")),
            "units" => report.units.extend(statement.words.get(1).map(|u| (*u).to_owned())),
            "attr" => {
                let rgb = statement.words.iter().position(|w| *w == "rgb" || *w == "color");
                let value = rgb.and_then(|i| statement.words.get(i + 1)).and_then(|v| colour(v));
                if let (Some(c), Some(object)) = (value, statement.words.get(2).and_then(|n| objects.get_mut(n))) {
                    object.colour = Some(c);
                }
            }
            "title" | "color" | "find" => {}
            other => {
                let other: String = other.chars().take(40).collect();
                return Err(Fault::new(statement.line, format!("`{other}` is not a statement of such a file")));
            }
        }
    }
    Ok(objects)
}

/// `{255 0 0}` or `255/0/0` to linear light.
fn colour(value: &str) -> Option<Colour> {
    let parts: Vec<f64> =
        value.split(['/', ' ']).filter(|w| !w.is_empty()).map(|w| w.parse().ok()).collect::<Option<_>>()?;
    let rgb: [f64; 3] = parts[..].try_into().ok()?;
    Some(linear(rgb.map(|c| c / 255.0), 1.0))
}

/// A combination in the middle of being worked out.
struct Frame<'o, 'a> {
    name: &'a str,
    items: &'o [Item<'a>],
    next: usize,
    transform: DAffine3,
    colour: Option<Colour>,
    values: Vec<u32>,
}

/// An object with everything below it, as a node.
fn expand<'a>(
    objects: &BTreeMap<&'a str, Object<'a>>,
    top: &Object<'a>,
    assembly: &mut Assembly,
    budget: &mut usize,
) -> Result<u32, Fault> {
    let mut stack: Vec<Frame<'_, 'a>> = Vec::new();
    let mut open: HashSet<&str> = HashSet::new();
    let mut call = Some((top, DAffine3::IDENTITY, None));
    let mut result = assembly.nothing();
    loop {
        if let Some((object, transform, inherited)) = call.take() {
            let (line, name) = (object.statement.line, object.statement.words[1]);
            *budget = budget
                .checked_sub(1)
                .ok_or_else(|| Fault::new(line, format!("more than {MOST_PLACED} placed members")))?;
            let colour = object.colour.or(inherited);
            if let Some(items) = &object.items {
                if !open.insert(name) {
                    return Err(Fault::new(line, format!("`{name}` is part of itself")));
                }
                stack.push(Frame { name, items, next: 0, transform, colour, values: Vec::new() });
            } else {
                let placed = Placed { transform, colour, id: object.id };
                result = body::body(assembly, &object.statement, &placed)?;
                if let Some(frame) = stack.last_mut() {
                    frame.values.push(result);
                }
            }
        }
        let Some(frame) = stack.last_mut() else { return Ok(result) };
        let Some(item) = frame.items.get(frame.next) else {
            result = frame.values.pop().unwrap_or_else(|| assembly.nothing());
            open.remove(frame.name);
            stack.pop();
            if let Some(parent) = stack.last_mut() {
                parent.values.push(result);
            }
            continue;
        };
        frame.next += 1;
        match item {
            Item::Member { name, matrix, line } => {
                let object = objects.get(name).ok_or_else(|| Fault::new(*line, format!("`{name}` does not exist")))?;
                call = Some((object, frame.transform * *matrix, frame.colour));
            }
            Item::Not => {
                let a = frame.values.pop().expect("counted by the parser");
                frame.values.push(assembly.nodes.complement(a));
            }
            Item::Pair(op) => {
                let b = frame.values.pop().expect("counted by the parser");
                let a = frame.values.pop().expect("counted by the parser");
                frame.values.push(assembly.nodes.pair(*op, a, b));
            }
        }
    }
}
