//! The command line: arguments, messages, exit statuses; and models through every command.

mod devices;
mod draw;
mod manifest;
mod many;
mod measure;
mod missing;
#[cfg(target_os = "linux")]
mod openscad;
mod outputs;
mod reading;
mod scenes;
mod throughput;

use std::process::{Command, Output};

fn selvedge(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_selvedge")).args(arguments).output().expect("the binary runs")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Status 2, nothing on standard output, and `message` on standard error.
#[track_caller]
fn refused(arguments: &[&str], message: &str) {
    let output = selvedge(arguments);
    let told = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {told}");
    assert!(output.stdout.is_empty(), "{arguments:?}");
    assert!(told.contains(message), "{arguments:?} should mention {message:?}, says: {told}");
}

#[test]
fn help_names_every_command_and_the_exit_statuses() {
    let help = selvedge(&["--help"]);
    assert_eq!(help.status.code(), Some(0));
    let help = text(&help.stdout);
    let commands =
        ["render", "draw", "info", "measure", "check", "bench", "trims", "sweep", "report", "convert", "devices"];
    for word in commands.into_iter().chain(["Exit status: 0 done; 1 a picture breaks"]) {
        assert!(help.contains(word), "{word} in {help}");
    }
    for command in commands {
        let help = selvedge(&[command, "--help"]);
        assert_eq!(help.status.code(), Some(0));
        assert!(text(&help.stdout).contains("Exit status:"), "{command}");
    }
}

#[test]
fn wrong_arguments_are_usage_errors() {
    refused(&[], "Usage");
    refused(&["paint", "m.step"], "unrecognized subcommand");
    refused(&["render", "m.step"], "--output");
    refused(&["report", "m.step"], "--out <DIR>");
    let render = |more: &[&'static str], message: &str| {
        refused(&[&["render", "m.step", "-o", "a.png"], more].concat(), message);
    };
    render(&["--size", "1920"], "WIDTHxHEIGHT");
    render(&["--size", "0x10"], "WIDTHxHEIGHT");
    render(&["--eye", "1,2"], "three finite numbers");
    render(&["--eye", "1,2,inf"], "three finite numbers");
    render(&["--fov", "30", "--ortho", "10"], "cannot be used with");
    render(&["--tolerance", "0.09"], "at least 0.1");
    render(&["--aov", "colour=c.npy"], "depth, face, uv, normal, thickness, edge, part or instance");
    refused(&["check", "m.step", "--samples", "0"], "above 0");
    refused(&["check", "m.step", "--views", "close", "--eye", "1,2,3"], "cannot be used with");
    refused(&["check", "m.step", "--zoom", "1e3,0.5"], "from 1 to 1e9");
    refused(&["check", "m.step", "--zoom", "10", "--views", "close"], "cannot be used with");
    render(&["--factors", "65"], "a level from 1 to 64");
    render(&["--section", "1,0,0"], "four finite numbers");
    render(&["--section", "0,0,0,1"], "all 0");
    refused(&["bench", "m.step", "--edit", "--section", "1,0,0,0"], "cannot be used with");
    refused(&["sweep", "m.step", "--sizes", "400"], "WIDTHxHEIGHT");
    render(&["--camera", "front", "--fov", "30"], "cannot be used with");
    render(&["--view", "sideways"], "no view is called `sideways`; wants iso, front, ");
    render(&["--style", "plaid"], "no style is called `plaid`; there are: shaded, ");
    render(&["--background", "whitish"], "`whitish` is no colour: ");
    render(&["--edge-colour", "whitish"], "`whitish` is no colour: ");
    render(&["--edges", "some"], "no choice of edges is called `some`; there are: all, sharp, none");
    render(&["--smooth", "some"], "smooth are none, trims or borders, and not `some`");
    render(&["--ao=-1"], "`-1` is no radius above 0");
    refused(&["bench"], "MODELS");
    refused(&["convert", "m.step"], "OUT.selvedge");
    refused(&["convert", "m.step", "m.xyz"], "m.xyz: what is written here is a .selvedge file");
}

/// No picture is written then.
#[test]
fn lines_without_a_width_are_refused() {
    let source = concat!(env!("CARGO_MANIFEST_DIR"), "/../io/src/import/step/tests/good.step");
    let folder = tempfile::tempdir().unwrap();
    let picture = folder.path().join("a.png");
    for width in ["--edge-width=-1", "--edge-width=inf", "--section-width=nan"] {
        let arguments = ["render", source, "-o", picture.to_str().unwrap(), "--edges", "all", width];
        refused(&arguments, "the width of edge lines must be from 0 to 64 pixels, not ");
    }
    assert!(!picture.exists());
}

#[test]
fn a_missing_file_is_named() {
    for arguments in [
        &["info", "no/such/model.step"][..],
        &["render", "no/such/model.step", "-o", "a.png"],
        &["check", "no/such/model.step"],
        &["bench", "no/such/model.step"],
        &["convert", "no/such/model.step", "m.selvedge"],
    ] {
        refused(arguments, "no/such/model.step");
    }
}

/// `report` reads every model before it measures the first.
#[test]
fn a_report_ends_at_once_where_a_model_cannot_be_read() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let sample = concat!(env!("CARGO_MANIFEST_DIR"), "/../../samples/panel.step");
    let report = |model| ["report", sample, model, "--out", out.to_str().unwrap()];
    refused(&report("no/such/model.step"), "no/such/model.step");
    refused(&report("-"), "`-` is standard input, which can be read once");
    let written = std::fs::read_dir(&out).unwrap().count();
    assert_eq!(written, 0, "neither a document nor a table");
}

