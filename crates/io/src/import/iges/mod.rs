//! IGES files: version 5.3 and older, fixed-format ASCII.
//!
//! ```text
//!   bytes ─card, value─▶ cards, parameters                      syntax
//!         ─global, directory, file─▶ File                       units; entries with their values
//!         ─entity─▶ Entity          typed parameters; every Fault names its entity
//!         ─geometry─▶ matrices, points, guards
//!         ─curve, conic, spline, fit─▶ Segment                  curves in millimetres
//!         ─surface, ruled─▶ Carrier                             surfaces, and how their (u, v) map
//!         ─trim─▶ Sheet   ─solid, swept─▶ Shells                faces, by themselves or with shared edges
//!         ─csg─▶ Expression         Boolean solids
//!         ─tree, array, owners, colour─▶ bodies and their places
//!         ─brep::build_face─▶ Face  in parallel, results in file order
//! ```
//!
//! Numbers behind `#` are those of the first directory card of an entity, as the file itself points to it.
//! Nothing in a file can cause a panic, endless work, or memory beyond a multiple of its size.
//!
//! Source: US Product Data Association, *Initial Graphics Exchange Specification IGES 5.3*, 1996.

mod array;
mod card;
mod colour;
mod conic;
mod csg;
mod curve;
mod directory;
mod entity;
mod file;
mod fit;
mod geometry;
mod global;
mod owners;
mod ruled;
mod solid;
mod spline;
mod surface;
mod swept;
mod tree;
mod trim;
mod value;

use super::{
    FaceCount, FaceRecord, Import, ImportError, ImportReport, LOOP_LOST, Options, Place, Pulse, Stage, Warnings,
    preview, stem, text,
};
use crate::brep::{FaceGeometry, build_face, settle};
use crate::model::{Instance, Model, Part};
use entity::Entity;
use file::File;
use geometry::{FACE_LOST, Geometry};
use rayon::prelude::*;
use std::sync::Arc;
use tree::{Body, Placement, SOLID_LOST, Tree};
use trim::Sheet;

/// Whether the bytes begin like IGES, in any of its forms.
pub(super) fn recognise(bytes: &[u8]) -> bool {
    card::recognise(text::without_mark(bytes)).is_some()
        || text::utf16(bytes).is_some_and(|(text, _)| card::recognise(text.as_bytes()).is_some())
}

/// Reads IGES text; `name` is the file's name in messages.
pub(super) fn read(bytes: &[u8], name: &str, options: &Options<'_>) -> Result<Import, ImportError> {
    let wide = text::utf16(bytes);
    let bytes = text::without_mark(wide.as_ref().map_or(bytes, |(text, _)| text.as_bytes()));
    let form = |form| ImportError::IgesForm { file: name.to_owned(), form };
    match card::recognise(bytes) {
        None => return Err(ImportError::NotIges { file: name.to_owned() }),
        Some(card::Form::Compressed) => return Err(form("compressed ASCII")),
        Some(card::Form::Binary) => return Err(form("binary")),
        Some(card::Form::Fixed) => {}
    }
    let mut warnings = Warnings::new(name);
    let pulse = Pulse::new(options, Stage::Parse { bytes: bytes.len() as u64 });
    let file = File::parse(bytes, name, &mut warnings, &pulse)?;
    if wide.as_ref().is_some_and(|(_, whole)| !whole) {
        warnings.push(text::KIND, || Place::File, || "it is UTF-16 with units that are no characters".to_owned());
    }
    if let Some(message) = file.encoding.told() {
        warnings.push(text::KIND, || Place::File, || message);
    }
    let geometry = Geometry::new(&file, warnings, &pulse);
    let tree = Tree::read(&geometry);
    let (mut bodies, placements) = (tree.bodies, tree.placements);
    let global = &file.global;
    let mut model = Model { name: model_name(&global.product, name), ..Model::default() };
    model.unit.clone_from(&global.unit_name);
    for body in &bodies {
        let closed = body.closed && body.shells.lost.is_empty();
        model.parts.push(Part { name: body.name.clone(), closed, ..Part::default() });
    }
    let (solids, placements): (Vec<_>, Vec<_>) = placements.into_iter().partition(|p| bodies[p.body].solid.is_some());
    for placed in placements {
        let (part, transform, name) = (placed.body, placed.transform, placed.name);
        model.instances.push(Instance { part, transform, colour: None, name });
    }
    let mut report = ImportReport {
        format: format!("IGES {}", global.version).trim_end().to_owned(),
        written_by: global.system.clone(),
        units: vec![global.unit_name.clone()],
        bodies: bodies.iter().filter(|b| !b.operand).count(),
        edges: bodies.iter().map(edges).sum(),
        pcurves: bodies.iter().map(pcurves).sum(),
        occurrences: model.instances.iter().map(|i| i.name.clone()).filter(|n| !n.is_empty()).collect(),
        ..ImportReport::default()
    };
    external(&geometry, &mut report);
    settled(&geometry, &mut bodies, &mut report);
    build(&geometry, &bodies, &mut model, &mut report, options);
    let faces = model.face_count();
    if !solids.is_empty() {
        place_solids(&geometry, &bodies, &solids, &mut model, &mut report);
    }
    let (warnings, dropped) = geometry.finish();
    report.faces = faces + dropped.total();
    report.dropped = dropped;
    let list = warnings.finish(&mut report);
    // most of what was read is needed no more, and is given back while the model is used
    rayon::spawn(move || drop((file, bodies)));
    Ok(Import { model, warnings: list, report, ..Import::default() })
}

