//! A frame's settings, images and statistics.

mod edges;
mod effects;
mod samples;
mod style;

pub(crate) use edges::LineStyle;
pub use edges::{BadEdges, EdgeChoice, EdgeSettings, TangentEdges, UnknownEdges};
pub use effects::Effects;
pub use samples::{Samples, Smooth, UnknownSamples, UnknownSmooth};
pub use style::{Style, UnknownStyle};

use crate::model::{Colour, Images};
use glam::DVec3;

/// The caller's choices for one frame. Later versions have more of them: end a literal with
/// `..FrameSettings::default()`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameSettings {
    /// Largest distance in pixels between a drawn boundary and the true one: the promise. At least
    /// [`LEAST_TOLERANCE_PX`](Self::LEAST_TOLERANCE_PX); the default is one half.
    pub tolerance_px: f64,
    /// Colour behind the model. With `None`, the target's content stays there.
    pub background: Option<Colour>,
    /// How surfaces look.
    pub style: Style,
    /// The largest curvature on the scale of styles that show it, in 1 / units of the model; beyond it colours stay the
    /// same. Finite and above 0.
    pub curvature_range: f64,
    /// Effects of the scene that this frame leaves out. The picture is that of a scene without them, except that
    /// colours above 1 are cut off as with them.
    pub without: Effects,
    /// How finely patches are divided.
    pub levels: Levels,
    /// Record every pass in every frame, for measurements. Otherwise a frame reuses results of the previous frame,
    /// which gives the same picture, bit for bit, in less time. It reuses the visibility if view and settings are the
    /// same and no loop was edited, and the trim table if that serves the view.
    pub all_passes: bool,
}

/// How the number of segments along a patch's sides is chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Levels {
    /// From bounds on its derivatives, for each view: the promise holds.
    #[default]
    Bound,
    /// The same number for all patches, 1 to 64, for comparisons. The promise does *not* hold.
    Fixed(u32),
}

impl Default for FrameSettings {
    fn default() -> Self {
        Self {
            tolerance_px: 0.5,
            background: Some([1.0, 1.0, 1.0, 1.0]),
            style: Style::Shaded,
            curvature_range: 1.0,
            without: Effects::NONE,
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

/// The way to decide which pixels of a patch the trim loops cut away. All ways draw the same picture within
/// [`FrameSettings::tolerance_px`]; `docs/design/trimming.md` compares their costs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
#[non_exhaustive]
pub enum TrimWay {
    /// [`Table`](Self::Table) for scenes that are expected to need few scan lines, [`Exact`](Self::Exact) for the
    /// others. [`renderer::trim_way`](crate::renderer::trim_way) returns the choice, and [`FrameStats::trim`] the way
    /// of a frame. After a view that needs more scan lines than possible, the scene is trimmed exactly.
    #[default]
    Auto,
    /// The u-intercept table: one table for all views from about the same distance, or for nearby views of a part of
    /// the model; a binary search in each of three rows a pixel.
    Table,
    /// The loops themselves, as arcs of conics in cells that are made once; a few arcs a pixel.
    Exact,
}

/// The way that a scene is trimmed, after [`TrimWay::Auto`] has been resolved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TakenWay {
    Table,
    Exact,
    /// A baseline.
    #[cfg(feature = "baselines")]
    Baseline(crate::baselines::TrimMethod),
}

impl TakenWay {
    /// The host's name for it; `None` for a baseline.
    pub(crate) fn reported(self) -> Option<TrimWay> {
        match self {
            Self::Table => Some(TrimWay::Table),
            Self::Exact => Some(TrimWay::Exact),
            #[cfg(feature = "baselines")]
            Self::Baseline(_) => None,
        }
    }

    /// The name in messages.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Table => TrimWay::Table.name(),
            Self::Exact => TrimWay::Exact.name(),
            #[cfg(feature = "baselines")]
            Self::Baseline(method) => method.name(),
        }
    }

    /// Whether trim textures are used, which are made of curves like the table.
    pub(crate) fn is_texture(self) -> bool {
        match self {
            Self::Table | Self::Exact => false,
            #[cfg(feature = "baselines")]
            Self::Baseline(method) => matches!(method, crate::baselines::TrimMethod::Texture { .. }),
        }
    }
}

impl TrimWay {
    /// Every way except [`Auto`](Self::Auto), which chooses one of them.
    pub const ALL: &'static [Self] = &[Self::Table, Self::Exact];

