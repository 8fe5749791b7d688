//! OpenSCAD's programs: the installed `openscad` runs them, and writes flattened text.
//!
//! ```text
//!   x.scad ──openscad -o - --export-format csg──▶ text ──▶ scad; files that it names lie beside x.scad
//!                     │
//!                     ╰─ Stage::Program, a hundred times a second: its callback may unwind
//! ```
//!
//! `openscad` leads a group of processes. All of the group is killed when the callback unwinds, when the text is too
//! long, and when this process ends for any reason.

use super::source::{self, OtherFiles};
use super::{Import, ImportError, Options, Place, Stage, Warnings, decoded, scad};
use std::io::{self, BufRead, BufReader, ErrorKind, Read};
use std::path::{Path, absolute};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::Duration;

/// Between two reports of a program that runs.
const BETWEEN: Duration = Duration::from_millis(10);

/// Bytes of a line of messages; the rest of a longer one counts as a line of its own.
const MOST_LINE: u64 = 1000;

/// The last line of the shell script's messages where there is no such program. Its exit status says less: a program
/// that runs may end with any.
const MISSING: &str = "selvedge: no such program";

/// The shell script that runs its arguments, from the second on, as a command; the first is [`MISSING`]. Its input is
/// an empty pipe, which ends when this process closes it or ends. The process in brackets waits for that end, and then
/// kills its group.
#[cfg(unix)]
const WATCHED: &str = concat!(
    r#"missing=$1; shift; command -v "$1" >/dev/null 2>&1 || { echo "$missing" >&2; exit 1; }; "#,
    r#"exec 3<&0; (read -r _ <&3; kill -s KILL 0) >/dev/null 2>&1 & exec 3<&-; "$@" </dev/null"#,
);

/// Whether the file is a program of OpenSCAD's, by its name.
pub(super) fn is_program(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("scad"))
}

/// Runs a program by the `openscad` on the path, and reads its output.
pub(super) fn open(path: &Path, name: &str, options: &Options<'_>) -> Result<Import, ImportError> {
    open_by(Path::new("openscad"), path, name, options)
}

fn open_by(openscad: &Path, path: &Path, name: &str, options: &Options<'_>) -> Result<Import, ImportError> {
    // its errors are those of any file
    source::load(path, name, options)?;
    let Output { status, text, said } = run(openscad, path, name, options)?;
    if !status.success() {
        if said.last == MISSING {
            return Err(not_installed(name));
        }
        let last = if said.last.is_empty() { "no word".to_owned() } else { said.last };
        let message = format!("openscad failed ({status}): {}", said.error.unwrap_or(last));
        return Err(ImportError::OpenScad { file: name.to_owned(), message });
    }
    options.tell(Stage::Parse { bytes: text.len() as u64 });
    let files = OtherFiles::new(name, path.parent(), options);
    let mut import = decoded(&text, name, |text| scad::read(text, name, options, files))?;
    let mut warnings = said.warnings.finish(&mut import.report);
    warnings.append(&mut import.warnings);
    Ok(Import { warnings, ..import })
}

fn not_installed(name: &str) -> ImportError {
    let message = format!(
        "openscad runs such programs and is not installed: install it (Debian: apt install openscad), or give the .csg \
         file that `openscad -o x.csg {name}` writes elsewhere"
    );
    ImportError::OpenScad { file: name.to_owned(), message }
}

/// The end of a program.
struct Output {
    status: ExitStatus,
    text: Vec<u8>,
    said: Said,
}

