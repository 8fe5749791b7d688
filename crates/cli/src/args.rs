//! The arguments of the command line, checked before any file is opened.

mod bench;
mod devices;
mod draw;
mod images;
mod lines;
mod many;
mod measure;
mod read;
mod report;
mod thumbnail;
#[cfg(feature = "view")]
mod view;
mod write;

pub use bench::{BenchArgs, Motion};
pub use devices::DevicesArgs;
pub use draw::DrawArgs;
pub use images::Aov;
pub use lines::LineArgs;
pub use many::ManyArgs;
pub use measure::MeasureArgs;
pub use read::{ReadArgs, SubdivideArgs};
pub use report::ReportArgs;
pub use thumbnail::ThumbnailArgs;
#[cfg(feature = "view")]
pub use view::ViewArgs;
pub use write::{ConvertArgs, ExportArgs};

use crate::cut::CutArgs;
use crate::shown::ShownArgs;
use crate::sweep::Divided;
use crate::trims::Way;
use crate::values::{at_least_one, curvature, direction, mebibytes, near_far, times, tolerance, vector, zoom};
use clap::{Args, Parser, Subcommand, ValueEnum};
use glam::DVec3;
use selvedge::model::Model;
use selvedge::picture::{Levels, Samples, Smooth, SolidWay, Style, TrimWay};
use selvedge_io::import::Import;
use selvedge_jobs::{Ambient, Backdrop, Directions};
use std::{path::PathBuf, str::FromStr};

/// Printed at the end of every help text.
const STATUSES: &str = "Exit status: 0 done; 1 a picture breaks the accuracy promise, or some of many files failed; 2 wrong usage, a file that cannot \
                        be read or written or of which nothing can be drawn, or with --strict not all of it; 3 no usable \
                        Vulkan device, or the device failed.";

/// Draws trimmed spline surfaces exactly, at the resolution of the picture.
#[derive(Debug, Parser)]
#[command(version, after_help = STATUSES)]
pub struct Cli {
    /// Say more on standard error; twice for more still
    #[arg(short, long, global = true, action = clap::ArgAction::Count)]
    pub verbose: u8,
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Draw models to PNG files
    #[command(after_help = STATUSES)]
    Render(RenderArgs),
    /// Draw the lines of a view to an SVG file: visible edges and silhouettes as curves; needs no GPU
    #[command(after_help = STATUSES)]
    Draw(DrawArgs),
    /// Describe the content of a file; needs no GPU
    #[command(after_help = STATUSES)]
    Info(InfoArgs),
    /// Measure lengths, areas, volumes and smallest distances, with their errors; needs no GPU
    #[command(after_help = STATUSES)]
    Measure(MeasureArgs),
    /// Write a model as a STEP file; needs no GPU
    #[command(after_help = STATUSES)]
    Export(ExportArgs),
    /// Draw a model and judge the picture against exact rays in double precision
    #[command(after_help = STATUSES)]
    Check(CheckArgs),
    /// Measure time and memory per pass along a fixed camera path, next to the error of the same frames
    #[command(after_help = STATUSES)]
    Bench(BenchArgs),
    /// Measure time against error over tolerances, sizes, levels, zooms and numbers of copies, all in turn
    #[command(after_help = STATUSES)]
    Sweep(SweepArgs),
    /// Compare the ways to trim: time, memory and error over zoom, picture size and each way's accuracy
    #[command(after_help = STATUSES)]
    Trims(TrimsArgs),
    /// Measure models over tolerances, zooms, ways to trim and numbers, all in one document
    #[command(after_help = STATUSES)]
    Report(ReportArgs),
    /// Draw a small square picture for file managers, on a transparent background
    #[command(after_help = STATUSES)]
    Thumbnail(ThumbnailArgs),
    /// Write a model in the engine's own form, which opens fast; needs no GPU
    #[command(after_help = STATUSES)]
    Convert(ConvertArgs),
    /// List Vulkan devices: what each lacks, and the limits that matter
    #[command(after_help = STATUSES)]
    Devices(DevicesArgs),
    /// Show models in a window: turn, pick, measure, cut
    #[cfg(feature = "view")]
    #[command(after_help = STATUSES)]
    View(ViewArgs),
}

