//! `selvedge report`: the measurements of `tools/report` that need no other program, in one run.
//!
//! ```text
//!   part ─▶ a command of this program, in this process ─▶ its CSV table ─▶ a section of report.md
//! ```
//!
//! A part that fails has the reason in place of its table, and the run goes on.

use crate::args::{Cli, ReportArgs};
use crate::target::{self, MARKDOWN};
use crate::{Outcome, dispatch, is_of_device, output};
use anyhow::{Context, Result};
use clap::Parser;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::time::Instant;

const OF_SWEEP: &[&str] = &["model", "copies", "zoom", "tolerance_px", "patches", "all_ms", "wrong", "worst_shift_px"];
const OF_SCALE: &[&str] = &["model", "copies", "patches", "all_ms", "persistent_bytes", "transient_bytes"];
const OF_BENCH: &[&str] = &["model", "quantity", "unit", "median", "p95", "largest"];
const OF_TRIMS: &[&str] = &[
    "model",
    "way",
    "zoom",
    "width",
    "height",
    "trim_ms",
    "frame_ms",
    "turning_frame_ms",
    "trim_bytes",
    "wrong",
    "worst_shift_px",
];

/// A command, and the columns of its table that the report shows.
struct Part {
    title: &'static str,
    /// The command and its options, but for the device and the output.
    words: Vec<OsString>,
    /// The value of `--out`.
    out: PathBuf,
    table: PathBuf,
    columns: &'static [&'static str],
}

/// Runs all parts, and writes report.md after each.
pub fn run(args: &ReportArgs) -> Result<Outcome> {
    let inputs: Vec<&Path> = args.models.iter().map(PathBuf::as_path).collect();
    let path = args.out.join("report.md");
    target::folder(&inputs, &args.out, [("report.md".to_owned(), MARKDOWN)])?;
    let mut outcome = Outcome::Good;
    let mut text =
        format!("# Speed and error\n\nWritten by `selvedge report`, version {}.\n", env!("CARGO_PKG_VERSION"));
    for part in parts(args) {
        let start = Instant::now();
        let body = match part.measured(args) {
            Ok((of, table)) => {
                outcome = if of == Outcome::Broken { of } else { outcome };
                table
            }
            Err(error) if is_of_device(&error) => return Err(error),
            Err(error) => {
                outcome = Outcome::Broken;
                format!("Not measured: {error:#}")
            }
        };
        let (title, command, seconds) = (part.title, part.command(), start.elapsed().as_secs_f64());
        text += &format!("\n## {title}\n\n`selvedge {command}` took {seconds:.0} s.\n\n{body}\n");
        target::write(&path, |to| Ok(to.write_all(text.as_bytes())?))?;
    }
    output::print(&path.display().to_string())?;
    Ok(outcome)
}

/// All parts, in the order of the report.
fn parts(args: &ReportArgs) -> Vec<Part> {
    let pick = |quick, whole| if args.quick { quick } else { whole };
    let (all, first) = (args.models.as_slice(), &args.models[..1]);
    let size = pick("480x270", "1280x720");
    let samples = pick("500", "2000");
    let folder = |title, words, name: &str, table: &str, columns| {
        let out = args.out.join(name);
        Part { title, words, table: out.join(table), out, columns }
    };
    let file = |title, words, name: &str, columns| {
        let out = args.out.join(name);
        Part { title, words, table: out.clone(), out, columns }
    };
    let bench = ["--motion", "turn", "--judged", "1", "--size", size, "--frames", pick("5", "12")];
    let tolerances = ["--tolerances", "0.1,0.25,0.5,1,4", "--sizes", size, "--frames", "3", "--samples", samples];
    let zooms = ["--zooms", pick("1,10,1000", "1,10,1000,1000000"), "--sizes", size, "--samples", samples];
    let trims =
        ["--no-knobs", "--holes", pick("20", "50"), "--zooms", pick("1,10", "1,10,100,1000"), "--size", "400x400"];
    let sizes = ["--sizes", pick("200x200", "200x200,800x800,1600x1600"), "--frames", "2", "--samples", samples];
    let patches = ["--degrees", "3", "--distinct", "--copies", pick("1,10", "1,10,100")];
    let copies = ["--copies", pick("1,10,100", "1,10,100,1000,10000")];
    let scale = ["--sizes", size, "--frames", "2", "--samples", "0"];
    vec![
        folder("Frames of a turn", words("bench", all, &[&bench]), "frames", "bench.csv", OF_BENCH),
        file("Time against error", words("sweep", all, &[&tolerances]), "tolerances.csv", OF_SWEEP),
        file("Time against zoom", words("sweep", all, &[&zooms]), "zoom.csv", OF_SWEEP),
        folder("Trimming", words("trims", all, &[&trims, &sizes]), "trims", "trims.csv", OF_TRIMS),
        file("Scale: patches", words("sweep", &[], &[&patches, &scale]), "patches.csv", OF_SCALE),
        file("Scale: copies", words("sweep", first, &[&copies, &scale]), "copies.csv", OF_SCALE),
    ]
}