/// Runs a program until it and all that writes to its output have ended: a wrapper may end before its program.
fn run(openscad: &Path, path: &Path, name: &str, options: &Options<'_>) -> Result<Output, ImportError> {
    let refused = |error: io::Error| match error.kind() {
        ErrorKind::NotFound => not_installed(name),
        _ => ImportError::OpenScad { file: name.to_owned(), message: format!("openscad: {error}") },
    };
    let mut command = command(openscad);
    // an absolute path is not taken for an option
    command.args(["-o", "-", "--export-format", "csg"]).arg(absolute(path).map_err(refused)?);
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut running = Running(command.spawn().map_err(refused)?);
    let process = running.0.id();
    let wait = || {
        options.tell(Stage::Program { process });
        thread::sleep(BETWEEN);
    };
    let limit = options.most_bytes();
    let (stdout, stderr) = (running.0.stdout.take().expect("piped"), running.0.stderr.take().expect("piped"));
    let text = thread::spawn(move || {
        let mut bytes = Vec::new();
        stdout.take(limit + 1).read_to_end(&mut bytes).map(|_| bytes)
    });
    let said = Said::new(name);
    let said = thread::spawn(move || said.heard(stderr));
    wait();
    while !text.is_finished() {
        wait();
    }
    let text = text.join().expect("a read does not panic").map_err(refused)?;
    if text.len() as u64 > limit {
        return Err(ImportError::TooLarge { file: name.to_owned(), limit });
    }
    while !said.is_finished() {
        wait();
    }
    let said = said.join().expect("a read does not panic").map_err(refused)?;
    let status = loop {
        match running.0.try_wait().map_err(refused)? {
            Some(status) => break status,
            None => wait(),
        }
    };
    Ok(Output { status, text, said })
}

/// The command of a program that leads a group, and is killed with it when its input ends.
#[cfg(unix)]
fn command(program: &Path) -> Command {
    use std::os::unix::process::CommandExt;
    let mut command = Command::new("/bin/sh");
    command.process_group(0).args(["-c", WATCHED, "sh", MISSING]).arg(program);
    command
}

/// The command of a program alone.
#[cfg(not(unix))]
fn command(program: &Path) -> Command {
    Command::new(program)
}

/// A program that runs; it is killed when this is dropped, with its group where there is one.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        drop(self.0.stdin.take());
        // it may have ended; no error is left that anyone could mend
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Messages of a program.
struct Said {
    warnings: Warnings,
    /// Its first error.
    error: Option<String>,
    /// Its last line that is not empty.
    last: String,
}

impl Said {
    fn new(name: &str) -> Self {
        Self { warnings: Warnings::new(name), error: None, last: String::new() }
    }

    /// All that comes from a pipe; what is kept of it is bounded.
    fn heard(mut self, pipe: impl Read) -> io::Result<Self> {
        let mut pipe = BufReader::new(pipe);
        loop {
            let mut line = Vec::new();
            if pipe.by_ref().take(MOST_LINE).read_until(b'\n', &mut line)? == 0 {
                return Ok(self);
            }
            let line = String::from_utf8_lossy(&line).trim_end().to_owned();
            if ["WARNING", "ERROR", "DEPRECATED"].iter().any(|kind| line.starts_with(kind)) {
                self.warnings.push("openscad", || Place::File, || line.clone());
            }
            if self.error.is_none() && line.starts_with("ERROR") {
                self.error = Some(line.clone());
            }
            if !line.is_empty() {
                self.last = line;
            }
        }
    }
}

