//! `selvedge draw`: the content of the file, and refusals.

use super::{refused, selvedge, text};
use std::fs;
use tempfile::TempDir;

/// A cube of side 2 about (5, 5, 5).
const CUBE: &str = "v 4 4 4\nv 6 4 4\nv 6 6 4\nv 4 6 4\nv 4 4 6\nv 6 4 6\nv 6 6 6\nv 4 6 6\n\
    f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

struct Folder(TempDir);

impl Folder {
    fn new(name: &str, text: &str) -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        fs::write(folder.path(name), text).unwrap();
        folder
    }

    fn path(&self, name: &str) -> String {
        self.0.path().join(name).to_str().unwrap().to_owned()
    }
}

fn drawn(arguments: &[&str], file: &str) -> String {
    let output = selvedge(arguments);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(output.stdout.is_empty());
    fs::read_to_string(file).unwrap()
}

/// The paths of a group: their points.
fn group(svg: &str, id: &str) -> Vec<Vec<(f64, f64)>> {
    let Some((_, rest)) = svg.split_once(&format!("<g id=\"{id}\"")) else { return Vec::new() };
    let inside = rest.split("</g>").next().unwrap();
    let data = inside.split("d=\"").skip(1).map(|d| d.split('"').next().unwrap());
    let points = |d: &str| {
        let spaced = d.replace(['M', 'L', 'C', 'Z'], " ");
        let numbers: Vec<f64> = spaced.split_whitespace().map(|n| n.parse().unwrap()).collect();
        numbers.chunks_exact(2).map(|p| (p[0], p[1])).collect()
    };
    data.map(points).collect()
}

/// From the front, ten to one: a square of 20 mm, in the middle of the paper.
#[test]
fn a_scale_is_that_of_the_paper() {
    let folder = Folder::new("cube.obj", CUBE);
    let (model, out) = (folder.path("cube.obj"), folder.path("cube.svg"));
    let svg = drawn(&["draw", &model, "-o", &out, "--view", "front", "--scale", "10", "--size", "400x300"], &out);
    let lines = group(&svg, "visible-sharp");
    assert_eq!(lines.len(), 4, "{svg}");
    for line in &lines {
        let [a, b] = line[..] else { panic!("{line:?}") };
        assert!(((a.0 - b.0).hypot(a.1 - b.1) - 20.0).abs() < 1e-3, "{line:?}");
    }
    // the cube fills nine tenths of the height
    let height = 20.0 / 0.9;
    let all: Vec<_> = lines.concat();
    let middle = |of: fn(&(f64, f64)) -> f64| all.iter().map(of).sum::<f64>() / all.len() as f64;
    assert!((middle(|p| p.0) - height * 2.0 / 3.0).abs() < 1e-2 && (middle(|p| p.1) - height * 0.5).abs() < 1e-2);
    assert!(svg.contains("<title>cube") || !svg.contains("<title>"));
}

#[test]
fn an_isometric_cube_has_nine_lines_and_three_dashed_ones() {
    let folder = Folder::new("cube.obj", CUBE);
    let (model, out) = (folder.path("cube.obj"), folder.path("cube_{view}.svg"));
    let file = folder.path("cube_iso.svg");
    let svg = drawn(&["draw", &model, "-o", &out, "--view", "iso", "--hidden-lines", "--width", "100"], &file);
    assert_eq!((group(&svg, "visible-sharp").len(), group(&svg, "hidden-sharp").len()), (9, 3), "{svg}");
    assert!(svg.contains("width=\"100mm\"") && svg.contains("stroke-dasharray"));
    // several views, a file each; hidden lines only on demand
    drawn(&["draw", &model, "-o", &out, "--view", "top,30,20"], &folder.path("cube_top.svg"));
    let other = fs::read_to_string(folder.path("cube_30_20.svg")).unwrap();
    assert_eq!((group(&other, "visible-sharp").len(), group(&other, "hidden-sharp").len()), (9, 0));
}

/// The bracket has edges of all kinds, and silhouettes.
#[test]
fn kinds_are_groups_and_can_be_left_out() {
    let folder = Folder::new("none", "");
    let model = concat!(env!("CARGO_MANIFEST_DIR"), "/../../samples/bracket.step");
    let out = folder.path("bracket.svg");
    let count = |more: &[&str]| {
        let svg = drawn(&[&["draw", model, "-o", &out, "--size", "400x300"], more].concat(), &out);
        ["visible-sharp", "visible-smooth", "visible-silhouette"].map(|id| group(&svg, id).len())
    };
    let [sharp, smooth, folds] = count(&[]);
    assert!(sharp > 10 && smooth > 10 && folds > 3, "{sharp} {smooth} {folds}");
    assert_eq!(count(&["--edges", "sharp"]), [sharp, 0, folds]);
    assert_eq!(count(&["--tangent-edges", "none"]), [sharp, 0, folds]);
    assert_eq!(count(&["--silhouettes", "false"])[2], 0);
    assert_eq!(count(&["--edges", "none"])[..2], [0, 0]);
    let full = drawn(&["draw", model, "-o", &out, "--tangent-edges", "full"], &out);
    assert!(!full.contains("stroke-width=\"0.13\""));
}

