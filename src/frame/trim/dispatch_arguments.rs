//! Pass `dispatch_arguments`: the first row of each v-strip, the numbers of rows and segments in the trim table, and the dispatches
//! that follow from them.
//!
//! Reads: `frame`, `strip_starts`, `segment_starts`. Writes: `dispatches`, `strips`, `counters`.
//! Twin: `src/twin/dispatch_arguments.rs`.
//! Parity: exact.

use crate::frame::common::kernel::Kernel;
use crate::gpu::{Buffer, Commands, Device, GpuError};
use crate::shaders::{self, constant};

/// The pass.
pub(crate) struct DispatchArguments {
    kernel: Kernel,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub strip_starts: &'a Buffer,
    pub segment_starts: &'a Buffer,
    /// Dispatch arguments of passes `cross` and `sort`.
    pub dispatches: &'a Buffer,
    /// The rows of each strip, stored at its first bin.
    pub strips: &'a Buffer,
    pub counters: &'a Buffer,
    /// One bit for each bin of a strip, if strips have several.
    pub seen_bins: Option<&'a Buffer>,
}

impl DispatchArguments {
    /// `bins`: strips of some face have several bins.
    pub(crate) fn new(device: &Device, bins: bool) -> Result<Self, GpuError> {
        let kernel = Kernel::new(
            device,
            "dispatch_arguments",
            &shaders::DISPATCH_ARGUMENTS_COMP,
            &[(constant::SCENE_HAS_BINS, u32::from(bins))],
        )?;
        Ok(Self { kernel })
    }

    /// One thread for each of `bins`.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, bins: u32) {
        // not read without bins
        let seen_bins = b.seen_bins.unwrap_or(b.frame);
        let resources = [b.frame, b.strip_starts, b.segment_starts, b.dispatches, b.strips, b.counters, seen_bins];
        let resources = resources.map(Into::into);
        self.kernel.record(cmd, &resources, bins);
    }
}
