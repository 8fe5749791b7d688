//! Whole files: hand-made text with exact numbers, and damaged text.

mod classes;
mod damage;
mod freeform;
mod polygons;

use crate::import::{Import, obj};

/// Reads text that lies in no folder.
fn import(text: &str) -> Import {
    obj(text.as_bytes(), "t.obj", None).expect("an OBJ file")
}

/// The warnings as text.
fn told(import: &Import) -> Vec<String> {
    import.warnings.iter().map(ToString::to_string).collect()
}
