//! Files with something or everything left out: messages, and the exit status.

use super::{refused, selvedge, text};
use std::fs;
use tempfile::TempDir;

/// A patch that is drawn, and one that is not.
const PATCH: &str = "4\n1\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n";
const DAMAGED: &str = "4\n0\n0 0 0\n";

fn file(folder: &TempDir, name: &str, content: &str) -> String {
    let path = folder.path().join(name);
    fs::write(&path, content).unwrap();
    path.to_str().unwrap().to_owned()
}

/// Status 2 and `message` from every command that draws or writes the model; nothing is written.
#[track_caller]
fn draws_nothing(folder: &TempDir, model: &str, message: &str) {
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (png, native, step) = (path("a.png"), path("a.selvedge"), path("a.step"));
    let (svg, out) = (path("a.svg"), path("out"));
    for call in [
        &["render", model, "-o", &png][..],
        &["check", model],
        &["bench", model],
        &["convert", model, &native],
        &["export", model, &step],
        &["thumbnail", model, &png, "32"],
        &["draw", model, "-o", &svg],
        &["measure", model],
        &["sweep", model],
        &["trims", model, "--holes", "0"],
        &["report", model, "--out", &out],
    ] {
        refused(call, message);
    }
    let written = [&png, &native, &step, &svg].map(|path| fs::exists(path).unwrap());
    assert_eq!(written, [false; 4]);
    // `info` describes the file all the same
    let info = selvedge(&["info", "--json", model]);
    assert_eq!(info.status.code(), Some(2));
    assert!(text(&info.stderr).contains(message), "{}", text(&info.stderr));
    let told: serde_json::Value = serde_json::from_slice(&info.stdout).unwrap();
    for what in ["faces", "meshes", "solids"] {
        assert_eq!(told["summary"][what]["drawn"], 0, "{told}");
    }
}

#[test]
fn a_file_without_anything_to_draw_is_refused() {
    let folder = TempDir::new().unwrap();
    let damaged = file(&folder, "damaged.bv", DAMAGED);
    let why = "damaged.bv: nothing of it can be drawn; 1 left out: 1 x degree 0 is not between 1 and 15";
    draws_nothing(&folder, &damaged, why);
    let step = |data: &str| {
        format!("ISO-10303-21;HEADER;FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));ENDSEC;DATA;{data}ENDSEC;END-ISO-10303-21;")
    };
    let lines = "#1=CARTESIAN_POINT('',(0.,0.,0.));#2=DIRECTION('',(1.,0.,0.));#3=VECTOR('',#2,1.);#4=LINE('',#1,#3);\
                 #5=GEOMETRIC_CURVE_SET('',(#4));#6=SHAPE_REPRESENTATION('',(#5),#7);#7=REPRESENTATION_CONTEXT('','');";
    let lines = file(&folder, "lines.step", &step(lines));
    draws_nothing(&folder, &lines, "lines.step: nothing of it can be drawn; it holds 1 x GEOMETRIC_CURVE_SET");
    let empty = file(&folder, "empty.csg", "group();");
    draws_nothing(&folder, &empty, "empty.csg: nothing of it can be drawn");
}

/// The only part stands in another file: its name where it is not found, and two copies of its six faces below the
/// folder that is searched.
#[test]
fn parts_of_other_files_are_named_or_found() {
    let folder = TempDir::new().unwrap();
    let model = file(&folder, "a.stp", include_str!("../../../io/src/import/external/tests/assembly.stp"));
    draws_nothing(&folder, &model, "a.stp: nothing of it can be drawn; other files not read: t8_bolt.stp");
    let away = folder.path().join("away");
    fs::create_dir_all(away.join("deep")).unwrap();
    fs::write(away.join("deep/t8_bolt.stp"), include_str!("../../../io/src/import/external/tests/bolt.stp")).unwrap();
    // two levels down is not beside the file
    assert_eq!(selvedge(&["info", &model]).status.code(), Some(2));
    let found = selvedge(&["info", "--json", "--strict", "--search", away.to_str().unwrap(), &model]);
    assert_eq!(found.status.code(), Some(0), "{}", text(&found.stderr));
    let told: serde_json::Value = serde_json::from_slice(&found.stdout).unwrap();
    assert_eq!(told["faces"], 6, "{told}");
    assert_eq!(told["face_instances"], 12, "{told}");
}

#[test]
fn omissions_are_reported_and_strict_refuses_them() {
    let folder = TempDir::new().unwrap();
    let some = file(&folder, "some.bv", &format!("{PATCH}{DAMAGED}{PATCH}{DAMAGED}"));
    let png = folder.path().join("a.png").to_str().unwrap().to_owned();
    let why = "some.bv: drawn 2 of 4 faces; 2 left out: 2 x degree 0 is not between 1 and 15";
    let small = ["--size", "32x24"];
    for call in [&["render", &some, "-o", &png][..], &["check", &some]] {
        let call = [call, &small].concat();
        let output = selvedge(&call);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        assert!(text(&output.stderr).contains(why), "{}", text(&output.stderr));
        refused(&[&call[..], &["--strict"]].concat(), &format!("--strict: {}", &some));
    }
    let thumbnail = selvedge(&["thumbnail", &some, &png, "32"]);
    assert_eq!(thumbnail.status.code(), Some(0), "{}", text(&thumbnail.stderr));
    assert!(text(&thumbnail.stderr).contains(why), "{}", text(&thumbnail.stderr));
    let info = selvedge(&["info", &some]);
    assert_eq!(info.status.code(), Some(0));
    assert!(text(&info.stdout).contains("faces left out: 2\n  2 x degree 0 is not between 1 and 15"));
    assert_eq!(selvedge(&["info", "--strict", &some]).status.code(), Some(2));
    let whole = file(&folder, "whole.bv", PATCH);
    let output = selvedge(&["info", "--strict", &whole]);
    assert_eq!((output.status.code(), text(&output.stderr).as_str()), (Some(0), ""));
}

