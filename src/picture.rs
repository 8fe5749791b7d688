//! What a frame is asked for and what it hands back: settings, images, statistics.

use crate::model::Colour;
use serde::Serialize;

/// What the caller decides about a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameSettings {
    /// Largest distance in pixels between a drawn boundary and the true one; the promise. At least
    /// 1/8; the default is one half.
    pub tolerance_px: f64,
    /// Colour behind the model; `None` keeps what the target holds.
    pub background: Option<Colour>,
}

impl Default for FrameSettings {
    fn default() -> Self {
        Self { tolerance_px: 0.5, background: Some([1.0, 1.0, 1.0, 1.0]) }
    }
}

/// Images wanted beside the colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[allow(missing_docs)]
pub struct Outputs {
    pub depth: bool,
    pub face: bool,
    pub uv: bool,
    pub normal: bool,
}

impl Outputs {
    /// Every image.
    pub const ALL: Self = Self { depth: true, face: true, uv: true, normal: true };
}

/// A finished picture in host memory. Row 0 is on top; samples are taken at pixel centres. Images
/// that were not asked for are empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Picture {
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// sRGB-encoded colour and opacity.
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
    /// What the frame cost.
    pub stats: FrameStats,
}

/// What a frame cost and whether anything was clamped.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct FrameStats {
    /// Name and GPU time in milliseconds of each pass, in order.
    pub passes: Vec<PassTime>,
    /// Triangles that the tessellator made, and those of meshes.
    pub triangles: u64,
    /// Sub-patches drawn.
    pub sub_patches: u64,
    /// Scan lines of the trim table.
    pub trim_rows: u64,
    /// u-intercepts stored in the trim table.
    pub trim_intercepts: u64,
    /// Pixels near borders of trimmed faces at which more than one face was asked who is seen.
    pub doubtful_pixels: u64,
    /// Patches whose tessellation factor would have exceeded the largest split: the promise is not
    /// kept there. 0 in a good frame.
    pub clamps: u64,
    /// Times the frame was recorded again because a buffer was too small.
    pub retries: u32,
    /// Bytes per memory pool.
    pub pools: Vec<PoolBytes>,
    /// Device name.
    pub device: String,
    /// Driver name and version.
    pub driver: String,
}

/// GPU time of one pass.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PassTime {
    /// The pass, as in `ARCHITECTURE.md`.
    pub name: String,
    /// Milliseconds between its first and last command.
    pub gpu_ms: f64,
}

/// Bytes in one pool.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PoolBytes {
    /// `persistent`, `ring` or `transient`.
    pub name: String,
    /// Bytes in buffers and images of this pool.
    pub bytes: u64,
}
