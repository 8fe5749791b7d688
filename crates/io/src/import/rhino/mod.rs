//! Rhino `.3dm` files, decoded by `cadmpeg-codec-rhino`.
//!
//! ```text
//!   bytes ─cadmpeg─▶ bodies, shells, faces, loops, p-curves ─face─▶ Face      trims are the file's p-curves
//!                    records of bodies that it refuses ─brep─▶ Face           each by itself
//!                    tessellations without a body ────────────────▶ Mesh
//!                    products and their occurrences ──────────────▶ Instance  blocks
//! ```
//!
//! Lengths come in millimetres. A face's trims are the curves in `(u, v)` that the file holds; the distance of their
//! images from the file's edges in space is reported as the gap. Losses that the decoder reports are among the
//! warnings; objects of hidden layers are read, but not placed. The decoder leaves out a whole body for one bad face;
//! such a body is read from its record, which the decoder finds.

mod archive;
mod brep;
mod face;
mod joined;
mod refused;
mod shape;

use super::{FaceRecord, Import, ImportError, ImportReport, Place, Warnings, colour, facets, stem};
use crate::brep::BuiltFace;
use crate::model::{Colour, Face, Instance, Mesh, Model, Part};
use cadmpeg_codec_rhino::RhinoCodec;
use cadmpeg_ir::document::CadIr;
use cadmpeg_ir::products::{OccurrenceParent, PrototypeReference};
use cadmpeg_ir::topology::{BodyKind, Color};
use cadmpeg_ir::transform::Transform;
use cadmpeg_ir::{Codec, DecodeOptions};
use face::{Built, Tables};
use glam::{DAffine3, DMat3, DVec3};
use refused::Records;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::io::Cursor;

/// Deepest nesting of blocks.
const MAX_LEVELS: usize = 256;

/// The part of a face that was left out with all others of its body, until the parts are counted.
const NOWHERE: usize = usize::MAX;

/// Reads a file; `name` is its name in messages.
pub(super) fn read(bytes: &[u8], name: &str) -> Result<Import, ImportError> {
    let failed = |why: String| ImportError::Rhino { file: name.to_owned(), why };
    let decoded = RhinoCodec.decode(&mut Cursor::new(bytes), &DecodeOptions::default());
    let decoded = decoded.map_err(|error| failed(error.to_string()))?;
    let (ir, losses, source) = decoded.into_parts();
    let ir = &ir;
    let mut warnings = Warnings::new(name);
    for loss in losses.losses.iter().filter(|loss| !is_whole(&loss.message)) {
        warnings.push("not decoded", || Place::File, || loss.message.clone());
    }
    let mut report = ImportReport { format: "Rhino 3dm".into(), ..ImportReport::default() };
    let attribute = |key: &str| {
        let found = ir.source.iter().flat_map(|s| &s.attributes).find(|(k, _)| k.as_str() == key);
        found.map(|(_, value)| value.clone()).unwrap_or_default()
    };
    report.written_by = attribute("application_name");
    report.units = vec![unit(&attribute("millimeters_per_unit"))];
    let tolerance = attribute("absolute_tolerance_millimeters").parse().unwrap_or(face::MEET);
    let mut model = Model { unit: report.units.join(", "), ..Model::default() };
    model.name = stem(name);
    let part_of = parts(ir, tolerance, &mut model, &mut report, &mut warnings);
    place(ir, &part_of, &mut model, &mut warnings);
    let scale = attribute("millimeters_per_unit").parse().unwrap_or(1.0);
    let records = Records { bytes, ir, source: &source, scale, tolerance };
    let read = refused::read(&records, &mut model, &mut report, &mut warnings);
    meshes(ir, read, &mut model, &mut warnings);
    for (what, count) in [("subdivision surface not read", ir.model.subds.len())] {
        if count > 0 {
            warnings.push(what, || Place::File, || format!("{count} of them"));
        }
    }
    report.bodies = model.parts.len();
    report.meshes = model.parts.iter().map(|p| p.meshes.len()).sum();
    report.face_records.iter_mut().for_each(|r| r.part = r.part.min(model.parts.len()));
    let warnings = warnings.finish(&mut report);
    Ok(Import { model, warnings, report, ..Import::default() })
}

/// The decoder counts the records that it has decoded, even where it has decoded all: `decoded 6/6 Rhino object records`.
fn is_whole(loss: &str) -> bool {
    let count = loss.strip_prefix("decoded ").and_then(|rest| rest.split_once(' ')).map(|(count, _)| count);
    count.and_then(|count| count.split_once('/')).is_some_and(|(decoded, all)| decoded == all)
}