/// How smooth edges are.
#[derive(Debug, Args)]
pub struct EdgeArgs {
    /// Samples of each pixel's colour, 1, 4 or 8: smooth edges, at about as many times the cost
    #[arg(long, value_name = "N", default_value = "1")]
    pub samples: Samples,
    /// Borders that are smooth in pictures of one sample: borders, of everything; trims, of trimmed faces, by the area
    /// that they cover of a pixel, with the exact way to trim; or none
    #[arg(long, value_name = "none|trims|borders")]
    smooth: Option<Smooth>,
}

impl EdgeArgs {
    /// The value of the option, or its default.
    pub fn smooth(&self) -> Smooth {
        selvedge_jobs::smooth(self.smooth, self.samples)
    }
}

/// The appearance of a picture.
#[derive(Debug, Args)]
pub struct LookArgs {
    /// Background of the model: a CSS colour, gradient, or none for a transparent PNG; without it the scene file's
    /// colour, or the gradient
    #[arg(long, value_name = "COLOUR|gradient|none")]
    pub background: Option<Backdrop>,
    /// How surfaces are shown: shaded, clay (one colour, no highlights), technical (white, with sharp edges and outlines
    /// unless --edges says otherwise), normals (as colours: right red, up green, towards the eye blue), zebra (stripes of a
    /// striped room, reflected: they break where surfaces do), isophotes (bands of equal angle to the light),
    /// mean-curvature or gaussian-curvature (of the exact surface, with a legend)
    #[arg(long, value_name = "STYLE", default_value = "shaded")]
    pub style: Style,
    /// The largest mean curvature on the scale, 1/mm; that of Gaussian curvature ends at its square. The default is a round
    /// number at which most of the model's curvatures are told apart
    #[arg(long, value_name = "PER_MM", value_parser = curvature)]
    pub curvature_range: Option<f64>,
    /// Ambient occlusion darkens corners and contacts. RADIUS is the reach of the occlusion in units of the model; auto is a
    /// twenty-fifth of the model's diagonal. The default is auto for one sample a pixel, and none for several
    #[arg(long, value_name = "RADIUS|auto|none")]
    pub ao: Option<Ambient>,
}

impl LookArgs {
    /// The background of the model of a file.
    pub fn backdrop(&self, import: &Import) -> Backdrop {
        let usual = if self.style == Style::Technical { Backdrop::Colour([1.0; 4]) } else { Backdrop::Gradient };
        self.background.or(import.picture.background.map(Backdrop::Colour)).unwrap_or(usual)
    }

    /// The end of the scale of curvature.
    pub fn range(&self, model: &Model) -> f64 {
        self.curvature_range.unwrap_or_else(|| model.curvature_range())
    }
}

