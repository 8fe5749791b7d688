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

use crate::bindings::{Placed, with_placed};
use crate::gpu::{
    Attachment, Binding, Blend, Buffer, ColourTarget, Commands, Device, GpuError, GraphicsInfo, Image, Pipeline,
    Resource,
};
use crate::shaders::{self, TRIM_EXACT};
use ash::vk;

/// `constant_id` of `SCENE_HAS_RATIONAL`.
const SCENE_HAS_RATIONAL: u32 = 0;

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
        let mut bindings = with_placed(9);
        bindings[7..9].fill(Binding::StorageImage);
        bindings.extend(vec![Binding::Texels; TRIM_EXACT.texels]);
        let pipeline = Pipeline::graphics(
            device,
            &GraphicsInfo {
                name: "coverage",
                stages: &[
                    (vk::ShaderStageFlags::VERTEX, shaders::RESOLVE_VERT),
                    (vk::ShaderStageFlags::FRAGMENT, shaders::COVERAGE_FRAG),
                ],
                bindings: &bindings,
                push_bytes: 0,
                constants: &[(SCENE_HAS_RATIONAL, u32::from(rational))],
                topology: vk::PrimitiveTopology::TRIANGLE_LIST,
                patch_points: 0,
                cull: vk::CullModeFlags::NONE,
                front: vk::FrontFace::COUNTER_CLOCKWISE,
                colour: &[ColourTarget { format: colour, blend: Blend::Over }],
                depth: None,
                stencil: None,
            },
        )?;
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
