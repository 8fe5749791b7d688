//! Pass `solid_blocks`: which leaves each block of tiles may see; `count`, prefix sum, `list`.
//!
//! Reads: `frame`, `rects`, `starts`. Writes: `counts`, then `leaves`, in Blist order.

use crate::bindings::with_constants;
use crate::gpu::{Buffer, Commands, ComputeInfo, Device, GpuError, Pipeline};
use crate::shaders;

/// Threads of a workgroup, as in the shader.
const GROUP: u32 = 64;

/// `constant_id` of `LISTS`.
const LISTS: u32 = 6;

/// The pass.
pub(crate) struct SolidBlocks {
    count: Pipeline,
    list: Pipeline,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub rects: &'a Buffer,
    pub counts: &'a Buffer,
    pub starts: &'a Buffer,
    pub leaves: &'a Buffer,
}

impl SolidBlocks {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        let pipeline = |name, lists| {
            let info = ComputeInfo {
                name,
                spirv: shaders::SOLID_BLOCKS_COMP,
                bindings: &with_constants(5),
                push_bytes: 0,
                constants: &[(LISTS, lists)],
            };
            Pipeline::compute(device, &info)
        };
        Ok(Self { count: pipeline("solid blocks (count)", 0)?, list: pipeline("solid blocks (list)", 1)? })
    }

    /// One thread for each of `runs` of leaves of all blocks.
    pub(crate) fn count(&self, cmd: &Commands<'_>, b: &Bindings<'_>, runs: u32) {
        record(cmd, &self.count, b, runs);
    }

    /// As [`count`](Self::count), after the prefix sum.
    pub(crate) fn list(&self, cmd: &Commands<'_>, b: &Bindings<'_>, runs: u32) {
        record(cmd, &self.list, b, runs);
    }
}

fn record(cmd: &Commands<'_>, pipeline: &Pipeline, b: &Bindings<'_>, runs: u32) {
    let resources = [b.frame, b.rects, b.counts, b.starts, b.leaves].map(Into::into);
    cmd.bind(pipeline, &resources, &[]);
    cmd.dispatch(runs.div_ceil(GROUP));
}
