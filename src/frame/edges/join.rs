//! Pass `edge_join`: lines through the places where what is seen of Boolean solids changes.
//!
//! ```text
//!   four centres, changes on the ways between them ─▶ stretches ─▶ share of each pixel around ─▶ each pixel's best line
//! ```
//!
//! Reads: everything that `record` is given. Writes: `best`, as pass `edge_line`.

use crate::frame::common::draw::Draw;
use crate::gpu::{Buffer, Commands, Device, GpuError, Image, Pipeline};
use crate::shaders;

/// The pass.
pub(crate) struct Join {
    pipeline: Pipeline,
}

impl Join {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        let draw = Draw::new("edge_join", &shaders::RESOLVE_VERT, &shaders::EDGE_JOIN_FRAG);
        Ok(Self { pipeline: draw.pipeline(device)? })
    }

    /// One triangle over a picture of `changes`' size; lines are twice `half_px` wide: full, thin, bold.
    pub(crate) fn record(
        &self,
        cmd: &Commands<'_>,
        frame: &Buffer,
        (changes, best): (&Image, &Image),
        half_px: [f32; 3],
    ) {
        cmd.rendering(changes.size(), &[], None, || {
            cmd.bind(&self.pipeline, &[frame.into(), changes.into(), best.into()], bytemuck::bytes_of(&half_px));
            cmd.draw(3, 0, 1);
        });
    }
}
