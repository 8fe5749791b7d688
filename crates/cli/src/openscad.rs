//! OpenSCAD's programs: `openscad` runs them and writes the flattened solid, which the library reads.
//!
//! ```text
//!   x.scad ──openscad -o - --export-format csg──▶ text ──▶ Import; files that it names lie beside x.scad
//! ```

use crate::session;
use anyhow::{Context, Result, bail};
use selvedge_io::import::{self, Facets, Import};
use selvedge_session::{Exceeded, Step};
use std::io::{self, ErrorKind, Read};
use std::path::{Path, absolute};
use std::process::{Command, Output, Stdio};
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// Between two looks at a program that runs.
const BETWEEN: Duration = Duration::from_millis(10);

/// Whether the file is a program of OpenSCAD's, by its name.
pub fn is_program(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("scad"))
}

/// Runs a program within the limits of a step and reads its output; OpenSCAD's warnings are passed on.
pub fn open(path: &Path, facets: Facets, step: &Step) -> Result<Import> {
    let name = path.display().to_string();
    // an absolute path is not taken for an option
    let mut command = Command::new("openscad");
    command.args(["-o", "-", "--export-format", "csg"]).arg(absolute(path)?).stdin(Stdio::null());
    let run = match ran(&mut command, step) {
        Err(error) if error.kind() == ErrorKind::NotFound => bail!(
            "{name}: openscad runs such programs and is not installed: install it (Debian: apt install openscad), or \
             give the .csg file that `openscad -o x.csg {name}` writes elsewhere"
        ),
        other => other.with_context(|| format!("{name}: openscad"))?.map_err(session::beyond)?,
    };
    let said = String::from_utf8_lossy(&run.stderr);
    let told = |kinds: &[&str]| {
        let of_kind = |line: &&str| kinds.iter().any(|kind| line.starts_with(kind));
        said.lines().filter(of_kind).map(str::to_owned).collect::<Vec<_>>()
    };
    if !run.status.success() {
        let errors = told(&["ERROR"]);
        let last = said.lines().last().unwrap_or("no word").to_owned();
        bail!("{name}: openscad failed ({}): {}", run.status, errors.first().unwrap_or(&last));
    }
    told(&["WARNING", "ERROR", "DEPRECATED"]).iter().for_each(|line| tracing::warn!("{name}: openscad: {line}"));
    Ok(import::scad(&run.stdout, &name, facets)?)
}

/// Runs a command until it and all that writes to its output have ended, or kills them when a limit is exceeded.
fn ran(command: &mut Command, step: &Step) -> io::Result<Result<Output, Exceeded>> {
    if step.is_bounded() {
        group::lead(command);
    }
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn()?;
    let stdout = gathered(child.stdout.take().expect("piped"));
    let stderr = gathered(child.stderr.take().expect("piped"));
    let all = |of: JoinHandle<io::Result<Vec<u8>>>| of.join().expect("a read does not panic");
    loop {
        // a wrapper may end before its program; its status is read last, since its number is the group's until then
        let has_told = stdout.is_finished() && stderr.is_finished();
        if has_told && let Some(status) = child.try_wait()? {
            return Ok(Ok(Output { status, stdout: all(stdout)?, stderr: all(stderr)? }));
        }
        if let Err(exceeded) = step.test() {
            group::kill(&mut child)?;
            child.wait()?;
            return Ok(Err(exceeded));
        }
        thread::sleep(BETWEEN);
    }
}

/// All that comes from a pipe, read beside other work.
fn gathered(mut pipe: impl Read + Send + 'static) -> JoinHandle<io::Result<Vec<u8>>> {
    thread::spawn(move || {
        let mut all = Vec::new();
        pipe.read_to_end(&mut all)?;
        Ok(all)
    })
}

/// A program with all that it starts: the `openscad` on the path may be a script that runs another program.
#[cfg(unix)]
mod group {
    use rustix::process::{Pid, Signal, kill_process_group};
    use std::io;
    use std::os::unix::process::CommandExt;
    use std::process::{Child, Command};

    /// The program leads a group. A terminal's Ctrl-C does not reach it there.
    pub fn lead(command: &mut Command) {
        command.process_group(0);
    }

    /// Kills the group that a program leads, which was not waited for.
    pub fn kill(leader: &mut Child) -> io::Result<()> {
        Ok(kill_process_group(Pid::from_child(leader), Signal::KILL)?)
    }
}

/// A program alone.
#[cfg(not(unix))]
mod group {
    use std::io;
    use std::process::{Child, Command};

    pub fn lead(_: &mut Command) {}

    pub fn kill(child: &mut Child) -> io::Result<()> {
        child.kill()
    }
}
