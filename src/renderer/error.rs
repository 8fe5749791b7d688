//! Why a model was not uploaded, or a frame not recorded.

use super::{TooMany, UndrawnEdges, UndrawnSolid};
use crate::gpu::GpuError;
use crate::model::{CameraError, ModelError};
use crate::picture::{BadEdges, FrameSettings};

impl RenderError {
    /// The error of Vulkan or of memory within.
    pub fn gpu(&self) -> Option<&GpuError> {
        if let Self::Gpu(error) = self { Some(error) } else { None }
    }
}

/// Why a model was not uploaded, or a frame not recorded. The renderer is as it was before the call, unless the device
/// is lost.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The camera shows nothing.
    #[error("camera: {0}")]
    Camera(#[from] CameraError),
    /// Vulkan or its memory.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// [`FrameSettings::tolerance_px`] is below [`FrameSettings::LEAST_TOLERANCE_PX`].
    #[error("the tolerance must be at least {least} pixels, not {0}", least = FrameSettings::LEAST_TOLERANCE_PX)]
    Tolerance(f64),
    /// The model cannot be drawn.
    #[error("model: {0}")]
    Model(#[from] ModelError),
    /// An added model has [`Model::trim`](crate::model::Model::trim).
    #[error("a model with a volume that trims it cannot be added: the volume would trim the whole scene")]
    AddedVolume,
    /// The model, or what this view needs of it.
    #[error(transparent)]
    TooMany(#[from] TooMany),
    /// A Boolean solid that cannot be drawn.
    #[error(transparent)]
    Solid(#[from] UndrawnSolid),
    /// [`sun`](crate::picture::SceneSettings::sun) has no length, or no numbers.
    #[error("the direction towards the sun must be finite and not 0, not {0}")]
    Sun(glam::DVec3),
    /// [`Smooth::Trims`](crate::picture::Smooth::Trims) beside something that it does not go with.
    #[error("smooth trims do not go with {0}")]
    SmoothTrims(&'static str),
    /// [`curvature_range`](FrameSettings::curvature_range) is no end of a scale.
    #[error("the largest curvature on the scale must be finite and above 0, not {0}")]
    CurvatureRange(f64),
    /// A style of curvature without [`SceneSettings::curvature`](crate::picture::SceneSettings::curvature).
    #[error("the model is not uploaded with SceneSettings::curvature")]
    NoCurvature,
    /// [`ambient`](crate::picture::SceneSettings::ambient) is not a radius.
    #[error("the radius of ambient occlusion must be finite and above 0, not {0}")]
    AmbientRadius(f64),
    /// [`ambient`](crate::picture::SceneSettings::ambient) with several samples a pixel.
    #[error("ambient occlusion does not go with several samples a pixel")]
    AmbientSamples,
    /// [`edges`](crate::picture::SceneSettings::edges) that cannot be drawn.
    #[error(transparent)]
    Edges(#[from] BadEdges),
    /// A part whose edges are no curves.
    #[error("edges: {0}")]
    UndrawnEdges(#[from] UndrawnEdges),
    /// A target of another size than the camera's.
    #[error("the target `{name}` is {width} x {height}, the camera's picture another size")]
    TargetSize {
        /// Its name.
        name: String,
        /// Its width.
        width: u32,
        /// Its height.
        height: u32,
    },
    /// A target does not contain the rectangle at [`Targets::corner`](super::Targets::corner).
    #[error("the target `{name}` is {width} x {height}: a picture of {} x {} at {}, {} is not within it",
        .size.0, .size.1, .corner.0, .corner.1)]
    TargetCorner {
        /// Its name.
        name: String,
        /// Its width.
        width: u32,
        /// Its height.
        height: u32,
        /// Column and row.
        corner: (u32, u32),
        /// Of the camera's picture.
        size: (u32, u32),
    },
}
