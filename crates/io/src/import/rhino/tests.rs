//! The `.3dm` files of a folder against its manifest, a file written by openNURBS, and damaged bytes.

use crate::import::{ImportError, open, rhino};
use std::path::PathBuf;

/// Written by openNURBS 8 in centimetres. On the layer `parts`, which is green: the cylinder of radius 2 and
/// height 5 on (1, 2, 3), red; a tetrahedron of triangles; twice, moved by 10 and 20 along x, a block that is the
/// box from 0 to (1, 2, 3). On a layer that is not shown: another box.
const BLOCKS: &[u8] = include_bytes!("blocks.3dm");

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
            "{}: {:?} faces of {:?}, {} placed, {} meshes, gap {:e} mm, {:?}, {:?} {:?} {:?}",
            file.display(),
            read.model.face_count(),
            count,
            read.model.face_instance_count(),
            read.model.parts.iter().map(|p| p.meshes.len()).sum::<usize>(),
            read.report.gap,
            start.elapsed(),
            read.report.warnings,
            read.report.dropped,
            read.report.healed,
        );
        read.warnings.iter().take(6).for_each(|w| eprintln!("    {w}"));
        let lost = read.report.dropped.total();
        if Some(read.model.face_count() + lost) != count || lost > 1 || read.report.meshes > 0 {
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

#[test]
fn blocks_meshes_colours_and_units() {
    let read = rhino(BLOCKS, "blocks.3dm").unwrap();
    let said = || read.warnings.iter().map(ToString::to_string).collect::<Vec<_>>();
    assert_eq!(read.model.unit, "centimetre");
    assert!(read.report.dropped.is_empty(), "{:?}", said());
    let part = |name: &str| read.model.parts.iter().position(|p| p.name == name).unwrap_or_else(|| panic!("{name}"));
    let of = |name: &str| &read.model.parts[part(name)];
    let counts = ["cylinder", "box", "unseen"].map(|n| (of(n).faces.len(), of(n).closed));
    assert_eq!(counts, [(3, true), (6, true), (6, true)], "{:?}", said());
    assert_eq!((of("tetra").meshes[0].triangles().len(), of("tetra").closed), (4, true));
    // a block is a body for each use, its points moved; the one on the hidden layer is not placed
    let at = |name: &str| {
        let placed = read.model.instances.iter().filter(|i| read.model.parts[i.part].name == name);
        let face = |i: &crate::model::Instance| {
            let part = &read.model.parts[i.part];
            let grids = part.faces.iter().map(|f| (f.surface.domain(), f.surface.patches()));
            let corners = grids.map(|(((u, _), (v, _)), grid)| grid.point(u, v).x);
            i.transform.translation.x + corners.fold(f64::INFINITY, f64::min)
        };
        let mut all: Vec<f64> = placed.map(face).collect();
        all.sort_by(f64::total_cmp);
        all
    };
    assert_eq!(at("box"), [100.0, 200.0], "{:?} {:?}", said(), read.model.instances);
    assert!(at("unseen").is_empty());
    assert_eq!(read.model.parts.iter().map(|p| p.meshes.len()).sum::<usize>(), 1);
    assert!(of("cylinder").faces.iter().all(|f| f.colour == Some([1.0, 0.0, 0.0, 1.0])));
    assert_eq!(of("tetra").meshes[0].colour, Some([0.0, 1.0, 0.0, 1.0]));
    // distance of the side from its axis
    let side = of("cylinder").faces.iter().find(|f| !f.surface.is_polynomial()).expect("a rational side");
    let ((u0, u1), (v0, v1)) = side.surface.domain();
    let grid = side.surface.patches();
    for k in 0..100 {
        let (s, t) = (f64::from(k % 10) / 9.0, f64::from(k / 10) / 9.0);
        let p = grid.point(u0 + (u1 - u0) * s, v0 + (v1 - v0) * t);
        assert!(((p.x - 10.0).hypot(p.y - 20.0) - 20.0).abs() < 1e-11, "{p}");
        assert!(p.z > 30.0 - 1e-9 && p.z < 80.0 + 1e-9, "{p}");
    }
    assert_eq!((read.report.face_records.len(), read.report.faces, read.report.sloppy), (21, 21, 0));
    assert!(read.report.gap < 1e-9, "{:e}", read.report.gap);
}

/// Every face is read or counted as lost, and nothing panics.
fn sound(bytes: &[u8]) {
    if let Ok(read) = rhino(bytes, "a.3dm") {
        let lost = read.report.dropped.total();
        assert_eq!(read.report.faces, read.report.face_records.len());
        assert_eq!(lost, read.report.face_records.iter().filter(|r| r.kind.is_none()).count());
    }
}

#[test]
fn cut_anywhere() {
    (0..BLOCKS.len()).step_by(BLOCKS.len() / 97).for_each(|n| sound(&BLOCKS[..n]));
}

#[test]
fn bytes_flipped() {
    let mut at = 0x2545_f491_4f6c_dd1d_u64;
    for _ in 0..200 {
        let mut bytes = BLOCKS.to_vec();
        for _ in 0..4 {
            at ^= at << 13;
            at ^= at >> 7;
            at ^= at << 17;
            let place = (at >> 8) as usize % bytes.len();
            bytes[place] ^= (at as u8) | 1;
        }
        sound(&bytes);
    }
}
