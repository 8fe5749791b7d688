//! Manifests of runs that are repeated, cut short or refused.

use super::many::{files, render, rows};
use super::{refused, selvedge, text};
use std::collections::HashMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// A row without its status, so that a picture that was drawn is compared with one that was skipped.
fn facts(row: &HashMap<String, String>) -> HashMap<String, String> {
    row.iter().filter(|(name, _)| *name != "status").map(|(name, cell)| (name.clone(), cell.clone())).collect()
}

fn states(table: &[HashMap<String, String>]) -> Vec<&str> {
    table.iter().map(|row| row["status"].as_str()).collect()
}

/// Files that wait for their place begin so.
fn waiting(folder: &Path) -> usize {
    let names = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").file_name());
    names.filter(|name| name.to_string_lossy().starts_with(".selvedge")).count()
}

#[test]
fn a_second_run_keeps_the_facts_of_the_first_one() {
    let (folder, names) = files();
    let pattern = folder.path().join("{stem}_{view}.png");
    let manifest = folder.path().join("all.csv");
    let table = manifest.display().to_string();
    let again = ["--skip-existing", "--manifest", &table];
    assert_eq!(render(&names, &pattern, &["--manifest", &table]).status.code(), Some(1));
    let first = rows(&manifest);
    assert_eq!(states(&first), ["drawn", "drawn", "failed", "failed", "drawn", "drawn"]);

    // the file that failed is tried again, and so is one with a picture that is not there
    fs::remove_file(folder.path().join("c_front.png")).expect("a picture");
    let output = render(&names, &pattern, &again);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    assert!(!text(&output.stderr).contains("old manifest"), "{}", text(&output.stderr));
    let second = rows(&manifest);
    assert_eq!(states(&second), ["skipped", "skipped", "failed", "failed", "drawn", "drawn"]);
    for k in [0, 1] {
        assert!(!first[k]["sha256"].is_empty() && !first[k]["camera"].is_empty() && !first[k]["draw_s"].is_empty());
        assert_eq!(facts(&second[k]), facts(&first[k]));
    }
    assert_eq!(second[2]["sha256"], "");

    // facts of rows that were skipped are kept, too
    assert_eq!(render(&names, &pattern, &again).status.code(), Some(1));
    let third = rows(&manifest);
    assert_eq!(states(&third), ["skipped", "skipped", "skipped", "skipped", "failed", "failed"]);
    for (k, known) in [(0, &first[0]), (1, &first[1]), (2, &second[4]), (3, &second[5])] {
        assert_eq!(facts(&third[k]), facts(known));
    }

    // rows of other pictures are not of this table, and the call says so
    let output = render(&names[2..], &pattern, &again);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let told = text(&output.stderr);
    assert!(told.contains("2 rows of the old manifest are of pictures that this call does not have"), "{told}");
    assert_eq!(states(&rows(&manifest)), ["skipped", "skipped"]);

    // without --skip-existing a table begins anew
    assert_eq!(render(&names[2..], &pattern, &["--manifest", &table]).status.code(), Some(0));
    assert_eq!(states(&rows(&manifest)), ["drawn", "drawn"]);
    assert_eq!(waiting(folder.path()), 0);
}

