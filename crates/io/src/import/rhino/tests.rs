//! The `.3dm` files of a folder against its manifest, a file written by openNURBS, and damaged bytes.

use crate::import::{ImportError, open, rhino};
use std::path::PathBuf;

/// Written by openNURBS 8 in centimetres. The layer `parts`, which is green, holds the red cylinder of radius 2 and
/// height 5 on (1, 2, 3), and a tetrahedron of triangles. It also holds a block twice, moved by 10 and 20 along x: the
/// box from 0 to (1, 2, 3). A layer that is not shown holds another box.
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
            read.report.repaired,
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
    assert!(read.summary().is_complete(), "{:?}", said());
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

/// Class ids as they stand in a file, by what the box and the cylinder are made of.
const ID_END: [u8; 8] = [0xBF, 0xE5, 0x00, 0x10, 0x83, 0x01, 0x22, 0xF0];

/// Places of the ids of a class that begin with `first`.
fn places(first: u32) -> Vec<usize> {
    let start = first.to_le_bytes();
    let is = |at: &usize| BLOCKS[*at..].starts_with(&start) && BLOCKS.get(at + 8..at + 16) == Some(&ID_END[..]);
    (0..BLOCKS.len() - 16).filter(is).collect()
}

/// Bodies by their records.
fn own(bytes: &[u8]) -> Vec<crate::model::Part> {
    use super::{archive, brep::Brep};
    use cadmpeg_codec_rhino::RhinoCodec;
    use cadmpeg_ir::{Codec, DecodeOptions};
    let decoded = RhinoCodec.decode(&mut std::io::Cursor::new(bytes), &DecodeOptions::default()).unwrap();
    let (ir, _, source) = decoded.into_parts();
    let record = |id: &str| {
        let kept = source.retained_record(id)?;
        let class = archive::object(bytes, kept.end_offset() - kept.byte_len()).ok().filter(Brep::is)?;
        let brep = Brep::read(bytes, class, 10.0).unwrap();
        let faces = (0..brep.len()).map(|k| brep.face(k, 1).unwrap().face).collect();
        Some(crate::model::Part { faces, closed: brep.closed, ..crate::model::Part::default() })
    };
    ir.native_unknowns_iter("rhino").flatten().filter_map(|r| record(r.id.as_str())).collect()
}

fn shapes(part: &crate::model::Part) -> Vec<[f64; 8]> {
    part.faces.iter().map(shape).collect()
}

/// Bodies' records, read here, hold the same faces as the decoder's bodies.
#[test]
fn records_of_bodies_are_read_as_the_decoder_reads_them() {
    let whole = rhino(BLOCKS, "blocks.3dm").unwrap();
    let bodies = own(BLOCKS);
    for body in &bodies {
        assert!(body.closed);
        // uses of a block have their points moved
        let same = |part: &crate::model::Part| {
            let (a, b) = (shapes(part), shapes(body));
            let step = if a.is_empty() { 0.0 } else { a[0][0] - b[0][0] };
            let near = |p: &[f64; 8], q: &[f64; 8]| {
                let along = |k: usize| if k == 0 || k == 3 { step } else { 0.0 };
                (0..8).all(|k| (p[k] - q[k] - along(k)).abs() < 1e-9)
            };
            a.len() == b.len() && a.iter().zip(&b).all(|(p, q)| near(p, q))
        };
        assert!(whole.model.parts.iter().any(same), "{:?}", shapes(body));
    }
    // the cylinder, the box of the block, the box that is not shown
    assert_eq!(bodies.iter().map(|b| b.faces.len()).sum::<usize>(), 3 + 6 + 6);
}

/// The box of the loops in space, their number, and the sense of a face.
fn shape(face: &crate::model::Face) -> [f64; 8] {
    let grid = face.surface.patches();
    let curves = face.loops.iter().flat_map(|l| l.curves());
    let points = curves.flat_map(|c| (0..=16).map(move |k| c.point(f64::from(k) / 16.0)));
    let space = points.map(|p| grid.point(p.x, p.y)).fold(crate::model::Bounds::EMPTY, crate::model::Bounds::with);
    let (a, b) = (space.min, space.max);
    [a.x, a.y, a.z, b.x, b.y, b.z, face.loops.len() as f64, f64::from(u8::from(face.same_sense))]
}

/// The decoder leaves out a body for one bad surface or curve; of its faces all others are shown.
#[test]
fn one_bad_surface_costs_one_face() {
    let names = |read: &crate::import::Import| {
        read.model.parts.iter().map(|p| (p.name.clone(), p.faces.len())).collect::<Vec<_>>()
    };
    let whole = rhino(BLOCKS, "a.3dm").unwrap();
    let surfaces = [places(0x4ED7_D4DE), places(0x4ED7_D4DF)].concat();
    assert!(surfaces.len() >= 9, "{surfaces:?}");
    let mut seen = 0;
    for at in surfaces {
        let mut bytes = BLOCKS.to_vec();
        bytes[at] ^= 0x55;
        let read = rhino(&bytes, "a.3dm").unwrap();
        let told = read.warnings.iter().map(ToString::to_string).collect::<Vec<_>>();
        if names(&read) == names(&whole) {
            continue;
        }
        seen += 1;
        assert_eq!(read.report.dropped.total(), 1, "{told:?}");
        assert!(!read.summary().is_complete(), "{told:?}");
        assert!(told.iter().any(|w| w.contains("face left out") && w.contains("a surface of class")), "{told:?}");
        assert!(told.iter().any(|w| w.contains("body read from its record")), "{told:?}");
        assert_eq!(read.report.face_records.iter().filter(|r| r.kind.is_none()).count(), 1);
    }
    assert!(seen >= 9, "{seen}");
}

/// Surfaces under the id of Rhino's modeller are the same.
#[test]
fn surfaces_under_another_id() {
    const OTHER: [u8; 16] =
        [0x17, 0xC8, 0x60, 0x47, 0xE3, 0x0B, 0xD4, 0x11, 0xBF, 0xFE, 0, 0x10, 0x83, 0x01, 0x22, 0xF0];
    let mut bytes = BLOCKS.to_vec();
    let all = places(0x4ED7_D4DE);
    assert!(!all.is_empty());
    all.iter().for_each(|at| bytes[*at..*at + 16].copy_from_slice(&OTHER));
    let of = |bytes: &[u8]| own(bytes).iter().map(shapes).collect::<Vec<_>>();
    assert_eq!(of(&bytes), of(BLOCKS));
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
