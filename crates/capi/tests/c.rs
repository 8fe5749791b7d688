//! C programs are compiled with every warning an error and run under the address sanitizer: no error, no leak.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::{env, fs};

fn folder() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn root() -> PathBuf {
    folder().join("../..")
}

/// Where cargo puts the library for this test.
fn libraries() -> PathBuf {
    let folder = env::current_exe().expect("a path").parent().expect("a folder").to_owned();
    assert!(folder.join("libselvedge_c.so").is_file(), "{}: the library was not built", folder.display());
    folder
}

fn compiled(source: &Path, into: &Path) -> PathBuf {
    linked(source, into, &[])
}

/// Compiles the program and links it with further libraries.
fn linked(source: &Path, into: &Path, beside: &[&str]) -> PathBuf {
    let program = into.join(source.file_stem().expect("a name"));
    let libraries = libraries();
    let version = format!("-DSELVEDGE_TEST_VERSION=\"{}\"", env!("CARGO_PKG_VERSION"));
    let mut cc = Command::new("cc");
    cc.args(["-std=c11", "-Wall", "-Wextra", "-Werror", "-pedantic", "-g", "-fsanitize=address,undefined", &version]);
    cc.arg("-I").arg(folder().join("include")).arg(source).arg(folder().join("tests/keep_loaded.c"));
    cc.arg("-rdynamic").arg("-o").arg(&program).arg("-L").arg(&libraries).args(["-lselvedge_c", "-lm"]).args(beside);
    cc.arg(format!("-Wl,-rpath,{}", libraries.display()));
    let output = cc.output().expect("cc runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    program
}

/// The program with the library that it was linked to: cargo's own path for libraries has others.
fn watched(program: &Path) -> Command {
    let mut command = Command::new(program);
    let suppressions = format!("suppressions={}:print_suppressions=0", folder().join("tests/leaks.supp").display());
    command.env_remove("LD_LIBRARY_PATH").env("LSAN_OPTIONS", suppressions);
    command.env("UBSAN_OPTIONS", "halt_on_error=1").env_remove("ASAN_OPTIONS");
    command
}

fn good(output: &Output) {
    let said = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    assert!(output.status.success(), "{}\n{}\n{}", output.status, said(&output.stdout), said(&output.stderr));
}

#[test]
fn every_call_refuses_what_it_must() {
    let into = tempfile::tempdir().expect("a folder");
    let program = compiled(&folder().join("tests/border.c"), into.path());
    let bracket = root().join("samples/bracket.step");
    good(&watched(&program).arg(bracket).output().expect("it runs"));
}

#[test]
fn threads_share_a_renderer_and_handles_outlive_it() {
    let into = tempfile::tempdir().expect("a folder");
    let program = linked(&folder().join("tests/threads.c"), into.path(), &["-pthread"]);
    good(&watched(&program).output().expect("it runs"));
}

/// The sanitizer reports it.
#[test]
fn a_handle_that_is_not_freed_is_seen() {
    let into = tempfile::tempdir().expect("a folder");
    let source = into.path().join("leak.c");
    // several, for a copy of the last one's address may be left on the stack
    let text = r#"
#include <selvedge.h>
int main(void)
{
    SelvedgeModel* model;
    for (int i = 0; i < 8; ++i) {
        selvedge_open_bytes("sphere(1);", 10, "a.csg", NULL, &model);
    }
    model = NULL;
    return *selvedge_last_error() != 0;
}
"#;
    fs::write(&source, text).expect("written");
    let output = watched(&compiled(&source, into.path())).output().expect("it runs");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!output.status.success() && said.contains("detected memory leaks"), "{}: {said}", output.status);
}

#[test]
fn the_example_draws_a_picture() {
    let into = tempfile::tempdir().expect("a folder");
    let program = compiled(&root().join("examples/c/render.c"), into.path());
    let picture = into.path().join("bracket.png");
    let run = |model: &str| {
        let mut command = watched(&program);
        command.arg(root().join(model)).arg(&picture).args(["64", "48"]).output().expect("it runs")
    };
    let output = run("samples/bracket.step");
    good(&output);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(said.contains("faces") && said.contains("of 3072 pixels"), "{said}");
    assert_eq!(&fs::read(&picture).expect("a picture")[..8], b"\x89PNG\r\n\x1a\n");
    let refused = run("samples/none.step");
    assert_eq!(refused.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("none.step"));
}

#[test]
fn the_header_is_cpp_too() {
    let into = tempfile::tempdir().expect("a folder");
    let source = into.path().join("version.cpp");
    let text =
        "#include <selvedge.h>\nint main() { return selvedge_version() == nullptr || selvedge_last_error()[0]; }\n";
    fs::write(&source, text).expect("written");
    let program = into.path().join("version");
    let mut compiler = Command::new("c++");
    compiler.args(["-std=c++11", "-Wall", "-Wextra", "-Werror", "-pedantic", "-I"]).arg(folder().join("include"));
    compiler.arg(&source).arg("-o").arg(&program).arg("-L").arg(libraries()).arg("-lselvedge_c");
    good(&compiler.arg(format!("-Wl,-rpath,{}", libraries().display())).output().expect("c++ runs"));
    good(&Command::new(program).env_remove("LD_LIBRARY_PATH").output().expect("it runs"));
}

/// Needs Vulkan's header: on Debian `apt install libvulkan-dev`.
#[test]
fn the_host_records_into_its_own_command_buffer() {
    let into = tempfile::tempdir().expect("a folder");
    let program = linked(&root().join("examples/c/host.c"), into.path(), &["-lvulkan"]);
    let run = |model: &str| watched(&program).arg(root().join(model)).args(["96", "80"]).output().expect("it runs");
    let output = run("samples/bracket.step");
    good(&output);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    let seen: usize = said.split(' ').next().and_then(|word| word.parse().ok()).unwrap_or(0);
    assert!(seen > 300 && seen < 64 * 48 && said.contains(", 0 beside its rectangle"), "{said}");
    let refused = run("samples/none.step");
    assert_eq!(refused.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("none.step"));
}

/// On a device of the host's: mistakes are refused, instances change, also while another thread draws, models come and
/// go, and a pixel is read back.
/// Needs Vulkan's header, too.
#[test]
fn the_hosts_scene_lives() {
    let into = tempfile::tempdir().expect("a folder");
    let program = linked(&folder().join("tests/host_scene.c"), into.path(), &["-lvulkan", "-pthread"]);
    good(&watched(&program).output().expect("it runs"));
}

/// Null handles, null pointers and wrong sizes are refused; no device is made.
#[test]
fn a_hosts_mistakes_are_refused() {
    let into = tempfile::tempdir().expect("a folder");
    good(&watched(&compiled(&folder().join("tests/host_border.c"), into.path())).output().expect("it runs"));
}
