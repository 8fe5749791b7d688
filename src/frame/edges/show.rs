//! Pass `edge_show`: each pixel's best line over its colour, and the number of its edge.
//!
//! ```text
//!   best line ─▶ share, seen or hidden ─▶ colour and opacity ──over──▶ the host's colour
//!            └─▶ chord ─▶ edge ─▶ number ─▶ the host's image of edges
//! ```
//!
//! Reads: everything that `Bindings` names. Writes: the targets.

use crate::frame::common::draw::Draw;
use crate::gpu::{Attachment, Blend, Buffer, ColourTarget, Commands, Device, GpuError, Image, Pipeline, Resource};
use crate::scene::{EdgeBuffers, SceneData};
use crate::shaders::{self, constant};
use ash::vk;
use bytemuck::{Pod, Zeroable};

/// The pass.
pub(crate) struct Show {
    pipeline: Pipeline,
}

/// Its buffers and images, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub best: &'a Image,
    pub chords: &'a Buffer,
    /// Where lines are drawn along edges.
    pub edges: Option<&'a EdgeBuffers>,
    pub visibility: &'a Image,
    pub meshes_and_solids: &'a Image,
}

/// Of the colour, and of the image of numbers where there is one.
pub(crate) type Formats = (vk::Format, Option<vk::Format>);

/// Linear light, and opacity.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct Colours {
    pub seen: [f32; 4],
    pub hidden: [f32; 4],
}

impl Show {
    pub(crate) fn new(device: &Device, data: &SceneData, (colour, numbers): Formats) -> Result<Self, GpuError> {
        let over = ColourTarget { format: colour, blend: Blend::Over };
        let number = numbers.map(|format| ColourTarget { format, blend: Blend::Replace });
        let colour: Vec<_> = [over].into_iter().chain(number).collect();
        let meshes_and_solids = data.has_meshes() || data.solids.kinds().is_some();
        let constants = [
            (constant::HAS_EDGE_IMAGE, u32::from(numbers.is_some())),
            (constant::SCENE_HAS_MESHES_OR_SOLIDS, u32::from(meshes_and_solids)),
        ];
        let draw = Draw::new("edge_show", &shaders::RESOLVE_VERT, &shaders::EDGE_SHOW_FRAG);
        Ok(Self { pipeline: Draw { constants: &constants, colour: &colour, ..draw }.pipeline(device)? })
    }

    /// One triangle over the targets.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, colours: Colours, into: &[Attachment<'_>]) {
        // not read without
        let edges = b.edges.map_or([b.frame; 3], |e| [&e.piece_instances, &e.pieces, &e.lines]).map(Resource::from);
        let lists = [b.frame.into(), b.best.into(), b.chords.into()].into_iter().chain(edges);
        let images = [b.visibility, b.meshes_and_solids].map(Resource::from);
        let resources: Vec<_> = lists.chain(images).collect();
        cmd.rendering(b.visibility.size(), into, None, || {
            cmd.bind(&self.pipeline, &resources, bytemuck::bytes_of(&colours));
            cmd.draw(3, 0, 1);
        });
    }
}
