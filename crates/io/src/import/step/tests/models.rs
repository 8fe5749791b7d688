//! Every STEP file of a folder, against its manifest: set `SELVEDGE_MODELS` to the folder.
//!
//! `manifest.csv` has a row a file; its fifth column starts with `faces F (O occurrences)`, counted
//! by Open CASCADE.

use crate::import::{Import, open};
use std::path::{Path, PathBuf};

/// Distinct faces and placed faces of each STEP file, where the manifest counts them.
fn manifest(folder: &Path) -> Vec<(PathBuf, Option<(usize, usize)>)> {
    let text = std::fs::read_to_string(folder.join("manifest.csv")).expect("manifest.csv in the folder");
    let numbers = |row: &str| {
        let counts = &row[row.find("faces ")? + 6..];
        let mut words = counts.split([' ', '(']).filter(|w| !w.is_empty());
        Some((words.next()?.parse().ok()?, words.next()?.parse().ok()?))
    };
    text.lines()
        .filter_map(|row| {
            let path = folder.join(row.split(',').next()?);
            let extension = path.extension()?.to_str()?;
            ["step", "stp"].contains(&extension).then(|| (path.clone(), numbers(row)))
        })
        .collect()
}

#[test]
fn face_counts_of_a_folder() {
    let Some(folder) = std::env::var_os("SELVEDGE_MODELS").map(PathBuf::from) else {
        eprintln!("skipped: SELVEDGE_MODELS names no folder");
        return;
    };
    let files = manifest(&folder);
    assert!(!files.is_empty(), "the manifest lists no STEP file");
    let mut wrong = Vec::new();
    for (path, expected) in files {
        let start = std::time::Instant::now();
        let Import { model, report, warnings, .. } = open(&path).expect("readable");
        let milliseconds = start.elapsed().as_secs_f64() * 1e3;
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let found = (report.faces, model.face_instance_count());
        let coloured = model.parts.iter().flat_map(|p| &p.faces).filter(|f| f.colour.is_some()).count();
        eprintln!(
            "{name}: faces {} placed {} expected {expected:?}, {coloured} coloured, {} bodies, {} edges, {}, \
             {milliseconds:.0} ms, {:?} {:?} {:?}",
            found.0, found.1, report.bodies, report.edges, model.unit, report.warnings, report.dropped, report.repaired,
        );
        warnings.iter().take(4).for_each(|warning| eprintln!("    {warning}"));
        let Some((faces, occurrences)) = expected else { continue };
        let lost = report.faces > model.face_count();
        if found.0 != faces || (found.1 != occurrences && !lost) {
            wrong.push(format!("{name}: faces and placed faces {found:?}, expected {expected:?}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
