//! A frame's settings, images and statistics.

mod edges;
mod samples;
mod style;

pub(crate) use edges::LineStyle;
pub use edges::{BadEdges, EdgeChoice, EdgeSettings, TangentEdges, UnknownEdges};
pub use samples::{Samples, Smooth, UnknownSamples, UnknownSmooth};
pub use style::{Style, UnknownStyle};

use crate::model::{Colour, Images};
use glam::DVec3;

/// The caller's choices for one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameSettings {
    /// Largest distance in pixels between a drawn boundary and the true one; the promise. At least
    /// [`LEAST_TOLERANCE_PX`](Self::LEAST_TOLERANCE_PX); the default is one half.
    pub tolerance_px: f64,
    /// Colour behind the model; with `None` the target's own content stays there.
    pub background: Option<Colour>,
    /// How surfaces are shown.
    pub style: Style,
    /// How finely patches are divided.
    pub levels: Levels,
    /// Record every pass in every frame, for measurements. Otherwise a frame reuses the visibility of the one before, if
    /// view and settings are the same and no loop was edited, and the trim table, if the view is from about as far: the
    /// same picture, bit for bit, sooner.
    pub all_passes: bool,
}

/// How the number of segments along a patch's sides is chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Levels {
    /// From bounds on its derivatives, for each view: the promise holds.
    #[default]
    Bound,
    /// The same number everywhere, 1 to 64. The promise does *not* hold; for comparisons.
    Fixed(u32),
}

impl Default for FrameSettings {
    fn default() -> Self {
        Self {
            tolerance_px: 0.5,
            background: Some([1.0, 1.0, 1.0, 1.0]),
            style: Style::Shaded,
            levels: Levels::Bound,
            all_passes: false,
        }
    }
}

impl FrameSettings {
    /// Single precision does not resolve smaller tolerances at full zoom.
    pub const LEAST_TOLERANCE_PX: f64 = 0.1;
}

impl Levels {
    /// The fixed level, if there is one, within the hardware's range.
    pub(crate) fn fixed(self) -> Option<u32> {
        match self {
            Self::Bound => None,
            Self::Fixed(level) => Some(level.clamp(1, 64)),
        }
    }
}

/// How it is decided which pixels of a patch the trim loops cut away. All ways draw the same picture within
/// [`FrameSettings::tolerance_px`]; `docs/design/trimming.md` has the cost of each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum TrimWay {
    /// [`Table`](Self::Table) for scenes that are expected to need few scan lines, [`Exact`](Self::Exact) for the others:
    /// [`renderer::trim_way`](crate::renderer::trim_way) returns the choice, and [`FrameStats::trim`] the way of a frame.
    /// Where a view needs more of the table than there can be, the scene is trimmed exactly from then on.
    #[default]
    Auto,
    /// The u-intercept table: made for all views from about as far, or closer up from near by; a binary search in each of three
    /// rows a pixel.
    Table,
    /// The loops themselves, as arcs of conics in cells made once: a few of them a pixel.
    Exact,
}

/// The way that a scene is trimmed: what [`TrimWay::Auto`] has settled for, too.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TakenWay {
    Table,
    Exact,
    /// One to compare with.
    #[cfg(feature = "baselines")]
    Baseline(crate::baselines::TrimMethod),
}

impl TakenWay {
    /// In a host's terms; `None` for a baseline.
    pub(crate) fn reported(self) -> Option<TrimWay> {
        match self {
            Self::Table => Some(TrimWay::Table),
            Self::Exact => Some(TrimWay::Exact),
            #[cfg(feature = "baselines")]
            Self::Baseline(_) => None,
        }
    }

    /// As in messages.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Table => TrimWay::Table.name(),
            Self::Exact => TrimWay::Exact.name(),
            #[cfg(feature = "baselines")]
            Self::Baseline(method) => method.name(),
        }
    }

    /// By trim textures, which are made of curves as the table is.
    pub(crate) fn is_texture(self) -> bool {
        match self {
            Self::Table | Self::Exact => false,
            #[cfg(feature = "baselines")]
            Self::Baseline(method) => matches!(method, crate::baselines::TrimMethod::Texture { .. }),
        }
    }
}

impl TrimWay {
    /// Every way, without [`Auto`](Self::Auto), which takes one of them.
    pub const ALL: &'static [Self] = &[Self::Table, Self::Exact];

    /// As in command lines and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::Table => "table",
            Self::Exact => "exact",
        }
    }
}

impl std::str::FromStr for TrimWay {
    type Err = UnknownTrimWay;

