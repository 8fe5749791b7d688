//! STEP files: ISO 10303-21 text with the shape of AP203, AP214 or AP242.
//!
//! ```text
//!   bytes ─part21─▶ File            syntax: records, parameters, id index
//!         ─entity─▶ Entity, Fields  typed attributes; every Fault names its entity
//!         ─units──▶ Units           per representation context
//!         ─curve, spline, surface─▶ CurveGeometry, SurfaceGeometry          one geometry each
//!         ─face, body, tessellated──▶ Body          faces and the edges that they share; triangles
//!         ─swept, disk──▶ Body          solids that an area or a disk sweeps
//!         ─csg, primitive, solids──▶ Solid          Boolean expressions over primitives and bodies
//!         ─product, assembly, place, orphans─▶ groups and placements
//!         ─once, walk─▶ one instance an occurrence
//!         ─document──▶ Mention      parts in files of their own, which `import::external` follows
//!         ─colour, presentation──▶ Looks            by styled item; layers, what is hidden
//!         ─brep::build_face─▶ Face  in parallel, results in file order
//! ```
//!
//! Nothing in a file can cause a panic, endless work, or memory beyond a multiple of its size: the
//! scanner is linear, the mapping has a budget of work, cycles are found by their trail.

mod assembly;
mod body;
mod colour;
mod csg;
mod curve;
mod disk;
mod document;
mod entity;
mod face;
mod geometry;
mod once;
mod orphans;
mod part21;
mod place;
mod presentation;
mod primitive;
mod product;
mod solids;
mod spline;
mod surface;
mod swept;
mod tessellated;
mod units;
mod walk;

pub(super) use part21::recognise;
pub(super) use surface::{OTHER_SIDE, OTHER_SIDE_HOW, as_cylinder, offset};

