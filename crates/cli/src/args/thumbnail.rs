//! A picture for file managers.

use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub struct ThumbnailArgs {
    /// The model, as for `render`
    pub model: PathBuf,
    /// PNG file to write, with any ending
    pub output: PathBuf,
    /// Width and height, pixels
    #[arg(value_parser = clap::value_parser!(u32).range(1..=2048))]
    pub size: u32,
    /// Part of the name of the Vulkan device to use; #1 behind it, or alone, is the second one
    #[arg(long, value_name = "NAME")]
    pub device: Option<String>,
}
