//! Pass `solid_rects`: the tiles that the box around each leaf may cover.
//!
//! Reads: `frame`, `leaves`, `centres`. Writes: `rects`. Twin: `src/twin/solid_rects.rs`.
//! Parity: exact.

use crate::frame::common::kernel::Kernel;
use crate::gpu::{Buffer, Commands, Device, GpuError};
use crate::shaders;

/// The pass.
pub(crate) struct SolidRects {
    kernel: Kernel,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub leaves: &'a Buffer,
    /// Centres of leaves, in model axes relative to the eye.
    pub centres: &'a Buffer,
    pub rects: &'a Buffer,
}

impl SolidRects {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        let kernel = Kernel::new(device, "solid rects", &shaders::SOLID_RECTS_COMP, &[])?;
        Ok(Self { kernel })
    }

    /// One thread for each of `leaves`.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, leaves: u32) {
        let resources = [b.frame, b.leaves, b.centres, b.rects].map(Into::into);
        self.kernel.record(cmd, &resources, leaves);
    }
}
