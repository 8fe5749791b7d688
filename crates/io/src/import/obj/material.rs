//! Materials: `Kd` and `d` of the `.mtl` files that lie beside the file. Their textures are reported, and not used.
//!
//! ```text
//!   mtllib a.mtl ─▶ folder/a.mtl ─▶ lines that say something about a colour ─tobj─▶ name: Colour
//! ```
//!
//! The format names no colour space; programs store the values of their screen, sRGB.

use super::lines::lines;
use crate::import::source::OtherFiles;
use crate::import::{Place, Warnings, colour, text};
use crate::model::Colour;
use std::collections::HashMap;
use std::fmt::Write;
use std::path::PathBuf;

/// Bytes of one material file that are read.
const MAX_BYTES: u64 = 1 << 26;

/// Files of materials that one model may name.
const MAX_FILES: usize = 256;

/// Colours by the names of materials.
#[derive(Default)]
pub(super) struct Materials {
    /// The colour, where the material has one.
    colours: HashMap<String, Option<Colour>>,
    files: usize,
    /// Those that were read.
    pub opened: Vec<PathBuf>,
}

impl Materials {
    /// The colour of a material; `None` when no file has it.
    pub fn get(&self, name: &str) -> Option<Option<Colour>> {
        self.colours.get(name).copied()
    }

    /// Reads one file.
    pub fn open(&mut self, files: OtherFiles<'_>, name: &str, line: usize, warnings: &mut Warnings) {
        self.files += 1;
        let result = if self.files > MAX_FILES {
            Err("too many files of materials".into())
        } else {
            files.open(name, MAX_BYTES)
        };
        match result {
            Ok((path, bytes)) => {
                self.opened.push(path);
                self.read(text::utf8(&bytes).text.as_bytes(), name, warnings);
            }
            Err(why) => {
                warnings.push("materials not read", || Place::Line(line), || format!("{name}: {why}"));
            }
        }
    }

    /// Reads the text of a material file.
    pub fn read(&mut self, text: &[u8], file: &str, warnings: &mut Warnings) {
        // tobj ends at the first missing number, so it gets whole statements only
        let mut clean = String::new();
        for (line, text) in lines(text) {
            let mut words = text.split_whitespace();
            let keyword = words.next().unwrap_or_default();
            let numbers =
                || words.clone().map(|w| w.parse::<f64>().ok().filter(|x| x.is_finite())).collect::<Option<Vec<_>>>();
            let written = match (keyword, numbers()) {
                ("newmtl", _) if words.clone().next().is_some() => writeln!(clean, "{}", text.trim()).is_ok(),
                ("Kd", Some(n)) if n.len() >= 3 => writeln!(clean, "Kd {} {} {}", n[0], n[1], n[2]).is_ok(),
                ("Kd", Some(n)) if n.len() == 1 => writeln!(clean, "Kd {0} {0} {0}", n[0]).is_ok(),
                ("d", Some(n)) if n.len() == 1 => writeln!(clean, "d {}", n[0]).is_ok(),
                ("Tr", Some(n)) if n.len() == 1 => writeln!(clean, "d {}", 1.0 - n[0]).is_ok(),
                ("newmtl" | "Kd" | "d" | "Tr", _) => false,
                ("map_Kd" | "map_d", _) => {
                    let what = || format!("{file}:{line}: {}", brief(&text));
                    warnings.push("texture left out", || Place::File, what);
                    true
                }
                _ => true,
            };
            if !written {
                warnings.push(
                    "material statement not read",
                    || Place::File,
                    || format!("{file}:{line}: {}", brief(&text)),
                );
            }
        }
        let Ok((materials, _)) = tobj::load_mtl_buf(&mut clean.as_bytes()) else {
            warnings.push("materials not read", || Place::File, || format!("{file}: no material file"));
            return;
        };
        for material in materials {
            let opacity = material.dissolve.unwrap_or(1.0);
            let rgb = material.diffuse.or(material.dissolve.map(|_| [0.8; 3]));
            self.colours.insert(material.name, rgb.map(|rgb| colour::linear(rgb, opacity)));
        }
    }
}

/// The beginning of a statement, for messages.
pub(super) fn brief(text: &str) -> String {
    let mut words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    if words.chars().count() > 40 {
        words = words.chars().take(40).chain("…".chars()).collect();
    }
    words
}
