//! Pass `solid_tiles`: which leaves each tile may see, of those of its block; `count`, prefix sum, `list`.
//!
//! Reads: `frame`, `rects`, `block_starts`, `block_leaves`, `starts`. Writes: `counts`, then `leaves`, in
//! Blist order; `counters`.

use crate::bindings::with_constants;
use crate::gpu::{Buffer, Commands, ComputeInfo, Device, GpuError, Pipeline};
use crate::shaders;

/// Threads of a workgroup, as in the shader.
const GROUP: u32 = 64;

/// `constant_id` of `LISTS`.
const LISTS: u32 = 6;

/// The pass.
pub(crate) struct SolidTiles {
    count: Pipeline,
    list: Pipeline,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub rects: &'a Buffer,
    pub block_starts: &'a Buffer,
    pub block_leaves: &'a Buffer,
    pub counts: &'a Buffer,
    pub starts: &'a Buffer,
    pub leaves: &'a Buffer,
    /// `block_leaves`, `tile_leaves`, `failed`.
    pub counters: &'a Buffer,
}

impl SolidTiles {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        let pipeline = |name, lists| {
            let info = ComputeInfo {
                name,
                spirv: shaders::SOLID_TILES_COMP,
                bindings: &with_constants(8),
                push_bytes: 0,
                constants: &[(LISTS, lists)],
            };
            Pipeline::compute(device, &info)
        };
        Ok(Self { count: pipeline("solid tiles (count)", 0)?, list: pipeline("solid tiles (list)", 1)? })
    }

    /// One thread for each of `tiles`.
    pub(crate) fn count(&self, cmd: &Commands<'_>, b: &Bindings<'_>, tiles: u32) {
        record(cmd, &self.count, b, tiles);
    }

    /// As [`count`](Self::count), after the prefix sum.
    pub(crate) fn list(&self, cmd: &Commands<'_>, b: &Bindings<'_>, tiles: u32) {
        record(cmd, &self.list, b, tiles);
    }
}

fn record(cmd: &Commands<'_>, pipeline: &Pipeline, b: &Bindings<'_>, tiles: u32) {
    let resources =
        [b.frame, b.rects, b.block_starts, b.block_leaves, b.counts, b.starts, b.leaves, b.counters].map(Into::into);
    cmd.bind(pipeline, &resources, &[]);
    cmd.dispatch(tiles.div_ceil(GROUP));
}