/// One part a body; places of parts by the names of bodies.
fn parts(
    ir: &CadIr,
    tolerance: f64,
    model: &mut Model,
    report: &mut ImportReport,
    warnings: &mut Warnings,
) -> HashMap<String, usize> {
    let tables = Tables::new(ir);
    let shells: BTreeMap<_, _> = ir.model.shells.iter().map(|s| (s.id.as_str(), s)).collect();
    let regions: BTreeMap<_, _> = ir.model.regions.iter().map(|r| (r.id.as_str(), r)).collect();
    report.pcurves = ir.model.pcurves.len();
    report.edges = ir.model.edges.len();
    let mut lost = Vec::new();
    let mut part_of = HashMap::new();
    for body in &ir.model.bodies {
        let closed = matches!(body.kind, BodyKind::Solid);
        let mut part = Part { name: body.name.clone().unwrap_or_default(), closed, ..Part::default() };
        let own = body.color.map(linear);
        let before = lost.len();
        let in_regions = body.regions.iter().filter_map(|r| regions.get(r.as_str()));
        let in_shells = in_regions.flat_map(|r| &r.shells).filter_map(|s| shells.get(s.as_str()));
        for id in in_shells.flat_map(|s| s.faces()) {
            report.faces += 1;
            let number = report.faces as u32;
            let record = FaceRecord { id: number, part: model.parts.len(), tolerance, ..FaceRecord::default() };
            let built = tables.face(id.as_str(), number);
            match kept(built, id.as_str(), own, record, report, warnings) {
                Ok(face) => part.faces.push(face),
                Err(record) => {
                    lost.push(record);
                    part.closed = false;
                }
            }
        }
        if part.faces.is_empty() {
            lost[before..].iter_mut().for_each(|r| r.part = NOWHERE);
            continue;
        }
        part_of.insert(body.id.as_str().to_owned(), model.parts.len());
        model.parts.push(part);
    }
    report.face_records.splice(0..0, lost);
    part_of
}

/// A face with its record, or the record of one that is left out; `name` is its name in messages.
fn kept(
    built: Result<Built, String>,
    name: &str,
    colour: Option<Colour>,
    record: FaceRecord,
    report: &mut ImportReport,
    warnings: &mut Warnings,
) -> Result<Face, FaceRecord> {
    match built {
        Ok(Built { mut face, notes, gap }) => {
            face.colour = face.colour.or(colour);
            for note in &notes {
                report.repaired.add(note);
                warnings.push("face repaired", || Place::File, || format!("{name}: {note}"));
            }
            Ok(report.record(record, BuiltFace { face, notes, deviation: 0.0, gap, lost: Vec::new() }))
        }
        Err(why) => {
            report.dropped.add(&why);
            warnings.push("face left out", || Place::File, || format!("{name}: {why}"));
            Err(FaceRecord { notes: vec![why], ..record })
        }
    }
}

/// Bodies at their places, and bodies of blocks at each use of the block.
fn place(ir: &CadIr, part_of: &HashMap<String, usize>, model: &mut Model, warnings: &mut Warnings) {
    let definitions: HashMap<_, _> = ir.model.product_definitions.iter().map(|d| (d.id.as_str(), d)).collect();
    let occurrences: HashMap<_, _> = ir.model.occurrences.iter().map(|o| (o.id.as_str(), o)).collect();
    let mut placed: HashSet<&str> = HashSet::new();
    for occurrence in &ir.model.occurrences {
        let PrototypeReference::Local { definition } = &occurrence.prototype else {
            warnings.push("external block not followed", || Place::File, || occurrence.id.as_str().to_owned());
            continue;
        };
        let (mut transform, mut at, mut levels) = (affine(occurrence.transform), &occurrence.parent, 0);
        while let OccurrenceParent::Occurrence { occurrence } = at {
            let Some(parent) = occurrences.get(occurrence.as_str()).filter(|_| levels <= MAX_LEVELS) else { break };
            transform = affine(parent.transform) * transform;
            at = &parent.parent;
            levels += 1;
        }
        if levels > MAX_LEVELS {
            let told = || format!("{} is nested deeper than {MAX_LEVELS} levels", occurrence.id.as_str());
            warnings.push("occurrence left out", || Place::File, told);
            continue;
        }
        let bodies = definitions.get(definition.as_str()).map(|d| d.bodies.as_slice()).unwrap_or_default();
        for body in bodies {
            placed.insert(body.as_str());
            let Some(&part) = part_of.get(body.as_str()) else { continue };
            let name = occurrence.name.clone().unwrap_or_default();
            model.instances.push(Instance { part, transform, colour: None, name });
        }
    }
    let in_blocks: HashSet<&str> =
        ir.model.product_definitions.iter().flat_map(|d| &d.bodies).map(|b| b.as_str()).collect();
    for body in &ir.model.bodies {
        let Some(&part) = part_of.get(body.id.as_str()) else { continue };
        if placed.contains(body.id.as_str()) || in_blocks.contains(body.id.as_str()) {
            continue;
        }
        if body.visible == Some(false) {
            warnings.push("hidden object not placed", || Place::File, || body.id.as_str().to_owned());
            continue;
        }
        let transform = body.transform.map_or(DAffine3::IDENTITY, affine);
        let name = model.parts[part].name.clone();
        model.instances.push(Instance { part, transform, colour: None, name });
    }
}