    fn from_str(name: &str) -> Result<Self, UnknownTrimWay> {
        let mut named = std::iter::once(Self::Auto).chain(Self::ALL.iter().copied());
        named.find(|way| way.name() == name).ok_or_else(|| UnknownTrimWay(name.to_owned()))
    }
}

/// No way to trim is called so.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no way to trim is called `{0}`; there are: auto, {names}", names = TrimWay::ALL.iter().map(|w| w.name()).collect::<Vec<_>>().join(", "))]
pub struct UnknownTrimWay(String);

/// How Boolean solids are drawn. All ways draw the same picture, bit for bit, but where [`Blister`](Self::Blister)
/// says otherwise.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum SolidWay {
    /// One ray a pixel, followed from event to event until it enters the solid.
    #[default]
    Events,
    /// The faces of each primitive, trimmed by the Blist of the others: constructive solid trimming. Scenes in
    /// which some operand is a mesh or a spline part, or something is seen through, are drawn by events.
    Cst,
    /// Layers of faces, peeled off from front to back, each tested whether it bounds the solid: by labels in a
    /// stencil image, as Hable and Rossignac have it. Its cost is that of all primitives, once a layer. Scenes in which
    /// some operand is a spline part, or a mesh that is not closed and turned outwards, crosses itself or lies back to back,
    /// or something is seen through, are drawn by events. Of a mesh's face and another that coincide, the face that is not
    /// the mesh's is seen; and a ray that enters and leaves a mesh within the rounding of a depth may see either side.
    Blister,
}

impl SolidWay {
    /// Every way.
    pub const ALL: &'static [Self] = &[Self::Events, Self::Cst, Self::Blister];

    /// As in command lines and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Events => "events",
            Self::Cst => "cst",
            Self::Blister => "blister",
        }
    }
}

impl std::str::FromStr for SolidWay {
    type Err = UnknownSolidWay;

    fn from_str(name: &str) -> Result<Self, UnknownSolidWay> {
        Self::ALL.iter().copied().find(|way| way.name() == name).ok_or_else(|| UnknownSolidWay(name.to_owned()))
    }
}

/// No way to draw Boolean solids is called so.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no way to draw solids is called `{0}`; there are: {names}", names = SolidWay::ALL.iter().map(|w| w.name()).collect::<Vec<_>>().join(", "))]
pub struct UnknownSolidWay(String);

/// Colours of places where solids of an assembly meet, in linear light; the opacity is that of the mark, which lies
/// before everything. Solids here are the model's Boolean solids and closed parts, each by itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Highlight {
    /// Where a pixel's ray meets coincident faces of two solids: those that share a surface with an equation, or a
    /// triangle's plane, to the bit. Spline faces never do: a gap or overlap of rounding lies between them.
    pub contact: Colour,
    /// Where it is within two solids at once.
    pub overlap: Colour,
}

impl Default for Highlight {
    /// Blue contacts and red overlaps, both half opaque.
    fn default() -> Self {
        Self { contact: [0.0, 0.1, 1.0, 0.5], overlap: [1.0, 0.0, 0.0, 0.5] }
    }
}

/// The caller's choices for a loaded model.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SceneSettings {
    /// How to trim.
    pub trim: TrimWay,
    /// How to draw Boolean solids.
    pub solids: SolidWay,
    /// Loops may be edited while the scene is drawn. Costs memory, room for larger loops, and time: trimmed faces are not
    /// cut into pieces, most of which would need no trim test.
    pub editable: bool,
    /// Samples of each pixel's colour: edges are smoothed where there are more than one.
    pub samples: Samples,
    /// Which borders are smooth. Costs far less than [`samples`](Self::samples), of which there must be one.
    pub smooth: Smooth,
    /// Ambient occlusion: points close to other surfaces get less of the sky's light. The radius, in units of the
    /// model: surfaces farther away have no effect. `None`: no ambient occlusion. It changes only colours, and only in
    /// styles that show light. It needs [`Samples::One`].
    pub ambient: Option<f64>,
    /// Frames may have an image of thickness: rays are followed through all solids.
    pub thickness: bool,
    /// Mark contacts and overlaps, and count their pixels: rays are followed through all solids.
    pub highlight: Option<Highlight>,
    /// Where the key light comes from: a direction from the model towards it, in model axes, of any length but 0;
    /// `None` for a studio's light, which travels with the camera and casts no shadows.
    ///
    /// It is parallel, and reaches a point where nothing opaque lies on the way: every face of the scene is shaded, and
    /// all that is opaque casts shadows. Those of primitives with equations and of meshes are exact. Spline faces, placed
    /// or of operands, cast them as triangles within [`FrameStats::shadow_deviation`] of the faces. Transparent
    /// objects cast none, nor do parts that [`Model::trim_by`](crate::model::Model::trim_by) cuts open, nor triangles beyond
    /// a million: [`FrameStats::shadowless`] counts them. Made with the scene: loops that are edited
    /// later change no shadow.
    pub sun: Option<DVec3>,
    /// Lines along edges; `None`: no lines, and nothing that lines need. Edges of parts and meshes are found when the model
    /// is uploaded; loops that are edited later move no line. Boolean solids have none.
    pub edges: Option<EdgeSettings>,
    /// Most bytes that the lists of [`SolidWay::Events`] take: which primitives each tile of 16 x 16 pixels sees, and
    /// where each pixel's ray crosses operands that are meshes or spline parts. Where they would take more, the picture
    /// is drawn in bands of rows of tiles, one after another, each with all geometry: the same picture, bit for bit.
    /// `None`: as much as one storage buffer of the device holds, for each list. A row of tiles that alone wants more
    /// is
    /// [`RenderError::TooMany`](crate::renderer::RenderError::TooMany).
    pub solid_budget: Option<u64>,
}

