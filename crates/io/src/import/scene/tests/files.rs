//! Other files: where they may lie, and what the scene takes from them.

use crate::import::{Files, Folders, Options, open, open_with, scene};
use std::path::PathBuf;

/// A folder of its own, with a scene.
fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("selvedge-scene-{name}-{}", std::process::id()));
    std::fs::create_dir_all(folder.join("sub")).unwrap();
    folder
}

#[test]
fn a_step_file_is_placed_and_keeps_its_own_colours() {
    let folder = folder("step");
    let good = include_bytes!("../../step/tests/good.step");
    std::fs::write(folder.join("sub/part.step"), good).unwrap();
    let text = "selvedge = 1\n[file.f]\npath = \"sub/part.step\"\n[[instance]]\nof = \"f\"\nat = [100, 0, 0]\n\
                [[instance]]\nof = \"f\"\ncolour = \"#ff0000\"\n[solid.s]\nshape = \"sphere\"\nradius = 1\n\
                [[instance]]\nof = \"s\"\n";
    std::fs::write(folder.join("a.toml"), text).unwrap();
    let import = open(&folder.join("a.toml"));
    let alone = open(&folder.join("sub/part.step")).unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    let import = import.unwrap();
    let (a, b) = (alone.model.bounds(), import.model.bounds());
    assert_eq!(import.model.parts.len(), alone.model.parts.len());
    assert_eq!(import.model.face_instance_count(), 2 * alone.model.face_instance_count());
    assert!((b.max.x - a.max.x - 100.0).abs() < 1e-9);
    assert_eq!(import.model.instances.last().unwrap().colour, Some([1.0, 0.0, 0.0, 1.0]));
    assert_eq!(import.report.faces, alone.report.faces);
    // numbers of faces and primitives do not meet
    let faces: Vec<u32> = import.model.parts.iter().flat_map(|p| &p.faces).map(|f| f.id).collect();
    assert!(!faces.contains(&import.model.solids[0].primitives()[0].id));
}

/// A cube of six squares, its corners at `(±1, ±1, ±1)`.
const CUBE: &str = "v -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1\n\
                    f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

#[test]
fn polygons_are_control_meshes_where_the_scene_says_so() {
    let folder = folder("cage");
    std::fs::write(folder.join("cube.obj"), CUBE).unwrap();
    let read = |keys: &str| {
        let text = format!(
            "selvedge = 1\n[file.c]\npath = \"cube.obj\"\n{keys}\n[solid.b]\nshape = \"sphere\"\nradius = 0.2\n\
             [solid.d]\nshape = \"boolean\"\nof = \"A-B\"\nwith = {{ A = \"c\", B = \"b\" }}\n[[instance]]\nof = \"c\"\n\
             [[instance]]\nof = \"d\"\n"
        );
        scene(text.as_bytes(), "t.toml", Some(&folder))
    };
    let made = read("subdivide = \"catmull-clark\"\ntolerance = 1e-4");
    let operand = {
        let text = "selvedge = 1\n[file.c]\npath = \"cube.obj\"\nsubdivide = \"catmull-clark\"\ntolerance = 1e-4\n\
                    [solid.b]\nshape = \"sphere\"\nradius = 0.2\n[solid.d]\nshape = \"boolean\"\nof = \"A-B\"\n\
                    with = { A = \"c\", B = \"b\" }\n[[instance]]\nof = \"d\"\n";
        scene(text.as_bytes(), "t.toml", Some(&folder)).unwrap()
    };
    let told = |keys: &str| read(keys).expect_err("no scene").to_string();
    let (no_triangles, no_scheme) = (told("subdivide = \"loop\""), told("subdivide = \"doo-sabin\""));
    let no_scheme_at_all = told("tolerance = 1e-4");
    std::fs::remove_dir_all(&folder).unwrap();
    let made = made.unwrap();
    let part = &made.model.parts[0];
    assert!(part.closed && part.meshes.is_empty() && part.faces.len() == 24, "{} faces", part.faces.len());
    // the cube's eight corners; no trim curve is off
    assert!(made.report.made <= 1e-4 && made.report.made > 0.0);
    assert_eq!((made.report.irregular, made.report.deviation), (8, 0.0));
    // as many where the file is an operand only
    assert_eq!((operand.report.irregular, operand.report.made), (8, made.report.made));
    // one step makes 1, 3/4 and 5/9 of a side's middle, of its edges' and of its corners; the limit of the middle is
    // (16 + 4 * 4 * 3/4 + 4 * 5/9) / 36 of it
    let corners = part.faces.iter().flat_map(|f| {
        let ((u0, u1), (v0, v1)) = f.surface.domain();
        [(u0, v0), (u1, v0), (u0, v1), (u1, v1)].map(|(u, v)| f.surface.point(u, v).z)
    });
    let top = corners.fold(0.0, f64::max);
    assert!((top - 68.0 / 81.0).abs() <= 1e-4, "{top}");
    assert_eq!(made.model.solids.len(), 1);
    assert!(
        no_triangles.starts_with("t.toml:3:8: `path`: ") && no_triangles.contains("is no triangle"),
        "{no_triangles}"
    );
    assert!(no_scheme.starts_with("t.toml:4:13: `subdivide`: `doo-sabin` is none of"), "{no_scheme}");
    assert!(no_scheme_at_all.starts_with("t.toml:4:1: `tolerance` is not known here"), "{no_scheme_at_all}");
}

