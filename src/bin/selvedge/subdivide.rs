//! `--subdivide`: the polygons of an OBJ file as the control meshes of subdivision surfaces.

use crate::args::{Smooth, SubdivideArgs};
use anyhow::{Context, Result};
use selvedge::construct::subdivide::{ControlMesh, Scheme, subdivide};
use selvedge::import::{self, Import, ImportReport};
use selvedge::model::{Bounds, Instance, Model};
use std::path::Path;

/// Share of a mesh's size within which surfaces are, where nothing else is asked for.
const WITHIN: f64 = 1e-5;

/// Reads the file and makes one part an object.
pub fn open(path: &Path, smooth: Smooth, args: &SubdivideArgs) -> Result<Import> {
    let name = path.display().to_string();
    let scheme = match smooth {
        Smooth::CatmullClark => Scheme::CatmullClark,
        Smooth::Loop => Scheme::Loop,
    };
    let mut model = Model {
        name: path.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default(),
        ..Model::default()
    };
    let mut report = ImportReport { format: "Wavefront OBJ, subdivided".into(), ..ImportReport::default() };
    let polygons = import::open_cages(path)?;
    for (part, cage) in polygons.into_iter().enumerate() {
        let import::Cage { name: object, positions, faces, creases } = cage;
        let size = positions.iter().copied().fold(Bounds::EMPTY, Bounds::with).diagonal();
        let within = args.within.unwrap_or(WITHIN * size);
        let context = || if object.is_empty() { name.clone() } else { format!("{name}: object {object}") };
        let mut made = subdivide(&ControlMesh { positions, faces, creases }, scheme, within).with_context(context)?;
        tracing::info!(
            "{}: {} faces within {:.2e} mm of the limit surface, {} irregular vertices, at most {} rings, {} steps",
            context(),
            made.part.faces.len(),
            made.deviation,
            made.irregular,
            made.rings,
            made.steps
        );
        report.faces += made.part.faces.len();
        report.deviation = report.deviation.max(made.deviation);
        made.part.name.clone_from(&object);
        model.instances.push(Instance { part, transform: Default::default(), colour: None, name: object });
        model.parts.push(made.part);
    }
    report.bodies = model.parts.len();
    Ok(Import { model, report, ..Import::default() })
}