/// Images wanted beside the colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[allow(missing_docs)]
pub struct Outputs {
    pub depth: bool,
    pub face: bool,
    pub uv: bool,
    pub normal: bool,
    pub thickness: bool,
    pub edge: bool,
    pub part: bool,
    pub instance: bool,
}

impl Outputs {
    /// Every image of the point that is seen first; those of `thickness`, for which rays are followed to the far plane,
    /// and of numbers of edges, parts and instances are not among them.
    pub const ALL: Self = Self {
        depth: true,
        face: true,
        uv: true,
        normal: true,
        thickness: false,
        edge: false,
        part: false,
        instance: false,
    };

    /// An image of depth, face, (u, v) or normal.
    pub fn has_points(self) -> bool {
        self.depth || self.face || self.uv || self.normal
    }

    /// An image of edges, parts or instances.
    pub fn has_numbers(self) -> bool {
        self.edge || self.part || self.instance
    }
}

/// A finished picture in host memory. Row 0 is on top; samples are taken at pixel centres. Images that
/// [`Outputs`] leaves out are empty. Depth, face, (u, v) and normal are those of the first face whose opacity is not 0,
/// transparent or not.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Picture {
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// sRGB-encoded colour, not multiplied by its opacity, and opacity.
    pub colour: Vec<[u8; 4]>,
    /// Distance along the view axis, `+inf` for background.
    pub depth: Vec<f32>,
    /// [`Face::id`](crate::model::Face::id) or [`Mesh::id`](crate::model::Mesh::id), 0 for background.
    pub face: Vec<u32>,
    /// Surface parameters in the face's own domain; of a mesh, the barycentric weights of the triangle's second
    /// and third corner; NaN for background.
    pub uv: Vec<[f32; 2]>,
    /// Unit outward normal in model space; 0 for background.
    pub normal: Vec<[f32; 3]>,
    /// Whether the sun reaches the point: it faces the sun, and no shadow lies on it. Comes with the normals; empty
    /// in scenes without [`SceneSettings::sun`]; false for background.
    pub sunlit: Vec<bool>,
    /// Length of the pixel's ray within solids, between the near and the far plane: Boolean solids and closed parts,
    /// model units, where several overlap counted once; 0 without any.
    pub thickness: Vec<f32>,
    /// Number of the edge whose line covers the pixel, by a tenth or more; 0 without any. Edges are counted from 1 on, part
    /// after part as [`Model::parts`](crate::model::Model::parts) has them: of each those of [`Edges::edges`](crate::model::Edges::edges), then
    /// [`Edges::of_meshes`](crate::model::Edges::of_meshes), drawn or not.
    /// 4294967295 is the outline of a curved face, 4294967294 a line of a Boolean solid. With [`SceneSettings::edges`];
    /// without, 0 everywhere.
    pub edge: Vec<u32>,
    /// Index into [`Model::parts`](crate::model::Model::parts), plus 1; 0 for background, Boolean solids and what is seen
    /// through.
    pub part: Vec<u32>,
    /// The same into [`Model::instances`](crate::model::Model::instances).
    pub instance: Vec<u32>,
    /// The frame's statistics.
    pub stats: FrameStats,
}

impl Picture {
    /// The images that a judge compares.
    pub fn images(&self) -> Images<'_> {
        Images {
            size: self.size,
            depth: &self.depth,
            face: &self.face,
            normal: &self.normal,
            sunlit: &self.sunlit,
            shadow_deviation: self.stats.shadow_deviation,
        }
    }
}

