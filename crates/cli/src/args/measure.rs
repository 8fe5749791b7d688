//! Arguments of `selvedge measure`.

use super::{ReadArgs, SubdivideArgs};
use crate::measure::{Name, edge, face, face_or_edge, part};
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub struct MeasureArgs {
    /// The model, as for `render`. Without items: area of each placed part; volume and centre of mass of closed ones.
    /// Millimetres where the file has a unit, else its own numbers
    pub model: PathBuf,
    #[command(flatten)]
    pub read: ReadArgs,
    #[command(flatten)]
    pub subdivide: SubdivideArgs,
    /// Area of a face, and radius, axis or angle of its surface. N is its number in the file. P is that of its placed
    /// part, counted from 1 as in the image `instance`; it may be left out where one placed part alone has the face. May
    /// be given several times
    #[arg(long, value_name = "N[@P]", value_parser = face)]
    pub face: Vec<Name>,
    /// Length of an edge, and radius and centre of a circle. N is its number in the file: for STEP that of the
    /// EDGE_CURVE; for IGES that of the list, and I the place there; for an edge without a number its place in the part,
    /// from 1
    #[arg(long, value_name = "N[.I][@P]", value_parser = edge)]
    pub edge: Vec<Name>,
    /// Area of a placed part; volume and centre of mass if it is closed
    #[arg(long, value_name = "P", value_parser = part)]
    pub part: Vec<Name>,
    /// Smallest distance of two faces or edges and where it is, with its error; their angle, and the distance of their
    /// axes or centres: as in face:12 edge:40@2. May be given several times
    #[arg(long, num_args = 2, value_names = ["A", "B"], value_parser = face_or_edge)]
    pub between: Vec<Name>,
    /// Print the names of all faces and edges, and a point of each, in place of measurements
    #[arg(long, conflicts_with_all = ["face", "edge", "part", "between"])]
    pub list: bool,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}
