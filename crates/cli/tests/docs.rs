//! docs/cli.md is the output of `--help`: `SELVEDGE_WRITE_DOCS=1 cargo test -p selvedge-cli --test docs` writes it.

use std::process::Command;
use std::{fs, path::Path};

const HEAD: &str = "# The program `selvedge`

Made from `selvedge help COMMAND`. Results go to standard output, warnings to standard error.

The arrays of `--aov` are samples at pixel centres, row 0 on top. Model files: STEP, IGES, OBJ, STL, 3MF, AMF,
PLY, OFF, glTF, Rhino `.3dm`, BezierView `.bv`, OpenSCAD `.csg` and `.scad`, BRL-CAD `.asc`, `.selvedge`, and
[scenes](scene.md) in TOML. Built with `--no-default-features`, the program reads no Rhino files
and has no window.
";

/// The program's help text.
fn help(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_selvedge")).args(arguments).output().expect("the program runs");
    assert!(output.status.success(), "{arguments:?}");
    String::from_utf8(output.stdout).expect("help is text")
}

/// The names of the commands, from the list in the program's own help.
fn commands() -> Vec<String> {
    let all = help(&["--help"]);
    let list = all.split("Commands:\n").nth(1).expect("help lists commands").split("\n\n").next().unwrap();
    let names = list.lines().filter_map(|line| line.strip_prefix("  ")).filter(|line| !line.starts_with(' '));
    names.map(|line| line.split(' ').next().unwrap().to_owned()).filter(|name| name != "help").collect()
}

#[test]
fn the_reference_is_what_help_prints() {
    let mut text = HEAD.to_owned();
    for command in commands() {
        let help = help(&["help", &command]);
        let lines: Vec<_> = help.lines().map(str::trim_end).collect();
        text += &format!("\n## selvedge {command}\n\n```text\n{}\n```\n", lines.join("\n").trim());
    }
    assert!(text.contains("## selvedge render") && text.contains("--tolerance"), "help is not read");
    let has_window = cfg!(feature = "view");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/cli.md");
    if std::env::var_os("SELVEDGE_WRITE_DOCS").is_some() {
        assert!(has_window, "the program with its window writes it");
        fs::write(&path, &text).unwrap();
    }
    let mut written = fs::read_to_string(&path).unwrap_or_default();
    if !has_window {
        let from = written.find("\n## selvedge view\n").expect("a section of the window");
        let to = written[from + 1..].find("\n## ").map_or(written.len(), |n| from + 1 + n);
        written.replace_range(from..to, "");
    }
    assert!(written == text, "docs/cli.md is not what --help prints: SELVEDGE_WRITE_DOCS=1 writes it");
}
