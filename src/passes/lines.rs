//! Pass `lines`: scan lines of each v-strip, `mu = ceil(height / spacing)`.
//!
//! Reads: `frame`, `strip_heights`. Writes: `line_counts`, `counters`.
//! Twin: `src/twin/lines.rs`.

use crate::bindings::with_constants;
use crate::gpu::{Buffer, Commands, ComputeInfo, Device, GpuError, Pipeline};
use crate::shaders;

/// Threads of a workgroup, as in the shader.
const GROUP: u32 = 64;

/// The pass.
pub(crate) struct Lines {
    pipeline: Pipeline,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub strip_heights: &'a Buffer,
    pub line_counts: &'a Buffer,
    /// `clamps`.
    pub counters: &'a Buffer,
}

impl Lines {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        let pipeline = Pipeline::compute(
            device,
            &ComputeInfo {
                name: "lines",
                spirv: shaders::LINES_COMP,
                bindings: &with_constants(4),
                push_bytes: 0,
                constants: &[],
            },
        )?;
        Ok(Self { pipeline })
    }

    /// One thread for each of `strips`.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, strips: u32) {
        let resources = [b.frame, b.strip_heights, b.line_counts, b.counters].map(Into::into);
        cmd.bind(&self.pipeline, &resources, &[]);
        cmd.dispatch(strips.div_ceil(GROUP));
    }
}
