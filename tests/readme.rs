//! README's first example as a new user has it: a project of its own, outside the workspace.

use std::path::Path;
use std::process::Command;
use std::{env, fs};

/// The first fenced block of `language` in README.md.
fn block(language: &str) -> String {
    let readme = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md")).unwrap();
    let rest = readme.split_once(&format!("```{language}")).expect("README has such a block").1;
    let rest = rest.split_once('\n').unwrap().1;
    rest.split_once("```").expect("the block ends").0.to_owned()
}

/// Its code compiles as a documentation test, too.
#[test]
#[ignore = "a minute, to compile every dependency anew: tools/soak"]
fn the_first_example_builds_as_a_fresh_project() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let project = env::temp_dir().join(format!("selvedge-readme-{}", std::process::id()));
    fs::create_dir_all(project.join("src")).unwrap();
    // the same crates, from this folder in place of the repository
    let source = "git = \"https://github.com/selvedge/selvedge\"";
    let snippet = block("toml");
    assert_eq!(snippet.matches(source).count(), 2, "README names two crates by the repository");
    let from = |crate_folder: &str| format!("path = {:?}", root.join(crate_folder));
    let dependencies = snippet.replacen(source, &from(""), 1).replacen(source, &from("crates/io"), 1);
    let manifest = format!("[package]\nname = \"first\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\n{dependencies}");
    fs::write(project.join("Cargo.toml"), manifest).unwrap();
    fs::write(project.join("src/main.rs"), block("rust,no_run")).unwrap();
    // the locked versions, which are available without a network
    fs::copy(root.join("Cargo.lock"), project.join("Cargo.lock")).unwrap();
    let target = env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), Into::into).join("readme");
    let output = Command::new(env!("CARGO"))
        .args(["check", "--offline", "--manifest-path"])
        .arg(project.join("Cargo.toml"))
        .env("CARGO_TARGET_DIR", target)
        .output()
        .expect("cargo runs");
    fs::remove_dir_all(&project).unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}
