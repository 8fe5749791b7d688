//! Every IGES file of a folder, against its manifest: set `SELVEDGE_MODELS` to the folder.
//!
//! `manifest.csv` has a row a file; its fifth column starts with `faces F`, counted by Open CASCADE.

use crate::import::open;
use std::path::{Path, PathBuf};

/// Faces of each IGES file that the manifest counts.
fn manifest(folder: &Path) -> Vec<(PathBuf, usize)> {
    let text = std::fs::read_to_string(folder.join("manifest.csv")).expect("manifest.csv in the folder");
    let row = |row: &str| {
        let path = folder.join(row.split(',').next()?);
        let counts = &row[row.find("faces ")? + 6..];
        let known = ["igs", "iges"].contains(&path.extension()?.to_str()?);
        known.then_some((path, counts.split(' ').next()?.parse().ok()?))
    };
    text.lines().filter_map(row).collect()
}

#[test]
fn face_counts_of_a_folder() {
    let Some(folder) = std::env::var_os("SELVEDGE_MODELS").map(PathBuf::from) else {
        eprintln!("skipped: SELVEDGE_MODELS names no folder");
        return;
    };
    let files = manifest(&folder);
    assert!(!files.is_empty(), "the manifest lists no IGES file");
    for (path, faces) in files {
        let import = open(&path).expect("readable");
        let found = (import.report.faces, import.model.face_count());
        assert_eq!(found, (faces, faces), "{}: {:?}", path.display(), import.report.dropped);
    }
}
