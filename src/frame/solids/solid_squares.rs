//! Pass `solid_squares`: the squares of tiles that may show Boolean solids.
//!
//! Reads: `frame`, `tile_entries`. Writes: `tile_squares`. Twin: `src/twin/squares.rs`.
//! Parity: exact.

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
    /// The first leaf of each tile's walk.
    pub tile_entries: &'a Buffer,
    /// The side, in tiles, of the square that begins at each tile, or 0.
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
