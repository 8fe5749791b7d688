//! Pass `solid_cst`: draws the faces of each leaf of the Boolean solids, trimmed by the other leaves.
//!
//! ```text
//!   leaf ──its tiles──▶ two triangles ──▶ ends of its span ──Blist in front and behind──▶ face or not
//!                                                              the depth test keeps the nearest
//! ```
//!
//! Reads: everything that `Bindings` names. Writes: the visibility image (side, depth) and depth. Needs no
//! storage per pixel. Source: J. Hable, J. Rossignac, *CST: constructive solid trimming*, 2007.

use crate::abi;
use crate::bindings::Primitives;
use crate::frame::common::draw::Draw;
use crate::gpu::{
    Attachment, Blend, Buffer, ColourTarget, Commands, DepthTest, Device, GpuError, Pipeline, Resource, TexelBuffer,
};
use crate::shaders::{self, constant};
use ash::vk;

/// The pass.
pub(crate) struct SolidCst {
    pipeline: Pipeline,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub primitives: Primitives<'a>,
    pub tile_starts: &'a Buffer,
    pub tile_leaves: &'a TexelBuffer,
    pub tile_entries: &'a Buffer,
    pub rects: &'a Buffer,
    /// The leaf that each instance draws, as in `trimmed_leaf.glsl`.
    pub order: &'a Buffer,
    /// `clamps`: ends of leaves whose walk through the Blist a driver cut short.
    pub counters: &'a Buffer,
}

impl SolidCst {
    /// For images of these formats; `surfaces`: the most general kind, `abi::SURFACE_*`.
    pub(crate) fn new(
        device: &Device,
        surfaces: u32,
        visibility: vk::Format,
        depth: vk::Format,
    ) -> Result<Self, GpuError> {
        let name = format!("solid cst ({})", abi::surface_kind(surfaces));
        let draw = Draw {
            constants: &[(constant::SOLIDS_HAVE, surfaces)],
            colour: &[ColourTarget { format: visibility, blend: Blend::Replace }],
            depth: Some(DepthTest { format: depth, compare: vk::CompareOp::GREATER, write: true }),
            ..Draw::new(&name, &shaders::SOLID_CST_VERT, &shaders::SOLID_CST_FRAG)
        };
        let pipeline = draw.pipeline(device)?;
        Ok(Self { pipeline })
    }

    /// One instance for each of `drawn`, the length of the order; nearer surfaces stay.
    pub(crate) fn record(
        &self,
        cmd: &Commands<'_>,
        b: &Bindings<'_>,
        (visibility, depth): (Attachment<'_>, Attachment<'_>),
        drawn: u32,
    ) {
        let lists: [Resource<'_>; 2] = [b.tile_starts.into(), b.tile_leaves.into()];
        let rest = [b.tile_entries, b.rects, b.order, b.counters].map(Resource::from);
        let resources: Vec<_> =
            [b.frame.into()].into_iter().chain(b.primitives.resources()).chain(lists).chain(rest).collect();
        cmd.rendering(visibility.image.size(), &[visibility], Some(depth), || {
            cmd.bind(&self.pipeline, &resources, &[]);
            cmd.draw_instances(0..6, 0..drawn);
        });
    }
}