    /// The name in command lines and tables.
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

/// A name that no way to trim has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no way to trim is called `{0}`; there are: auto, {names}", names = TrimWay::ALL.iter().map(|w| w.name()).collect::<Vec<_>>().join(", "))]
pub struct UnknownTrimWay(String);

/// The way to draw Boolean solids. All ways draw the same picture, bit for bit, except as stated for
/// [`Blister`](Self::Blister).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
#[non_exhaustive]
pub enum SolidWay {
    /// One ray a pixel, followed from event to event until it enters the solid.
    #[default]
    Events,
    /// The faces of each primitive, trimmed by the Blist of the others: constructive solid trimming. Scenes with
    /// operands that are meshes or spline parts, or with transparent solids, are drawn by events.
    Cst,
    /// Layers of faces, peeled from front to back; each is tested whether it bounds the solid, by labels in a stencil
    /// image (Hable and Rossignac). The cost of a layer is that of all primitives. If a mesh's face coincides with
    /// another face, the other face is drawn. A ray that enters and leaves a mesh within the rounding of a depth may
    /// show either side.
    ///
    /// Scenes are drawn by events if an operand is a spline part, or if a solid is transparent. So are scenes with an
    /// operand that is a mesh which is not closed and outward-oriented, intersects itself or has coinciding faces.
    Blister,
}

impl SolidWay {
    /// Every way.
    pub const ALL: &'static [Self] = &[Self::Events, Self::Cst, Self::Blister];

    /// The name in command lines and tables.
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

/// A name that no way to draw Boolean solids has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no way to draw solids is called `{0}`; there are: {names}", names = SolidWay::ALL.iter().map(|w| w.name()).collect::<Vec<_>>().join(", "))]
pub struct UnknownSolidWay(String);

/// Colours that mark where solids of an assembly meet, in linear light. A mark lies in front of everything, with this
/// opacity. The solids are the model's Boolean solids and closed parts, each by itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Highlight {
    /// Where a pixel's ray meets coincident faces of two solids: faces on the same surface with an equation, or
    /// triangles in exactly the same plane. Spline faces never coincide, because rounding separates them.
    pub contact: Colour,
    /// Where the ray is inside two solids at once.
    pub overlap: Colour,
}

impl Default for Highlight {
    /// Blue contacts and red overlaps, both half opaque.
    fn default() -> Self {
        Self { contact: [0.0, 0.1, 1.0, 0.5], overlap: [1.0, 0.0, 0.0, 0.5] }
    }
}

/// The caller's choices for a loaded model. Later versions have more of them: end a literal with
/// `..SceneSettings::default()`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SceneSettings {
    /// How to trim.
    pub trim: TrimWay,
    /// How to draw Boolean solids.
    pub solids: SolidWay,
    /// Loops may be edited between frames. This costs memory, as room for larger loops, and time: trimmed faces are not
    /// split into sub-patches, most of which would need no trim test.
    pub editable: bool,
    /// Samples of each pixel's colour; several samples smooth all edges.
    pub samples: Samples,
    /// The borders that are smoothed. This costs far less than [`samples`](Self::samples), and needs [`Samples::One`].
    pub smooth: Smooth,
    /// Ambient occlusion: points near other surfaces get less of the sky's light. The value is the radius in model
    /// units; surfaces farther away have no effect. `None`: no ambient occlusion. It changes only colours, and only in
    /// styles with light. It needs [`Samples::One`].
    pub ambient: Option<f64>,
    /// Frames may have a style that shows curvature: pixels evaluate second derivatives, too.
    pub curvature: bool,
    /// Frames may have an image of thickness: rays are followed through all solids.
    pub thickness: bool,
    /// Mark contacts and overlaps, and count their pixels: rays are followed through all solids.
    pub highlight: Option<Highlight>,
    /// Direction of the key light: a vector from the model towards the sun, in model axes, of any length but 0. With
    /// `None`, a studio's light travels with the camera and casts no shadows.
    ///
    /// The sun's light is parallel, and reaches a point if nothing opaque lies between. Every face of the scene is
    /// shaded, and everything opaque casts shadows. Shadows of primitives with equations and of meshes are exact.
    /// Spline faces, placed or of operands, cast shadows as triangles within [`FrameStats::shadow_deviation`] of the
    /// faces. No shadows are cast by transparent objects, by parts that
    /// [`Model::trim_by`](crate::model::Model::trim_by) cuts open, or by triangles beyond a million;
    /// [`FrameStats::shadowless`] counts these. Shadows are made with the scene: later edits of loops do not change
    /// them.
    pub sun: Option<DVec3>,
    /// Lines along edges; `None`: no lines. Edges of parts and meshes are found when the model is uploaded; later edits
    /// of loops do not move lines. Lines of Boolean solids are found in each frame.
    pub edges: Option<EdgeSettings>,
    /// Most bytes of the lists of [`SolidWay::Events`]: the primitives of each tile of 16 x 16 pixels, and the
    /// crossings of each pixel's ray with operands that are meshes or spline parts. If the lists would be larger, the
    /// picture is drawn in bands of rows of tiles, one after another, each with all geometry: the same picture, bit for
    /// bit. `None`: for each list, the size of the device's largest storage buffer. If one row of tiles alone needs
    /// more, the frame fails with [`RenderError::TooMany`](crate::renderer::RenderError::TooMany).
    pub solid_budget: Option<u64>,
}

