//! Every STEP file of a folder, against its manifest: set `SELVEDGE_MODELS` to the folder.
//!
//! `manifest.csv` has a row a file; its fifth column starts with `faces F (O occurrences)`, counted
//! by Open CASCADE.

use crate::import::open;
use std::path::{Path, PathBuf};

/// Distinct faces and placed faces of each file that the manifest counts.
fn manifest(folder: &Path) -> Vec<(PathBuf, usize, usize)> {
    let text = std::fs::read_to_string(folder.join("manifest.csv")).expect("manifest.csv in the folder");
    let numbers = |row: &str| {
        let counts = &row[row.find("faces ")? + 6..];
        let mut words = counts.split([' ', '(']).filter(|w| !w.is_empty());
        Some((words.next()?.parse().ok()?, words.next()?.parse().ok()?))
    };
    text.lines()
        .filter_map(|row| {
            let path = folder.join(row.split(',').next()?);
            let (faces, occurrences) = numbers(row)?;
            let extension = path.extension()?.to_str()?;
            ["step", "stp"].contains(&extension).then_some((path, faces, occurrences))
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
    for (path, faces, occurrences) in files {
        let start = std::time::Instant::now();
        let import = open(&path).expect("readable");
        let found = (import.report.faces, import.model.face_count(), import.model.face_instance_count());
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        eprintln!(
            "{name}: faces {} of {faces}, placed {} of {occurrences}, bodies {}, edges {}, {}, {:?}, {:.0} ms",
            found.1,
            found.2,
            import.report.bodies,
            import.report.edges,
            import.model.unit,
            import.report.warnings,
            start.elapsed().as_secs_f64() * 1e3,
        );
        for warning in import.warnings.iter().take(4) {
            eprintln!("    {warning}");
        }
        if import.report.faces != faces {
            wrong.push(format!("{name}: {} faces, the manifest says {faces}", import.report.faces));
        }
        let lost = import.report.faces - import.model.face_count();
        if lost == 0 && found.2 != occurrences {
            wrong.push(format!("{name}: {} placed faces, the manifest says {occurrences}", found.2));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
