//! Pass `solid_fold`: the Blist of each tile, reduced to the leaves that the tile may show.
//!
//! Reads: `frame`, `leaves`, `tile_starts`. Writes: exits of `tile_leaves`, `tile_entries`, and the counter `clamps`:
//! tiles whose loops a driver ended. Twin: `src/twin/solid_fold.rs`.
//! Parity: exact.

use crate::frame::common::kernel::Kernel;
use crate::gpu::{Buffer, Commands, Device, GpuError};
use crate::shaders;

/// The pass.
pub(crate) struct SolidFold {
    kernel: Kernel,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub leaves: &'a Buffer,
    pub tile_starts: &'a Buffer,
    pub tile_leaves: &'a Buffer,
    /// The first leaf of each tile's walk.
    pub tile_entries: &'a Buffer,
    pub counters: &'a Buffer,
}

impl SolidFold {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        let kernel = Kernel::new(device, "solid fold", &shaders::SOLID_FOLD_COMP, &[])?;
        Ok(Self { kernel })
    }

    /// One thread for each of `tiles`.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, tiles: u32) {
        let resources = [b.frame, b.leaves, b.tile_starts, b.tile_leaves, b.tile_entries, b.counters].map(Into::into);
        self.kernel.record(cmd, &resources, tiles);
    }
}
