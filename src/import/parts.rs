//! Faces and meshes of formats that know names but no assembly, as a model.

use super::facets;
use crate::model::{Face, Instance, Mesh, Model, Part};
use glam::DAffine3;
use std::collections::HashMap;
use std::path::Path;

/// One part for the faces of each name and one for its meshes, in the order given, each placed once.
///
/// Parts of meshes are closed where [`facets::closed`] says so, parts of faces never.
pub(super) fn assemble(
    file: &str,
    faces: impl IntoIterator<Item = (String, Face)>,
    meshes: impl IntoIterator<Item = (String, Mesh)>,
) -> Model {
    let mut parts: Vec<Part> = Vec::new();
    let mut places: HashMap<(String, bool), usize> = HashMap::new();
    let mut part = |parts: &mut Vec<Part>, name: String, faces: bool| {
        *places.entry((name.clone(), faces)).or_insert_with(|| {
            parts.push(Part { name, ..Part::default() });
            parts.len() - 1
        })
    };
    for (name, face) in faces {
        let at = part(&mut parts, name, true);
        parts[at].faces.push(face);
    }
    for (name, mesh) in meshes {
        let at = part(&mut parts, name, false);
        parts[at].meshes.push(mesh);
    }
    let mut instances = Vec::new();
    for (part, body) in parts.iter_mut().enumerate() {
        body.closed = facets::closed(&body.meshes);
        instances.push(Instance { part, transform: DAffine3::IDENTITY, colour: None, name: body.name.clone() });
    }
    let name = Path::new(file).file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    Model { name, parts, instances, ..Model::default() }
}
