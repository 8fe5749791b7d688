//! Arguments of `selvedge bench`.

use super::{EdgeArgs, FrameArgs, ReadArgs, Size};
use crate::cut::CutArgs;
use crate::values::at_least_one;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub struct BenchArgs {
    /// The models: STEP, IGES, OBJ, STL, 3MF, AMF, PLY, OFF, glTF, Rhino .3dm, BezierView .bv, .scad, .csg, .asc,
    /// .selvedge or scenes .toml
    #[arg(required = true)]
    pub models: Vec<PathBuf>,
    #[command(flatten)]
    pub read: ReadArgs,
    /// Measured frames for each model, after the warm-up
    #[arg(long, value_name = "N", default_value_t = 24, value_parser = at_least_one)]
    pub frames: usize,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "1920x1080")]
    pub size: Size,
    #[command(flatten)]
    pub frame: FrameArgs,
    #[command(flatten)]
    pub edges: EdgeArgs,
    #[command(flatten)]
    pub cut: CutArgs,
    /// Drag a loop of the face with the most loops, once a frame, instead of moving the camera: latency, bytes sent,
    /// and whether pictures equal those of a fresh upload
    #[arg(long, conflicts_with_all = ["section", "trim_by"])]
    pub edit: bool,
    /// How the camera moves from frame to frame
    #[arg(long, value_enum, default_value_t = Motion::Path, conflicts_with = "edit")]
    pub motion: Motion,
    /// Also draw the frames with several in flight: pictures per second, and wall clock over passes
    #[arg(long, conflicts_with = "edit")]
    pub throughput: bool,
    /// Frames judged against the exact model, spread evenly; 0 judges none
    #[arg(long, value_name = "N", default_value_t = 4)]
    pub judged: usize,
    /// Folder for bench.json and bench.csv
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// How the camera of `bench` moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Motion {
    /// Once around the model, nearer and back twice
    Path,
    /// By three degrees a frame, all of the model in view
    Turn,
    /// Not at all. Each frame twice: with every pass recorded, and as a viewer draws it, which reuses the visible
    /// surface of each pixel
    Still,
}