#[derive(Debug, Args)]
pub struct RenderArgs {
    /// The models: STEP, IGES, OBJ, STL, 3MF, AMF, PLY, OFF, glTF, Rhino .3dm, BezierView .bv, .scad, .csg, .asc,
    /// .selvedge or a scene .toml; `-` is standard input. Of several, each adds its name where the names of the outputs
    /// say {stem}; the next is read while one is drawn
    #[arg(required = true)]
    pub models: Vec<PathBuf>,
    #[command(flatten)]
    pub many: ManyArgs,
    #[command(flatten)]
    pub read: ReadArgs,
    #[command(flatten)]
    pub subdivide: SubdivideArgs,
    #[command(flatten)]
    pub shown: ShownArgs,
    #[command(flatten)]
    pub cut: CutArgs,
    /// PNG file to write; `-` is standard output, here and for any other single file. With several views each adds its
    /// name to every file's, or replaces {view} in it
    #[arg(short, long, value_name = "OUT.png")]
    pub output: PathBuf,
    /// Standard views, each fitted to the picture: iso, front, right, back, left, top, bottom, or AZIMUTH,ELEVATION in
    /// degrees, azimuth 0 the front and 90 the right; several with commas
    #[arg(long, value_name = "VIEWS", allow_hyphen_values = true, visible_alias = "views", conflicts_with_all = ["eye", "target", "camera"])]
    pub view: Option<Directions>,
    /// All views in one picture, side by side; without --view the named standard views
    #[arg(long, conflicts_with_all = ["aov", "stats", "camera_out", "eye", "target", "camera"])]
    pub contact_sheet: bool,
    #[command(flatten)]
    pub look: LookArgs,
    #[command(flatten)]
    pub camera: CameraArgs,
    #[command(flatten)]
    pub frame: FrameArgs,
    #[command(flatten)]
    pub edges: EdgeArgs,
    #[command(flatten)]
    pub lines: LineArgs,
    /// Also write an image as a NumPy array, row 0 on top: depth (f32, H x W, +inf is background), face (u32, H x W,
    /// 0 is background), uv (f32, H x W x 2, NaN is background), normal (f32, H x W x 3, 0 is background), thickness
    /// (f32, H x W: length of the ray within solids and closed parts, overlaps counted once), edge (u32, H x W, with
    /// --edges: number of the edge whose line covers the pixel, 0 is none), part and instance (u32, H x W, counted from 1, 0 is none)
    #[arg(long, value_name = "IMAGE=FILE.npy")]
    pub aov: Vec<Aov>,
    /// Write statistics of a second drawing of the same frame as JSON. `first_frame` has the driver's compile times for
    /// the first one; `objects` lists the pipelines, buffers and images that exist
    #[arg(long, value_name = "FILE.json")]
    pub stats: Option<PathBuf>,
    /// Write the camera as JSON: eye, target, up, fovy in degrees (or ortho: half the height), size
    #[arg(long, value_name = "FILE.json")]
    pub camera_out: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub struct InfoArgs {
    /// The model: STEP, IGES, OBJ, STL, 3MF, AMF, PLY, OFF, glTF, Rhino .3dm, BezierView .bv, .scad, .csg, .asc,
    /// .selvedge or a scene .toml
    pub model: PathBuf,
    #[command(flatten)]
    pub read: ReadArgs,
    #[command(flatten)]
    pub subdivide: SubdivideArgs,
    #[command(flatten)]
    pub camera: CameraArgs,
    /// List every face: deviation, gap, loops, notes; and the worst of them
    #[arg(long)]
    pub deep: bool,
    /// Print JSON; it includes everything of `--deep`
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub struct CheckArgs {
    /// The model: STEP, IGES, OBJ, STL, 3MF, AMF, PLY, OFF, glTF, Rhino .3dm, BezierView .bv, .scad, .csg, .asc,
    /// .selvedge or a scene .toml
    pub model: PathBuf,
    #[command(flatten)]
    pub read: ReadArgs,
    #[command(flatten)]
    pub subdivide: SubdivideArgs,
    #[command(flatten)]
    pub cut: CutArgs,
    #[command(flatten)]
    pub camera: CameraArgs,
    #[command(flatten)]
    pub frame: FrameArgs,
    /// Built-in views; not together with a camera
    #[arg(long, value_enum, default_value_t = Views::Whole, conflicts_with_all = ["eye", "target", "camera"])]
    pub views: Views,
    /// In place of the views: so many times closer than the whole model, at the nearest detail that is seen; one view
    /// for each number
    #[arg(long, value_name = "TIMES", value_parser = times, value_delimiter = ',', conflicts_with_all = ["eye", "target", "camera", "views"])]
    pub zoom: Vec<f64>,
    /// Move the model by this before anything is drawn
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    pub moved: Option<DVec3>,
    /// Pixels to judge in each view, spread evenly; those at which the face changes are judged in any case
    #[arg(long, value_name = "N", default_value_t = 20_000, value_parser = at_least_one)]
    pub samples: usize,
    /// Write a picture of the verdicts: right grey, shifted within the tolerance green, farther orange, wrong red. With
    /// several views each adds its name to the file's
    #[arg(long, value_name = "OUT.png")]
    pub difference: Option<PathBuf>,
    /// Also draw lines along all edges and judge them: visible points half a pixel apart, and places between pixels
    /// where what is seen of Boolean solids changes, without a line within half its width and 0.5 px; and pixels of
    /// lines farther than that from every visible edge
    #[arg(long)]
    pub edges: bool,
    /// Draw and judge the outlines of curved faces, too, where they fold away from the eye
    #[arg(long, requires = "edges")]
    pub silhouettes: bool,
    /// Write the judgements as JSON
    #[arg(long, value_name = "FILE.json")]
    pub json: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub struct SweepArgs {
    /// The models: STEP, IGES, OBJ, Rhino .3dm, BezierView .bv or .selvedge
    #[arg(required_unless_present = "degrees")]
    pub models: Vec<PathBuf>,
    #[command(flatten)]
    pub read: ReadArgs,
    /// Also a wavy sheet of 1024 patches of each of these degrees
    #[arg(long, value_name = "LIST", value_parser = clap::value_parser!(u8).range(1..=9), value_delimiter = ',')]
    pub degrees: Vec<u8>,
    /// How patches are divided: bound, a level from 1 to 64, or slefe: by slefes of 3 segments, or of the number behind
    /// it, up to slefe9; corners and tessellated: by the bound, with patches of one segment a side drawn by their
    /// corners, or none; several, with commas
    #[arg(long, value_name = "LIST", value_delimiter = ',', default_value = "bound")]
    pub factors: Vec<Divided>,
    /// Tolerances in pixels
    #[arg(long, value_name = "LIST", value_parser = tolerance, value_delimiter = ',', default_value = "0.5")]
    pub tolerances: Vec<f64>,
    /// Sizes in pixels
    #[arg(long, value_name = "LIST", value_delimiter = ',', default_value = "1920x1080")]
    pub sizes: Vec<Size>,
    /// How many times closer than the whole model
    #[arg(long, value_name = "LIST", value_parser = times, value_delimiter = ',', default_value = "1")]
    pub zooms: Vec<f64>,
    /// How many copies of the model, in a cube
    #[arg(long, value_name = "LIST", value_parser = at_least_one, value_delimiter = ',', default_value = "1")]
    pub copies: Vec<usize>,
    /// Copy the parts too, not only their placements
    #[arg(long)]
    pub distinct: bool,
    /// Measured frames for each setting
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = at_least_one)]
    pub frames: usize,
    /// Pixels judged in the first frame of each setting; 0 judges none
    #[arg(long, value_name = "N", default_value_t = 2_000)]
    pub samples: usize,
    /// In place of the table: the bound beside the smallest fixed level with no larger error, for each view and for all
    /// zooms together
    #[arg(long, conflicts_with = "factors")]
    pub against_fixed: bool,
    /// Also the triangles a second beside those of an instanced grid with the same number
    #[arg(long)]
    pub rate: bool,
    /// Part of the name of the Vulkan device to use; #1 behind it, or alone, is the second one
    #[arg(long, value_name = "NAME")]
    pub device: Option<String>,
    /// Table to write
    #[arg(long, value_name = "FILE.csv", conflicts_with = "against_fixed")]
    pub out: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub struct TrimsArgs {
    /// Models beside the generated face: STEP, IGES, OBJ, Rhino .3dm, BezierView .bv or .selvedge. Without any:
    /// samples/panel.step, and nist_pmi_2.stp and m6_countersunk_screw.step in the folder that SELVEDGE_MODELS names,
    /// if they exist
    pub models: Vec<PathBuf>,
    #[command(flatten)]
    pub read: ReadArgs,
    /// Holes along each side of the generated face; 0 leaves it out
    #[arg(long, value_name = "N", default_value_t = 100)]
    pub holes: usize,
    /// Ways to compare
    #[arg(long, value_delimiter = ',', value_name = "WAYS", default_values_t = Way::all())]
    pub ways: Vec<Way>,
    /// Magnifications of the view of the whole model
    #[arg(long, value_delimiter = ',', value_name = "TIMES", default_value = "1,10,100,1000", value_parser = zoom)]
    pub zooms: Vec<f64>,
    /// Pictures of the sweep over sizes
    #[arg(long, value_delimiter = ',', value_name = "WxH", default_value = "400x400,800x800,1600x1600,3840x2160")]
    pub sizes: Vec<Size>,
    /// Picture of the other sweeps
    #[arg(long, value_name = "WxH", default_value = "800x800")]
    pub size: Size,
    /// Magnification of the sweeps over sizes and accuracies
    #[arg(long, value_name = "TIMES", default_value = "1", value_parser = zoom)]
    pub zoom: f64,
    /// Leave out the sweep over each way's own accuracy
    #[arg(long)]
    pub no_knobs: bool,
    /// Frames of each measurement; the quickest counts, because slower ones include other work of the machine
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = at_least_one)]
    pub frames: usize,
    /// Pixels to judge in each view beside those at which the face changes
    #[arg(long, value_name = "N", default_value_t = 2_000, value_parser = at_least_one)]
    pub samples: usize,
    /// Part of the name of the Vulkan device to use; #1 behind it, or alone, is the second one
    #[arg(long, value_name = "NAME")]
    pub device: Option<String>,
    /// Folder for trims.json, trims.csv and the plots
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// The position of the eye.
#[derive(Debug, Args)]
pub struct CameraArgs {
    /// Width and height in pixels; by default that of the scene, or 1920x1080
    #[arg(long, value_name = "WxH")]
    pub size: Option<Size>,
    /// A camera of the scene file, by its name; by default the one that the scene's picture names, if any
    #[arg(long, value_name = "NAME", conflicts_with_all = ["eye", "target", "up", "fov", "ortho"])]
    pub camera: Option<String>,
    /// Position of the eye, millimetres; without it the whole model is framed
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    pub eye: Option<DVec3>,
    /// Point that the eye looks at; the middle of the model without it
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    pub target: Option<DVec3>,
    /// Direction that points up in the picture; 0,0,1 without it
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    pub up: Option<DVec3>,
    /// Vertical field of view in degrees; 35 without it
    #[arg(long, value_name = "DEG", conflicts_with = "ortho")]
    pub fov: Option<f64>,
    /// Parallel projection; the height of the picture in millimetres
    #[arg(long, value_name = "HEIGHT")]
    pub ortho: Option<f64>,
    /// Distances of the near and the far plane from the eye, millimetres: only what lies between them is drawn. Without
    /// it all of the model in front of the eye
    #[arg(long, value_name = "NEAR,FAR", value_parser = near_far, requires = "eye")]
    pub near_far: Option<(f64, f64)>,
}

/// How a frame is drawn.
#[derive(Debug, Args)]
pub struct FrameArgs {
    /// Largest distance in pixels between a drawn boundary and the true one, at least 0.1
    #[arg(long, value_name = "PX", default_value_t = 0.5, value_parser = tolerance)]
    pub tolerance: f64,
    /// How finely patches are divided: bound, which keeps the accuracy promise, or the same level from 1 to 64
    /// everywhere, which does not
    #[arg(long, value_name = "bound|N", default_value = "bound")]
    pub factors: Factors,
    /// How to trim: table (made for views from about the same distance; for close views, for those from near by), exact
    /// (made once), or auto: table where the scene needs few scan lines, exact beyond
    #[arg(long, value_name = "WAY", default_value = "auto")]
    pub trim: TrimWay,
    /// How to draw Boolean solids: events (a ray a pixel), cst (each primitive, trimmed by the others) or blister
    /// (layers of faces, classified by labels)
    #[arg(long, value_name = "WAY", default_value = "events")]
    pub solids: SolidWay,
    /// Most memory for the lists of events, MiB; beyond it the picture is drawn in bands of rows. By default the
    /// largest buffer of the device for each list
    #[arg(long, value_name = "MIB", value_parser = mebibytes)]
    pub solid_budget: Option<f64>,
    /// Mark, over everything, where faces of two solids or closed parts coincide, blue, and where two overlap, red; the
    /// counts of the pixels are printed, and are part of the statistics
    #[arg(long)]
    pub highlight: bool,
    /// Light from this direction, fixed in the model, with the shadows of all opaque objects: from the model towards
    /// the sun. Without it the light of a scene file, or one that travels with the camera and casts no shadows
    #[arg(long, value_name = "X,Y,Z", value_parser = direction, allow_hyphen_values = true)]
    pub sun: Option<DVec3>,
    /// Part of the name of the Vulkan device to use; #1 behind it, or alone, is the second one
    #[arg(long, value_name = "NAME")]
    pub device: Option<String>,
    /// Load the Vulkan validation layer; a message from it counts as a broken promise
    #[arg(long)]
    pub validation: bool,
}

/// How patches are divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Factors(pub Levels);

impl FromStr for Factors {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let level = || text.parse().ok().filter(|n| (1..=64).contains(n)).map(Levels::Fixed);
        let levels = if text == "bound" { Some(Levels::Bound) } else { level() };
        levels.map(Self).ok_or_else(|| "wants `bound` or a level from 1 to 64".into())
    }
}

impl std::fmt::Display for Factors {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.0 {
            Levels::Bound => f.write_str("bound"),
            Levels::Fixed(level) => write!(f, "{level}"),
        }
    }
}

/// Built-in views of `check`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Views {
    /// All of the model
    Whole,
    /// Six times closer, at the nearest detail that is seen
    Close,
    /// From 8 degrees above the ground along the largest extent
    Grazing,
    /// All three
    All,
}

/// Width and height in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size(pub u32, pub u32);

impl FromStr for Size {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let side = |s: &str| s.parse::<u32>().ok().filter(|&n| (1..=16384).contains(&n));
        text.split_once('x')
            .and_then(|(w, h)| Some(Self(side(w)?, side(h)?)))
            .ok_or_else(|| "wants WIDTHxHEIGHT, each from 1 to 16384, as in 1920x1080".into())
    }
}

#[cfg(test)]
mod tests;
