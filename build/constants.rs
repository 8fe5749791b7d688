//! Constants that GLSL states and Rust uses, read out of the sources: `const uint NAME = 16u;`. SPIR-V has no names of
//! them. A module a file; what stands in an include and an entry point of one name is one module.

use crate::{files, folders};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// `constants.rs`: every constant with a literal value.
pub fn of_sources(glsl: &Path) -> Result<String, String> {
    let mut modules: BTreeMap<String, BTreeMap<String, String>> = BTreeMap::new();
    let folders = folders(glsl).into_iter().filter(|folder| !folder.ends_with("spirv"));
    for path in folders.flat_map(|folder| files(&folder)) {
        let text = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        if stem.starts_with("baseline_") {
            continue;
        }
        for (name, value) in text.lines().filter_map(literal) {
            let known = modules.entry(stem.clone()).or_default().insert(name.to_owned(), value.clone());
            if known.is_some_and(|known| known != value) {
                return Err(format!("{}: `{name}` has another value in a file of the same name", path.display()));
            }
        }
    }
    let mut text = String::from("// Written by build.rs from the shaders: constants of theirs.\n");
    for (stem, constants) in modules {
        let _ = writeln!(text, "pub mod {stem} {{");
        for (name, value) in constants {
            let _ = writeln!(text, "    pub const {name}: {value};");
        }
        text.push_str("}\n");
    }
    Ok(text)
}

/// Name, and type and value in Rust, of a line `const uint NAME = 16u;`.
fn literal(line: &str) -> Option<(&str, String)> {
    let (declared, rest) = line.trim_start().strip_prefix("const ")?.split_once(" = ")?;
    let (of, name) = declared.split_once(' ')?;
    let value = rest.split_once(';')?.0;
    let rust = match of {
        "uint" => format!("u32 = {}", value.strip_suffix('u').filter(|digits| is_whole(digits))?),
        "int" if is_whole(value) => format!("i32 = {value}"),
        "float" if value.parse::<f32>().is_ok() => format!("f32 = {value}"),
        _ => return None,
    };
    Some((name, rust))
}

fn is_whole(text: &str) -> bool {
    match text.strip_prefix("0x") {
        Some(digits) => u32::from_str_radix(digits, 16).is_ok(),
        None => text.parse::<u32>().is_ok(),
    }
}
