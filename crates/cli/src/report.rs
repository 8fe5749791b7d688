//! `selvedge report`: the measurements of `tools/report` that need no other program, in one run.
//!
//! ```text
//!   part ─▶ a command of this program, in this process ─▶ its CSV table ─▶ a section of report.md
//! ```
//!
//! All models are read before the first part: one that cannot be read ends the run at once. A part that fails later has
//! the reason in place of its table, and the run goes on.

use crate::args::{Cli, ReadArgs, ReportArgs, SubdivideArgs};
use crate::target::{self, MARKDOWN};
use crate::{Outcome, dispatch, is_of_device, output, reading, remains};
use anyhow::{Context, Result, bail};
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

/// Reads all models, and measures them.
pub fn run(args: &ReportArgs) -> Result<Outcome> {
    let inputs: Vec<&Path> = args.models.iter().map(PathBuf::as_path).collect();
    if inputs.iter().any(|path| target::is_standard(path)) {
        bail!("each part reads the models anew, and `-` is standard input, which can be read once");
    }
    let outputs = target::folder(&inputs, &args.out, [("report.md".to_owned(), MARKDOWN)])?;
    for path in inputs {
        let import = reading::open(path, &ReadArgs::default(), &SubdivideArgs::default())?;
        remains::judge(path, &import.model)?;
        target::check_read(&import, &outputs)?;
    }
    measured(args, &parts(args))
}

/// Runs the parts, and writes report.md after each.
fn measured(args: &ReportArgs, parts: &[Part]) -> Result<Outcome> {
    let path = args.out.join("report.md");
    let mut outcome = Outcome::Good;
    let mut text =
        format!("# Speed and error\n\nWritten by `selvedge report`, version {}.\n", env!("CARGO_PKG_VERSION"));
    for part in parts {
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
        let (title, command, seconds) = (part.title, part.command(args), start.elapsed().as_secs_f64());
        text += &format!("\n## {title}\n\n```sh\n{command}\n```\n\nIt took {seconds:.0} s.\n\n{body}\n");
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
    /// The command as a reader can run it in a shell.
    fn command(&self, args: &ReportArgs) -> String {
        let words: Vec<_> = self.whole(args).iter().map(|word| quoted(&word.to_string_lossy())).collect();
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

/// A word of a command line, quoted for a shell where it must be.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./,=".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

/// These columns of a CSV table, as Markdown; an error where one is absent.
fn markdown(path: &Path, columns: &[&str]) -> Result<String> {
    let mut reader = csv::Reader::from_path(path).with_context(|| format!("cannot read {}", path.display()))?;
    let head = reader.headers()?.clone();
    let position = |&name: &&str| {
        head.iter().position(|of| of == name).with_context(|| format!("{} has no column {name}", path.display()))
    };
    let at = columns.iter().map(position).collect::<Result<Vec<usize>>>()?;
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
                assert!(parsed.is_ok(), "{}: {}", part.command(&args), parsed.unwrap_err());
            }
        }
    }

    #[test]
    fn a_reader_can_run_the_commands() {
        let models = vec![PathBuf::from("it's a part.step")];
        let args = ReportArgs { models, quick: true, device: Some("RTX 4090".into()), out: PathBuf::from("my out") };
        let copies = parts(&args).pop().unwrap();
        let sweep = r"selvedge sweep 'it'\''s a part.step' --copies 1,10,100 --sizes 480x270 --frames 2 --samples 0";
        let places = "--device 'RTX 4090' --out 'my out/copies.csv'";
        assert_eq!(copies.command(&args), format!("{sweep} {places}"));
        assert_eq!(quoted(""), "''");
    }

    #[test]
    fn a_table_has_the_chosen_columns_in_their_order() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.csv");
        std::fs::write(&path, "model,ms,spare\nfirst|one,1.23456,x\nsecond,7,y\n").unwrap();
        let table = markdown(&path, &["ms", "model"]).unwrap();
        assert_eq!(table, "| ms | model |\n|---|---|\n| 1.235 | first\\|one |\n| 7 | second |");
        let error = markdown(&path, &["ms", "absent"]).unwrap_err();
        assert!(error.to_string().ends_with("a.csv has no column absent"), "{error}");
    }

    /// A flat patch, a folder for the output, and arguments for both.
    fn small() -> (tempfile::TempDir, ReportArgs) {
        let folder = tempfile::tempdir().unwrap();
        let (model, out) = (folder.path().join("a.bv"), folder.path().join("out"));
        std::fs::write(&model, "4\n1\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n").unwrap();
        std::fs::create_dir(&out).unwrap();
        (folder, ReportArgs { models: vec![model], quick: true, device: None, out })
    }

    /// The parts of a report, in small: each command writes the columns that its tables show.
    #[test]
    fn the_commands_write_what_the_report_shows() {
        let (_folder, args) = small();
        let models = args.models.as_slice();
        let turn = ["--motion", "turn", "--judged", "1", "--size", "48x32", "--frames", "2"];
        let sweep = ["--sizes", "48x32", "--frames", "1", "--samples", "20"];
        let trims = ["--no-knobs", "--holes", "1", "--zooms", "1", "--size", "32x32", "--sizes", "32x32"];
        let few = ["--frames", "1", "--samples", "20"];
        let part = |title, words, name: &str, table: &str, columns| {
            let out = args.out.join(name);
            Part { title, words, table: out.join(table), out, columns }
        };
        let table = args.out.join("sweep.csv");
        let parts = [
            part("Turn", words("bench", models, &[&turn]), "turn", "bench.csv", OF_BENCH),
            part("Trims", words("trims", &[], &[&trims, &few]), "trims", "trims.csv", OF_TRIMS),
            Part {
                title: "Sweep",
                words: words("sweep", models, &[&sweep]),
                out: table.clone(),
                table: table.clone(),
                columns: OF_SWEEP,
            },
        ];
        assert_eq!(measured(&args, &parts).unwrap(), Outcome::Good);
        let text = std::fs::read_to_string(args.out.join("report.md")).unwrap();
        for (title, columns) in [("Turn", OF_BENCH), ("Trims", OF_TRIMS), ("Sweep", OF_SWEEP)] {
            let (_, section) = text.split_once(&format!("\n## {title}\n")).unwrap();
            let section = section.split("\n## ").next().unwrap();
            let rows = section.split_once(&row(columns.iter().copied())).unwrap().1;
            assert!(rows.lines().count() > 2, "{title}: {section}");
        }
        assert!(markdown(&table, OF_SCALE).is_ok());
    }

    #[test]
    fn a_part_that_fails_has_its_reason_and_the_next_ones_follow() {
        let (folder, args) = small();
        let absent = [folder.path().join("absent.bv")];
        let part = |title| Part {
            title,
            words: words("bench", &absent, &[]),
            out: args.out.join(title),
            table: args.out.join(title).join("bench.csv"),
            columns: OF_BENCH,
        };
        assert_eq!(measured(&args, &[part("one"), part("two")]).unwrap(), Outcome::Broken);
        let text = std::fs::read_to_string(args.out.join("report.md")).unwrap();
        assert_eq!(text.matches("Not measured: ").count(), 2, "{text}");
    }
}
