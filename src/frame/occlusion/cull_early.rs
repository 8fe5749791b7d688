//! Pass `cull_early`: patches that lay behind others in the frame before are not drawn, unless pass
//! [`cull_late`](super::cull_late) finds that they may be seen.
//!
//! Reads: `frame`, `hidden`. Writes: `taus`, `counters`. Twin: `src/twin/occlusion.rs`.

use crate::bindings::with_constants;
use crate::gpu::{Buffer, Commands, ComputeInfo, Device, GpuError, Pipeline};
use crate::shaders;

/// Threads of a workgroup, as in the shader.
const GROUP: u32 = 64;

/// The pass.
pub(crate) struct CullEarly {
    pipeline: Pipeline,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    /// Of each item: whether it lay behind others.
    pub hidden: &'a Buffer,
    pub taus: &'a Buffer,
    /// `hidden`.
    pub counters: &'a Buffer,
}

impl CullEarly {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        let pipeline = Pipeline::compute(
            device,
            &ComputeInfo {
                name: "cull early",
                spirv: shaders::CULL_EARLY_COMP,
                bindings: &with_constants(4),
                push_bytes: 0,
                constants: &[],
            },
        )?;
        Ok(Self { pipeline })
    }

    /// One thread for each of `items`.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, items: u32) {
        let resources = [b.frame, b.hidden, b.taus, b.counters].map(Into::into);
        cmd.bind(&self.pipeline, &resources, &[]);
        cmd.dispatch(items.div_ceil(GROUP));
    }
}
