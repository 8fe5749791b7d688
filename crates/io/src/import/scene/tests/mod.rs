//! Scene files: the models that they make, and the errors with their places.

mod cuts;
mod errors;
mod files;
mod grid;
mod made;
mod solids;
mod views;

use crate::import::{Import, scene};
use crate::model::Face;

/// A scene of the text after its first line.
#[track_caller]
fn import(text: &str) -> Import {
    scene(format!("selvedge = 1\n{text}").as_bytes(), "t.toml", None).unwrap_or_else(|e| panic!("{e}"))
}

/// The message without the file's name, the first line being `selvedge = 1`.
#[track_caller]
fn refused(text: &str) -> String {
    let error = scene(format!("selvedge = 1\n{text}").as_bytes(), "t.toml", None).expect_err("no scene");
    error.to_string().strip_prefix("t.toml:").expect("names its file").to_owned()
}

/// The only face.
#[track_caller]
fn face(text: &str) -> Face {
    let import = import(text);
    assert_eq!(import.model.face_count(), 1);
    import.model.parts[0].faces[0].clone()
}
