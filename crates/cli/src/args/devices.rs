//! Arguments of `selvedge devices`.

use clap::Args;

#[derive(Debug, Args)]
pub struct DevicesArgs {
    /// As JSON
    #[arg(long)]
    pub json: bool,
}
