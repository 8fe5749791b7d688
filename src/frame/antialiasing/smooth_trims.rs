//! Smooth borders of trimmed faces.
//!
//! ```text
//!   resolve ──▶ linear colour and depth ──coverage──▶ the host's colour
//!           ──▶ the host's depth, depth, face, (u, v), normal: those of the pixels' centres, as without it
//! ```

use super::coverage;
use crate::frame::Frame;
use crate::frame::common::room::{DRAWN_AND_READ, Room};
use crate::frame::shading::resolve;
use crate::gpu::{Access, Attachment, Commands, Device, GpuError, Image, Load, Resource, barrier};
use crate::scene::SceneData;
use std::sync::Arc;

/// The pass; `None` where no trims are smoothed.
pub(crate) fn pass(
    device: &Device,
    data: &SceneData,
    formats: resolve::Formats,
) -> Result<Option<coverage::Coverage>, GpuError> {
    let make = || coverage::Coverage::new(device, formats.colour, data.has_rational);
    data.smooths_trims().then(make).transpose()
}

/// The stage.
pub(crate) struct SmoothTrims {
    pass: Arc<coverage::Coverage>,
    /// What is mixed: linear colour and depth.
    pub resolved: Image,
}

impl SmoothTrims {
    pub(crate) fn new(room: &Room<'_>, pass: &Arc<coverage::Coverage>) -> Result<Self, GpuError> {
        let resolved = room.image("resolved", resolve::BEHIND_FORMAT, DRAWN_AND_READ)?;
        Ok(Self { pass: Arc::clone(pass), resolved })
    }

    /// Pixels at the borders of trimmed faces are mixed from what pass `resolve` drew; all go to the host's colour.
    pub(crate) fn record(&self, frame: &Frame<'_>, cmd: &Commands<'_>, test: &[Resource<'_>]) {
        barrier::images(cmd, &[(&self.resolved, Access::COLOUR_WRITE, Access::FRAGMENT_READ)]);
        let bindings = coverage::Bindings {
            frame: frame.constants,
            placed: frame.scene.placed(frame.views),
            visibility: &frame.stages.visibility.image,
            resolved: &self.resolved,
            trim: test,
        };
        let load = match frame.colour[0].load {
            Load::Discard => Load::ColourF32([0.0; 4]),
            load => load,
        };
        self.pass.record(cmd, &bindings, Attachment { load, ..frame.colour[0] });
    }
}
