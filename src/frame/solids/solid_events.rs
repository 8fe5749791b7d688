//! Pass `solid_events`: finds the point where each pixel's ray enters a Boolean solid.
//!
//! ```text
//!   leaves of the tile ──▶ spans of the ray ──▶ events in order ──▶ Blist behind each ──▶ first outside→inside
//! ```
//!
//! Reads: everything that `Bindings` names. Writes: the visibility image (side, depth) and depth, in addition to pass
//! `visibility`; for spline faces, the image of (u, v). Per pixel it stores only the fragments of operands without
//! equations; if a driver ends long loops, also the point where the ray's next segment resumes.

use crate::abi;
use crate::bindings::Primitives;
use crate::frame::common::draw::Draw;
use crate::gpu::{
    Attachment, Blend, Buffer, ColourTarget, Commands, DepthTest, Device, GpuError, Pipeline, Resource, TexelBuffer,
};
use crate::shaders::{self, constant};
use ash::vk;
use std::ops::Range;

/// Format of the image of (u, v) of spline faces: packed as in the visibility image.
pub(crate) const OPERAND_UV_FORMAT: vk::Format = vk::Format::R32_UINT;

/// The kinds of surfaces in the scene.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Kinds {
    /// The most general kind of surface: `abi::SURFACE_*`.
    pub surfaces: u32,
    /// Some operand has no equations.
    pub boundary_operands: bool,
    /// Some operand is a spline part.
    pub patches: bool,
    /// There are items that rays are followed through.
    pub followed: bool,
}

/// The pass.
pub(crate) struct SolidEvents {
    pipeline: Pipeline,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub primitives: Primitives<'a>,
    pub tile_starts: &'a TexelBuffer,
    pub tile_leaves: &'a TexelBuffer,
    pub tile_entries: &'a TexelBuffer,
    /// Crossings of rays with operands without equations; `None` without such operands.
    pub fragments: Option<Fragments<'a>>,
    /// `clamps`: rays that a driver cut short.
    pub counters: &'a Buffer,
    pub tile_squares: &'a Buffer,
    /// The point where each ray's next segment resumes, one word a pixel of the band; `None` with one segment.
    pub resume_points: Option<&'a Buffer>,
}

/// One segment of a drawing's rays.
#[derive(Clone, Copy)]
pub(crate) struct RaySegment {
    /// Number, from 0.
    pub nth: u32,
    pub of: u32,
    /// It is the last possible segment: rays that it does not finish are clamps. Otherwise they make the frame report
    /// failure.
    pub is_most: bool,
}

/// The sorted fragments of each pixel.
pub(crate) struct Fragments<'a> {
    pub starts: &'a Buffer,
    pub counts: &'a Buffer,
    pub all: &'a TexelBuffer,
}

impl SolidEvents {
    /// For images of these formats.
    pub(crate) fn new(
        device: &Device,
        kinds: Kinds,
        visibility: vk::Format,
        depth: vk::Format,
    ) -> Result<Self, GpuError> {
        let target = |format| ColourTarget { format, blend: Blend::Replace };
        let colour = [target(visibility), target(OPERAND_UV_FORMAT)];
        let name = format!("solid events ({})", abi::surface_kind(kinds.surfaces));
        let draw = Draw {
            constants: &[
                (constant::SOLIDS_HAVE, kinds.surfaces),
                (constant::SOLIDS_HAVE_BOUNDARY_OPERANDS, u32::from(kinds.boundary_operands)),
                (constant::SOLIDS_ARE_FOLLOWED, u32::from(kinds.followed)),
            ],
            colour: &colour[..if kinds.patches { 2 } else { 1 }],
            depth: Some(DepthTest { format: depth, compare: vk::CompareOp::GREATER, write: true }),
            ..Draw::new(&name, &shaders::SOLID_EVENTS_VERT, &shaders::SOLID_EVENTS_FRAG)
        };
        let pipeline = draw.pipeline(device)?;
        Ok(Self { pipeline })
    }

    /// Draws the squares that begin at one of `tiles`, in these rows of the picture; nearer surfaces stay. `uv` in
    /// scenes with spline operands.
    pub(crate) fn record(
        &self,
        cmd: &Commands<'_>,
        b: &Bindings<'_>,
        (visibility, uv, depth): (Attachment<'_>, Option<Attachment<'_>>, Attachment<'_>),
        (rows, tiles): (Range<u32>, Range<u32>),
        segment: RaySegment,
    ) {
        // the shader declares these bindings in every scene, and reads them only with boundary operands
        let none = Fragments { starts: b.frame, counts: b.frame, all: b.tile_leaves };
        let f = b.fragments.as_ref().unwrap_or(&none);
        let lists: [Resource<'_>; 3] = [b.tile_starts.into(), b.tile_leaves.into(), b.tile_entries.into()];
        let fragments: [Resource<'_>; 3] = [f.starts.into(), f.counts.into(), f.all.into()];
        let rest = [b.counters, b.tile_squares, b.resume_points.unwrap_or(b.counters)].map(Resource::from);
        let segment: Vec<u8> =
            [segment.nth, segment.of, u32::from(segment.is_most)].into_iter().flat_map(u32::to_ne_bytes).collect();
        let resources: Vec<_> = [b.frame.into()]
            .into_iter()
            .chain(b.primitives.resources())
            .chain(lists)
            .chain(fragments)
            .chain(rest)
            .collect();
        let colour: Vec<_> = [visibility].into_iter().chain(uv).collect();
        cmd.rendering_rows((visibility.image.size(), rows), &colour, Some(depth), || {
            cmd.bind(&self.pipeline, &resources, &segment);
            cmd.draw_instances(0..6, tiles);
        });
    }
}
