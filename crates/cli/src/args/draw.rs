//! Arguments of `selvedge draw`.

use super::{CameraArgs, CutArgs, Directions, ReadArgs, SubdivideArgs};
use crate::values::{drawing_scale, millimetres};
use clap::{ArgAction, Args};
use selvedge::picture::{EdgeChoice, TangentEdges};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub struct DrawArgs {
    /// The model, as for `render`
    pub model: PathBuf,
    #[command(flatten)]
    pub read: ReadArgs,
    #[command(flatten)]
    pub subdivide: SubdivideArgs,
    #[command(flatten)]
    pub cut: CutArgs,
    /// SVG file to write, in millimetres, one group a kind of line. With several views each adds its name to the
    /// file's, or replaces {view} in it
    #[arg(short, long, value_name = "OUT.svg")]
    pub output: PathBuf,
    /// Standard views, as for `render`; parallel, unless --fov, --eye or a camera of the scene says otherwise
    #[arg(long, value_name = "VIEWS", allow_hyphen_values = true, conflicts_with_all = ["eye", "target", "camera"])]
    pub view: Option<Directions>,
    #[command(flatten)]
    pub camera: CameraArgs,
    /// Width of the drawing on paper, millimetres; its height follows from --size
    #[arg(long, value_name = "MM", default_value_t = 297.0, value_parser = millimetres)]
    pub width: f64,
    /// In place of the width: millimetres on paper for one of the model, as in 1 or 0.5; parallel views only
    #[arg(long, value_name = "TIMES", value_parser = drawing_scale, conflicts_with = "width")]
    pub scale: Option<f64>,
    /// Also hidden lines, thin and dashed
    #[arg(long)]
    pub hidden_lines: bool,
    /// Which edges: all, sharp (and borders), or none
    #[arg(long, value_name = "all|sharp|none", default_value = "all")]
    pub edges: EdgeChoice,
    /// Silhouettes: curves where surfaces turn away from the eye
    #[arg(long, value_name = "true|false", default_value_t = true, action = ArgAction::Set)]
    pub silhouettes: bool,
    /// Edges at which faces continue each other: none, thin, or full like other edges
    #[arg(long, value_name = "none|thin|full", default_value = "thin")]
    pub tangent_edges: TangentEdges,
    /// Write the camera as JSON, as for `render`
    #[arg(long, value_name = "FILE.json")]
    pub camera_out: Option<PathBuf>,
}
