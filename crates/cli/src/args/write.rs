//! Arguments of `selvedge export` and `selvedge convert`.

use super::{ReadArgs, SubdivideArgs};
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub struct ExportArgs {
    /// The model, as for `render`
    pub model: PathBuf,
    #[command(flatten)]
    pub read: ReadArgs,
    #[command(flatten)]
    pub subdivide: SubdivideArgs,
    /// STEP file to write
    #[arg(value_name = "OUT.step")]
    pub output: PathBuf,
}

#[derive(Debug, Args)]
pub struct ConvertArgs {
    /// The model: STEP, IGES, OBJ, STL, 3MF, AMF, PLY, OFF, glTF, Rhino .3dm, BezierView .bv, .scad, .csg, .asc,
    /// .selvedge or a scene .toml
    pub model: PathBuf,
    #[command(flatten)]
    pub read: ReadArgs,
    #[command(flatten)]
    pub subdivide: SubdivideArgs,
    /// File to write, in the engine's own form, bit for bit
    #[arg(value_name = "OUT.selvedge")]
    pub output: PathBuf,
}
