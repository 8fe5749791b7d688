//! Pass `numbers`: the part and the instance visible in each pixel.
//!
//! ```text
//!   visibility ─▶ patch or mesh instance ─▶ instance of the scene ─sources─▶ the model's part and instance
//! ```
//!
//! Reads: everything that `Bindings` names. Writes: the host's images of numbers, and 0 to the image of edges.

use crate::frame::common::draw::Draw;
use crate::gpu::{
    Attachment, Blend, Buffer, ColourTarget, Commands, Device, GpuError, Image, Load, Pipeline, Resource, TexelBuffer,
};
use crate::shaders;
use ash::vk;

/// Format of the images of edges, parts and instances.
pub(crate) const NUMBER_FORMAT: vk::Format = vk::Format::R32_UINT;

/// The pass.
pub(crate) struct Numbers {
    pipeline: Pipeline,
}

/// Its buffers and images, in binding order.
pub(crate) struct Bindings<'a> {
    pub sources: &'a TexelBuffer,
    pub face_instances: &'a TexelBuffer,
    pub patch_instances: &'a TexelBuffer,
    pub visibility: &'a Image,
    pub meshes_and_solids: &'a Image,
    /// A placeholder in scenes without meshes.
    pub mesh_instances: &'a Buffer,
}

impl Numbers {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        let colour = [ColourTarget { format: NUMBER_FORMAT, blend: Blend::Replace }; 3];
        let draw = Draw::new("numbers", &shaders::RESOLVE_VERT, &shaders::NUMBERS_FRAG);
        Ok(Self { pipeline: Draw { colour: &colour, ..draw }.pipeline(device)? })
    }

    /// Draws one triangle over the images of edges, parts and instances, which are loaded or 0.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, into: [Attachment<'_>; 3]) {
        let cleared = |attachment: Attachment<'_>| match attachment.load {
            Load::Discard => Load::ColourU32([0; 4]),
            load => load,
        };
        let into = into.map(|attachment| Attachment { load: cleared(attachment), ..attachment });
        let texels = [b.sources, b.face_instances, b.patch_instances].map(Resource::from);
        let rest = [b.visibility.into(), b.meshes_and_solids.into(), b.mesh_instances.into()];
        let resources: Vec<_> = texels.into_iter().chain(rest).collect();
        cmd.rendering(b.visibility.size(), &into, None, || {
            cmd.bind(&self.pipeline, &resources, &[]);
            cmd.draw(3, 0, 1);
        });
    }
}