/// A row that failed has facts of no picture, not even of one that another call has written since.
#[test]
fn a_row_that_failed_lends_nothing() {
    let (folder, names) = files();
    let pattern = folder.path().join("{stem}_{view}.png");
    let manifest = folder.path().join("all.csv");
    let table = manifest.display().to_string();
    assert_eq!(render(&names[1..2], &pattern, &["--manifest", &table]).status.code(), Some(1));
    let failed = fs::read_to_string(&manifest).expect("a table").replace(",,iso,", ",0123abc,iso,");
    assert!(failed.contains("0123abc"), "{failed}");
    fs::write(&manifest, failed).expect("written");
    for view in ["iso", "front"] {
        fs::write(folder.path().join(format!("b_{view}.png")), "mine").expect("written");
    }
    let output = render(&names[1..2], &pattern, &["--skip-existing", "--manifest", &table]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let second = rows(&manifest);
    assert_eq!(states(&second), ["skipped", "skipped"]);
    assert!(second.iter().all(|row| row["sha256"].is_empty() && row["error"].is_empty()), "{second:?}");
}

/// A last row whose end is missing is left out: in a number, or in a message of several lines.
#[test]
fn a_torn_row_is_left_out_and_told() {
    let (folder, names) = files();
    let names = [names[0].clone(), names[2].clone()];
    let pattern = folder.path().join("{stem}_{view}.png");
    let manifest = folder.path().join("all.csv");
    let table = manifest.display().to_string();
    assert_eq!(render(&names, &pattern, &["--manifest", &table]).status.code(), Some(0));
    let whole = fs::read_to_string(&manifest).expect("a table");
    let first = rows(&manifest);
    let again = || {
        let output = render(&names, &pattern, &["--skip-existing", "--manifest", &table]);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        (rows(&manifest), text(&output.stderr))
    };
    let tells = |told: &str| told.contains("all.csv: the last row has no end");

    let (kept, told) = again();
    assert!(!tells(&told) && kept.iter().zip(&first).all(|(kept, first)| facts(kept) == facts(first)), "{told}");

    for (torn, whole_rows) in [
        (whole[..whole.len() - 2].to_owned(), 3),
        (whole[..whole.len() - 1].to_owned(), 3),
        (format!("{whole}{},,iso,x.png,failed,\"one line\n", names[1]), 4),
        (whole[..10].to_owned(), 0),
    ] {
        fs::write(&manifest, &torn).expect("written");
        let (kept, told) = again();
        assert!(tells(&told), "{told}");
        assert_eq!(states(&kept), ["skipped"; 4]);
        for (k, row) in kept.iter().enumerate() {
            if k < whole_rows {
                assert_eq!(facts(row), facts(&first[k]), "row {k} of {torn}");
            } else {
                assert_eq!((row["sha256"].as_str(), row["draw_s"].as_str()), ("", ""), "row {k} of {torn}");
            }
        }
    }
}

#[test]
fn a_run_that_cannot_begin_leaves_the_old_table() {
    let (folder, names) = files();
    let pattern = folder.path().join("{stem}_{view}.png");
    let manifest = folder.path().join("all.csv");
    let table = manifest.display().to_string();
    assert_eq!(render(&names[2..], &pattern, &["--manifest", &table]).status.code(), Some(0));
    let before = fs::read(&manifest).expect("a table");
    let no_device = ["--manifest", &table, "--device", "no device has this name"];
    for more in [&no_device[..], &[&no_device[..], &["--skip-existing"]].concat()] {
        let output = render(&names, &pattern, more);
        let told = text(&output.stderr);
        assert!(!output.status.success() && told.contains("no device has this name"), "{told}");
        assert_eq!(fs::read(&manifest).expect("a table"), before);
    }

    let output = pattern.display().to_string();
    let call = ["render", &names[2], "-o", &output, "--size", "48x32", "--view", "iso", "--skip-existing"];
    for other in ["name,size\nball,3\n", "name,size\nball,3"] {
        fs::write(&manifest, other).expect("written");
        refused(&[&call[..], &["--manifest", &table]].concat(), "not those of a manifest");
        assert_eq!(fs::read_to_string(&manifest).expect("a file"), other);
    }
    refused(&[&call[..], &["--manifest", "-"]].concat(), "not standard output");
    assert_eq!(waiting(folder.path()), 0);
}

/// Thirty pictures of four million pixels take longer than it takes to see two of their rows.
#[test]
fn a_run_that_is_killed_leaves_whole_rows() {
    let (folder, names) = files();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (table, output) = (path("all.csv"), path("{stem}_{view}.png"));
    let views = (0..30).map(|n| format!("{n},20")).collect::<Vec<_>>().join(",");
    let call = ["--views", &views, "-o", &output, "--manifest", &table, "--skip-existing"];
    let small = selvedge(&[&["render", &names[0], "--size", "48x32"][..], &call].concat());
    assert_eq!(small.status.code(), Some(0), "{}", text(&small.stderr));
    let first = rows(Path::new(&table));

    let mut killed = Command::new(env!("CARGO_BIN_EXE_selvedge"))
        .args([&["render", &names[0], &names[2], "--size", "2000x2000"][..], &call].concat())
        .stderr(Stdio::null())
        .spawn()
        .expect("the binary runs");
    // a header, the rows of the file that is skipped, and two of pictures
    let begun = Instant::now();
    while fs::read_to_string(&table).expect("a table at any time").lines().count() < 1 + 30 + 2 {
        assert!(begun.elapsed() < Duration::from_secs(300), "no pictures in five minutes");
        sleep(Duration::from_millis(5));
    }
    killed.kill().expect("it runs");
    killed.wait().expect("it ran");

    let left = fs::read_to_string(&table).expect("a table");
    assert!(left.ends_with('\n'), "half a row: {left}");
    let second = rows(Path::new(&table));
    let drawn = second.len() - 30;
    assert!((2..30).contains(&drawn), "{drawn} pictures were drawn before the end");
    for (row, known) in second.iter().zip(&first) {
        assert_eq!((row["status"].as_str(), facts(row)), ("skipped", facts(known)));
    }
    for row in &second[30..] {
        assert!(
            row["status"] == "drawn" && Path::new(&row["output"]).is_file() && row["sha256"].len() == 64,
            "{row:?}"
        );
    }
}
