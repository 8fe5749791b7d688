//! Pass `solid_rects`: the tiles that the box around each leaf may cover.
//!
//! Reads: `frame`, `leaves`, `centres`. Writes: `rects`. Twin: `src/twin/solid_rects.rs`.

use crate::bindings::with_constants;
use crate::gpu::{Buffer, Commands, ComputeInfo, Device, GpuError, Pipeline};
use crate::shaders;

/// Threads of a workgroup, as in the shader.
const GROUP: u32 = 64;

/// The pass.
pub(crate) struct SolidRects {
    pipeline: Pipeline,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub leaves: &'a Buffer,
    /// Of the leaves, model axes, seen from the eye.
    pub centres: &'a Buffer,
    pub rects: &'a Buffer,
}

impl SolidRects {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        let pipeline = Pipeline::compute(
            device,
            &ComputeInfo {
                name: "solid rects",
                spirv: shaders::SOLID_RECTS_COMP,
                bindings: &with_constants(4),
                push_bytes: 0,
                constants: &[],
            },
        )?;
        Ok(Self { pipeline })
    }

    /// One thread for each of `leaves`.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, leaves: u32) {
        let resources = [b.frame, b.leaves, b.centres, b.rects].map(Into::into);
        cmd.bind(&self.pipeline, &resources, &[]);
        cmd.dispatch(leaves.div_ceil(GROUP));
    }
}
