//! Scene files: models made of curves, equations, data, primitives and other files, written by hand as TOML.
//!
//! ```text
//!   selvedge = 1                                     text ──toml──▶ tables with places ──▶ items by name
//!   [curve.outline]  shape = "through" …                              │ each made once, when it is named
//!   [surface.vase]   shape = "lathe"  profile = "outline" …           ▼
//!   [solid.cut]      shape = "boolean" …             curve ─▶ surface ─▶ part ─┐
//!   [file.bolt]      path = "bolt.step"              solid, file ──────────────┴─▶ instances ─▶ Model
//!   [[instance]]     of = "vase" …
//! ```
//!
//! `docs/scene.md` describes the form, [`VERSION`] numbers it. Nothing is left out: the first fault is an error with
//! file, line and column. Time and memory are bounded: by counts on everything that grows faster than the text (see the
//! constants named `MOST_`), and by a budget of control points and placed things for the whole scene.

mod cameras;
mod curve;
mod cuts;
mod data;
mod files;
mod grid;
mod instances;
mod items;
mod place;
mod shapes;
mod solid;
mod surface;
#[cfg(test)]
mod tests;
mod text;
mod trim;

use super::{Import, ImportError, Options};
use std::path::Path;
use text::Fault;

/// The version of the form that is read.
const VERSION: usize = 1;
/// Largest scene file, bytes.
const MOST_BYTES: usize = 1 << 24;

/// The name is that of a scene file.
pub(super) fn named(path: &Path) -> bool {
    let file = path.file_name().and_then(|f| f.to_str()).map(str::to_ascii_lowercase).unwrap_or_default();
    [".toml", ".toml.gz"].iter().any(|e| file.ends_with(e))
}

/// Reads the text; other files are looked for in `folder`, if there is one, and read as `options` say.
pub(super) fn read(
    bytes: &[u8],
    name: &str,
    folder: Option<&Path>,
    options: &Options<'_>,
) -> Result<Import, ImportError> {
    let placed = |text: &[u8], fault: Fault| {
        let before = &text[..fault.at.min(text.len())];
        let line = 1 + before.iter().filter(|b| **b == b'\n').count();
        let start = before.iter().rposition(|b| *b == b'\n').map_or(0, |n| n + 1);
        let column = 1 + String::from_utf8_lossy(&before[start..]).chars().count();
        ImportError::Scene { file: name.to_owned(), line, column, message: fault.message }
    };
    if bytes.len() > MOST_BYTES {
        let message = format!("{} bytes of a scene, and at most {MOST_BYTES} are read", bytes.len());
        return Err(placed(bytes, Fault::new(0, message)));
    }
    let text = match std::str::from_utf8(bytes) {
        Ok(text) => text.strip_prefix('\u{feff}').unwrap_or(text),
        Err(e) => return Err(placed(bytes, Fault::new(e.valid_up_to(), "not UTF-8 text"))),
    };
    instances::read(text, name, folder, options).map_err(|fault| placed(text.as_bytes(), fault))
}
