//! Many files in one call.

use clap::Args;
use std::path::PathBuf;

/// How a run over many files treats failures and existing outputs.
#[derive(Debug, Default, Args)]
pub struct ManyArgs {
    /// Stop at the first file that fails. Without this option the program reports the failure, draws all other files, and
    /// exits with status 1
    #[arg(long)]
    pub fail_fast: bool,
    /// Skip files whose outputs all exist
    #[arg(long)]
    pub skip_existing: bool,
    /// Write a table as the pictures are drawn, a row each: file, its SHA-256, view, output, drawn, skipped or failed and
    /// why, camera, counts, warnings, seconds
    #[arg(long, value_name = "OUT.csv")]
    pub manifest: Option<PathBuf>,
}

impl ManyArgs {
    /// Whether any of these options was given.
    pub fn any(&self) -> bool {
        self.fail_fast || self.skip_existing || self.manifest.is_some()
    }
}
