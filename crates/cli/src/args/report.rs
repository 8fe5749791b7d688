//! Arguments of `selvedge report`.

use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub struct ReportArgs {
    /// The models: STEP, IGES, OBJ, Rhino .3dm, BezierView .bv or .selvedge
    #[arg(required = true)]
    pub models: Vec<PathBuf>,
    /// Smaller pictures, and fewer of them
    #[arg(long)]
    pub quick: bool,
    /// Part of the name of the Vulkan device to use; #1 behind it, or alone, is the second one
    #[arg(long, value_name = "NAME")]
    pub device: Option<String>,
    /// Folder for report.md, the tables as CSV, and plots
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}
