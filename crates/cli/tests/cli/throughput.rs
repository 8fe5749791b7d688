//! `bench --throughput`: what is printed and written of several frames in flight.

use super::{refused, selvedge, text};
use std::fs;

#[test]
fn pictures_per_second_are_printed_and_written() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let model = concat!(env!("CARGO_MANIFEST_DIR"), "/../../samples/bracket.step");
    // fewer frames than the warm-up has
    let bench = ["bench", model, "--size", "64x48", "--frames", "2", "--judged", "0", "--throughput", "--out", out];
    let output = selvedge(&bench);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("several frames in flight: "), "{}", text(&output.stdout));

    let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    let reports: serde_json::Value = serde_json::from_str(&read("bench.json")).unwrap();
    let told = |name: &str| reports[0]["throughput"][name].as_f64().unwrap();
    let (wall_ms, passes_ms) = (told("wall_ms"), told("passes_ms"));
    assert!(wall_ms > 0.0 && passes_ms > 0.0, "{reports}");
    assert!((told("pictures_per_second") * wall_ms - 1e3).abs() < 1e-6, "{reports}");
    assert!((told("wall_over_passes") * passes_ms - wall_ms).abs() < 1e-9 * wall_ms, "{reports}");
    let rows = read("bench.csv");
    let value = |name: &str| -> f64 {
        let row = rows.lines().find(|row| row.contains(name)).unwrap_or_else(|| panic!("no {name} in {rows}"));
        assert!(row.ends_with(",2"), "two frames: {row}");
        row.split(',').nth(3).unwrap().parse().unwrap()
    };
    let quantities = [
        ("in flight: pictures per second", "pictures_per_second"),
        ("in flight: mean wall clock", "wall_ms"),
        ("in flight: mean of all passes", "passes_ms"),
        ("in flight: wall clock over passes", "wall_over_passes"),
    ];
    for (row, field) in quantities {
        // the JSON reader is off by an ulp now and then
        assert!((value(row) / told(field) - 1.0).abs() < 1e-12, "{row}: {} and {}", value(row), told(field));
    }
}

#[test]
fn an_edited_loop_has_no_throughput() {
    refused(&["bench", "m.step", "--edit", "--throughput"], "cannot be used with");
}
