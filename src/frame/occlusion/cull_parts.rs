//! Pass `cull_parts`: finds the placed parts that are hidden as a whole behind the surfaces drawn so far.
//!
//! Reads: `frame`, `parts_in_sight`, `farthest`. Writes: `hidden_now`. Twin: `src/twin/parts.rs`.
//! Parity: exact.

use crate::frame::common::kernel::Kernel;
use crate::gpu::{Buffer, Commands, Device, GpuError};
use crate::shaders;

/// The pass.
pub(crate) struct CullParts {
    kernel: Kernel,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    /// [`PartInSight`](crate::abi::PartInSight)s: the pixels and the depth of each part.
    pub parts_in_sight: &'a Buffer,
    /// Farthest depths of squares, then of tiles, then of blocks.
    pub farthest: &'a Buffer,
    /// Whether each group of faces of the placed parts is hidden; those out of sight keep their result.
    pub hidden_now: &'a Buffer,
}

impl CullParts {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        Ok(Self { kernel: Kernel::new(device, "cull parts", &shaders::CULL_PARTS_COMP, &[])? })
    }

    /// One thread for each part in sight.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, parts: u32) {
        let resources = [b.frame, b.parts_in_sight, b.farthest, b.hidden_now].map(Into::into);
        self.kernel.bind(cmd, &resources, bytemuck::bytes_of(&parts));
        self.kernel.dispatch(cmd, parts);
    }
}
