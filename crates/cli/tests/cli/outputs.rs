//! The outputs of a call: nothing overwrites its inputs or another output, no file is incomplete, and standard output
//! has the file alone.

use super::scenes::SCENE;
use super::{refused, selvedge, text};
use std::fs;
use std::path::Path;
use std::process::Output;

/// A folder with `small.toml` in it.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        fs::write(folder.path("small.toml"), SCENE).unwrap();
        folder
    }

    fn path(&self, name: &str) -> String {
        self.0.path().join(name).to_str().unwrap().to_owned()
    }

    fn files(&self) -> Vec<String> {
        let mut all: Vec<_> =
            fs::read_dir(self.0.path()).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        all.sort();
        all
    }
}

#[track_caller]
fn done(output: &Output) {
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
}

/// Every command, every output: refused, and the input is what it was.
#[test]
fn no_output_replaces_an_input() {
    let folder = Folder::new();
    let path = |name: &str| folder.path(name);
    let source = concat!(env!("CARGO_MANIFEST_DIR"), "/../io/src/import/step/tests/good.step");
    let ours = path("good.step");
    fs::copy(source, &ours).unwrap();
    let (picture, json) = (path("in.png"), path("in.json"));
    // the same file under another name
    fs::hard_link(&ours, &picture).unwrap();
    fs::hard_link(&ours, &json).unwrap();
    let aov = format!("depth={}", path("in.npy"));
    fs::hard_link(&ours, path("in.npy")).unwrap();
    fs::hard_link(&ours, path("in.csv")).unwrap();
    fs::hard_link(&ours, path("in.selvedge")).unwrap();
    fs::hard_link(&ours, path("in.svg")).unwrap();
    fs::create_dir(path("out")).unwrap();
    let free = path("free.png");
    for name in ["bench.csv", "edit.json", "trims.json", "report.md"] {
        fs::hard_link(&ours, path(&format!("out/{name}"))).unwrap();
    }
    let mut calls: Vec<Vec<&str>> = vec![
        vec!["render", &ours, "-o", &picture],
        vec!["render", &ours, "-o", &free, "--aov", &aov],
        vec!["render", &ours, "-o", &free, "--stats", &json],
        vec!["render", &ours, "-o", &free, "--camera-out", &json],
        vec!["check", &ours, "--difference", &picture],
        vec!["check", &ours, "--json", &json],
    ];
    let (csv, native, out) = (path("in.csv"), path("in.selvedge"), path("out"));
    calls.push(vec!["sweep", &ours, "--out", &csv]);
    calls.push(vec!["convert", &ours, &native]);
    calls.push(vec!["export", &ours, &ours]);
    calls.push(vec!["bench", &ours, "--out", &out]);
    calls.push(vec!["bench", &ours, "--edit", "--out", &out]);
    calls.push(vec!["trims", &ours, "--out", &out]);
    calls.push(vec!["report", &ours, "--out", &out]);
    let (svg, free_svg) = (path("in.svg"), path("free.svg"));
    calls.push(vec!["draw", &ours, "-o", &svg]);
    calls.push(vec!["draw", &ours, "-o", &free_svg, "--camera-out", &json]);
    calls.push(vec!["thumbnail", &ours, &ours, "32"]);
    for call in &calls {
        refused(call, "the same file as the input");
    }
    // the trimming file is an input too
    refused(&["render", &path("small.toml"), "-o", &picture, "--trim-by", &ours], "the same file as the input");
    // and so are the files that the scene names
    let scene = path("parts.toml");
    fs::write(&scene, "selvedge = 1\n[file.a]\npath = \"good.step\"\n").unwrap();
    for call in [
        &["render", &scene, "-o", &picture][..],
        &["check", &scene, "--json", &json],
        &["export", &scene, &ours],
        &["thumbnail", &scene, &ours, "32"],
    ] {
        refused(call, "the same file as the input");
    }
    // files that an OpenSCAD file names are inputs, too, even where the import leaves them out
    let csg = path("relief.csg");
    fs::write(&csg, "cube(size = 1); surface(file = \"in.png\");").unwrap();
    refused(&["render", &csg, "-o", &picture], "the same file as the input");
    // and the points of a scene's surface
    let (grid, points) = (path("grid.toml"), path("out/bench.csv"));
    fs::remove_file(&points).unwrap();
    let row = |j: u32| (0..5).map(|i| format!("{i},{j},{}", i * j)).collect::<Vec<_>>().join(",");
    fs::write(&points, (0..5).map(row).collect::<Vec<_>>().join("\n")).unwrap();
    fs::write(&grid, "selvedge = 1\n[surface.a]\nshape = \"grid\"\nfile = \"out/bench.csv\"\n").unwrap();
    refused(&["sweep", &grid, "--out", &points], "the same file as the input");
    refused(&["bench", &grid, "--out", &out], "the same file as the input");
    let loops = path("loops.toml");
    fs::remove_file(path("out/edit.json")).unwrap();
    fs::copy(source, path("out/edit.json")).unwrap();
    fs::write(&loops, "selvedge = 1\n[file.a]\npath = \"out/edit.json\"\n").unwrap();
    refused(&["bench", &loops, "--edit", "--out", &out], "the same file as the input");
    assert_eq!(fs::read(&ours).unwrap(), fs::read(source).unwrap());
    assert!(!Path::new(&free).exists(), "refused before the work");
}