/// The cost of a frame, and counts of the places where the promise does not hold.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct FrameStats {
    /// Name and GPU time in milliseconds of each pass, in order. Where pixels have several samples, passes are those of
    /// the first one; the others are `more samples`, and the images beside the colour `centre sample`.
    pub passes: Vec<PassTime>,
    /// The visibility of each pixel is that of the frame before, which had the same view; where pixels have several
    /// samples, only the division of patches and the trim table are. `passes` lacks the passes that made them, and the
    /// counts are that frame's. Never with [`FrameSettings::all_passes`].
    pub reused: bool,
    /// How faces were trimmed, never [`TrimWay::Auto`]; `None` where no face needs it.
    pub trim: Option<TrimWay>,
    /// Patches of the loaded model, those of each instance counted; of a view from very near, those near it.
    pub patches: u64,
    /// Triangles that the tessellator made, and those of meshes; for one sample. 0 where none was drawn: `reused`.
    pub triangles: u64,
    /// Sub-patches drawn.
    pub sub_patches: u64,
    /// Scan lines of the trim table.
    pub trim_rows: u64,
    /// Chords of trim curves that the trim table was made from.
    pub trim_segments: u64,
    /// u-intercepts stored in the trim table.
    pub trim_intercepts: u64,
    /// Candidates for gap filling: pixels near borders of trimmed faces at which several faces may be seen; of the sample
    /// with the most.
    pub gap_candidates: u64,
    /// Patches whose tessellation factor would have exceeded the largest split; and how often a ray or a tile of Boolean
    /// solids or a row of the trim table needed more steps than the driver lets a shader make: the promise does not hold
    /// there. 0 in a good frame.
    pub clamps: u64,
    /// Patches left out because they lie behind others; 0 in the first frames of a scene, whose occlusion is not tested yet.
    pub hidden_patches: u64,
    /// Crossings of rays with operands of Boolean solids that are meshes or spline parts.
    pub fragments: u64,
    /// Of those rays, how many slip between two faces of an operand and were given the face that is nearest
    /// beside the gap, within the tolerance.
    pub mended: u64,
    /// Rays that enter an operand and never leave it, or leave it without having entered: it is not closed. A ray
    /// without an exit stays inside; an exit without an entry is ignored.
    pub unpaired: u64,
    /// Pixels whose rays meet coincident faces of two solids, with [`SceneSettings::highlight`]; of the
    /// sample with the most.
    pub contact_pixels: u64,
    /// The same of rays that are within two solids at once.
    pub overlap_pixels: u64,
    /// Instances with transparent faces that are not closed, or cut open by a volume: they have no inside, and are drawn
    /// opaque.
    pub open_clear: u64,
    /// In a scene with a sun, the number of things that cast no shadow: transparent solids and parts, parts that a volume
    /// cuts open, and parts and spline operands that would need too many triangles. Such an operand is left out of the
    /// solid that casts the shadow.
    pub shadowless: u64,
    /// In a scene with a sun: shadows that spline faces cast are those of surfaces that are no farther from them than this,
    /// model units. At most an 8192nd of the diagonal of all that casts shadows, and a 1024th of a part's own; more where
    /// that would need too many triangles.
    pub shadow_deviation: f64,
    /// Chords of lines along edges.
    pub edge_chords: u64,
    /// Layers of faces that [`SolidWay::Blister`] peeled off before every pixel was decided.
    pub layers: u64,
    /// Bands of rows of tiles in which the lists of [`SolidWay::Events`] were made: 1 where all of them fit, 0 where
    /// that way draws nothing. See [`SceneSettings::solid_budget`].
    pub bands: u32,
    /// Bytes of the lists and images of Boolean solids: primitives of each of the `blocks` of 8 x 8 tiles, and of each of
    /// the `tiles`; `crossings` with operands; images of `layers`; `resume_points`, where rays resume. Those that exist are listed;
    /// [`SceneSettings::solid_budget`] bounds `tiles` and `crossings` together.
    pub solid_bytes: Vec<PoolBytes>,
    /// Times the frame was recorded again because a buffer was too small, or rays took more segments.
    pub retries: u32,
    /// Bytes copied for edits of trim loops since the frame before.
    pub edit_bytes: u64,
    /// Bytes per memory pool.
    pub pools: Vec<PoolBytes>,
    /// Device name.
    pub device: String,
    /// Driver name and version.
    pub driver: String,
}

/// GPU time of one pass.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct PassTime {
    /// The pass, as in `ARCHITECTURE.md`.
    pub name: String,
    /// Milliseconds between its first and last command.
    pub gpu_ms: f64,
}

/// Bytes in one pool.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct PoolBytes {
    /// `persistent`, `ring` or `transient`.
    pub name: String,
    /// Bytes in buffers and images of this pool.
    pub bytes: u64,
}
