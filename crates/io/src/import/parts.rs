//! Faces and meshes of formats that have names but no assembly, as a model.
//!
//! ```text
//!   (name, face) … ─┬─▶ a part a name ─▶ an instance each
//!   (name, mesh) … ─┘        └▶ a record a face
//! ```

use super::{FaceRecord, ImportReport, facets, stem};
use crate::brep::BuiltFace;
use crate::model::{Face, Instance, Mesh, Model, Part};
use glam::DAffine3;
use std::collections::HashMap;

/// A face whose curves in `(u, v)` are the file's, with notes on repairs; or its number and why it is lost.
pub(super) type Stated = Result<(Face, Vec<String>), (u32, String)>;

/// One part for the faces of each name and one for its meshes, in the order given, each placed once.
///
/// Parts of meshes are closed where [`facets::closed`] says so, parts of faces never. The report gets a record of every
/// face: nothing is fitted, so the deviation is zero.
pub(super) fn assemble(
    file: &str,
    faces: Vec<(String, Stated)>,
    meshes: impl IntoIterator<Item = (String, Mesh)>,
    report: &mut ImportReport,
) -> Model {
    let mut parts: Vec<Part> = Vec::new();
    let mut places: HashMap<(String, bool), usize> = HashMap::new();
    let mut part = |parts: &mut Vec<Part>, name: String, faces: bool| {
        *places.entry((name.clone(), faces)).or_insert_with(|| {
            parts.push(Part { name, ..Part::default() });
            parts.len() - 1
        })
    };
    let mut lost = Vec::new();
    for (name, stated) in faces {
        match stated {
            Ok((face, notes)) => {
                let at = part(&mut parts, name, true);
                let record = FaceRecord { id: face.id, part: at, ..FaceRecord::default() };
                let face = report.record(record, BuiltFace { face, notes, deviation: 0.0, gap: 0.0, lost: Vec::new() });
                parts[at].faces.push(face);
            }
            Err((id, why)) => lost.push((name, id, why)),
        }
    }
    for (name, mesh) in meshes {
        let at = part(&mut parts, name, false);
        parts[at].meshes.push(mesh);
    }
    let lost = lost.into_iter().map(|(name, id, why)| {
        let part = places.get(&(name, true)).copied().unwrap_or(parts.len());
        FaceRecord { id, part, notes: vec![why], ..FaceRecord::default() }
    });
    report.face_records.splice(0..0, lost);
    report.meshes = parts.iter().map(|p| p.meshes.len()).sum();
    let mut instances = Vec::new();
    for (part, body) in parts.iter_mut().enumerate() {
        body.closed = facets::closed(&body.meshes);
        instances.push(Instance { part, transform: DAffine3::IDENTITY, colour: None, name: body.name.clone() });
    }
    Model { name: stem(file), parts, instances, ..Model::default() }
}
