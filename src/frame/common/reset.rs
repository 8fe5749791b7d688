//! Pass `reset`: empty draws and zero counters, before anything counts.
//!
//! ```text
//!    draws     [0 vertices, first = none] x 2 capacity
//!    counters  all 0
//! ```
//!
//! Where patches are drawn a second time, only the draws and how many there are.
//!
//! Reads: `frame`. Writes: `draws`, `counters`.
//! Twin: `src/twin/reset.rs`.

use crate::bindings::with_constants;
use crate::gpu::{Buffer, Commands, ComputeInfo, Device, GpuError, Pipeline};
use crate::shaders;

/// Threads of a workgroup, as in the shader.
const GROUP: u32 = 64;

/// `constant_id` of `DRAWS_ONLY`.
const DRAWS_ONLY: u32 = 1;

/// The pass.
pub(crate) struct Reset {
    pipeline: Pipeline,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    /// The frame.
    pub frame: &'a Buffer,
    /// Plain, then trimmed draws.
    pub draws: &'a Buffer,
    /// What the frame counted.
    pub counters: &'a Buffer,
}

impl Reset {
    /// `draws_only`: the other counters stay.
    pub(crate) fn new(device: &Device, draws_only: bool) -> Result<Self, GpuError> {
        let pipeline = Pipeline::compute(
            device,
            &ComputeInfo {
                name: if draws_only { "reset (draws)" } else { "reset" },
                spirv: shaders::RESET_COMP,
                bindings: &with_constants(3),
                push_bytes: 0,
                constants: &[(DRAWS_ONLY, u32::from(draws_only))],
            },
        )?;
        Ok(Self { pipeline })
    }

    /// One thread for each of `threads`.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, threads: u32) {
        let resources = [b.frame, b.draws, b.counters].map(Into::into);
        cmd.bind(&self.pipeline, &resources, &[]);
        cmd.dispatch(threads.div_ceil(GROUP));
    }
}
