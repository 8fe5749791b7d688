//! Files and streams that are read, up to the limits, and paths that are neither.

use super::scenes::SCENE;
use super::{refused, selvedge, text};
use std::fs;
use std::io::Write;
use std::process::{Command, Output, Stdio};

/// Runs with `input` on standard input.
fn piped(arguments: &[&str], input: &[u8]) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_selvedge"))
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // it may have seen enough, and closed the pipe
    let _ = child.stdin.take().unwrap().write_all(input);
    child.wait_with_output().unwrap()
}

/// A cylinder with a seam, from its source and from the engine's own form.
#[test]
fn edges_are_counted_by_kind() {
    let good = include_bytes!("../../../io/src/import/step/tests/good.step");
    let folder = tempfile::tempdir().unwrap();
    let native = folder.path().join("a.selvedge").to_str().unwrap().to_owned();
    assert_eq!(piped(&["convert", "-", &native], good).status.code(), Some(0));
    let native = selvedge(&["info", "--json", &native]);
    for told in [piped(&["info", "--json", "-"], good), native] {
        let told: serde_json::Value = serde_json::from_slice(&told.stdout).unwrap();
        let counts = ["sharp", "smooth", "seams", "borders", "vertices", "mesh_creases", "mesh_borders"];
        assert_eq!(counts.map(|kind| told["edges"][kind].as_u64().unwrap()), [2, 0, 1, 0, 2, 0, 0]);
    }
    let told = text(&piped(&["info", "-"], good).stdout);
    let row = |name: &str| {
        told.lines().find(|l| l.contains(name)).unwrap_or_else(|| panic!("no {name} in {told}")).to_owned()
    };
    for (name, count) in [("sharp edges", "2"), ("seams", "1"), ("vertices", "2")] {
        assert!(row(name).contains(count), "{told}");
    }
}

/// Beside the time of reading stands that of the box, in shares of it: one command measures both.
#[test]
fn info_times_the_box() {
    let good = include_bytes!("../../../io/src/import/step/tests/good.step");
    let told = text(&piped(&["-v", "info", "-"], good).stderr);
    let share = |line: &str| {
        let (_, share) = line.split_once(" box in ")?.1.split_once(", ")?;
        share.strip_suffix(" % of the time of reading")?.parse::<f64>().ok()
    };
    let shares: Vec<f64> = told.lines().filter_map(share).collect();
    assert!(shares.len() == 1 && shares[0] >= 0.0, "{told}");
    assert!(!text(&piped(&["info", "-"], good).stderr).contains(" box in "));
}

#[test]
fn a_dash_is_standard_input() {
    let good = include_bytes!("../../../io/src/import/step/tests/good.step");
    let told = piped(&["info", "--json", "-"], good);
    assert_eq!(told.status.code(), Some(0), "{}", text(&told.stderr));
    let told: serde_json::Value = serde_json::from_slice(&told.stdout).unwrap();
    assert_eq!(told["faces"], 3);
    let folder = tempfile::tempdir().unwrap();
    let native = folder.path().join("a.selvedge").to_str().unwrap().to_owned();
    assert_eq!(piped(&["convert", "-", &native], good).status.code(), Some(0));
    let again = selvedge(&["convert", &native, "-"]).stdout;
    let through = piped(&["convert", "-", "-"], &again);
    assert!(through.stdout == again, "{}", text(&through.stderr));
    for (input, message) in [(&b"no model"[..], "not a CAD file of a known format"), (b"", "not a CAD file")] {
        let output = piped(&["info", "-"], input);
        assert_eq!(output.status.code(), Some(2));
        let told = text(&output.stderr);
        assert!(told.contains("standard input: ") && told.contains(message), "{told}");
    }
    // no format begins so: the rest is not waited for
    let output = piped(&["info", "-"], &vec![b'y'; 4 << 20]);
    assert!(text(&output.stderr).contains("not a CAD file of a known format"), "{}", text(&output.stderr));
}

#[test]
fn what_is_no_file_is_not_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let within = path("a.step");
    fs::create_dir(&within).unwrap();
    refused(&["info", &within], "a.step: a folder, not a file");
    #[cfg(unix)]
    {
        refused(&["info", "/dev/zero"], "/dev/zero: a device, not a file");
        let pipe = path("pipe.step");
        assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        refused(&["info", &pipe], "pipe.step: a named pipe");
        refused(&["render", &pipe, "-o", &path("a.png")], "pipe.step: a named pipe");
        // beside a model too
        let scene = path("a.toml");
        fs::write(&scene, "selvedge = 1\n[file.a]\npath = \"pipe.step\"\n").unwrap();
        refused(&["info", &scene], "pipe.step: a named pipe");
        let data = "selvedge = 1\n[surface.a]\nshape = \"grid\"\nfile = \"pipe.csv\"\n";
        fs::rename(&pipe, path("pipe.csv")).unwrap();
        fs::write(&scene, data).unwrap();
        refused(&["info", &scene], "pipe.csv: a named pipe");
    }
}

#[test]
fn what_is_read_is_bounded() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (scene, large) = (path("a.toml"), path("large.step"));
    fs::write(&scene, SCENE).unwrap();
    let mut step = include_bytes!("../../../io/src/import/step/tests/good.step").to_vec();
    step.extend(vec![b'\n'; 2 << 20]);
    fs::write(&large, &step).unwrap();
    assert_eq!(selvedge(&["info", &large]).status.code(), Some(0));
    let bounded = "more than --limit-mib allows: ";
    refused(&["info", &large, "--limit-mib", "1"], bounded);
    refused(&["render", &large, "-o", &path("a.png"), "--limit-mib", "1"], bounded);
    refused(&["render", &scene, "-o", &path("a.png"), "--trim-by", &large, "--limit-mib", "1"], bounded);
    let output = piped(&["info", "-", "--limit-mib", "1"], &step);
    assert!(output.status.code() == Some(2) && text(&output.stderr).contains(bounded), "{}", text(&output.stderr));
    refused(&["info", &large, "--limit-mib", "0"], "MiB above 0");
}

/// Files that others name: a scene's model, a part of an assembly, a height map. The limit is above what the program
/// itself holds, and below the size of these files.
#[test]
fn files_that_others_name_are_bounded() {
    const LARGE: usize = 65 << 20;
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let padded = |name: &str, bytes: &[u8]| {
        let mut bytes = bytes.to_vec();
        bytes.resize(LARGE, b'\n');
        fs::write(path(name), bytes).unwrap();
    };
    padded("large.step", include_bytes!("../../../io/src/import/step/tests/good.step"));
    padded("t8_bolt.stp", include_bytes!("../../../io/src/import/external/tests/bolt.stp"));
    padded("height.dat", b"0 0\n0 1\n");
    let (scene, of_two, height) = (path("a.toml"), path("of_two.stp"), path("height.csg"));
    fs::write(&scene, "selvedge = 1\n[file.a]\npath = \"large.step\"\n").unwrap();
    fs::write(&of_two, include_bytes!("../../../io/src/import/external/tests/assembly.stp")).unwrap();
    fs::write(&height, "surface(file = \"height.dat\");").unwrap();
    for (model, file) in [(&scene, "large.step"), (&of_two, "t8_bolt.stp"), (&height, "height.dat")] {
        let output = selvedge(&["info", "--strict", model]);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        let told = format!("{file}: larger than {} bytes", 64 << 20);
        let output = selvedge(&["info", "--strict", model, "--limit-mib", "64"]);
        let stderr = text(&output.stderr);
        assert!(output.status.code() == Some(2) && stderr.contains(&told), "{told}: {stderr}");
    }
}
