//! Pass `edge_show`: each pixel's best line over its colour, and the number of its edge.
//!
//! ```text
//!   best line ─▶ share, seen or hidden ─▶ colour and opacity ──over──▶ the host's colour
//!                                  resolved ──┘ where it is shown as it is: the target may be see-through
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
    /// Blends lines over the target.
    over: Pipeline,
    /// Writes lines over `resolved`, in scenes that have that image.
    over_resolved: Option<Pipeline>,
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
    /// If the target shows it over the scene's background.
    pub resolved: Option<&'a Image>,
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
        let number = numbers.map(|format| ColourTarget { format, blend: Blend::Replace });
        let meshes_and_solids = data.has_meshes() || data.solids.kinds().is_some();
        let pipeline = |name, blend, fragment| {
            let colour: Vec<_> = [ColourTarget { format: colour, blend }].into_iter().chain(number).collect();
            let constants = [
                (constant::HAS_EDGE_IMAGE, u32::from(numbers.is_some())),
                (constant::SCENE_HAS_MESHES_OR_SOLIDS, u32::from(meshes_and_solids)),
            ];
            let draw = Draw::new(name, &shaders::RESOLVE_VERT, fragment);
            Draw { constants: &constants, colour: &colour, ..draw }.pipeline(device)
        };
        let over_resolved = || pipeline("edge_show (resolved)", Blend::Replace, &shaders::EDGE_SHOW_RESOLVED_FRAG);
        let has_resolved = data.is_mixed() && !data.smooths_trims();
        Ok(Self {
            over: pipeline("edge_show", Blend::Over, &shaders::EDGE_SHOW_FRAG)?,
            over_resolved: has_resolved.then(over_resolved).transpose()?,
        })
    }

    /// One triangle over the targets.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, colours: Colours, into: &[Attachment<'_>]) {
        // not read without
        let edges = b.edges.map_or([b.frame; 3], |e| [&e.piece_instances, &e.pieces, &e.lines]).map(Resource::from);
        let lists = [b.frame.into(), b.best.into(), b.chords.into()].into_iter().chain(edges);
        let over_resolved = self.over_resolved.as_ref().zip(b.resolved);
        // with it, the target and not what is seen says whether a pixel is empty
        let images = match over_resolved {
            Some((_, resolved)) => vec![resolved],
            None => vec![b.visibility, b.meshes_and_solids],
        };
        let pipeline = over_resolved.map_or(&self.over, |(pipeline, _)| pipeline);
        let resources: Vec<_> = lists.chain(images.into_iter().map(Resource::from)).collect();
        cmd.rendering(b.visibility.size(), into, None, || {
            cmd.bind(pipeline, &resources, bytemuck::bytes_of(&colours));
            cmd.draw(3, 0, 1);
        });
    }
}
