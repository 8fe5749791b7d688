//! The `.3dm` files of a folder against its manifest, and damaged bytes.

use crate::import::{ImportError, open, rhino};
use std::path::PathBuf;

/// Set `SELVEDGE_MODELS` to the folder; the manifest's fifth column holds `brep faces N`.
#[test]
fn face_counts_of_a_folder() {
    let Some(folder) = std::env::var_os("SELVEDGE_MODELS").map(PathBuf::from) else {
        eprintln!("skipped: SELVEDGE_MODELS names no folder");
        return;
    };
    let manifest = std::fs::read_to_string(folder.join("manifest.csv")).expect("manifest.csv in the folder");
    let mut wrong = Vec::new();
    for row in manifest.lines().filter(|row| row.contains(".3dm,")) {
        let file = folder.join(row.split(',').next().unwrap_or_default());
        let count =
            row.split("brep faces ").nth(1).and_then(|t| t.split(';').next()).and_then(|t| t.parse::<usize>().ok());
        let start = std::time::Instant::now();
        let read = open(&file).expect("readable");
        eprintln!(
            "{}: {:?} faces of {:?}, {} placed, {} meshes, deviation {:e} mm, {:?}, {:?} {:?} {:?}",
            file.display(),
            read.model.face_count(),
            count,
            read.model.face_instance_count(),
            read.model.parts.iter().map(|p| p.meshes.len()).sum::<usize>(),
            read.report.deviation,
            start.elapsed(),
            read.report.warnings,
            read.report.dropped,
            read.report.healed,
        );
        read.warnings.iter().take(6).for_each(|w| eprintln!("    {w}"));
        if Some(read.model.face_count()) != count || Some(read.report.faces) != count {
            wrong.push(file);
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

#[test]
fn what_is_no_archive() {
    for bytes in
        [b"3D Geometry File Format ".as_slice(), b"", b"3D Geometry File Format        5\0\0\0\xff\xff\xff\xff"]
    {
        assert!(matches!(rhino(bytes, "a.3dm"), Err(ImportError::Rhino { .. })), "{bytes:?}");
    }
}
