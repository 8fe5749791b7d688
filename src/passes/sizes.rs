//! Pass `sizes`: where the rows of each v-strip are; rows and segments of the whole trim table, and the dispatches that
//! follow from them.
//!
//! Reads: `frame`, `line_starts`, `segment_starts`. Writes: `dispatches`, `strips`, `counters`.
//! Twin: `src/twin/sizes.rs`.

use crate::bindings::with_constants;
use crate::gpu::{Buffer, Commands, ComputeInfo, Device, GpuError, Pipeline};
use crate::shaders;

/// Threads of a workgroup, as in the shader.
const GROUP: u32 = 64;

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
    /// First row and rows of each.
    pub strips: &'a Buffer,
    pub counters: &'a Buffer,
}

impl Sizes {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        let pipeline = Pipeline::compute(
            device,
            &ComputeInfo {
                name: "sizes",
                spirv: shaders::SIZES_COMP,
                bindings: &with_constants(6),
                push_bytes: 0,
                constants: &[],
            },
        )?;
        Ok(Self { pipeline })
    }

    /// One thread for each of `strips`.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, strips: u32) {
        let resources = [b.frame, b.line_starts, b.segment_starts, b.dispatches, b.strips, b.counters].map(Into::into);
        cmd.bind(&self.pipeline, &resources, &[]);
        cmd.dispatch(strips.div_ceil(GROUP));
    }
}