use super::external::{Mention, Read};
use super::{
    FaceCount, FaceRecord, Import, ImportError, ImportReport, LOOP_LOST, Options, Place, Pulse, Stage, Warnings,
    locate, preview, stem,
};
use crate::brep::{BuildError, BuiltFace, FaceGeometry, build_face, settle};
use crate::model::{Colour, Instance, Model, Part};
use assembly::Assembly;
use body::{Body, Looks};
use colour::Colours;
use entity::Entity;
use geometry::{FACE_LOST, Geometry, Ledger, Notes};
use part21::{File, Places};
use presentation::Presentation;
use rayon::prelude::*;
use solids::Solids;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Reads STEP text; `name` is the file's name in messages. The result mentions other files that hold parts.
pub(super) fn read(bytes: &[u8], name: &str, options: &Options<'_>) -> Result<Read, ImportError> {
    let mut warnings = Warnings::new(name);
    let file = File::parse_telling(bytes, name, &mut warnings, options)?;
    let ledger = Ledger::new(&file, warnings);
    let mut report = header(&file);
    let colours = Colours::read(&file, &ledger);
    let presentation = Presentation::read(&file, &ledger);
    let assembly = Assembly::read(&file, &ledger, &presentation);
    let mut model = Model { name: model_name(&assembly, name), ..Model::default() };
    let looks = Looks { colours: &colours, presentation: &presentation };
    let mut bodies = Vec::new();
    let mut part_of = HashMap::new();
    let mut units = BTreeSet::new();
    let mut solids = Solids::default();
    let add = |model: &mut Model, report: &mut ImportReport, name: String, body: &mut Body, tolerance: f64| {
        let (closed, meshes) = (body.closed && !body.incomplete, std::mem::take(&mut body.meshes));
        model.parts.push(Part { name, closed, meshes, ..Part::default() });
        let lost = |(id, reason): &(u32, String)| FaceRecord {
            id: *id,
            part: model.parts.len() - 1,
            tolerance,
            notes: vec![reason.clone()],
            ..FaceRecord::default()
        };
        report.face_records.extend(body.lost.iter().map(lost));
    };
    let total = assembly.groups.values().map(|group| group.bodies.len()).sum();
    let mut mapped = 0;
    for group in assembly.groups.values() {
        for &(id, representation) in &group.bodies {
            file.tell(Stage::Bodies { mapped, total });
            mapped += 1;
            if part_of.contains_key(&id) || assembly.files.contains_key(&id) {
                continue;
            }
            let unit = assembly.units_of(representation);
            units.insert(unit.name.clone());
            let geometry = Geometry { file: &file, units: &unit, ledger: &ledger };
            if geometry.entity(id).is_ok_and(csg::is_boolean) {
                solids.read(&geometry, id, looks, representation);
                continue;
            }
            let mut body = if assembly.loose.first() == Some(&id) {
                body::loose(&geometry, &assembly.loose, looks)
            } else {
                body::body(&geometry, id, looks, &[representation])
            };
            part_of.insert(id, model.parts.len());
            add(&mut model, &mut report, part_name(&file, group, id), &mut body, unit.tolerance);
            bodies.push((body, unit.tolerance));
        }
    }
    let parts = model.parts.len();
    for (id, mut body, tolerance) in solids.operands(parts) {
        let name = Entity::find(&file, id).map(|e| e.label()).unwrap_or_default();
        add(&mut model, &mut report, name, &mut body, tolerance);
        bodies.push((body, tolerance));
    }
    let mut mentions: BTreeMap<u32, Mention> = BTreeMap::new();
    for placed in assembly.walk(looks, &ledger) {
        if let Some(documents) = assembly.files.get(&placed.body) {
            let mention = mentions.entry(placed.body).or_insert_with(|| Mention {
                at: Entity::find(&file, documents[0].0).map_or(Place::File, Entity::place),
                documents: documents.iter().map(|(_, names)| names.clone()).collect(),
                stands: Vec::new(),
            });
            mention.stands.push((placed.transform, placed.colour, placed.name));
            continue;
        }
        if solids.place(&placed, &ledger) {
            continue;
        }
        let Some(&part) = part_of.get(&placed.body) else { continue };
        let (transform, colour) = (placed.transform, placed.colour);
        model.instances.push(Instance { part, transform, colour, name: placed.name });
    }
    report.units = units.into_iter().collect();
    model.unit = report.units.join(", ");
    report.occurrences = model.instances.iter().map(|i| i.name.clone()).filter(|n| !n.is_empty()).collect();
    report.bodies = parts + solids.len();
    for (kind, count) in solids.kinds() {
        *report.nodes.entry(kind.to_owned()).or_default() += count;
    }
    report.meshes = model.parts.iter().map(|p| p.meshes.len()).sum();
    report.edges = bodies.iter().map(|b| b.0.edges.len()).sum();
    report.faces = bodies.iter().map(|b| b.0.faces.len() + b.0.lost.len()).sum();
    report.layers = presentation.layers;
    let mut notes = ledger.finish();
    drop((assembly, colours));
    let places = file.into_places();
    build((bodies, parts, total), (&places, &mut notes), &mut model, &mut report, options);
    solids.finish(parts, &mut model, (&places, &mut notes));
    report.face_records.iter_mut().for_each(|r| r.part = r.part.min(parts));
    report.dropped = notes.dropped;
    report.ignored = notes.ignored;
    let warnings = notes.warnings.finish(&mut report);
    Ok((Import { model, warnings, report, ..Import::default() }, mentions.into_values().collect()))
}

/// A part, its body and the tolerance of its representation.
type PartBody = (usize, Body, f64);

