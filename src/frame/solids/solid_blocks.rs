//! Pass `solid_blocks`: lists the leaves that each block of tiles may show; `count`, prefix sum, `list`.
//!
//! Reads: `frame`, `rects`, `starts`. Writes: `counts`, then `leaves`, in Blist order.

use crate::frame::common::kernel::Kernel;
use crate::gpu::{Buffer, Commands, Device, GpuError};
use crate::shaders::{self, constant};

/// The pass.
pub(crate) struct SolidBlocks {
    count: Kernel,
    list: Kernel,
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
        let kernel = |name, lists| Kernel::new(device, name, &shaders::SOLID_BLOCKS_COMP, &[(constant::LISTS, lists)]);
        Ok(Self { count: kernel("solid blocks (count)", 0)?, list: kernel("solid blocks (list)", 1)? })
    }

    /// Counts; one thread for each of `runs`, the runs of leaves of all blocks.
    pub(crate) fn count(&self, cmd: &Commands<'_>, b: &Bindings<'_>, runs: u32) {
        record(cmd, &self.count, b, runs);
    }

    /// Lists, after the prefix sum; threads as in [`count`](Self::count).
    pub(crate) fn list(&self, cmd: &Commands<'_>, b: &Bindings<'_>, runs: u32) {
        record(cmd, &self.list, b, runs);
    }
}

fn record(cmd: &Commands<'_>, kernel: &Kernel, b: &Bindings<'_>, runs: u32) {
    let resources = [b.frame, b.rects, b.counts, b.starts, b.leaves].map(Into::into);
    kernel.record(cmd, &resources, runs);
}
