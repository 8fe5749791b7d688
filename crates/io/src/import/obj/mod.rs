//! Wavefront OBJ: polygons to meshes, free-form surfaces to faces.
//!
//! ```text
//!   bytes ─lines─▶ statements ┬ v vn f o g usemtl ─polygons, tobj─▶ Mesh
//!                             ├ mtllib ──────────material, tobj──▶ Colour
//!                             └ vp curv2 surf trim hole … ─freeform, axis─▶ Face
//! ```
//!
//! An object (`o`) is a part; a group in one colour is a mesh; a surface is a face. The format states no unit:
//! coordinates are taken as millimetres. It states no volumes either: meshes of a part are closed when every side of a
//! triangle has its opposite, surfaces never.
//!
//! An unreadable statement is left out, or its whole surface, with a warning; statements that do not describe surfaces
//! are counted.

mod axis;
pub(super) mod cage;
mod freeform;
mod lines;
mod material;
mod polygons;
mod read;

pub(super) use lines::lines;

use super::source::OtherFiles;
use super::{Import, ImportError};

/// Words with which statements begin.
const KEYWORDS: [&str; 22] = [
    "v", "vn", "vt", "vp", "f", "fo", "l", "p", "o", "g", "s", "mtllib", "usemtl", "cstype", "deg", "surf", "curv",
    "curv2", "parm", "end", "trim", "mg",
];

/// Statements from which a file's form is recognised.
const LOOKED_AT: usize = 16;

/// The text begins as an OBJ file does: known statements, a vertex among them.
pub(super) fn recognise(bytes: &[u8]) -> bool {
    // a vertex stands within the first statements, and those within the first kilobytes
    let head = &bytes[..bytes.len().min(1 << 14)];
    let mut vertex = false;
    for (_, line) in lines(head).take(LOOKED_AT) {
        let keyword = line.split_whitespace().next().unwrap_or_default();
        if !KEYWORDS.contains(&keyword) {
            return false;
        }
        vertex |= ["v", "vp"].contains(&keyword);
    }
    vertex
}

/// Reads the text, and the materials that it names.
pub(super) fn read(bytes: &[u8], name: &str, files: OtherFiles<'_>) -> Result<Import, ImportError> {
    let mut reader = read::Reader::new(name, files, bytes.len());
    let pulse = files.parsing(bytes.len());
    for (line, text) in lines(bytes) {
        pulse.work(1);
        reader.statement(line, &text);
    }
    reader.finish()
}

/// Place in a list of `count` for a number that counts from 1, or back from the end when negative.
fn index(text: &str, count: usize, what: &str) -> Result<usize, String> {
    let number: i64 = text.parse().map_err(|_| format!("{what} {text} is no whole number"))?;
    let place = if number < 0 { count as i64 + number } else { number - 1 };
    match usize::try_from(place) {
        Ok(place) if place < count => Ok(place),
        _ => Err(format!("{what} {number} of {count}")),
    }
}

#[cfg(test)]
mod tests;