/// A Boolean solid that is empty, which no reader can see; a section that removes everything; a camera that looks past
/// the model.
#[test]
fn pictures_of_nothing_are_no_success() {
    let folder = TempDir::new().unwrap();
    let nothing =
        file(&folder, "nothing.csg", "difference() { sphere(r = 1); cube(size = [9, 9, 9], center = true); }");
    let ball = file(&folder, "ball.csg", "sphere(r = 1);");
    let png = folder.path().join("a.png").to_str().unwrap().to_owned();
    let small = ["--size", "32x24"];
    let refused_drawing = |model: &str, more: &[&str], status: i32| {
        for call in [&["render", model, "-o", &png][..], &["check", model]] {
            let output = selvedge(&[call, &small, more].concat());
            let told = text(&output.stderr);
            assert_eq!(output.status.code(), Some(status), "{call:?} {more:?}: {told}");
            let what = if status == 2 { "nothing is seen" } else { "no pixel shows anything of it" };
            assert!(told.contains(what), "{call:?} {more:?}: {told}");
        }
    };
    refused_drawing(&nothing, &[], 2);
    let written = ["a.selvedge", "a.step"].map(|name| folder.path().join(name).to_str().unwrap().to_owned());
    let [native, step] = &written;
    let why = "nothing.csg: nothing of it can be drawn: its solids leave no surface";
    refused(&["convert", &nothing, native], why);
    refused(&["export", &nothing, step], why);
    refused(&["sweep", &nothing], why);
    refused(&["trims", &nothing, "--holes", "0"], why);
    let out = folder.path().join("out").to_str().unwrap().to_owned();
    refused(&["report", &nothing, "--out", &out], why);
    refused(&["thumbnail", &nothing, &png, "32"], "nothing.csg: nothing is seen");
    assert!(!fs::exists(&png).unwrap());
    let info = selvedge(&["info", &nothing]);
    assert_eq!(info.status.code(), Some(2));
    assert!(text(&info.stderr).contains(why), "{}", text(&info.stderr));
    assert_eq!(written.each_ref().map(|path| fs::exists(path).unwrap()), [false; 2]);
    // all below a plane
    let open = "selvedge = 1\n[solid.a]\nshape = \"half-space\"\nnormal = [0, 0, 1]\noffset = 1\n";
    let open = file(&folder, "open.toml", open);
    let why = "no box holds its solids: they are unbounded, or empty";
    refused(&["render", &open, "-o", &png], why);
    let info = selvedge(&["info", &open]);
    assert!(info.status.code() == Some(2) && text(&info.stderr).contains(why), "{}", text(&info.stderr));
    // a sliver that one ray in thousands meets is something
    let sliver =
        file(&folder, "sliver.csg", "difference() { sphere(r = 1); cube(size = [1.98, 9, 9], center = true); }");
    assert_eq!(selvedge(&["info", &sliver]).status.code(), Some(0));
    assert_eq!(selvedge(&["convert", &sliver, native]).status.code(), Some(0));
    refused_drawing(&nothing, &["--eye", "0,-9,0", "--target", "0,0,0"], 2);
    refused(&["render", &ball, "-o", &png, "--section", "1,0,0,-2"], "what cuts the model open leaves nothing of it");
    assert!(!fs::exists(&png).unwrap());
    refused_drawing(&ball, &["--eye", "0,-9,0", "--target", "0,-99,0"], 0);
    let past = ["render", &ball, "-o", &png, "--eye", "0,-9,0", "--target", "0,-99,0", "--strict"];
    refused(&past, "ball.csg: no pixel shows anything of it");
}

/// A Rhino file of 21 faces, six of which lie on a layer that is not shown, and the same with one surface of a class that
/// does not exist.
#[cfg(feature = "rhino")]
#[test]
fn a_face_that_is_left_out_of_a_rhino_file_is_reported() {
    const BLOCKS: &[u8] = include_bytes!("../../../io/src/import/rhino/blocks.3dm");
    /// The first bytes of the class of spline surfaces.
    const SURFACE: [u8; 4] = 0x4ED7_D4DE_u32.to_le_bytes();
    let folder = TempDir::new().unwrap();
    let file = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let whole = file("whole.3dm", BLOCKS);
    let output = selvedge(&["info", "--strict", &whole]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let mut damaged = BLOCKS.to_vec();
    let at = damaged.windows(4).position(|w| w == SURFACE).expect("a surface");
    damaged[at] ^= 0x55;
    let damaged = file("damaged.3dm", &damaged);
    let info = selvedge(&["info", "--json", &damaged]);
    assert_eq!(info.status.code(), Some(0), "{}", text(&info.stderr));
    let told: serde_json::Value = serde_json::from_slice(&info.stdout).unwrap();
    let faces = &told["summary"]["faces"];
    assert_eq!((&faces["stated"], &faces["drawn"]), (&21.into(), &14.into()), "{}", text(&info.stderr));
    let named = text(&info.stderr).lines().any(|l| l.contains("face left out") && l.contains(": a surface of class"));
    assert!(named, "{}", text(&info.stderr));
    refused(&["check", &damaged, "--strict"], "drawn 14 of 21 faces, 1 mesh; 1 left out: 1 x a surface of class");
}