/// An assembly whose part stands in a file of its own; the limit on a file counts for each of them.
#[test]
fn files_are_read_as_the_options_say() {
    const ASSEMBLY: &[u8] = include_bytes!("../../external/tests/assembly.stp");
    const BOLT: &[u8] = include_bytes!("../../external/tests/bolt.stp");
    let folder = folder("options");
    let path = folder.join("a.toml");
    std::fs::write(&path, "selvedge = 1\n[file.f]\npath = \"sub/a.stp\"\n").unwrap();
    std::fs::write(folder.join("sub/a.stp"), ASSEMBLY).unwrap();
    std::fs::write(folder.join("sub/t8_bolt.stp"), BOLT).unwrap();
    let beside = Folders::default();
    let read = |files: Option<&dyn Files>, most: Option<usize>| {
        let most_bytes = most.map(|most| most as u64);
        open_with(&path, &Options { files, most_bytes, ..Options::default() })
    };
    let (whole, alone) = (read(Some(&beside), None), read(None, None));
    let (no_bolt, nothing) = (read(Some(&beside), Some(BOLT.len() - 1)), read(Some(&beside), Some(ASSEMBLY.len() - 1)));
    std::fs::remove_dir_all(&folder).unwrap();
    let whole = whole.unwrap();
    assert_eq!((whole.model.face_instance_count(), whole.report.files_read.len()), (12, 2));
    for (missing, why) in [(alone, "external file not followed"), (no_bolt, "larger than 6353 bytes")] {
        let missing = missing.unwrap();
        assert_eq!(missing.report.missing_files, ["t8_bolt.stp"]);
        assert_eq!(missing.model.face_instance_count(), 0);
        assert!(missing.warnings.iter().any(|w| w.message.contains(why)), "{:?}", missing.warnings);
    }
    let told = nothing.expect_err("too long").to_string();
    assert!(told.contains("a.stp: larger than 3150 bytes"), "{told}");
}

/// An assembly and a scene that name each other: the references of files within a scene within a file are not followed.
#[test]
fn an_assembly_and_a_scene_that_name_each_other_end() {
    let folder = folder("circle");
    let assembly = include_str!("../../external/tests/assembly.stp").replace("t8_bolt.stp", "a.toml");
    std::fs::write(folder.join("a.stp"), assembly).unwrap();
    std::fs::write(folder.join("a.toml"), "selvedge = 1\n[file.f]\npath = \"a.stp\"\n").unwrap();
    let beside = Folders::default();
    let options = Options { files: Some(&beside), ..Options::default() };
    let read = ["a.stp", "a.toml"].map(|name| open_with(&folder.join(name), &options));
    std::fs::remove_dir_all(&folder).unwrap();
    for import in read {
        let import = import.unwrap();
        assert_eq!(import.model.face_instance_count(), 0);
        let told = import.warnings.iter().any(|w| w.message.contains("external file not followed: a.toml"));
        assert!(told, "{:?}", import.warnings);
    }
}

#[test]
fn paths_stay_within_the_folder() {
    let folder = folder("paths");
    let told = |path: &str| {
        let text = format!("selvedge = 1\n[file.f]\npath = {path}\n");
        let error = scene(text.as_bytes(), "t.toml", Some(&folder)).expect_err("no scene");
        error.to_string()
    };
    let outside =
        |path: &str| format!("t.toml:3:8: `path`: `{path}` is not a relative path within the scene's own folder");
    for path in ["../part.step", "sub/../../part.step", "/etc/passwd", ""] {
        assert_eq!(told(&format!("\"{path}\"")), outside(path));
    }
    assert_eq!(told("'C:\\part.step'"), outside("C:\\part.step"));
    assert_eq!(told("\"t.TOML\""), "t.toml:3:8: `path`: a scene within a scene is not read");
    assert!(told("\"gone.step\"").starts_with("t.toml:3:8: `path`: "), "{}", told("\"gone.step\""));
    std::fs::remove_dir_all(&folder).unwrap();
    let nowhere = scene(b"selvedge = 1\n[file.f]\npath = \"a.step\"\n", "t.toml", None).unwrap_err().to_string();
    assert_eq!(nowhere, "t.toml:3:8: `path`: the scene has no folder in which other files could be");
}

#[test]
fn a_table_of_points_is_met() {
    let folder = folder("csv");
    let rows: Vec<String> =
        (0..5).map(|j| (0..6).map(|i| format!("{i},{j},{}", (i * j) % 4)).collect::<Vec<_>>().join(",")).collect();
    std::fs::write(folder.join("p.csv"), rows.join("\n")).unwrap();
    let text = |more: &str| format!("selvedge = 1\n[surface.s]\nshape = \"grid\"\nfile = \"p.csv\"\n{more}\n");
    let read = |more: &str| scene(text(more).as_bytes(), "t.toml", Some(&folder));
    let (met, near, few) = (read(""), read("controls = [5, 4]"), read("controls = [7, 4]"));
    std::fs::write(folder.join("p.csv"), "1,2,3\n4,5,x\n").unwrap();
    let broken = read("").unwrap_err().to_string();
    std::fs::remove_dir_all(&folder).unwrap();
    let surface = met.unwrap().model.parts[0].faces[0].surface.clone();
    let ((u0, u1), (v0, v1)) = surface.domain();
    for (u, v, p) in [(u0, v0, [0.0, 0.0, 0.0]), (u1, v0, [5.0, 0.0, 0.0]), (u1, v1, [5.0, 4.0, 0.0])] {
        assert!(surface.point(u, v).distance(p.into()) < 1e-12);
    }
    let near = near.unwrap();
    assert_eq!(near.model.parts[0].faces[0].surface.counts(), (5, 4));
    let notes = &near.report.face_records[0].notes;
    assert!(notes[0].starts_with("data met within"), "{notes:?}");
    assert_eq!(few.unwrap_err().to_string(), "t.toml:3:9: `shape`: 7 control points in u, but at most 6 are taken");
    assert!(broken.contains("p.csv, line 2, field 3: `x` is not a finite number"), "{broken}");
}
