//! Pass `operand_sort`: the fragments of each pixel in order, entering and leaving in turn.
//!
//! ```text
//!   E2 L1 E1 L2 e1 ──by shell, by depth──▶ E1 e1 L1 │ E2 L2 ──what follows in turn──▶ E1 L1 │ E2 L2
//! ```
//!
//! Reads: everything that `Bindings` names but what it writes. Writes: `counts`, `fragments`, `counters`.
//! Twin: `src/twin/operand_sort.rs`.

use crate::bindings::with_constants;
use crate::gpu::{Buffer, Commands, ComputeInfo, Device, GpuError, Pipeline};
use crate::shaders;
use std::ops::Range;

/// Threads of a workgroup, as in the shader.
const GROUP: u32 = 64;

/// The pass.
pub(crate) struct OperandSort {
    pipeline: Pipeline,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub leaves: &'a Buffer,
    /// Model axes, seen from the eye.
    pub leaf_centres: &'a Buffer,
    /// A leaf of each shell.
    pub shell_leaves: &'a Buffer,
    pub starts: &'a Buffer,
    pub counts: &'a Buffer,
    pub fragments: &'a Buffer,
    pub counters: &'a Buffer,
}

impl OperandSort {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        let pipeline = Pipeline::compute(
            device,
            &ComputeInfo {
                name: "operand sort",
                spirv: shaders::OPERAND_SORT_COMP,
                bindings: &with_constants(8),
                push_bytes: 8,
                constants: &[],
            },
        )?;
        Ok(Self { pipeline })
    }

    /// One thread a pixel of these columns of the picture, and rows of the band: where there may be fragments. The first
    /// row is that of a tile.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, columns: Range<u32>, rows: Range<u32>) {
        if columns.is_empty() || rows.is_empty() {
            return;
        }
        let solid = [b.frame, b.leaves, b.leaf_centres, b.shell_leaves];
        let lists = [b.starts, b.counts, b.fragments, b.counters];
        let resources: Vec<_> = solid.into_iter().chain(lists).map(Into::into).collect();
        cmd.bind(&self.pipeline, &resources, bytemuck::bytes_of(&[columns.start, rows.start]));
        cmd.dispatch_grid([(columns.end - columns.start).div_ceil(GROUP), rows.end - rows.start, 1]);
    }
}