#[test]
fn bad_requests_are_refused() {
    let folder = Folder::new("cube.obj", CUBE);
    let (model, out) = (folder.path("cube.obj"), folder.path("cube.svg"));
    let draw = |more: &[&str], message: &str| refused(&[&["draw", &model, "-o", &out], more].concat(), message);
    refused(&["draw", &model], "--output");
    refused(
        &["draw", &model, "-o", "a.png"],
        "a.png: what is written here is an SVG drawing, so its name ends in .svg",
    );
    refused(&["draw", &model, "-o", &model], "its name ends in .svg");
    draw(&["--view", "side"], "no view is called `side`");
    for bad in ["0", "inf", "nan", "-3", "1e9"] {
        draw(&[&format!("--width={bad}")], "wants millimetres, from 1 to 10000");
    }
    for bad in ["0", "inf", "nan", "-1"] {
        draw(&[&format!("--scale={bad}")], "wants a scale above 0");
    }
    draw(&["--scale", "1", "--width", "100"], "cannot be used with");
    draw(&["--scale", "1", "--fov", "30"], "--scale wants a parallel view");
    draw(&["--scale", "1e9"], "--scale makes a sheet of");
    draw(&["--edges", "some"], "there are: all, sharp, none");
    draw(&["--size", "0x10"], "WIDTHxHEIGHT");
    draw(&["--edges", "none", "--silhouettes", "false"], "nothing to draw");
    let two = folder.path("{view}.svg");
    refused(&["draw", &model, "-o", &two], "--view says which");
    assert!(!fs::exists(&out).unwrap(), "nothing is written");
}

/// Solids have no lines of their own: a warning, or a refusal where there is nothing else; an old file stays.
#[test]
fn a_solid_alone_is_refused_and_the_old_file_stays() {
    let folder = Folder::new("ball.csg", "sphere(r = 3);");
    let (model, out) = (folder.path("ball.csg"), folder.path("ball.svg"));
    fs::write(&out, "old").unwrap();
    refused(&["draw", &model, "-o", &out], "nothing to draw");
    let told = text(&selvedge(&["draw", &model, "-o", &out]).stderr);
    assert!(told.contains("1 Boolean solid"), "{told}");
    assert_eq!(fs::read_to_string(&out).unwrap(), "old");
}

/// The lines of a cube are complete and nowhere else, also in a small picture.
#[test]
fn lines_along_edges_are_judged() {
    let folder = Folder::new("cube.obj", CUBE);
    let (model, json) = (folder.path("cube.obj"), folder.path("cube.json"));
    let output = selvedge(&["check", &model, "--edges", "--size", "320x240", "--samples", "50", "--json", &json]);
    assert_eq!(output.status.code(), Some(0), "{}{}", text(&output.stdout), text(&output.stderr));
    assert!(text(&output.stdout).contains("lines: points seen, missing, unsure; pixels, stray"));
    let told: serde_json::Value = serde_json::from_str(&fs::read_to_string(&json).unwrap()).unwrap();
    let lines = &told[0]["lines"];
    let count = |what: &str| lines[what].as_u64().unwrap();
    assert!(count("visible") > 500 && count("line_pixels") > 200, "{lines}");
    assert_eq!((count("missing"), count("stray"), count("unsure")), (0, 0, 0), "{lines}");
}

/// With the two outlines of a cylinder there are more points, and their lines are there.
#[test]
fn outlines_are_judged_where_that_is_wanted() {
    let model = concat!(env!("CARGO_MANIFEST_DIR"), "/../io/src/import/step/tests/good.step");
    let folder = Folder::new("no.txt", "");
    let judged = |more: &[&str]| {
        let json = folder.path("lines.json");
        let check = ["check", model, "--edges", "--size", "240x180", "--samples", "50", "--json", json.as_str()];
        let output = selvedge(&[&check[..], more].concat());
        assert!(output.status.code().is_some_and(|code| code < 2), "{}", text(&output.stderr));
        let told: serde_json::Value = serde_json::from_str(&fs::read_to_string(&json).unwrap()).unwrap();
        ["visible", "line_pixels", "missing"].map(|what| told[0]["lines"][what].as_u64().unwrap())
    };
    let ([seen, pixels, missing], [more_seen, more_pixels, more_missing]) = (judged(&[]), judged(&["--silhouettes"]));
    assert!(more_seen > seen + 100 && more_pixels > pixels + 100, "{seen}, {more_seen}; {pixels}, {more_pixels}");
    assert_eq!((missing, more_missing), (0, 0));
    refused(&["check", model, "--silhouettes"], "--edges");
}

/// A cube without one of its corners: lines of Boolean solids are judged, too.
#[test]
fn lines_of_solids_are_judged() {
    let corner = "multmatrix([[1, 0, 0, 2], [0, 1, 0, -2], [0, 0, 1, 2], [0, 0, 0, 1]])";
    let cube = "cube(size = [4, 4, 4], center = true);";
    let solid = format!("difference() {{\n{cube}\n{corner} {{\n{cube}\n}}\n}}");
    let folder = Folder::new("cube.csg", &solid);
    let (model, json) = (folder.path("cube.csg"), folder.path("cube.json"));
    let output = selvedge(&["check", &model, "--edges", "--size", "320x240", "--samples", "50", "--json", &json]);
    assert_eq!(output.status.code(), Some(0), "{}{}", text(&output.stdout), text(&output.stderr));
    let told: serde_json::Value = serde_json::from_str(&fs::read_to_string(&json).unwrap()).unwrap();
    let lines = &told[0]["lines"];
    let count = |what: &str| lines[what].as_u64().unwrap();
    assert!(count("visible") > 500 && count("line_pixels") > 200, "{lines}");
    assert_eq!((count("missing"), count("stray"), count("unsure")), (0, 0, 0), "{lines}");
}