/// Mesh objects. The meshes with which Rhino draws its bodies are skipped, including those of the bodies `read`.
fn meshes(ir: &CadIr, read: HashSet<&str>, model: &mut Model, warnings: &mut Warnings) {
    let mut id = model.face_count() as u32;
    // names of bodies end in the number of their object
    let bodies = ir.model.bodies.iter().filter_map(|b| object(b.id.as_str()));
    let drawn: HashSet<&str> = bodies.chain(read).collect();
    for mesh in ir.model.tessellations.iter().filter(|t| t.body.is_none() && t.faces.is_empty()) {
        let source = mesh.source_object.as_ref();
        if source.is_some_and(|s| drawn.contains(s.object_id.as_str()))
            || object(mesh.id.as_str()).is_some_and(|o| drawn.contains(o))
        {
            continue;
        }
        if source.is_some_and(|s| s.visible == Some(false)) {
            warnings.push("hidden object not placed", || Place::File, || mesh.id.as_str().to_owned());
            continue;
        }
        id += 1;
        let positions = mesh.vertices().into_iter().map(|p| p.get()).map(|p| DVec3::new(p.x, p.y, p.z)).collect();
        let triangles = mesh.triangles();
        let at = |n: &cadmpeg_ir::features::FiniteVector3| {
            let n = n.get();
            DVec3::new(n.x, n.y, n.z)
        };
        let corners: Vec<DVec3> = mesh.per_corner_normals().iter().map(at).collect();
        let vertices: Vec<DVec3> = mesh.vertex_normals().iter().map(at).collect();
        let normals: Vec<[DVec3; 3]> = if corners.len() == 3 * triangles.len() {
            corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect()
        } else {
            let of = |t: &[u32; 3]| {
                let n = t.map(|v| vertices.get(v as usize).copied());
                Some([n[0]?, n[1]?, n[2]?])
            };
            triangles.iter().map(of).collect::<Option<_>>().unwrap_or_default()
        };
        match Mesh::new(id, positions, triangles, normals) {
            Ok(mut built) => {
                built.colour = source.and_then(|s| s.color).map(linear);
                let name = source.and_then(|s| s.name.clone()).unwrap_or_default();
                let closed = facets::closed([&built]);
                let instance = Instance {
                    part: model.parts.len(),
                    transform: DAffine3::IDENTITY,
                    colour: None,
                    name: name.clone(),
                };
                model.parts.push(Part { name, meshes: vec![built], closed, ..Part::default() });
                model.instances.push(instance);
            }
            Err(error) => warnings.push("mesh left out", || Place::File, || error.to_string()),
        }
    }
}

/// Rhino stores sRGB.
fn linear(c: Color) -> Colour {
    colour::linear([c.r(), c.g(), c.b()].map(f64::from), f64::from(c.a()))
}

/// The number of the object in the name of something that belongs to it.
fn object(name: &str) -> Option<&str> {
    const GUID: usize = 36;
    name.split_once('#').and_then(|(_, rest)| rest.get(..GUID))
}

/// The name of a unit of so many millimetres.
fn unit(millimetres: &str) -> String {
    let name = match millimetres {
        "0.001" => "micrometre",
        "" | "1" => "millimetre",
        "10" => "centimetre",
        "1000" => "metre",
        "25.4" => "inch",
        "304.8" => "foot",
        other => return format!("{other} mm"),
    };
    name.into()
}

fn affine(transform: Transform) -> DAffine3 {
    let [x, y, z] = transform.affine_rows();
    let column = |i: usize| DVec3::new(x[i], y[i], z[i]);
    DAffine3::from_mat3_translation(DMat3::from_cols(column(0), column(1), column(2)), column(3))
}

#[cfg(test)]
mod tests;
