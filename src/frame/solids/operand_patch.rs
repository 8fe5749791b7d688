//! Pass `operand_patch`: the crossings of rays with the spline faces of operands.
//!
//! ```text
//!   sub-patches ──stages of pass `visibility`──▶ fragments of each pixel: counted, then stored from the pixel's
//!                 ──trim test, Newton──▶         prefix sum on: operand, patch, (u, v), exact depth
//! ```
//!
//! Reads: everything that `Bindings` names except its outputs. Writes: `counts`; in the second step `counts`, which
//! return to 0, and `fragments`.

use crate::abi::Counters;
use crate::bindings::Placed;
use crate::frame::common::draw::Draw;
use crate::gpu::{Buffer, Commands, Device, GpuError, Pipeline, Resource, TexelBuffer};
use crate::shaders::{self, TrimTest, constant};
use ash::vk;
use std::mem::offset_of;
use std::ops::Range;

/// The pass, in its two steps: a pipeline for each kind of patch that the scene has.
pub(crate) struct OperandPatch {
    count: Kinds,
    fill: Kinds,
}

struct Kinds {
    plain: Option<Pipeline>,
    trimmed: Option<Pipeline>,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub placed: Placed<'a>,
    pub factors: &'a Buffer,
    pub sub_patches: &'a Buffer,
    pub instances: &'a TexelBuffer,
    pub counts: &'a Buffer,
    pub starts: &'a Buffer,
    pub fragments: &'a Buffer,
    /// The trim test's resources, in its order.
    pub trim: &'a [Resource<'a>],
    /// Sides that faces share; `None` without any.
    pub links: Option<&'a Buffer>,
    pub draws: &'a Buffer,
    pub counters: &'a Buffer,
}

impl OperandPatch {
    /// `plain`: the scene has patches without a trim test; `linked`: faces share sides; `trimmed`: the trim test of the
    /// others.
    pub(crate) fn new(
        device: &Device,
        rational: bool,
        (plain, linked): (bool, bool),
        trimmed: Option<&TrimTest>,
    ) -> Result<Self, GpuError> {
        let pipeline = |fills: bool, trimmed: Option<&TrimTest>| {
            let (fragment, kind) =
                trimmed.map_or((&shaders::OPERAND_PATCH_FRAG, "plain"), |t| (t.operand_patch, t.way));
            let linked = linked && trimmed.is_none();
            let surface = if linked { &shaders::OPERAND_LINKED_TESE } else { &shaders::VISIBILITY_TESE };
            let name = format!("operand patch ({kind}, {})", if fills { "fill" } else { "count" });
            let draw = Draw {
                tessellation: Some([&shaders::VISIBILITY_TESC, surface]),
                constants: &[
                    (constant::SCENE_HAS_RATIONAL, u32::from(rational)),
                    (constant::TRIMMED, u32::from(trimmed.is_some())),
                    (constant::SCENE_HAS_OPERANDS, 1),
                    (constant::DRAWS_OPERANDS, 1),
                    (constant::FILLS, u32::from(fills)),
                ],
                ..Draw::new(&name, &shaders::VISIBILITY_VERT, fragment)
            };
            draw.pipeline(device)
        };
        let kinds = |fills| {
            Ok(Kinds {
                plain: plain.then(|| pipeline(fills, None)).transpose()?,
                trimmed: trimmed.map(|test| pipeline(fills, Some(test))).transpose()?,
            })
        };
        Ok(Self { count: kinds(false)?, fill: kinds(true)? })
    }

    /// Counts the fragments of each pixel in these rows of a picture of this size, or stores them (`fills`).
    /// `draw_capacity` draws of each kind lie in `draws`, plain first.
    pub(crate) fn record(
        &self,
        cmd: &Commands<'_>,
        b: &Bindings<'_>,
        (size, rows): ((u32, u32), Range<u32>),
        draw_capacity: u32,
        fills: bool,
    ) {
        let bytes = u64::from(draw_capacity) * size_of::<vk::DrawIndirectCommand>() as u64;
        let lists = [b.factors.into(), b.sub_patches.into(), b.instances.into()];
        let fragments = [b.counts, b.starts, b.fragments].map(Into::into);
        let shared = || [b.frame.into()].into_iter().chain(b.placed.resources()).chain(lists).chain(fragments);
        let step = if fills { &self.fill } else { &self.count };
        cmd.rendering_rows((size, rows), &[], None, || {
            if let Some(plain) = &step.plain {
                cmd.bind(plain, &shared().chain(b.links.map(Into::into)).collect::<Vec<_>>(), &[]);
                let count = offset_of!(Counters, plain_draws) as u64;
                cmd.draw_indirect_count(b.draws, 0, b.counters, count, draw_capacity);
            }
            if let Some(trimmed) = &step.trimmed {
                let resources: Vec<_> = shared().chain(b.trim.iter().copied()).collect();
                cmd.bind(trimmed, &resources, &[]);
                let count = offset_of!(Counters, trimmed_draws) as u64;
                cmd.draw_indirect_count(b.draws, bytes, b.counters, count, draw_capacity);
            }
        });
    }
}
