//! Arguments of the window.

use super::Size;
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub struct ViewArgs {
    /// Models, side by side in one scene: STEP, IGES, OBJ, STL, 3MF, AMF, PLY, OFF, glTF, Rhino .3dm, BezierView .bv,
    /// .csg, .asc, .selvedge or scenes .toml; more can be opened in the window
    pub models: Vec<PathBuf>,
    /// Width and height of the window, in points of the display
    #[arg(long, value_name = "WxH")]
    pub size: Option<Size>,
    /// Part of the name of the Vulkan device to use; #1 behind it, or alone, is the second one
    #[arg(long, value_name = "NAME")]
    pub device: Option<String>,
    /// Turn on the validation layer; its messages make the exit status 1
    #[arg(long)]
    pub validation: bool,
    /// File of settings; without it viewer.json in the folder selvedge of the user's settings
    #[arg(long, value_name = "FILE.json")]
    pub settings: Option<PathBuf>,
}
