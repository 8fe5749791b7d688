//! Pass `sizes`: rows and segments of the trim table, and the dispatches that follow from them.
//!
//! Reads: `frame`, `line_starts`, `segment_starts`. Writes: `dispatches`, `counters`.
//! Twin: `src/twin/sizes.rs`.

use crate::bindings::with_constants;
use crate::gpu::{Buffer, Commands, ComputeInfo, Device, GpuError, Pipeline};
use crate::shaders;

/// Threads of a workgroup, as in the shader.
const GROUP: u32 = 1;

/// The pass.
pub(crate) struct Sizes {
    pipeline: Pipeline,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub line_starts: &'a Buffer,
    pub segment_starts: &'a Buffer,
    /// Of passes cross and sort.
    pub dispatches: &'a Buffer,
    pub counters: &'a Buffer,
}

impl Sizes {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        let pipeline = Pipeline::compute(
            device,
            &ComputeInfo {
                name: "sizes",
                spirv: shaders::SIZES_COMP,
                bindings: &with_constants(5),
                push_bytes: 0,
                constants: &[],
            },
        )?;
        Ok(Self { pipeline })
    }

    /// One thread.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>) {
        let resources = [b.frame, b.line_starts, b.segment_starts, b.dispatches, b.counters].map(Into::into);
        cmd.bind(&self.pipeline, &resources, &[]);
        cmd.dispatch(GROUP);
    }
}
