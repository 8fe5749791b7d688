//! Many files in one call, and thumbnails.

use super::{refused, selvedge, text};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

fn sample(name: &str) -> String {
    format!("{}/../../samples/{name}", env!("CARGO_MANIFEST_DIR"))
}

/// A folder with a whole file, an invalid one, and another whole one, in this order.
pub(super) fn files() -> (tempfile::TempDir, Vec<String>) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    let names = ["a.step", "b.step", "c.csg"].map(path);
    fs::copy(sample("bracket.step"), &names[0]).expect("a copy");
    fs::write(&names[1], "ISO-10303-21;\nHEADER;\n").expect("written");
    fs::write(&names[2], "sphere(4);\n").expect("written");
    (folder, names.to_vec())
}

const SMALL: [&str; 4] = ["--size", "48x32", "--views", "iso,front"];

pub(super) fn render(files: &[String], output: &Path, more: &[&str]) -> std::process::Output {
    let output = output.display().to_string();
    let files = files.iter().map(String::as_str);
    let all: Vec<&str> =
        ["render"].into_iter().chain(files).chain(["-o", &output]).chain(SMALL).chain(more.iter().copied()).collect();
    selvedge(&all)
}

/// Rows of a table, each by the names of its columns.
pub(super) fn rows(path: &Path) -> Vec<std::collections::HashMap<String, String>> {
    csv::Reader::from_path(path).expect("a table").deserialize().map(|row| row.expect("a row")).collect()
}

/// Several views are drawn with frames in flight, but for pictures of one colour, which may show nothing.
#[test]
fn views_together_are_what_each_is_alone() {
    let (folder, names) = files();
    let draw = |model: &str, start: &str, size: &str, views: &str| {
        let path = |end: &str| folder.path().join(format!("{start}_{{view}}.{end}")).display().to_string();
        let depth = format!("depth={}", path("npy"));
        let output =
            selvedge(&["render", model, "-o", &path("png"), "--aov", &depth, "--size", size, "--views", views]);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    };
    let views = ["iso", "front", "top"];
    // one pixel, of a sphere, has one colour
    for (model, size) in [(&names[0], "48x32"), (&names[2], "1x1")] {
        draw(model, &format!("all{size}"), size, &views.join(","));
        let mut known = Vec::new();
        for view in views {
            draw(model, &format!("one{size}"), size, view);
            for end in ["png", "npy"] {
                let read = |start: &str| {
                    fs::read(folder.path().join(format!("{start}{size}_{view}.{end}"))).expect("a file of each view")
                };
                assert_eq!(read("all"), read("one"), "{size} {view}.{end}");
                known.push(read("all"));
            }
        }
        known.sort();
        known.dedup();
        assert!(size == "1x1" || known.len() == 2 * views.len(), "no two views are alike");
    }
}

#[test]
fn a_file_that_fails_costs_itself_only() {
    let (folder, names) = files();
    let pattern = folder.path().join("{stem}_{view}.png");
    let depth = format!("depth={}", folder.path().join("{stem}.npy").display());
    let manifest = folder.path().join("all.csv");
    let output = render(&names, &pattern, &["--aov", &depth, "--manifest", &manifest.display().to_string()]);
    let told = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{told}");
    assert!(told.contains("b.step:") && told.contains("DATA section"), "{told}");
    assert!(told.contains("2 of 3 files drawn, 0 skipped, 1 failed"), "{told}");

    // the same as each by itself
    for (name, stem) in [(&names[0], "a"), (&names[2], "c")] {
        let alone = folder.path().join(format!("alone_{stem}_{{view}}.png"));
        assert_eq!(render(std::slice::from_ref(name), &alone, &[]).status.code(), Some(0));
        for view in ["iso", "front"] {
            let read =
                |start: &str| fs::read(folder.path().join(format!("{start}{stem}_{view}.png"))).expect("a picture");
            assert_eq!(read(""), read("alone_"), "{stem} {view}");
            assert!(folder.path().join(format!("{stem}_{view}.npy")).is_file());
        }
    }

    let table = rows(&manifest);
    let of = |column: &str| table.iter().map(|row| row[column].as_str()).collect::<Vec<_>>();
    assert_eq!(of("status"), ["drawn", "drawn", "failed", "failed", "drawn", "drawn"]);
    assert_eq!(of("view"), ["iso", "front", "iso", "front", "iso", "front"]);
    assert!(table[2]["error"].contains("b.step") && table[0]["error"].is_empty());
    // sha256sum of `sphere(4);` and a line feed
    assert_eq!(table[4]["sha256"], "80f0b0189d147596e5ca9ec87427f8f326cea7fe1e4ad0602ed221488ef6bd90");
    let camera: serde_json::Value = serde_json::from_str(&table[0]["camera"]).expect("JSON");
    assert_eq!(camera["size"], serde_json::json!([48, 32]));
    assert!(table[0]["faces"].parse::<usize>().expect("a count") > 10 && table[0]["clamps"] == "0");
    assert!(table[0]["draw_s"].parse::<f64>().expect("seconds") > 0.0);
}

