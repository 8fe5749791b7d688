//! Pass `sort`: sorts each row by u, and reduces it to the places where inside and outside change.
//!
//! ```text
//!   intercepts   ↑  ↑  ↓  ↑  ↓  ↓        winding   0 1 2 1 2 1 0
//!   flips        |              |        inside    0 1 1 1 1 1 0
//! ```
//!
//! Reads: `frame`, `row_starts`, `row_total`, `row_windings`, `dispatches`. Writes: `rows` (for each row its first
//! flip, and its number of flips twice, plus 1 if it starts inside), `intercepts`, `counters`. Twin:
//! `src/twin/sort.rs`.
//! Parity: exact.

use crate::frame::common::kernel::Kernel;
use crate::gpu::{Buffer, Commands, Device, GpuError, TexelBuffer};
use crate::shaders::{self, constant};

/// The pass.
pub(crate) struct Sort {
    kernel: Kernel,
}

/// Its buffers, in binding order, and the dispatches.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub row_starts: &'a TexelBuffer,
    /// Number of intercepts in all rows.
    pub row_total: &'a Buffer,
    /// Two words a row.
    pub rows: &'a Buffer,
    pub intercepts: &'a Buffer,
    pub counters: &'a Buffer,
    /// The winding number at the start of each row, if strips have several bins.
    pub row_windings: Option<&'a Buffer>,
    /// Written by pass `dispatch_arguments`; the second is that of this pass.
    pub dispatches: &'a Buffer,
}

impl Sort {
    /// `bins`: strips of some face have several bins.
    pub(crate) fn new(device: &Device, bins: bool) -> Result<Self, GpuError> {
        let kernel = Kernel::new(device, "sort", &shaders::SORT_COMP, &[(constant::SCENE_HAS_BINS, u32::from(bins))])?;
        Ok(Self { kernel })
    }

    /// One thread a row.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>) {
        let resources = [
            b.frame.into(),
            b.row_starts.into(),
            b.row_total.into(),
            b.rows.into(),
            b.intercepts.into(),
            b.counters.into(),
            // not read where there are none
            b.row_windings.unwrap_or(b.frame).into(),
        ];
        self.kernel.record_indirect(cmd, &resources, (b.dispatches, size_of::<[u32; 3]>() as u64));
    }
}
