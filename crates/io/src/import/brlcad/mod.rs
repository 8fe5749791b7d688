//! BRL-CAD databases as text: what `g2asc` writes, version 5 and the older 4.
//!
//! ```text
//!   put rod tgc V {0 0 0} H {0 0 9} A {1 0 0} B {0 1 0} C {1 0 0} D {0 1 0}     a solid
//!   put all comb region yes rgb {255 0 0} tree {- {l box} {l rod {1 0 0 ...}}}  a combination
//!
//!   text ──words, tree──▶ objects by name ──from objects without parent, expand───▶ Assembly ──▶ one Solid
//!        ╰─────old──────▶               ╰──body: arb, quadric, tube, sketch──▶ shapes
//! ```
//!
//! Lengths are millimetres, whatever `units` says. An object without an exact counterpart is left out, named with its
//! line, together with everything that would be too large without it. A file of which nothing remains is refused.
//! Combinations may share members; the expansion is bounded. A sketch is drawn only as part of an extrusion.

mod arb;
mod body;
mod expand;
mod object;
mod old;
mod quadric;
mod sketch;
#[cfg(test)]
mod tests;
mod tree;
mod tube;
mod words;

use super::solid::Fault;
use super::{Import, ImportError, ImportReport, Place, Warnings};
use crate::model::Model;
use expand::Expansion;
use object::{Database, Object};
use std::collections::{BTreeMap, HashSet};

/// Whether a line of the text's beginning is one that such files have.
pub(super) fn recognise(text: &str) -> bool {
    let start = text.lines().take(20).map(str::trim_start);
    let new = start
        .take_while(|l| !l.is_empty() || text.starts_with('\n'))
        .any(|l| l.starts_with("put {") || l.starts_with("put ") || l.starts_with("title {"));
    new || old::recognise(text)
}

/// Reads the text; `name` is the file's name in messages.
pub(super) fn read(text: &str, name: &str) -> Result<Import, ImportError> {
    let failed = |fault: Fault| fault.of_file(name);
    let mut report = ImportReport { format: "BRL-CAD asc".to_owned(), ..ImportReport::default() };
    let mut warnings = Warnings::new(name);
    let database = if old::recognise(text) {
        "BRL-CAD asc, version 4".clone_into(&mut report.format);
        old::read(text, &mut report, &mut warnings)
    } else {
        object::read(text, &mut report, &mut warnings).map_err(failed)?
    };
    let objects = &database.objects;
    let named: HashSet<&str> = objects.values().flat_map(Database::named).collect();
    if objects.keys().all(|name| named.contains(name)) && !objects.is_empty() {
        return Err(failed(Fault::new(1, "every combination is part of another")));
    }
    if let Some(object) = circular(objects, &named) {
        let name = object.record.name;
        return Err(failed(Fault::new(object.record.line, format!("`{name}` is part of itself"))));
    }
    let mut model = Model { name: super::stem(name), unit: report.units.join(", "), ..Model::default() };
    let mut expansion = Expansion::new(&database);
    for top in objects.values().filter(|o| !named.contains(o.record.name) && o.record.kind != "sketch") {
        report.occurrences.push(top.record.name.to_owned());
        expansion.add(top, &mut warnings).map_err(failed)?;
    }
    model.solids.extend(expansion.finish().map_err(failed)?);
    let primitives = model.solids.iter().flat_map(|solid| solid.primitives());
    let flat: HashSet<u32> = primitives.filter(|p| p.to_own().is_none()).map(|p| p.id).collect();
    for object in objects.values().filter(|o| flat.contains(&o.id)) {
        let what = || format!("the axes of `{}`, or matrices around it, are flat", object.record.name);
        warnings.push("empty solid", || Place::Line(object.record.line), what);
    }
    report.bodies = model.solids.len();
    let warnings = warnings.finish(&mut report);
    Ok(Import { model, warnings, report, ..Import::default() })
}

/// An object that is reached only through its own members, if there is one: a cycle, which nothing drawn would show.
fn circular<'o, 'a>(objects: &'o BTreeMap<&'a str, Object<'a>>, named: &HashSet<&str>) -> Option<&'o Object<'a>> {
    let members = |name: &str| objects.get(name).into_iter().flat_map(Database::named);
    let mut todo: Vec<&str> = objects.keys().copied().filter(|name| !named.contains(name)).collect();
    let mut reached: HashSet<&str> = todo.iter().copied().collect();
    while let Some(name) = todo.pop() {
        todo.extend(members(name).filter(|member| reached.insert(member)));
    }
    // the owner of an unreached object is unreached too: following owners ends in the cycle
    let mut owner: BTreeMap<&str, &str> = BTreeMap::new();
    for name in objects.keys().copied().filter(|name| !reached.contains(name)) {
        owner.extend(members(name).map(|member| (member, name)));
    }
    let mut at = *owner.keys().find(|name| objects.contains_key(*name))?;
    let mut seen = HashSet::new();
    while seen.insert(at) {
        at = owner.get(at)?;
    }
    // around the cycle again, for its first object in the file
    let mut first = at;
    loop {
        at = owner.get(at)?;
        if objects[at].record.line < objects[first].record.line {
            first = at;
        }
        if !seen.remove(at) {
            return objects.get(first);
        }
    }
}