/// A small shell script stands for `openscad`.
#[cfg(unix)]
#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::os::unix::fs::PermissionsExt;
    use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
    use std::path::PathBuf;
    use std::sync::{Mutex, MutexGuard, PoisonError};
    use std::time::Instant;

    /// Another test's new process may hold the script open for writing, for which the system refuses to run it.
    static ALONE: Mutex<()> = Mutex::new(());

    /// A folder with a program of OpenSCAD's, and the script that runs it.
    struct Folder {
        path: PathBuf,
        _alone: MutexGuard<'static, ()>,
    }

    impl Folder {
        fn new(of: &str, script: &str) -> Self {
            let alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
            let path = std::env::temp_dir().join(format!("selvedge-scad-{of}-{}", std::process::id()));
            fs::create_dir_all(&path).unwrap();
            fs::write(path.join("a.scad"), "cube(2);").unwrap();
            let program = path.join("openscad");
            fs::write(&program, format!("#!/bin/sh\n{script}\n")).unwrap();
            fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
            Self { path, _alone: alone }
        }

        fn open(&self, options: &Options<'_>) -> Result<Import, ImportError> {
            open_by(&self.path.join("openscad"), &self.path.join("a.scad"), "a.scad", options)
        }
    }

    impl Drop for Folder {
        fn drop(&mut self) {
            fs::remove_dir_all(&self.path).unwrap();
        }
    }

    /// Whether a process runs. One that was killed may keep its number, without a command, until its parent waits.
    #[cfg(target_os = "linux")]
    fn lives(process: &str) -> bool {
        fs::read(format!("/proc/{}/cmdline", process.trim())).is_ok_and(|line| !line.is_empty())
    }

    #[test]
    fn its_text_its_messages_and_its_stages_arrive() {
        let script = "echo 'ECHO: 1' >&2; echo 'WARNING: odd' >&2; echo 'cube(size = [2, 3, 4], center = false);'";
        let folder = Folder::new("text", script);
        let stages = Mutex::new(Vec::new());
        let tell = |stage| stages.lock().unwrap().push(stage);
        let import = folder.open(&Options { progress: Some(&tell), ..Options::default() }).unwrap();
        assert_eq!(import.model.solids.len(), 1);
        let told: Vec<_> = import.warnings.iter().map(ToString::to_string).collect();
        assert_eq!(told, ["a.scad: openscad: WARNING: odd"]);
        let stages = stages.into_inner().unwrap();
        assert_eq!(stages[0], Stage::Read { bytes: 8 });
        let ran = stages.iter().filter(|stage| matches!(stage, Stage::Program { .. })).count();
        assert!(ran > 0 && matches!(stages[1 + ran], Stage::Parse { .. }), "{stages:?}");
    }

    #[test]
    fn its_failures_are_told() {
        let told = |script: &str| {
            let folder = Folder::new("failure", script);
            let error = folder.open(&Options::default()).unwrap_err();
            assert!(matches!(error, ImportError::OpenScad { .. }), "{error:?}");
            error.to_string()
        };
        assert!(told("echo 'ERROR: odd' >&2; echo end >&2; exit 1").ends_with(": ERROR: odd"));
        assert!(told("echo; echo end >&2; exit 1").ends_with(": end"));
        assert!(told("exit 3").contains("exit status: 3"));
        // the exit status of a shell whose command is not found says nothing of openscad
        assert!(told("echo 'no such library' >&2; exit 127").ends_with("(exit status: 127): no such library"));
        let none = Folder::new("none", "");
        fs::remove_file(none.path.join("openscad")).unwrap();
        let error = none.open(&Options::default()).unwrap_err();
        assert!(error.to_string().contains("apt install openscad"), "{error}");
        let missing = none.path.join("b.scad");
        let error = open(&missing, "b.scad", &Options::default()).unwrap_err();
        assert!(matches!(error, ImportError::Read { .. }), "{error}");
    }

    /// It writes for ever, and a pipe that is closed does not end it.
    #[test]
    fn its_text_is_bounded() {
        let folder = Folder::new("long", "trap '' PIPE; while :; do echo 'cube(size = 1);'; done 2>/dev/null");
        let begun = Instant::now();
        let error = folder.open(&Options { most_bytes: Some(10_000), ..Options::default() }).unwrap_err();
        assert!(matches!(error, ImportError::TooLarge { limit: 10_000, .. }), "{error}");
        assert!(begun.elapsed() < Duration::from_secs(20));
    }

    /// A callback unwinds, as those of limits and of a cancelled file do. The kernel needs a millisecond; the rest of
    /// the time is for busy machines.
    #[test]
    fn it_ends_with_all_that_it_started_when_the_callback_unwinds() {
        let folder = Folder::new("stopped", "");
        let started = folder.path.join("started");
        let script = format!("#!/bin/sh\nsleep 120 & echo $! > '{0}.new'; mv '{0}.new' '{0}'; wait", started.display());
        fs::write(folder.path.join("openscad"), script).unwrap();
        let leader = Mutex::new(0);
        let tell = |stage| {
            if let Stage::Program { process } = stage {
                *leader.lock().unwrap() = process;
                if started.exists() {
                    resume_unwind(Box::new("stopped"));
                }
            }
        };
        let options = Options { progress: Some(&tell), ..Options::default() };
        let cause = catch_unwind(AssertUnwindSafe(|| folder.open(&options))).expect_err("it unwinds");
        assert_eq!(cause.downcast_ref::<&str>(), Some(&"stopped"));
        #[cfg(target_os = "linux")]
        {
            let leader = leader.into_inner().unwrap();
            assert!(!Path::new(&format!("/proc/{leader}")).exists(), "it was waited for");
            let (asleep, begun) = (fs::read_to_string(&started).unwrap(), Instant::now());
            while lives(&asleep) {
                assert!(begun.elapsed() < Duration::from_secs(5), "what it started lives on");
                thread::sleep(Duration::from_millis(5));
            }
        }
    }
}
