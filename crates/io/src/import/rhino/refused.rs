//! Bodies that the decoder left out, from their records.
//!
//! ```text
//!   record without a body ─▶ offset ─archive, brep─▶ faces ─▶ Part, placed where it stands
//! ```
//!
//! Names, colours and layers come from the decoder's other records of the object.

use super::brep::Brep;
use super::{NOWHERE, archive, kept, linear, object};
use crate::import::{FaceRecord, ImportReport, Place, Warnings};
use crate::model::{Instance, Model, Part};
use cadmpeg_ir::SourceFidelity;
use cadmpeg_ir::SourceObjectAssociation;
use cadmpeg_ir::document::CadIr;
use glam::DAffine3;
use std::collections::{HashMap, HashSet};

/// The decoder's records of a file.
pub(super) struct Records<'i> {
    pub bytes: &'i [u8],
    pub ir: &'i CadIr,
    /// Where the records are.
    pub source: &'i SourceFidelity,
    /// Millimetres of a unit.
    pub scale: f64,
    pub tolerance: f64,
}

/// Adds the bodies, and returns the numbers of the objects that were read.
pub(super) fn read<'i>(
    records: &Records<'i>,
    model: &mut Model,
    report: &mut ImportReport,
    warnings: &mut Warnings,
) -> HashSet<&'i str> {
    let m = &records.ir.model;
    let bodies: HashSet<&str> = m.bodies.iter().map(|b| b.id.as_str()).collect();
    let surfaces = m.surfaces.iter().map(|s| (s.id.as_str(), s.source_object.as_ref()));
    let curves = m.curves.iter().map(|c| (c.id.as_str(), c.source_object.as_ref()));
    let kept_of: HashMap<&str, (&'i str, &'i SourceObjectAssociation)> =
        surfaces.chain(curves).filter_map(|(id, of)| Some((id, (object(id)?, of?)))).collect();
    let mut done = HashSet::new();
    let mut lost = Vec::new();
    for record in records.ir.native_unknowns_iter("rhino").flatten() {
        if record.links.iter().any(|link| bodies.contains(link.as_str())) {
            continue;
        }
        let retained = records.source.retained_record(record.id.as_str());
        let Some(offset) = retained.map(|r| r.end_offset() - r.byte_len()) else { continue };
        let Ok(class) = archive::object(records.bytes, offset) else { continue };
        if !Brep::is(&class) {
            continue;
        }
        let of = record.links.iter().find_map(|link| kept_of.get(link.as_str()));
        let name = of.and_then(|(_, of)| of.name.clone()).unwrap_or_default();
        let known = of.map_or(record.id.as_str(), |(number, _)| number);
        let brep = match Brep::read(records.bytes, class, records.scale) {
            Ok(brep) => brep,
            Err(why) => {
                warnings.push("body left out", || Place::File, || format!("{known} {name}: {why}"));
                continue;
            }
        };
        let mut part = Part { name: name.clone(), closed: brep.closed, ..Part::default() };
        let colour = of.and_then(|(_, of)| of.color).map(linear);
        let before = lost.len();
        for face in 0..brep.len() {
            report.faces += 1;
            let id = report.faces as u32;
            let tolerance = records.tolerance;
            let record = FaceRecord { id, part: model.parts.len(), tolerance, ..FaceRecord::default() };
            let label = format!("{known} {name}, face {face}");
            match kept(brep.face(face, id), &label, colour, record, report, warnings) {
                Ok(face) => part.faces.push(face),
                Err(record) => {
                    lost.push(record);
                    part.closed = false;
                }
            }
        }
        let (read, all) = (part.faces.len(), brep.len());
        warnings.push("body read from its record", || Place::File, || format!("{known} {name}: {read} of {all} faces"));
        if part.faces.is_empty() {
            lost[before..].iter_mut().for_each(|r| r.part = NOWHERE);
            continue;
        }
        done.extend(of.map(|(number, _)| *number));
        let hidden = of.is_some_and(|(_, of)| of.visible == Some(false));
        let in_block = of.is_some_and(|(_, of)| !of.instance_path.is_empty());
        if hidden || in_block {
            let what = if hidden { "hidden object not placed" } else { "body of a block not placed" };
            warnings.push(what, || Place::File, || format!("{known} {name}"));
        } else {
            let part = model.parts.len();
            model.instances.push(Instance { part, transform: DAffine3::IDENTITY, colour: None, name });
        }
        model.parts.push(part);
    }
    report.face_records.splice(0..0, lost);
    done
}
