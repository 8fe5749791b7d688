//! Pass `coverage`: the borders of trimmed faces, smooth: each pixel there is mixed from what it sees.
//!
//! ```text
//!   visibility ───────────────┐
//!   resolved (colour, depth) ─┴─ share of the pixel inside the trim curves ──▶ the host's colour
//! ```
//!
//! Reads: everything that `Bindings` names. Writes: the colour target, over what the host keeps. The share is exact for
//! straight trim curves, and for bent ones within what `twin::coverage` says; pixels away from borders come out as
//! pass `resolve` drew them.

use crate::bindings::Placed;
use crate::frame::common::draw::Draw;
use crate::gpu::{Attachment, Blend, Buffer, ColourTarget, Commands, Device, GpuError, Image, Pipeline, Resource};
use crate::shaders::{self, constant};
use ash::vk;

/// The pass.
pub(crate) struct Coverage {
    pipeline: Pipeline,
}

/// Its buffers and images, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub placed: Placed<'a>,
    pub visibility: &'a Image,
    /// Linear colour and depth.
    pub resolved: &'a Image,
    /// Of the exact way to trim.
    pub trim: &'a [Resource<'a>],
}

impl Coverage {
    pub(crate) fn new(device: &Device, colour: vk::Format, rational: bool) -> Result<Self, GpuError> {
        let colour = [ColourTarget { format: colour, blend: Blend::Over }];
        let constants = [(constant::SCENE_HAS_RATIONAL, u32::from(rational))];
        let draw = Draw::new("coverage", &shaders::RESOLVE_VERT, &shaders::COVERAGE_FRAG);
        let pipeline = Draw { constants: &constants, colour: &colour, ..draw }.pipeline(device)?;
        Ok(Self { pipeline })
    }

    /// One triangle over the target, which is kept or zero before.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, colour: Attachment<'_>) {
        let images = [b.visibility.into(), b.resolved.into()];
        let placed = [b.frame.into()].into_iter().chain(b.placed.resources());
        let resources: Vec<_> = placed.chain(images).chain(b.trim.iter().copied()).collect();
        cmd.rendering(b.visibility.size(), &[colour], None, || {
            cmd.bind(&self.pipeline, &resources, &[]);
            cmd.draw(3, 0, 1);
        });
    }
}
