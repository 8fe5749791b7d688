//! Pass `operand_sort`: sorts the fragments of each pixel, so that entries and exits alternate.
//!
//! ```text
//!   E2 L1 E1 L2 e1 ──by operand, by depth──▶ E1 e1 L1 │ E2 L2 ──the alternating ones──▶ E1 L1 │ E2 L2
//! ```
//!
//! Reads: everything that `Bindings` names except its outputs. Writes: `counts`, `fragments`, `counters`.
//! Twin: `src/twin/operand_sort.rs`.
//! Parity: exact.

use crate::frame::common::kernel::Kernel;
use crate::gpu::{Buffer, Commands, Device, GpuError};
use crate::shaders;
use std::ops::Range;

/// The pass.
pub(crate) struct OperandSort {
    kernel: Kernel,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub leaves: &'a Buffer,
    /// In model axes, relative to the eye.
    pub leaf_centres: &'a Buffer,
    /// A leaf of each operand.
    pub operand_leaves: &'a Buffer,
    pub starts: &'a Buffer,
    pub counts: &'a Buffer,
    pub fragments: &'a Buffer,
    pub counters: &'a Buffer,
}

impl OperandSort {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        let kernel = Kernel::new(device, "operand sort", &shaders::OPERAND_SORT_COMP, &[])?;
        Ok(Self { kernel })
    }

    /// One thread for each pixel of these columns of the picture and rows of the band, which contain all fragments. The
    /// first row is the first of a tile.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, columns: Range<u32>, rows: Range<u32>) {
        if columns.is_empty() || rows.is_empty() {
            return;
        }
        let solid = [b.frame, b.leaves, b.leaf_centres, b.operand_leaves];
        let lists = [b.starts, b.counts, b.fragments, b.counters];
        let resources: Vec<_> = solid.into_iter().chain(lists).map(Into::into).collect();
        self.kernel.bind(cmd, &resources, bytemuck::bytes_of(&[columns.start, rows.start]));
        self.kernel.dispatch_rows(cmd, [columns.end - columns.start, rows.end - rows.start]);
    }
}