#[test]
fn what_is_there_is_left_alone() {
    let (folder, names) = files();
    let pattern = folder.path().join("{stem}_{view}.png");
    let names = [names[0].clone(), names[2].clone()];
    for view in ["iso", "front"] {
        fs::write(folder.path().join(format!("a_{view}.png")), "mine").expect("written");
    }
    fs::write(folder.path().join("c_iso.png"), "half").expect("written");
    let manifest = folder.path().join("all.csv");
    let output = render(&names, &pattern, &["--skip-existing", "--manifest", &manifest.display().to_string()]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(text(&output.stderr).contains("1 of 2 files drawn, 1 skipped, 0 failed"));
    assert_eq!(fs::read(folder.path().join("a_iso.png")).expect("a file"), b"mine");
    assert_ne!(fs::read(folder.path().join("c_iso.png")).expect("a file"), b"half");
    let states: Vec<_> = rows(&manifest).into_iter().map(|row| row["status"].clone()).collect();
    assert_eq!(states, ["skipped", "skipped", "drawn", "drawn"]);
}

#[test]
fn the_first_failure_ends_it_where_that_is_wanted() {
    let (folder, mut names) = files();
    names.swap(0, 1);
    let output = render(&names, &folder.path().join("{stem}_{view}.png"), &["--fail-fast"]);
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
    assert!(!folder.path().join("a_iso.png").exists());
}

/// A file that takes too long to read fails; nothing takes less than a nanosecond.
#[test]
fn a_file_has_its_time_to_be_read() {
    let (folder, names) = files();
    let names = [names[0].clone(), names[2].clone()];
    let output = render(&names, &folder.path().join("{stem}_{view}.png"), &["--limit-s", "1e-9"]);
    let told = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{told}");
    for name in ["a.step", "c.csg"] {
        assert!(told.contains(&format!("{name}: reading it takes longer than the limit of 1ns")), "{told}");
    }
    assert!(told.contains("more than --limit-s allows: "), "{told}");
    assert!(told.contains("0 of 2 files drawn, 0 skipped, 2 failed"), "{told}");
    refused(&["info", &names[0], "--limit-s", "0"], "above 0");
    refused(&["info", &names[0], "--limit-s", "1e-9"], "--limit-s");
    assert_eq!(selvedge(&["info", &names[0], "--limit-s", "1e9"]).status.code(), Some(0));
}

/// A hundred pictures of four million pixels take longer than a second, whose first part is enough to read a sphere.
#[test]
fn a_file_has_its_time_to_be_drawn() {
    let (folder, names) = files();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (manifest, views) = (path("all.csv"), (0..100).map(|n| format!("{n},20")).collect::<Vec<_>>().join(","));
    let output = path("{stem}_{view}.png");
    let limited = ["--limit-s", "1", "--manifest", &manifest];
    let drawn = ["render", &names[2], "-o", &output, "--size", "2000x2000", "--views", &views];
    let output = selvedge(&[&drawn[..], &limited].concat());
    let told = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{told}");
    assert!(told.contains("preparing") && told.contains("take longer than the limit of 1s"), "{told}");
    let table = rows(Path::new(&manifest));
    assert_eq!(table.len(), 100);
    let count = table.iter().take_while(|row| row["status"] == "drawn").count();
    let late = |row: &std::collections::HashMap<String, String>| {
        row["status"] == "failed" && row["error"].contains("c.csg: reading") && !Path::new(&row["output"]).exists()
    };
    assert!(count < 100 && table[count..].iter().all(late), "{count} were drawn");
    assert!(table[..count].iter().all(|row| Path::new(&row["output"]).is_file()), "pictures before stay");
}

/// The colour alone of the large picture takes 549 MiB on the device and as much beside it.
#[test]
fn a_file_has_its_memory() {
    let (folder, names) = files();
    let names = [names[0].clone(), names[2].clone()];
    let draw = |size: &str, limit: &str| {
        let output = folder.path().join(format!("{{stem}}_{size}.png")).display().to_string();
        selvedge(&["render", &names[0], &names[1], "-o", &output, "--size", size, "--limit-mib", limit])
    };
    let output = draw("12000x12000", "1024");
    let told = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{told}");
    for name in &names {
        let line = told.lines().find(|line| line.contains(name.as_str()));
        assert!(line.is_some_and(|line| line.contains("more than --limit-mib allows: ")), "{told}");
    }
    assert!(told.contains("0 of 2 files drawn, 0 skipped, 2 failed"), "{told}");
    let output = draw("48x32", "1024");
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let output = draw("48x32", "8");
    let told = text(&output.stderr);
    assert!(
        output.status.code() == Some(1) && told.contains("reading it takes more memory than the limit of 8.0 MiB"),
        "{told}"
    );
}

/// A file whose picture exceeds the limit leaves nothing of what it took: the next one is drawn as by itself.
#[test]
fn a_file_after_a_large_one_is_what_it_is_alone() {
    let (folder, _) = files();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (large, small) = (path("large.toml"), path("small.toml"));
    for (scene, size) in [(&large, 12_000), (&small, 48)] {
        let text = format!("selvedge = 1\n[picture]\nsize = [{size}, {size}]\n[file.model]\npath = 'c.csg'\n");
        fs::write(scene, text).expect("written");
    }
    let draw = |models: &[&String], output: &str| {
        let models = models.iter().map(|model| model.as_str());
        let all: Vec<&str> =
            ["render"].into_iter().chain(models).chain(["-o", output, "--limit-mib", "1024"]).collect();
        let output = selvedge(&all);
        (output.status.code(), text(&output.stderr))
    };
    let (status, told) = draw(&[&small], &path("alone.png"));
    assert_eq!(status, Some(0), "{told}");
    let (status, told) = draw(&[&large, &small], &path("{stem}.png"));
    assert!(status == Some(1) && told.contains("1 of 2 files drawn, 0 skipped, 1 failed"), "{told}");
    assert!(told.contains("large.toml") && told.contains("more than --limit-mib allows"), "{told}");
    let read = |name: &str| fs::read(path(name)).expect("a picture");
    assert_eq!(read("small.png"), read("alone.png"));
    assert!(!Path::new(&path("large.png")).exists());
}

#[test]
fn two_files_do_not_go_to_one_place() {
    let (folder, names) = files();
    let [a, c] = [&names[0], &names[2]];
    let out = |name: &str| folder.path().join(name).display().to_string();
    refused(&["render", a, c, "-o", &out("one.png")], "{stem} stands for a file's name");
    let other = folder.path().join("other");
    fs::create_dir(&other).expect("a folder");
    let twin = other.join("a.csg").display().to_string();
    fs::copy(c, &twin).expect("a copy");
    refused(&["render", a, &twin, "-o", &out("{stem}.png")], "both");
    refused(&["render", a, c, "-o", &out("{stem}.png"), "--aov", &format!("depth={}", out("d.npy"))], "{stem}");
}

/// The script of docs/many.md, as Slurm runs its tasks. A task that was killed is submitted again.
#[test]
fn an_array_of_tasks_draws_every_file_once() {
    let page = include_str!("../../../../docs/many.md");
    let begun = page.split("```sh\n").find(|block| block.starts_with("#!/bin/bash")).expect("a script");
    let script = begun.split("```").next().expect("its end").replace("512x512", "48x32");
    assert!(script.contains("--size 48x32") && script.contains("#SBATCH --array"), "{script}");
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    fs::create_dir(path("models")).expect("a folder");
    for stem in ["a", "b", "c"] {
        fs::copy(sample("bracket.step"), path(&format!("models/{stem}.step"))).expect("a copy");
    }
    fs::write(path("draw.sh"), script).expect("written");
    let programs = Path::new(env!("CARGO_BIN_EXE_selvedge")).parent().expect("a folder").display();
    let programs = format!("{programs}:{}", std::env::var("PATH").expect("a path"));
    let task = |id: &str| {
        let mut bash = Command::new("bash");
        bash.arg("draw.sh").current_dir(folder.path()).env("PATH", &programs);
        let ran = bash.env("SLURM_ARRAY_TASK_ID", id).env("SLURM_ARRAY_TASK_COUNT", "2").output().expect("bash");
        assert!(ran.status.success(), "task {id}: {}", text(&ran.stderr));
        let told = |row: &std::collections::HashMap<String, String>| (row["file"].clone(), row["status"].clone());
        rows(&path(&format!("out/{id}.csv"))).iter().map(told).collect::<Vec<_>>()
    };
    let all = |stem: &str, status: &str| vec![(format!("models/{stem}.step"), status.to_owned()); 3];
    assert_eq!(task("0"), [all("a", "drawn"), all("c", "drawn")].concat());
    assert_eq!(task("1"), all("b", "drawn"));
    for stem in ["a", "b", "c"] {
        for end in ["iso.png", "front.npy", "top.png", "top.npy"] {
            assert!(path(&format!("out/{stem}_{end}")).is_file(), "{stem} {end}");
        }
    }
    fs::remove_file(path("out/c_top.npy")).expect("it was not written yet");
    assert_eq!(task("0"), [all("a", "skipped"), all("c", "drawn")].concat());
    assert!(path("out/c_top.npy").is_file());
}

/// The call of the file that desktops read, with the specification's replacements for its fields.
#[test]
fn desktops_get_their_thumbnails() {
    let desktop = concat!(env!("CARGO_MANIFEST_DIR"), "/../../desktop/selvedge.thumbnailer");
    let entry = fs::read_to_string(desktop).expect("the entry");
    assert_eq!(entry.lines().next(), Some("[Thumbnailer Entry]"));
    let exec = entry.lines().find_map(|line| line.strip_prefix("Exec=")).expect("a call");
    let folder = tempfile::tempdir().expect("a folder");
    let output = folder.path().join(".thumbnail.J8TT7Z");
    let of = |model: &str, size: &str| {
        let mut words = exec.split(' ').map(|word| match word {
            "%i" => model.to_owned(),
            "%o" => output.display().to_string(),
            "%s" => size.to_owned(),
            word => word.to_owned(),
        });
        assert_eq!(words.next().as_deref(), Some("selvedge"));
        Command::new(env!("CARGO_BIN_EXE_selvedge")).args(words).output().expect("it runs")
    };
    let made = of(&sample("bracket.step"), "128");
    assert!(made.status.success(), "{}", text(&made.stderr));
    let decoder = png::Decoder::new(std::io::BufReader::new(fs::File::open(&output).expect("a picture")));
    let mut reader = decoder.read_info().expect("PNG");
    assert_eq!((reader.info().width, reader.info().height), (128, 128));
    let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
    reader.next_frame(&mut pixels).expect("pixels");
    let opaque = pixels.chunks(4).filter(|pixel| pixel[3] == 255).count();
    assert!(pixels[3] == 0 && opaque > 128 * 128 / 5, "{opaque} opaque pixels");

    let mime = fs::read_to_string(PathBuf::from(desktop).with_file_name("selvedge-mime.xml")).expect("the types");
    assert!(mime.contains("model/step") && entry.contains("model/step;"));
    fs::remove_file(&output).expect("removed");
    assert_eq!(of(&sample("none.step"), "128").status.code(), Some(2));
    assert_eq!(of(&sample("bracket.step"), "0").status.code(), Some(2));
    assert!(!output.exists());
}

/// `tools/install_desktop` puts both files where desktops look, and the types of the entry are known there.
#[test]
fn desktop_files_are_put_in_place() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let prefix = tempfile::tempdir().expect("a folder");
    let output =
        Command::new("bash").arg(root.join("tools/install_desktop")).arg(prefix.path()).output().expect("bash");
    assert!(output.status.success(), "{}", text(&output.stderr));
    let share = prefix.path().join("share");
    for (from, to) in [
        ("selvedge.thumbnailer", "thumbnailers/selvedge.thumbnailer"),
        ("selvedge-mime.xml", "mime/packages/selvedge.xml"),
    ] {
        let read = |path: PathBuf| fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        assert_eq!(read(share.join(to)), read(root.join("desktop").join(from)));
    }
    let has_database = Command::new("sh").args(["-c", "command -v update-mime-database"]).output().expect("sh");
    if has_database.status.success() {
        assert!(share.join("mime/model/step.xml").is_file(), "the database has the type");
    } else {
        assert!(text(&output.stderr).contains("update-mime-database is missing"));
    }
}
