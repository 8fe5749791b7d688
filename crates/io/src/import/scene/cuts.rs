//! A scene cut open: `trim` and `section`, at the top of the file.
//!
//! ```text
//!   trim = "window"                                  surfaces stay within the solid of that name, open
//!   section = { normal = [0, -1, 0], offset = 2 }    the side behind a plane is cut off; caps. Or a list
//! ```

use super::items::{Scene, Thing};
use super::solid::{self, Adding};
use super::text::{Fault, Outcome, Value};
use crate::import::solid::Assembly;
use crate::model::{Model, Solid};
use glam::DAffine3;

/// The solid by which the scene is trimmed.
pub(super) fn volume<'a>(scene: &mut Scene<'a>, name: Value<'a>) -> Outcome<Solid> {
    let thing = scene.thing(name)?;
    if !matches!(thing, Thing::Body(_) | Thing::File(_)) {
        return Err(scene.other(name, &thing, "solid"));
    }
    let mut assembly = Assembly::default();
    let how = Adding { transform: DAffine3::IDENTITY, over: None, inherited: None };
    let root = solid::add(scene, &mut assembly, &thing, how, name)?;
    let volume = assembly.finish(root).map_err(|e| name.fault(e))?;
    if volume.primitives().iter().any(|p| !p.shape.is_analytic()) {
        return Err(name.fault(format!("`{}` has faces or meshes: what trims a scene needs equations", name.text()?)));
    }
    Ok(volume)
}

/// Cuts the whole model: first by the trimming solid, then by sections in the order of the text.
pub(super) fn cut(
    scene: &Scene<'_>,
    model: &mut Model,
    trim: Option<&Solid>,
    sections: Option<Value<'_>>,
) -> Outcome<()> {
    if let Some(volume) = trim {
        model.trim_by(volume).map_err(|e| Fault::new(0, e.to_string()))?;
    }
    let Some(sections) = sections else { return Ok(()) };
    let all = if sections.is_table() { vec![sections] } else { sections.list()? };
    for section in all {
        let mut table = section.table()?;
        let normal = table.need("normal")?.direction()?;
        let offset = table.number_or("offset", 0.0)? * scene.unit;
        table.finish()?;
        *model = model.section(normal, offset).map_err(|e| section.fault(e))?;
    }
    Ok(())
}
