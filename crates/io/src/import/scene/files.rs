//! Other files: models and data, beside the scene file or in folders below it.
//!
//! A path is relative to the scene's folder and never leads out of it: no `..`, nothing absolute. A scene is not read
//! within a scene, so files cannot name each other in a circle.

use super::items::Scene;
use super::text::{Outcome, Value, shortened};
use crate::construct::subdivide::Scheme;
use crate::import::{Import, source};
use std::path::{Component, Path, PathBuf};

/// Largest file of data, bytes.
const MOST_BYTES: u64 = 1 << 26;

/// The path that a value names.
fn path(scene: &Scene<'_>, value: Value<'_>) -> Outcome<PathBuf> {
    let text = value.text()?;
    let inside = |c: Component<'_>| matches!(c, Component::Normal(_) | Component::CurDir);
    if text.is_empty() || text.contains(['\\', '\0']) || !Path::new(text).components().all(inside) {
        let text = shortened(text);
        return Err(value.fault(format!("`{text}` is not a relative path within the scene's own folder")));
    }
    match scene.folder {
        Some(folder) => {
            let path = folder.join(text);
            scene.files.borrow_mut().push(path.clone());
            Ok(path)
        }
        None => Err(value.fault("the scene has no folder in which other files could be")),
    }
}

/// Bytes and name of a file of data.
pub(super) fn data(scene: &Scene<'_>, value: Value<'_>) -> Outcome<(Vec<u8>, String)> {
    let path = path(scene, value)?;
    let shown = path.display().to_string();
    let most = MOST_BYTES.min(scene.options.most_bytes());
    let bytes = source::beside(&path, most).map_err(|why| value.fault(format!("{shown}: {why}")))?;
    Ok((bytes, shown))
}

/// The model in a file.
pub(super) fn model(scene: &Scene<'_>, value: Value<'_>) -> Outcome<Import> {
    let path = path(scene, value)?;
    if super::named(&path) {
        return Err(value.fault("a scene within a scene is not read"));
    }
    crate::import::open_with(&path, &scene.options).map_err(|e| value.fault(e))
}

/// The polygons of a file as the control meshes of smooth surfaces, within `tolerance` millimetres.
pub(super) fn subdivided(scene: &Scene<'_>, value: Value<'_>, scheme: Scheme, tolerance: f64) -> Outcome<Import> {
    let path = path(scene, value)?;
    crate::import::open_subdivided(&path, scheme, Some(tolerance), &scene.options).map_err(|e| value.fault(e))
}
