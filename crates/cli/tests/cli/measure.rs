//! `selvedge measure`: numbers against the formulas of a cylinder, names, and refusals.

use super::{refused, selvedge, text};
use serde_json::Value;
use std::f64::consts::PI;

/// A cylinder, placed twice, the first one its own height above the second: radius 5 inches, height 8.
const CAN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../io/src/import/step/tests/good.step");
const RADIUS: f64 = 127.0;
const HEIGHT: f64 = 203.2;

/// The rows of a call on the cylinder.
fn rows(more: &[&str]) -> Vec<Value> {
    let output = selvedge(&[&["measure", CAN, "--json"], more].concat());
    assert_eq!(output.status.code(), Some(0), "{more:?}: {}", text(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// A number of a row; its error is an estimate that is small.
#[track_caller]
fn number(row: &Value, what: &str) -> f64 {
    let values = row["values"].as_array().unwrap();
    let found = values.iter().find(|value| value["what"] == what).unwrap_or_else(|| panic!("no {what} in {row}"));
    let (value, error) = (found["value"].as_f64().unwrap(), found["error"].as_f64().unwrap());
    assert!((0.0..=1e-9 * value.abs().max(1.0)).contains(&error), "{found}");
    value
}

/// Equal within some thousand roundings.
#[track_caller]
fn close(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-11 * expected.abs(), "{found} instead of {expected}");
}

#[test]
fn faces_edges_and_parts_are_those_of_the_formulas() {
    let of_items = rows(&["--face", "61@1", "--face", "62@2", "--edge", "46@1", "--edge", "48@2", "--part", "1"]);
    let [side, disc, rim, seam, part] = &of_items[..] else { panic!("{of_items:?}") };
    assert_eq!((&side["items"][0], &rim["items"][0]), (&"face:61@1".into(), &"edge:46@1".into()));
    close(number(side, "area"), 2.0 * PI * RADIUS * HEIGHT);
    close(number(side, "radius"), RADIUS);
    close(number(disc, "area"), PI * RADIUS * RADIUS);
    close(number(rim, "length"), 2.0 * PI * RADIUS);
    close(number(rim, "diameter"), 2.0 * RADIUS);
    close(number(seam, "length"), HEIGHT);
    close(number(part, "area"), 2.0 * PI * RADIUS * (RADIUS + HEIGHT));
    close(number(part, "volume"), PI * RADIUS * RADIUS * HEIGHT);
    // without items all parts
    let all = rows(&[]);
    assert_eq!(all.iter().map(|row| row["items"][0].as_str().unwrap()).collect::<Vec<_>>(), ["part:1", "part:2"]);
    assert_eq!(all[0], *part);
    let height = |row: &Value| row["points"][0]["at"][2].as_f64().unwrap();
    close((height(&all[0]) - height(&all[1])).abs(), HEIGHT);
}

#[test]
fn distances_are_between_placed_items() {
    let names = |a: &'static str, b: &'static str| ["--between", a, b];
    let calls = [names("face:62@1", "face:63@1"), names("face:62@1", "face:62@2"), names("edge:46@1", "face:61@1")];
    let found = rows(&calls.concat());
    close(number(&found[0], "distance"), HEIGHT);
    assert!(number(&found[0], "angle").abs() < 1e-9 && found[0]["items"][1] == "face:63@1", "{}", found[0]);
    close(number(&found[1], "distance"), HEIGHT);
    // the rim is on the side
    assert!(number(&found[2], "distance") < 1e-9 && number(&found[2], "between axes") < 1e-9, "{}", found[2]);
}

#[test]
fn the_list_has_names_that_are_understood() {
    let listed = rows(&["--list"]);
    let mut names: Vec<&str> = listed.iter().map(|row| row["item"].as_str().unwrap()).collect();
    names.sort_unstable();
    let of_can = |placed: usize| {
        ["edge:46", "edge:47", "edge:48", "face:61", "face:62", "face:63"].map(|name| format!("{name}@{placed}"))
    };
    let mut expected = [of_can(1), of_can(2)].concat();
    expected.sort_unstable();
    assert_eq!(names, expected);
    let kind = |item: &str| &listed.iter().find(|row| row["item"] == item).unwrap()["kind"];
    assert_eq!((kind("face:61@1"), kind("edge:48@2")), (&"Cylinder".into(), &"Seam".into()));
    // a point of the rim
    let rim = listed.iter().find(|row| row["item"] == "edge:46@1").unwrap();
    let at: Vec<f64> = rim["at"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
    close(at[0].hypot(at[1]), RADIUS);
    let table = text(&selvedge(&["measure", CAN, "--edge", "48@1"]).stdout);
    let line = table.lines().find(|line| line.contains("length")).unwrap_or_else(|| panic!("{table}"));
    assert!(line.contains("edge:48@1") && line.contains("203.") && line.contains("mm"), "{table}");
}

/// Facets have no surfaces, but the file has something to draw.
const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";

#[test]
fn bad_requests_are_refused_in_a_sentence() {
    let refuse = |more: &[&str], message: &str| refused(&[&["measure", CAN], more].concat(), message);
    refused(&["measure"], "MODEL");
    refused(&["measure", "no/such/model.step"], "no/such/model.step");
    refuse(&["--face", "0"], "wants the number of a face above 0");
    refuse(&["--face", "12.3"], "wants the number of a face above 0");
    refuse(&["--edge", "x"], "wants the number of an edge above 0");
    refuse(&["--part", "0"], "wants the number of a placed part, from 1");
    refuse(&["--between", "face:61@1"], "2 values required");
    refuse(&["--between", "face:61@1", "61"], "wants a face or an edge");
    refuse(&["--list", "--face", "61"], "cannot be used with");
    refuse(&["--face", "99"], "good.step: there is no face:99 in the model: --list names what there is");
    refuse(&["--edge", "61@1"], "there is no edge:61@1 in the model");
    refuse(&["--face", "61"], "face:61 is in 2 placed parts: say in which, as in face:61@1");
    refuse(&["--face", "61@3"], "face:61@3: placed parts have numbers from 1 to 2");
    refuse(&["--part", "3"], "part:3: placed parts have numbers from 1 to 2");
    let folder = tempfile::tempdir().unwrap();
    let facets = folder.path().join("facets.obj");
    std::fs::write(&facets, SQUARE).unwrap();
    let facets = facets.to_str().unwrap();
    refused(&["measure", facets], "facets.obj: nothing to measure: no placed part has faces");
    refused(&["measure", facets, "--part", "1"], "part:1: there is nothing to measure");
}
