//! The command line: draw a CAD model, describe it, prove the picture right, measure the cost.
//!
//! ```text
//!   render   model ─▶ picture and images      info    content of a file
//!   check    picture against exact rays       bench   time and memory beside the error
//!   trims    ways to trim, side by side       sweep   time against error, over many settings
//!   report   all of these as one document
//!   convert  model ─▶ the engine's own form
//!   export   model ─▶ STEP file                draw    lines of a view ─▶ SVG
//!   measure  lengths, areas, volumes, distances
//!   view     models in a window
//!   thumbnail model ─▶ small picture
//!   devices  features and limits of the system's GPUs
//! ```
//!
//! Results go to standard output, everything else to standard error.

mod args;
mod bench;
mod camera;
mod check;
mod closer;
mod convert;
mod cut;
mod device;
mod draw;
mod edit;
mod export;
mod heap;
mod info;
mod measure;
mod model_renderer;
mod npy;
mod output;
mod path;
mod progress;
mod reading;
mod remains;
mod render;
mod report;
mod series;
mod sheet;
mod shown;
mod sweep;
mod target;
mod thumbnail;
mod trims;
mod values;
mod verdict;
#[cfg(feature = "view")]
mod view;

use args::{Cli, Command};
use clap::Parser;
use selvedge::headless::HeadlessError;
use std::io::IsTerminal;
use std::process::ExitCode;

/// The outcome of a command that ran to its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Outcome {
    /// The command did its work, and every tested promise was kept.
    Good,
    /// A picture breaks the accuracy promise, or some of many files failed.
    Broken,
}

/// Exit statuses; the help text lists them (`args::STATUSES`).
const BROKEN: u8 = 1;
const USAGE: u8 = 2;
const DEVICE: u8 = 3;

fn main() -> ExitCode {
    let cli = Cli::parse();
    let level = match cli.verbose {
        0 => tracing::Level::WARN,
        1 => tracing::Level::INFO,
        _ => tracing::Level::DEBUG,
    };
    tracing_subscriber::fmt()
        .with_max_level(level)
        .with_writer(std::io::stderr)
        .with_ansi(std::io::stderr().is_terminal())
        .without_time()
        .with_target(false)
        .init();
    match dispatch(&cli.command) {
        Ok(Outcome::Good) => ExitCode::SUCCESS,
        Ok(Outcome::Broken) => ExitCode::from(BROKEN),
        Err(error) => {
            eprintln!("selvedge: {}", explained(&error));
            ExitCode::from(if is_of_device(&error) { DEVICE } else { USAGE })
        }
    }
}

/// Runs a command.
fn dispatch(command: &Command) -> anyhow::Result<Outcome> {
    match command {
        Command::Render(args) => render::run(args),
        Command::Draw(args) => draw::run(args),
        Command::Info(args) => info::run(args),
        Command::Measure(args) => measure::run(args),
        Command::Export(args) => export::run(args),
        Command::Check(args) => check::run(args),
        Command::Bench(args) => bench::run(args),
        Command::Sweep(args) => sweep::run(args),
        Command::Trims(args) => trims::run(args),
        Command::Report(args) => report::run(args),
        Command::Thumbnail(args) => thumbnail::run(args),
        Command::Convert(args) => convert::run(args),
        Command::Devices(args) => device::run(args),
        #[cfg(feature = "view")]
        Command::View(args) => view::run(args),
    }
}

/// No usable device, or a device that failed.
fn is_of_device(error: &anyhow::Error) -> bool {
    #[cfg(feature = "view")]
    if view::is_of_device(error) {
        return true;
    }
    error.is::<HeadlessError>()
}

/// The error and its causes in one line; a message that quotes its cause needs it only once.
fn explained(error: &anyhow::Error) -> String {
    let mut text = String::new();
    for cause in error.chain().map(ToString::to_string) {
        if text.is_empty() {
            text = cause;
        } else if !text.contains(&cause) {
            text = format!("{text}: {cause}");
        }
    }
    text
}
