//! Pass `solid_squares`: which squares of tiles are drawn where Boolean solids may be seen.
//!
//! Reads: `frame`, `tile_entries`. Writes: `tile_squares`. Twin: `src/twin/squares.rs`.

use crate::frame::common::kernel::Kernel;
use crate::gpu::{Buffer, Commands, Device, GpuError};
use crate::shaders;

/// The pass.
pub(crate) struct SolidSquares {
    kernel: Kernel,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    /// Where each tile's walk begins.
    pub tile_entries: &'a Buffer,
    /// The side of the square that each tile draws, in tiles, or 0.
    pub tile_squares: &'a Buffer,
}

impl SolidSquares {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        let kernel = Kernel::new(device, "solid squares", &shaders::SOLID_SQUARES_COMP, &[])?;
        Ok(Self { kernel })
    }

    /// One thread for each of `tiles`.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, tiles: u32) {
        self.kernel.record(cmd, &[b.frame, b.tile_entries, b.tile_squares].map(Into::into), tiles);
    }
}