/// Builds all faces, in parallel; results are taken in file order. Between groups of bodies, previews show the first of
/// the `parts` that the model will have. The input of a face is freed with it. `listed` is the number of bodies that the
/// stages state.
fn build(
    (bodies, parts, listed): (Vec<(Body, f64)>, usize, usize),
    (places, notes): (&Places<'_>, &mut Notes),
    model: &mut Model,
    report: &mut ImportReport,
    options: &Options<'_>,
) {
    let total = bodies.iter().map(|(body, _)| body.faces.len()).sum();
    let mut division = preview::Division::new(options);
    let (mut groups, mut group, mut count) = (Vec::new(), Vec::new(), 0);
    let settling = Pulse::new(options, Stage::Bodies { mapped: listed, total: listed });
    for (part, (mut body, tolerance)) in bodies.into_iter().enumerate() {
        settling.work(body.edges.len() + body.faces.len());
        let mut faces: Vec<_> = body.faces.iter_mut().map(|(face, _)| face).collect();
        for (id, note) in settle(&mut body.edges, &mut faces, body.closed, tolerance) {
            report.repaired.add(&note);
            notes.push("edge repaired", || places.of(id), note);
        }
        model.parts[part].stated_edges = std::mem::take(&mut body.stated_edges);
        count += body.faces.len();
        group.push((part, body, tolerance));
        if division.is_behind(count) {
            groups.push(std::mem::take(&mut group));
        }
    }
    groups.push(group);
    let count = FaceCount::new(options, total);
    for group in groups {
        let done = group.last().map_or(parts, |(part, ..)| part + 1);
        for (record, colour, result) in built(group, &count) {
            let id = record.id;
            match result {
                Ok(mut built) => {
                    built.face.colour = colour;
                    for note in &built.notes {
                        report.repaired.add(note);
                        notes.push("face repaired", || places.of(id), note.clone());
                    }
                    for why in &built.lost {
                        notes.push(LOOP_LOST, || places.of(id), why.clone());
                    }
                    model.parts[record.part].faces.push(report.record(record, built));
                }
                Err((error, is_sliver)) => {
                    model.parts[record.part].closed &= is_sliver;
                    notes.push(FACE_LOST, || places.of(id), error.to_string());
                    report.face_records.push(FaceRecord { notes: vec![error.to_string()], ..record });
                }
            }
        }
        if done < parts {
            options.preview(|| preview::beginning(model, done, parts));
        }
    }
}

/// The record of a face and its colour; the face, or why there is none, and whether it is a sliver.
type Outcome = (FaceRecord, Option<Colour>, Result<BuiltFace, (BuildError, bool)>);

/// The faces of some bodies, in their order.
fn built(bodies: Vec<PartBody>, count: &FaceCount<'_>) -> Vec<Outcome> {
    let first = bodies.first().map_or(0, |(part, ..)| *part);
    let mut edges = Vec::with_capacity(bodies.len());
    let mut jobs = Vec::with_capacity(bodies.iter().map(|(_, body, _)| body.faces.len()).sum());
    for (part, body, tolerance) in bodies {
        edges.push(body.edges);
        jobs.extend(body.faces.into_iter().map(|(face, colour)| (part, tolerance, face, colour)));
    }
    let build = |(part, tolerance, face, colour): (usize, f64, FaceGeometry, Option<Colour>)| {
        let record = FaceRecord { id: face.id, part, tolerance, ..FaceRecord::default() };
        let edges = &edges[part - first];
        let result = build_face(&face, edges, tolerance).map_err(|why| (why, face.is_sliver(edges, tolerance)));
        count.one();
        (record, colour, result)
    };
    jobs.into_par_iter().map(build).collect()
}

/// The report of the header.
fn header(file: &File<'_>) -> ImportReport {
    let schema = file.header("FILE_SCHEMA").and_then(|mut v| v.next()?.list()?.next()?.text());
    let system = file.header("FILE_NAME").and_then(|mut v| v.nth(5)?.text());
    ImportReport {
        format: format!("STEP {}", schema.unwrap_or_default()).trim_end().to_owned(),
        written_by: system.unwrap_or_default(),
        pcurves: file.of_kind("PCURVE").len(),
        ..ImportReport::default()
    }
}

/// The name of the first root product, else of the file.
fn model_name(assembly: &Assembly, file: &str) -> String {
    let roots = assembly.roots();
    let product = roots
        .products
        .first()
        .or(roots.others.first())
        .map(|r| assembly.groups[r].name.clone())
        .filter(|n| !n.is_empty());
    product.unwrap_or_else(|| stem(file))
}

/// The product's name; with the body's own when the product has several.
fn part_name(file: &File<'_>, group: &assembly::Group, body: u32) -> String {
    let own = Entity::find(file, body).map(|e| e.label()).unwrap_or_default();
    let own = if own == "NONE" { String::new() } else { own };
    match (group.name.is_empty(), own.is_empty()) {
        (true, _) => own,
        (false, false) if group.bodies.len() > 1 => format!("{}/{own}", group.name),
        _ => group.name.clone(),
    }
}

#[cfg(test)]
mod tests;