#[test]
fn outputs_that_cannot_be_are_found_before_the_work() {
    let folder = Folder::new();
    let path = |name: &str| folder.path(name);
    let (scene, a) = (path("small.toml"), path("a.png"));
    // a model that is not there would be found first, had the work begun
    let none = path("none.step");
    let same = format!("{}/./A.png", folder.0.path().display());
    refused(&["render", &none, "-o", &path("no/a.png")], "no/a.png");
    refused(&["render", &none, "-o", &path("a.ppm")], "a.ppm: what is written here is a PNG picture");
    refused(&["render", &none, "-o", &a, "--stats", &path("s.txt")], "s.txt: what is written here is JSON");
    refused(&["render", &none, "-o", &a, "--aov", "uv=uv.exr"], "uv.exr: what is written here is a NumPy array");
    refused(&["check", &none, "--difference", &path("d.jpg")], "d.jpg: what is written here is a PNG picture");
    refused(&["export", &none, &path("a.iges")], "a.iges: what is written here is a STEP file");
    refused(&["export", &none, &path("no/a.step")], "no/a.step");
    refused(&["thumbnail", &none, &path("no/a"), "32"], "no/a");
    refused(&["draw", &none, "-o", &path("a.dxf")], "a.dxf: what is written here is an SVG drawing");
    refused(&["bench", &none, "--out", &scene], "small.toml");
    refused(&["bench", &none, "--out", "-"], "a folder is wanted");
    refused(&["render", &none, "-o", "-", "--stats", "-"], "the same place as another output");
    refused(&["render", &none, "-o", &a, "--aov", &format!("face={same}")], "A.png: what is written here is a NumPy");
    refused(&["check", &scene, "--views", "all", "--difference", "-"], "the same place as another output");
    fs::create_dir(path("folder.png")).unwrap();
    refused(&["render", &none, "-o", &path("folder.png")], "folder.png: a folder");
    assert_eq!(folder.files(), ["folder.png", "small.toml"]);
}

/// Standard output has the file and nothing else.
#[test]
fn a_dash_is_standard_output() {
    let folder = Folder::new();
    let path = |name: &str| folder.path(name);
    let scene = path("small.toml");
    let drawn = selvedge(&["render", &scene, "-o", &path("a.png"), "--aov", "face=-"]);
    done(&drawn);
    assert!(drawn.stdout.starts_with(b"\x93NUMPY"));
    let picture = selvedge(&["render", &scene, "-o", "-", "--stats", &path("a.json")]);
    done(&picture);
    assert_eq!(picture.stdout, fs::read(path("a.png")).unwrap());
    // the driver's compile times are separate from the frame's time
    let stats: serde_json::Value = serde_json::from_slice(&fs::read(path("a.json")).unwrap()).unwrap();
    let ms = |of: &str| stats["first_frame"][of].as_f64().unwrap();
    assert!(ms("pipelines_ms") > 0.0 && ms("wall_ms") > 0.0, "{stats}");
    assert_eq!(stats["reused"], false, "every pass is measured");
    let passes: f64 = stats["passes"].as_array().unwrap().iter().map(|pass| pass["gpu_ms"].as_f64().unwrap()).sum();
    assert!(passes > 0.0, "{stats}");
    // objects of the scene: buffers have sizes, pipelines 0
    let objects = stats["objects"].as_array().unwrap();
    let bytes = |name: &str| objects.iter().find(|o| o["name"] == name).and_then(|o| o["bytes"].as_u64());
    assert!(bytes("patches").is_some_and(|bytes| bytes > 0) && bytes("bound") == Some(0), "{stats}");
    assert_eq!(bytes("meshes"), None, "the scene has none");
    let verdicts = selvedge(&["check", &scene, "--samples", "100", "--json", "-"]);
    done(&verdicts);
    assert_eq!(serde_json::from_slice::<serde_json::Value>(&verdicts.stdout).unwrap()[0]["kept"], true);
    assert!(text(&verdicts.stderr).contains("promise"), "the table goes beside: {}", text(&verdicts.stderr));
    let step = selvedge(&["export", &scene, "-"]);
    done(&step);
    assert!(step.stdout.starts_with(b"ISO-10303-21;") && step.stdout.ends_with(b"END-ISO-10303-21;\n"));
    let native = selvedge(&["convert", &scene, "-"]);
    done(&native);
    fs::write(path("a.selvedge"), &native.stdout).unwrap();
    done(&selvedge(&["info", &path("a.selvedge")]));
}

/// A disk with room for 512 bytes of a file: the old picture stays, and no part of a new one.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_costs_nothing() {
    let folder = Folder::new();
    let path = |name: &str| folder.path(name);
    let (scene, old, step) = (path("small.toml"), path("old.png"), path("new.step"));
    fs::write(&old, "old").unwrap();
    let full = |arguments: &[&str]| {
        let script = "trap '' XFSZ; ulimit -f 1; exec \"$@\"";
        let program = env!("CARGO_BIN_EXE_selvedge");
        // blocks of 512 bytes, by POSIX
        let call = [&["-c", script, "sh", program][..], arguments].concat();
        let output =
            std::process::Command::new("sh").args(call).env("MESA_SHADER_CACHE_DISABLE", "1").output().unwrap();
        let told = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {told}");
        assert!(told.contains("cannot write") && told.contains("File too large"), "{told}");
    };
    full(&["render", &scene, "-o", &old, "--size", "160x120"]);
    full(&["export", &scene, &step]);
    assert_eq!(fs::read(&old).unwrap(), b"old");
    assert_eq!(folder.files(), ["old.png", "small.toml"]);
    refused(&["export", &scene, "/dev/full"], "cannot write /dev/full: No space left");
    done(&selvedge(&["export", &scene, "/dev/null"]));
}