/// A command of models and options.
fn words(command: &str, models: &[PathBuf], options: &[&[&str]]) -> Vec<OsString> {
    let models = models.iter().map(|path| path.as_os_str().to_owned());
    let options = options.iter().flat_map(|some| some.iter()).map(OsString::from);
    std::iter::once(OsString::from(command)).chain(models).chain(options).collect()
}

impl Part {
    /// The command as a reader can run it.
    fn command(&self) -> String {
        let words: Vec<_> = self.words.iter().map(|word| word.to_string_lossy()).collect();
        words.join(" ")
    }

    /// The command with the program's name, the device and the output.
    fn whole(&self, args: &ReportArgs) -> Vec<OsString> {
        let mut words = vec![OsString::from("selvedge")];
        words.extend(self.words.iter().cloned());
        if let Some(device) = &args.device {
            words.extend([OsString::from("--device"), OsString::from(device)]);
        }
        words.extend([OsString::from("--out"), self.out.as_os_str().to_owned()]);
        words
    }

    /// Runs the command; its outcome, and its table as Markdown.
    fn measured(&self, args: &ReportArgs) -> Result<(Outcome, String)> {
        let cli = Cli::try_parse_from(self.whole(args))?;
        let outcome = dispatch(&cli.command)?;
        Ok((outcome, markdown(&self.table, self.columns)?))
    }
}

/// These columns of a CSV table, as Markdown.
fn markdown(path: &Path, columns: &[&str]) -> Result<String> {
    let mut reader = csv::Reader::from_path(path).with_context(|| format!("cannot read {}", path.display()))?;
    let head = reader.headers()?.clone();
    let at: Vec<usize> = columns.iter().filter_map(|&name| head.iter().position(|of| of == name)).collect();
    let mut lines = vec![row(at.iter().map(|&k| &head[k])), format!("|{}", "---|".repeat(at.len()))];
    for record in reader.records() {
        let record = record?;
        lines.push(row(at.iter().map(|&k| &record[k])));
    }
    Ok(lines.join("\n"))
}

fn row<'a>(cells: impl Iterator<Item = &'a str>) -> String {
    let cells: Vec<String> = cells.map(cell).collect();
    format!("| {} |", cells.join(" | "))
}

/// Numbers have three digits behind the point at most.
fn cell(text: &str) -> String {
    match text.parse::<f64>() {
        Ok(value) if text.contains('.') => format!("{value:.3}"),
        _ => text.replace('|', "\\|"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn args(quick: bool) -> ReportArgs {
        let models = vec![PathBuf::from("a.step"), PathBuf::from("b.igs")];
        ReportArgs { models, quick, device: Some("llvmpipe".into()), out: PathBuf::from("out") }
    }

    #[test]
    fn every_part_is_a_command_of_the_program() {
        for quick in [true, false] {
            let args = args(quick);
            for part in parts(&args) {
                let parsed = Cli::try_parse_from(part.whole(&args));
                assert!(parsed.is_ok(), "{}: {}", part.command(), parsed.unwrap_err());
            }
        }
    }

    #[test]
    fn a_table_has_the_chosen_columns_in_their_order() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.csv");
        std::fs::write(&path, "model,ms,spare\nfirst|one,1.23456,x\nsecond,7,y\n").unwrap();
        let table = markdown(&path, &["ms", "model", "absent"]).unwrap();
        assert_eq!(table, "| ms | model |\n|---|---|\n| 1.235 | first\\|one |\n| 7 | second |");
    }
}
