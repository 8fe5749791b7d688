//! Polygons of a Wavefront OBJ file as the control meshes of subdivision surfaces, one part an object.

use super::{Cage, Import, ImportError, ImportReport, Options, open_cages, stem};
use crate::construct::subdivide::{ControlMesh, Scheme, subdivide};
use crate::model::{Bounds, Instance, Model};
use std::path::Path;

/// Default distance from the limit surface, as a share of a mesh's size.
const WITHIN: f64 = 1e-5;

/// Reads the polygons of a Wavefront OBJ file as control meshes, and makes their smooth surfaces; one part an object, one
/// unit of the file a millimetre. `within`: largest distance of the faces from the limit surface, in millimetres; a
/// hundred-thousandth of each mesh's size where it is `None`.
///
/// # Errors
/// As [`open_cages`], and [`ImportError::Construct`] for a mesh that has no such surface.
pub fn open_subdivided(
    path: &Path,
    scheme: Scheme,
    within: Option<f64>,
    options: &Options<'_>,
) -> Result<Import, ImportError> {
    let file = path.display().to_string();
    let mut model = Model { name: stem(&file), ..Model::default() };
    let mut report = ImportReport { format: "Wavefront OBJ, subdivided".into(), ..ImportReport::default() };
    for (part, cage) in open_cages(path, options)?.into_iter().enumerate() {
        let Cage { name: object, positions, faces, creases } = cage;
        let size = positions.iter().copied().fold(Bounds::EMPTY, Bounds::with).diagonal();
        let named = if object.is_empty() { file.clone() } else { format!("{file}: object {object}") };
        let mut made = subdivide(&ControlMesh { positions, faces, creases }, scheme, within.unwrap_or(WITHIN * size))
            .map_err(|source| ImportError::Construct { file: named.clone(), source })?;
        report.irregular += made.irregular;
        // numbers go on from object to object
        made.part.faces.iter_mut().for_each(|face| face.id += report.faces as u32);
        report.faces += made.part.faces.len();
        report.made = report.made.max(made.deviation);
        made.part.name.clone_from(&object);
        model.instances.push(Instance { part, transform: Default::default(), colour: None, name: object });
        model.parts.push(made.part);
    }
    report.bodies = model.parts.len();
    Ok(Import { model, report, ..Import::default() })
}