#[test]
fn a_file_that_is_no_model_is_an_import_error() {
    let manifest = concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml");
    refused(&["info", manifest], "Cargo.toml");
}

/// A converted file has the model of the source; converting it again gives the same bytes.
#[test]
fn a_converted_model_is_the_same_model() {
    let source = concat!(env!("CARGO_MANIFEST_DIR"), "/../io/src/import/step/tests/good.step");
    let folder = std::env::temp_dir().join(format!("selvedge-convert-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = |name: &str| folder.join(name).to_string_lossy().into_owned();
    let (once, twice) = (path("once.selvedge"), path("twice.selvedge"));
    assert_eq!(selvedge(&["convert", source, &once]).status.code(), Some(0));
    assert_eq!(selvedge(&["convert", &once, &twice]).status.code(), Some(0));
    let described = |file: &str| -> serde_json::Value {
        let mut told: serde_json::Value = serde_json::from_slice(&selvedge(&["info", "--json", file]).stdout).unwrap();
        // the report and its faces' records are of the file, not of the model
        told.as_object_mut().unwrap().retain(|key, _| !["report", "face_records"].contains(&key.as_str()));
        told
    };
    assert_eq!(described(&once), described(source));
    let bytes = [&once, &twice].map(|file| std::fs::read(file).unwrap());
    std::fs::write(&twice, &bytes[1][..bytes[1].len() - 1]).unwrap();
    refused(&["info", &twice], "the header says");
    std::fs::remove_dir_all(&folder).unwrap();
    assert_eq!(bytes[0], bytes[1]);
}

/// What Open CASCADE counts in the sample, as samples/README.md says.
#[test]
fn info_reports_bodies_faces_and_the_assembly() {
    let model = concat!(env!("CARGO_MANIFEST_DIR"), "/../../samples/assembly.step");
    let plain = selvedge(&["info", model]);
    assert_eq!(plain.status.code(), Some(0));
    let plain = text(&plain.stdout);
    let row = |name: &str, numbers: &[&str]| {
        let line =
            plain.lines().find(|l| l.trim_start().starts_with(name)).unwrap_or_else(|| panic!("{name}: {plain}"));
        let found: Vec<_> = line.split_whitespace().filter(|w| w.parse::<usize>().is_ok()).collect();
        assert_eq!(found, numbers, "{line}");
    };
    row("solids", &["9", "23"]);
    row("faces", &["112", "195"]);
    row("p-curves, given", &["0"]);
    for line in ["│  └─ ball_1 x 9", "├─ 14, 17, 20, 23 (4 alike)", "   └─ handle"] {
        assert!(plain.contains(line), "{line} in {plain}");
    }
    let deep = text(&selvedge(&["info", "--deep", model]).stdout);
    let list = deep.split("every face:").nth(1).unwrap().split("trim curves farthest").next().unwrap();
    assert_eq!(list.lines().filter(|l| l.trim_start().starts_with('#')).count(), 112);
    let json: serde_json::Value = serde_json::from_slice(&selvedge(&["info", "--json", model]).stdout).unwrap();
    let records = json["face_records"].as_array().unwrap();
    assert_eq!(records.len(), 112);
    assert!(records.iter().all(|r| r["deviation"].is_number() && r["loops"].is_number() && r["notes"].is_array()));
    assert_eq!(json["assembly"]["children"].as_array().unwrap().len(), 3);
    assert_eq!(
        (&json["report"]["dropped"], &json["report"]["layers"]),
        (&serde_json::json!({}), &serde_json::json!({}))
    );
}

/// Polygons become the smooth surface of their scheme, closed where they are; an error names the file of unsuitable
/// ones.
#[test]
fn polygons_are_subdivided() {
    let folder = std::env::temp_dir().join(format!("selvedge-subdivide-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    let (cube, made, step) = (path("cube.obj"), path("cube.selvedge"), path("cube.step"));
    let vertices: String = (0..8).map(|i| format!("v {} {} {}\n", i & 1, i >> 1 & 1, i >> 2)).collect();
    std::fs::write(&cube, vertices + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n").unwrap();
    let smooth = ["--subdivide", "catmull-clark", "--within", "0.001"];
    let output = selvedge(&[&["convert", &cube, &made][..], &smooth].concat());
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let model = selvedge_io::import::open(std::path::Path::new(&made)).unwrap().model;
    // one step parts the corners; each of the 24 faces has one of them
    assert!(model.parts[0].closed && model.parts[0].faces.len() == 24);
    assert_eq!(selvedge(&[&["export", &cube, &step][..], &smooth].concat()).status.code(), Some(0));
    assert!(std::fs::read_to_string(&step).unwrap().contains("MANIFOLD_SOLID_BREP"));
    let told = text(&selvedge(&[&["info", &cube][..], &smooth].concat()).stdout);
    let off = told.lines().find_map(|l| l.strip_prefix("surfaces made: largest distance ")).expect(&told);
    let off: f64 = off.split_once(" mm from what they stand for").expect(off).0.parse().unwrap();
    assert!(off > 0.0 && off <= 1e-3, "{told}");
    assert!(told.contains("subdivision: 8 irregular vertices") && !told.contains("trim curves:"), "{told}");
    refused(&["info", &cube, "--subdivide", "loop"], "cube.obj: face 0 of the mesh (from 0) is no triangle");
    refused(&["info", &cube, "--within", "1"], "--subdivide");
    refused(&["info", &cube, "--subdivide", "loop", "--within", "0"], "a length above 0");
    std::fs::remove_dir_all(&folder).unwrap();
}

/// `sweep` writes a row a setting, and beside the bound the smallest level with no larger error.
#[test]
fn sweeps_measure_the_given_quantities() {
    let out = std::env::temp_dir().join(format!("selvedge-sweep-{}.csv", std::process::id()));
    let file = out.to_string_lossy();
    let sample = concat!(env!("CARGO_MANIFEST_DIR"), "/../../samples/bracket.step");
    let small = ["--sizes", "160x120", "--frames", "1", "--samples", "200"];
    let done = |more: &[&str]| {
        let output = selvedge(&[&["sweep", sample], &small[..], more].concat());
        assert_eq!(output.status.code(), Some(0), "{more:?}: {}", text(&output.stderr));
        text(&output.stdout)
    };
    let told = done(&["--degrees", "2", "--factors", "bound,slefe,8", "--rate", "--out", &file]);
    let mut table = csv::Reader::from_path(&out).unwrap();
    let rows: Vec<std::collections::HashMap<String, String>> = table.deserialize().map(Result::unwrap).collect();
    std::fs::remove_file(&out).unwrap();
    let column = |name: &str| rows.iter().map(|row| row[name].as_str()).collect::<Vec<_>>();
    assert_eq!(column("model"), [["bracket"; 3], ["degree 2"; 3]].concat());
    assert_eq!(column("factors"), ["bound", "slefe", "8"].repeat(2));
    // 32 by 32 spans of a face, cut into patches at the middles too
    assert_eq!(column("patches")[3..], ["4096"; 3]);
    assert_eq!((column("wrong"), column("clamps")), (vec!["0"; 6], vec!["0"; 6]));
    assert!(column("deviation_px").iter().all(|px| (0.0..0.5).contains(&px.parse::<f64>().unwrap())), "{rows:?}");
    // two triangles for each of 8 by 8 cells of each sub-patch that may be seen
    for row in rows.iter().filter(|row| row["factors"] == "8") {
        let count = |name: &str| row[name].parse::<u64>().unwrap();
        assert_eq!(count("triangles"), 128 * count("sub_patches"), "{row:?}");
    }
    assert!(told.contains("triangles a second in tessellation and visibility"), "{told}");

    let told = done(&["--against-fixed", "--zooms", "1,4"]);
    let levels: Vec<&str> = told.lines().filter(|line| line.contains(" bracket ")).collect();
    assert_eq!(levels.len(), 3, "a row a view and one for all: {told}");
    refused(&["sweep", sample, "--against-fixed", "--out", &file], "cannot be used with");
    refused(&["sweep", sample, "--against-fixed", "--factors", "8"], "cannot be used with");
    refused(&["sweep", sample, "--factors", "slefe10"], "1 to 9 segments");
    refused(&["check", sample, "--factors", "slefe"], "a level from 1 to 64");
}

/// Width, height and a pixel of a picture.
fn pixel(path: &str, x: u32, y: u32) -> ((u32, u32), [u8; 4]) {
    let file = std::io::BufReader::new(std::fs::File::open(path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    let at = 4 * (y * info.width + x) as usize;
    ((info.width, info.height), bytes[at..at + 4].try_into().unwrap())
}
