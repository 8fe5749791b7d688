//! Pass `solid_tiles`: lists the leaves of its block that each tile may show; `count`, prefix sum, `list`.
//!
//! Reads: `frame`, `rects`, `block_starts`, `block_leaves`, `starts`. Writes: `counts`, then `leaves`, in
//! Blist order; `counters`.

use crate::frame::common::kernel::Kernel;
use crate::gpu::{Buffer, Commands, Device, GpuError};
use crate::shaders::{self, constant};

/// The pass.
pub(crate) struct SolidTiles {
    count: Kernel,
    list: Kernel,
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
        let kernel = |name, lists| Kernel::new(device, name, &shaders::SOLID_TILES_COMP, &[(constant::LISTS, lists)]);
        Ok(Self { count: kernel("solid tiles (count)", 0)?, list: kernel("solid tiles (list)", 1)? })
    }

    /// One thread for each of `tiles`.
    pub(crate) fn count(&self, cmd: &Commands<'_>, b: &Bindings<'_>, tiles: u32) {
        record(cmd, &self.count, b, tiles);
    }

    /// Lists, after the prefix sum; threads as in [`count`](Self::count).
    pub(crate) fn list(&self, cmd: &Commands<'_>, b: &Bindings<'_>, tiles: u32) {
        record(cmd, &self.list, b, tiles);
    }
}

fn record(cmd: &Commands<'_>, kernel: &Kernel, b: &Bindings<'_>, tiles: u32) {
    let resources =
        [b.frame, b.rects, b.block_starts, b.block_leaves, b.counts, b.starts, b.leaves, b.counters].map(Into::into);
    kernel.record(cmd, &resources, tiles);
}
