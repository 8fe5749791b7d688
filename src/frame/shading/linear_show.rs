//! Pass `linear_show`: writes linear colours to the host's colour.
//!
//! ```text
//!   resolved: linear colour and depth; in mixed pixels, colour and opacity ──▶ blended over the target
//! ```
//!
//! Reads: `frame`, `resolved`. Writes: the colour target.

use crate::frame::common::draw::Draw;
use crate::gpu::{Attachment, Blend, Buffer, ColourTarget, Commands, Device, GpuError, Image, Pipeline};
use crate::shaders;
use ash::vk;

/// The pass.
pub(crate) struct LinearShow {
    pipeline: Pipeline,
}

impl LinearShow {
    /// For targets of the format `colour`.
    pub(crate) fn new(device: &Device, colour: vk::Format) -> Result<Self, GpuError> {
        let colour = [ColourTarget { format: colour, blend: Blend::Over }];
        let draw = Draw::new("linear_show", &shaders::RESOLVE_VERT, &shaders::LINEAR_SHOW_FRAG);
        Ok(Self { pipeline: Draw { colour: &colour, ..draw }.pipeline(device)? })
    }

    /// Draws one triangle over the target, which is loaded or zero.
    pub(crate) fn record(&self, cmd: &Commands<'_>, frame: &Buffer, resolved: &Image, colour: Attachment<'_>) {
        cmd.rendering(resolved.size(), &[colour], None, || {
            cmd.bind(&self.pipeline, &[frame.into(), resolved.into()], &[]);
            cmd.draw(3, 0, 1);
        });
    }
}