/// Names the files that hold the rest of the model, once each: 416. They are not read.
fn external(geometry: &Geometry<'_>, report: &mut ImportReport) {
    for entry in geometry.file.entries.iter().filter(|entry| entry.kind == 416 && !entry.blank) {
        let Ok(entity) = Entity::find(geometry.file, entry.id) else { continue };
        let named = entity.string(1);
        if !report.missing_files.contains(&named) {
            geometry.note("external file not followed", entry.id, named.as_str());
            report.external_files.push(named.clone());
            report.missing_files.push(named);
        }
    }
}

/// Makes the Boolean solids from what their operands became, and takes both from the parts.
fn place_solids(
    geometry: &Geometry<'_>,
    bodies: &[Body],
    placements: &[Placement],
    model: &mut Model,
    report: &mut ImportReport,
) {
    let parts: Vec<Arc<Part>> = std::mem::take(&mut model.parts).into_iter().map(Arc::new).collect();
    for placed in placements {
        let Some((expression, first)) = &bodies[placed.body].solid else { continue };
        match expression.solid(placed.transform, &parts[*first..placed.body]) {
            Ok(solid) => model.solids.push(solid),
            Err(why) => geometry.note(SOLID_LOST, expression.id, why),
        }
    }
    for (name, count) in bodies.iter().filter_map(|b| b.solid.as_ref()).flat_map(|(e, _)| &e.kinds) {
        *report.nodes.entry((*name).to_owned()).or_default() += count;
    }
    let stays = |b: &Body| !b.operand && b.solid.is_none();
    let mut new = vec![None; parts.len()];
    for (old, part) in parts.into_iter().enumerate().filter(|(old, _)| stays(&bodies[*old])) {
        new[old] = Some(model.parts.len());
        model.parts.push(Arc::unwrap_or_clone(part));
    }
    let left = model.parts.len();
    model.instances.iter_mut().for_each(|i| i.part = new[i.part].unwrap_or(left));
    report.face_records.iter_mut().for_each(|r| r.part = new[r.part].unwrap_or(left));
}

/// Repairs edges of solids and shells where they miss their vertices.
fn settled(geometry: &Geometry<'_>, bodies: &mut [Body], report: &mut ImportReport) {
    for body in bodies {
        geometry.work(body.shells.edges.len() + body.shells.faces.len());
        let mut faces: Vec<_> = body.shells.faces.iter_mut().map(|(face, _)| face).collect();
        for (id, note) in settle(&mut body.shells.edges, &mut faces, body.closed, geometry.file.global.resolution) {
            report.repaired.add(&note);
            geometry.note("edge repaired", id, note);
        }
    }
}

/// Builds all faces, in parallel; results are taken in file order. Previews are made between parts.
fn build(
    geometry: &Geometry<'_>,
    bodies: &[Body],
    model: &mut Model,
    report: &mut ImportReport,
    options: &Options<'_>,
) {
    let count = FaceCount::new(options, bodies.iter().map(|b| b.shells.faces.len() + b.sheets.len()).sum());
    let counted = |built| {
        count.one();
        built
    };
    let tolerance = geometry.file.global.resolution;
    let record = |id, part| FaceRecord { id, part, tolerance, ..FaceRecord::default() };
    for (part, body) in bodies.iter().enumerate() {
        let lost = |(id, why): &(u32, String)| FaceRecord { notes: vec![why.clone()], ..record(*id, part) };
        report.face_records.extend(body.shells.lost.iter().map(lost));
    }
    let (mut division, mut faces) = (preview::Division::new(options), 0);
    for (part, body) in bodies.iter().enumerate() {
        let shared = &body.shells;
        model.parts[part].stated_edges = shared.sources();
        let of_solid = |f: &FaceGeometry| {
            let edges = &shared.edges;
            build_face(f, edges, tolerance).map_err(|why| (why, f.is_sliver(edges, tolerance)))
        };
        let solid = shared.faces.par_iter().map(|(f, colour)| (f.id, *colour, of_solid(f)));
        let alone = |sheet: &Sheet| sheet.build(tolerance).map_err(|why| (why, false));
        let free = body.sheets.par_iter().map(|(sheet, colour)| (sheet.id, *colour, alone(sheet)));
        let built: Vec<_> = solid.chain(free).map(counted).collect();
        for (id, colour, result) in built {
            match result {
                Ok(mut built) => {
                    built.face.colour = colour;
                    for note in &built.notes {
                        report.repaired.add(note);
                        geometry.note("face repaired", id, note.as_str());
                    }
                    for why in &built.lost {
                        geometry.note(LOOP_LOST, id, why.as_str());
                    }
                    model.parts[part].faces.push(report.record(record(id, part), built));
                }
                Err((error, is_sliver)) => {
                    model.parts[part].closed &= is_sliver;
                    geometry.note(FACE_LOST, id, error.to_string());
                    report.face_records.push(FaceRecord { notes: vec![error.to_string()], ..record(id, part) });
                }
            }
        }
        faces += shared.faces.len() + body.sheets.len();
        if division.is_behind(faces) && part + 1 < bodies.len() {
            options.preview(|| preview::beginning(model, part + 1, bodies.len()));
        }
    }
}

fn edges(body: &Body) -> usize {
    let loops = body.sheets.iter().flat_map(|(sheet, _)| &sheet.loops);
    body.shells.edges.len() + loops.map(|l| l.model.len().max(l.parameter.len())).sum::<usize>()
}

fn pcurves(body: &Body) -> usize {
    let loops = body.sheets.iter().flat_map(|(sheet, _)| &sheet.loops);
    body.shells.pcurves + loops.map(|l| l.parameter.len()).sum::<usize>()
}

/// The product's name, else the file's.
fn model_name(product: &str, file: &str) -> String {
    if product.is_empty() { stem(file) } else { product.to_owned() }
}

#[cfg(test)]
mod tests;
