//! Pass `average`: the mean of a pixel's samples, into the host's colour target.
//!
//! ```text
//!   resolve, once a sample ──added──▶ sum ──/ samples──▶ colour
//! ```
//!
//! Reads: the constants, `sum`. Writes: the target, over what the host keeps. Halves hold the sum: eleven bits of
//! eight linear colours, each a rounding of 2⁻¹², leave the mean right to 1/500 of itself, half a step of 8 bits.

use crate::frame::common::draw::Draw;
use crate::gpu::{Attachment, Blend, Buffer, ColourTarget, Commands, Device, GpuError, Image, Pipeline};
use crate::shaders;
use ash::vk;

/// Format of the sum of a pixel's colours.
pub(crate) const SUM_FORMAT: vk::Format = vk::Format::R16G16B16A16_SFLOAT;

/// The pass.
pub(crate) struct Average {
    pipeline: Pipeline,
}

/// Its buffer and image, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub sum: &'a Image,
}

impl Average {
    pub(crate) fn new(device: &Device, colour: vk::Format) -> Result<Self, GpuError> {
        let colour = [ColourTarget { format: colour, blend: Blend::Over }];
        let draw = Draw::new("average", &shaders::RESOLVE_VERT, &shaders::AVERAGE_FRAG);
        let pipeline = Draw { colour: &colour, ..draw }.pipeline(device)?;
        Ok(Self { pipeline })
    }

    /// One triangle over the target, which is kept or zero before.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, colour: Attachment<'_>) {
        cmd.rendering(b.sum.size(), &[colour], None, || {
            cmd.bind(&self.pipeline, &[b.frame.into(), b.sum.into()], &[]);
            cmd.draw(3, 0, 1);
        });
    }
}