/// Images in addition to the colour. [`Picture`] says what each holds, in which unit and space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outputs {
    /// [`Picture::depth`].
    pub depth: bool,
    /// [`Picture::face`].
    pub face: bool,
    /// [`Picture::uv`].
    pub uv: bool,
    /// [`Picture::normal`].
    pub normal: bool,
    /// [`Picture::thickness`].
    pub thickness: bool,
    /// [`Picture::edge`].
    pub edge: bool,
    /// [`Picture::part`].
    pub part: bool,
    /// [`Picture::instance`].
    pub instance: bool,
}

impl Outputs {
    /// Every image of the first visible point. `thickness`, whose rays are followed to the far plane, and the images of
    /// numbers of edges, parts and instances are not among them.
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

    /// Whether there is an image of depth, face, (u, v) or normal.
    pub fn has_points(self) -> bool {
        self.depth || self.face || self.uv || self.normal
    }

    /// Whether there is an image of edges, parts or instances.
    pub fn has_numbers(self) -> bool {
        self.edge || self.part || self.instance
    }
}

/// A finished picture in host memory. Row 0 is at the top; samples are taken at pixel centres. Images that [`Outputs`]
/// omits are empty. Depth, face, (u, v) and normal are those of the first face whose opacity is not 0, transparent or
/// not.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Picture {
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// sRGB-encoded colour, not multiplied by its opacity, and opacity.
    pub colour: Vec<[u8; 4]>,
    /// Distance from the eye along the view axis, model units; `+inf` for background.
    pub depth: Vec<f32>,
    /// [`Face::id`](crate::model::Face::id) or [`Mesh::id`](crate::model::Mesh::id), 0 for background.
    pub face: Vec<u32>,
    /// Surface parameters in the face's own domain; for a mesh, the barycentric weights of the triangle's second and
    /// third corner; NaN for background.
    pub uv: Vec<[f32; 2]>,
    /// Unit outward normal in model space; 0 for background.
    pub normal: Vec<[f32; 3]>,
    /// Whether the sun's light reaches the point: it faces the sun, and no shadow lies on it. Exists together with the
    /// normals; empty without [`SceneSettings::sun`]; false for background.
    pub sunlit: Vec<bool>,
    /// Length of the pixel's ray inside solids, between the near and the far plane, in model units. Solids are Boolean
    /// solids and closed parts; overlaps count once. 0 without any.
    pub thickness: Vec<f32>,
    /// Number of the edge whose line covers at least a tenth of the pixel; 0 without a line, and everywhere without
    /// [`SceneSettings::edges`]. Edges are numbered from 1, in the order of
    /// [`Model::parts`](crate::model::Model::parts), whether drawn or not. Within a part
    /// [`Edges::edges`](crate::model::Edges::edges) come first, then
    /// [`Edges::of_meshes`](crate::model::Edges::of_meshes). 4294967295 is the outline of a curved face, 4294967294 a
    /// line of a Boolean solid.
    pub edge: Vec<u32>,
    /// Index into [`Model::parts`](crate::model::Model::parts), plus 1; 0 for background, Boolean solids and
    /// transparent parts.
    pub part: Vec<u32>,
    /// Index into [`Model::instances`](crate::model::Model::instances), likewise.
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
    /// Name and GPU time in milliseconds of each pass, in order. With several samples a pixel, the passes of the first
    /// sample are listed; the others are `more samples`, and the images beside the colour are `centre sample`.
    pub passes: Vec<PassTime>,
    /// The visibility of each pixel was reused from the previous frame, which had the same view. With several samples a
    /// pixel, only the division of patches and the trim table were. `passes` omits the passes that made them, and the
    /// counts are those of that frame. Never with [`FrameSettings::all_passes`].
    pub reused: bool,
    /// The way in which faces were trimmed, never [`TrimWay::Auto`]; `None` if no face needs trimming.
    pub trim: Option<TrimWay>,
    /// Patches of the loaded model, counted for each instance; in a very close view, the patches near it.
    pub patches: u64,
    /// Triangles of the tessellator and of meshes, for one sample. 0 if none was drawn: `reused`.
    pub triangles: u64,
    /// Sub-patches drawn.
    pub sub_patches: u64,
    /// Those of them that are whole patches of one segment a side, drawn by their corners without tessellation stages:
    /// in scenes of many patches.
    pub corner_patches: u64,
    /// Scan lines of the trim table.
    pub trim_rows: u64,
    /// Chords of trim curves from which the trim table was made.
    pub trim_segments: u64,
    /// u-intercepts stored in the trim table.
    pub trim_intercepts: u64,
    /// Candidates for gap filling: pixels near borders of trimmed faces where several faces may be visible. With
    /// several samples, the largest count.
    pub gap_candidates: u64,
    /// Patches whose tessellation factor exceeds the largest split, and rays, tiles of Boolean solids and rows of the
    /// trim table that need more steps than the driver allows in a shader. The promise does not hold there. 0 in a good
    /// frame.
    pub clamps: u64,
    /// Patches that were not drawn because other surfaces hide them; 0 in the first frames of a scene, before any
    /// occlusion test. Patches of [`hidden_parts`](Self::hidden_parts) are not among them.
    pub hidden_patches: u64,
    /// Placed parts in the picture that other surfaces hide as a whole, so that no pass looked at their patches. Of a
    /// part of many patches, each group of faces counts as a part. 0 in the first frames of a scene, and in scenes of
    /// few placed parts, with few patches a part, with several samples a pixel, or with spline operands.
    pub hidden_parts: u64,
    /// Patches that passes looked at: those of placed parts, and of groups of faces, in the picture, without
    /// `hidden_parts`.
    pub listed_patches: u64,
    /// Crossings of rays with operands of Boolean solids that are meshes or spline parts.
    pub fragments: u64,
    /// Rays among those that pass through a gap between two faces of an operand, and were given the nearest face beside
    /// the gap, within the tolerance.
    pub mended: u64,
    /// Rays that enter an operand and never leave it, or leave it without having entered: the operand is not closed. A
    /// ray without an exit stays inside; an exit without an entry is ignored.
    pub unpaired: u64,
    /// Pixels whose rays meet coincident faces of two solids, with [`SceneSettings::highlight`]. With several samples,
    /// the largest count.
    pub contact_pixels: u64,
    /// Pixels whose rays are inside two solids at once, likewise.
    pub overlap_pixels: u64,
    /// Instances with transparent faces that are drawn opaque, because they are not closed or a volume cuts them open:
    /// they have no inside.
    pub open_clear: u64,
    /// With a sun, the number of things that cast no shadow: transparent solids and parts, parts that a volume cuts
    /// open, and parts and spline operands that would need too many triangles. Such an operand is missing from the
    /// solid that casts the shadow.
    pub shadowless: u64,
    /// With a sun: largest distance between spline faces and the triangles that cast their shadows, in model units. At
    /// most an 8192nd of the diagonal of all that casts shadows, and a 1024th of a part's own, unless that needs too
    /// many triangles.
    pub shadow_deviation: f64,
    /// Chords of lines along edges.
    pub edge_chords: u64,
    /// Layers of faces that [`SolidWay::Blister`] peeled until every pixel was decided.
    pub layers: u64,
    /// Bands of rows of tiles in which the lists of [`SolidWay::Events`] were made: 1 if all of them fit, 0 if that way
    /// draws nothing. See [`SceneSettings::solid_budget`].
    pub bands: u32,
    /// Bytes of the lists and images of Boolean solids: primitives of each of the `blocks` of 8 x 8 tiles, and of each
    /// of the `tiles`; `crossings` with operands; images of `layers`; `resume_points`, where rays resume. Only existing
    /// ones are listed; [`SceneSettings::solid_budget`] bounds `tiles` and `crossings` together.
    pub solid_bytes: Vec<PoolBytes>,
    /// Times that the frame was recorded again because a buffer was too small, or rays needed more segments.
    pub retries: u32,
    /// Bytes copied for edits of trim loops since the previous frame.
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
    /// The name of the pass.
    pub name: String,
    /// Milliseconds between its first and last command.
    pub gpu_ms: f64,
}

/// Bytes in one pool, or in one kind of list.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct PoolBytes {
    /// `persistent`, `ring`, `transient` or `staging`; in [`FrameStats::solid_bytes`] what that field names.
    pub name: String,
    /// Bytes in buffers and images of this pool.
    pub bytes: u64,
}
