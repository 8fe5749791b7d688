//! Pass `resolve`, its pixels of Boolean solids: normal and light of the side that the ray enters.
//!
//! Reads: everything that `Bindings` names. Writes: the targets, where pass `resolve` left pixels alone.

use crate::gpu::{
    Attachment, Binding, Blend, Buffer, ColourTarget, Commands, DepthTest, Device, GpuError, GraphicsInfo, Image, Load,
    Pipeline,
};
use crate::shaders;
use ash::vk;

/// `constant_id` of `HAS_AOVS`.
const HAS_AOVS: u32 = 3;

/// The pass.
pub(crate) struct ResolveSolids {
    pipeline: Pipeline,
}

/// Its buffers and image, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub leaves: &'a Buffer,
    pub leaf_surfaces: &'a Buffer,
    pub surfaces: &'a Buffer,
    pub surface_centres: &'a Buffer,
    pub visibility: &'a Image,
}

impl ResolveSolids {
    /// For these targets; `colour` holds the host's and those of the extra images, if any.
    pub(crate) fn new(device: &Device, colour: &[vk::Format], depth: Option<vk::Format>) -> Result<Self, GpuError> {
        let colour: Vec<_> = colour.iter().map(|&format| ColourTarget { format, blend: Blend::Replace }).collect();
        let mut bindings = [Binding::Storage; 6];
        bindings[5] = Binding::StorageImage;
        let pipeline = Pipeline::graphics(
            device,
            &GraphicsInfo {
                name: "resolve (solids)",
                stages: &[
                    (vk::ShaderStageFlags::VERTEX, shaders::RESOLVE_VERT),
                    (vk::ShaderStageFlags::FRAGMENT, shaders::RESOLVE_SOLIDS_FRAG),
                ],
                bindings: &bindings,
                push_bytes: 0,
                constants: &[(HAS_AOVS, u32::from(colour.len() > 1))],
                topology: vk::PrimitiveTopology::TRIANGLE_LIST,
                patch_points: 0,
                cull: vk::CullModeFlags::NONE,
                front: vk::FrontFace::COUNTER_CLOCKWISE,
                colour: &colour,
                depth: depth.map(|format| DepthTest { format, compare: vk::CompareOp::GREATER_OR_EQUAL, write: true }),
            },
        )?;
        Ok(Self { pipeline })
    }

    /// One triangle over the targets.
    pub(crate) fn record(
        &self,
        cmd: &Commands<'_>,
        b: &Bindings<'_>,
        colour: &[Attachment<'_>],
        depth: Option<Attachment<'_>>,
    ) {
        let colour: Vec<_> = colour.iter().map(|a| Attachment { load: Load::Keep, ..*a }).collect();
        let depth = depth.map(|a| Attachment { load: Load::Keep, ..a });
        cmd.rendering(b.visibility.size(), &colour, depth, || {
            let buffers = [b.frame, b.leaves, b.leaf_surfaces, b.surfaces, b.surface_centres].map(Into::into);
            let resources: Vec<_> = buffers.into_iter().chain([b.visibility.into()]).collect();
            cmd.bind(&self.pipeline, &resources, &[]);
            cmd.draw(3, 0, 1);
        });
    }
}
