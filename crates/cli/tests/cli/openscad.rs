//! The `openscad` on the path runs an OpenSCAD program, within the limits of its file. Here it is a shell script.

use super::text;
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// A folder with `a.scad`, and the only one on the path.
struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        fs::write(folder.path("a.scad"), "cube(2);").unwrap();
        folder
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Makes the `openscad`.
    fn script(&self, script: &str) {
        let program = self.path("openscad");
        fs::write(&program, format!("#!/bin/sh\n{script}\n")).unwrap();
        fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
    }

    fn info(&self, more: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_selvedge"));
        command.arg("info").arg(self.path("a.scad")).args(more).env("PATH", self.0.path());
        command
    }

    /// Exit status, standard output, standard error.
    fn run(&self, more: &[&str]) -> (Option<i32>, String, String) {
        let output = self.info(more).output().unwrap();
        (output.status.code(), text(&output.stdout), text(&output.stderr))
    }
}

/// Waits until it is so; busy machines take long to start a process.
#[track_caller]
fn soon(what: &str, is_so: impl Fn() -> bool) {
    let begun = Instant::now();
    while !is_so() {
        assert!(begun.elapsed() < Duration::from_secs(20), "{what}");
        thread::sleep(Duration::from_millis(5));
    }
}

/// Waits until a process has ended, whose number a file holds. One that was killed may keep its number, without a
/// command, until its parent waits.
#[track_caller]
fn ends(file: &Path) {
    let process = fs::read_to_string(file).unwrap();
    let command = format!("/proc/{}/cmdline", process.trim());
    soon("the script's program lives on", || !fs::read(&command).is_ok_and(|line| !line.is_empty()));
}

#[test]
fn a_program_is_run_and_its_messages_are_passed_on() {
    let folder = Folder::new();
    let (status, _, told) = folder.run(&[]);
    assert!(status == Some(2) && told.contains("apt install openscad"), "{told}");
    folder.script("echo 'ERROR: Parser error' >&2; exit 1");
    let (status, _, told) = folder.run(&[]);
    assert!(status == Some(2) && told.contains("openscad failed") && told.contains("Parser error"), "{told}");
    folder.script("echo 'WARNING: odd' >&2; echo 'cube(size = [2, 3, 4], center = false);'");
    let (status, out, told) = folder.run(&[]);
    assert!(status == Some(0) && out.contains("box 2.000 x 3.000 x 4.000 mm") && told.contains("odd"), "{out} {told}");
}

/// The time of a program that never ends, and of one that has ended, but has started another that holds the pipes.
#[test]
fn its_time_is_that_of_the_file() {
    let folder = Folder::new();
    folder.script("while :; do :; done");
    let (status, _, told) = folder.run(&["--limit-s", "0.5"]);
    assert!(status == Some(2) && told.contains("a.scad: reading it takes longer than the limit of 500ms"), "{told}");
    let process = folder.path("process");
    folder.script(&format!("/bin/sleep 120 & echo $! > '{}'; echo 'cube(2);'", process.display()));
    let begun = Instant::now();
    let (status, _, told) = folder.run(&["--limit-s", "0.5"]);
    assert!(status == Some(2) && told.contains("more than --limit-s allows: "), "{told}");
    assert!(begun.elapsed() < Duration::from_secs(60), "it did not wait for the program");
    ends(&process);
}

/// A script whose text doubles up to 256 MiB, more than the limit and what the program itself holds.
#[test]
fn its_memory_is_that_of_the_file() {
    let folder = Folder::new();
    folder.script("x=0123456789abcdef; while [ ${#x} -lt 200000000 ]; do x=$x$x; done; /bin/sleep 60; echo 'cube(2);'");
    let (status, _, told) = folder.run(&["--limit-mib", "200"]);
    assert_eq!(status, Some(2), "{told}");
    assert!(told.contains("more than --limit-mib allows: ") && told.contains("the limit of 200.0 MiB: "), "{told}");
}

/// A terminal's Ctrl-C reaches only this program's group, and SIGKILL leaves no code of it that could end another.
#[test]
fn it_ends_with_this_program() {
    let folder = Folder::new();
    let process = folder.path("process");
    let script = format!("/bin/sleep 120 & echo $! > '{0}.new'; /bin/mv '{0}.new' '{0}'; wait", process.display());
    folder.script(&script);
    for signal in ["TERM", "KILL"] {
        let mut running = folder.info(&[]).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        soon("openscad is not started", || process.exists());
        let kill = format!("kill -s {signal} {}", running.id());
        assert!(Command::new("sh").args(["-c", &kill]).status().unwrap().success());
        assert!(!running.wait().unwrap().success());
        ends(&process);
        fs::remove_file(&process).unwrap();
    }
}
