//! Pass `emit`: writes the list of sub-patches and the draws that cover it.
//!
//! ```text
//!    vertices before a patch instance  0 ..... draw_vertices ..... 2 draw_vertices ....
//!    draw that covers it      |   0   |        1         |        2
//! ```
//!
//! Reads: `frame`, `factors`, `sub_patch_starts`, `vertex_starts`, `runs`.
//! Writes: `sub_patches`, `draws`, `counters`.
//! Twin: `src/twin/emit.rs`.
//! Parity: exact.

use crate::frame::common::kernel::{Kernel, Threads};
use crate::gpu::{Buffer, Commands, Device, GpuError};
use crate::shaders;

/// The pass.
pub(crate) struct Emit {
    kernel: Kernel,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub factors: &'a Buffer,
    /// Prefix sums of the counts, one more than there are counts.
    pub sub_patch_starts: &'a Buffer,
    /// Prefix sums of the numbers of vertices, likewise.
    pub vertex_starts: &'a Buffer,
    /// The list of sub-patches.
    pub sub_patches: &'a Buffer,
    pub draws: &'a Buffer,
    pub counters: &'a Buffer,
    /// [`PatchRun`](crate::abi::PatchRun)s of the listed patch instances.
    pub runs: &'a Buffer,
}

impl Emit {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        let kernel = Kernel::new(device, "emit", &shaders::EMIT_COMP, &[])?;
        Ok(Self { kernel })
    }

    /// One thread for each listed patch instance.
    pub(crate) fn record<'t>(&self, cmd: &Commands<'_>, b: &Bindings<'_>, threads: impl Into<Threads<'t>>) {
        let lists = [b.sub_patch_starts, b.vertex_starts, b.sub_patches, b.draws, b.counters, b.runs];
        let resources: Vec<_> = [b.frame, b.factors].into_iter().chain(lists).map(Into::into).collect();
        self.kernel.record_threads(cmd, &resources, threads.into());
    }
}
