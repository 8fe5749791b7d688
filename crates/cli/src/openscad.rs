//! OpenSCAD's programs: `openscad` runs them and writes the flattened solid, which the library reads.
//!
//! ```text
//!   x.scad ──openscad -o - --export-format csg──▶ text ──▶ Import; files that it names lie beside x.scad
//! ```

use anyhow::{Context, Result, bail};
use selvedge_io::import::{self, Facets, Import};
use std::io::ErrorKind;
use std::path::{Path, absolute};
use std::process::{Command, Stdio};

/// Whether the file is a program of OpenSCAD's, by its name.
pub fn is_program(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("scad"))
}

/// Runs a program and reads its output; OpenSCAD's warnings are passed on.
pub fn open(path: &Path, facets: Facets) -> Result<Import> {
    let name = path.display().to_string();
    // an absolute path is not taken for an option
    let mut command = Command::new("openscad");
    command.args(["-o", "-", "--export-format", "csg"]).arg(absolute(path)?).stdin(Stdio::null());
    let run = match command.output() {
        Err(error) if error.kind() == ErrorKind::NotFound => bail!(
            "{name}: openscad runs such programs and is not installed: install it (Debian: apt install openscad), or \
             give the .csg file that `openscad -o x.csg {name}` writes elsewhere"
        ),
        other => other.with_context(|| format!("{name}: openscad"))?,
    };
    let said = String::from_utf8_lossy(&run.stderr);
    let told = |kinds: &[&str]| {
        let of_kind = |line: &&str| kinds.iter().any(|kind| line.starts_with(kind));
        said.lines().filter(of_kind).map(str::to_owned).collect::<Vec<_>>()
    };
    if !run.status.success() {
        let errors = told(&["ERROR"]);
        let last = said.lines().last().unwrap_or("no word").to_owned();
        bail!("{name}: openscad failed ({}): {}", run.status, errors.first().unwrap_or(&last));
    }
    told(&["WARNING", "ERROR", "DEPRECATED"]).iter().for_each(|line| tracing::warn!("{name}: openscad: {line}"));
    Ok(import::scad(&run.stdout, &name, facets)?)
}
