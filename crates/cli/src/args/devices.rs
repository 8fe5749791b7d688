//! What `selvedge devices` tells.

use clap::Args;

#[derive(Debug, Args)]
pub struct DevicesArgs {
    /// As JSON
    #[arg(long)]
    pub json: bool,
}
