//! Pass `lines`: scan lines of each v-strip, `mu = ceil(height / spacing)`.
//!
//! Reads: `frame`, `strip_heights`. Writes: `strip_counts`, `counters`.
//! Twin: `src/twin/lines.rs`.
//! Parity: exact; on a GPU with other quotients and roots a count may differ by one.

use crate::frame::common::kernel::Kernel;
use crate::gpu::{Buffer, Commands, Device, GpuError};
use crate::shaders::{self, constant};

/// The pass.
pub(crate) struct Lines {
    kernel: Kernel,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub strip_heights: &'a Buffer,
    pub strip_counts: &'a Buffer,
    /// `clamps`.
    pub counters: &'a Buffer,
    /// One bit for each bin of a strip, if strips have several.
    pub seen_bins: Option<&'a Buffer>,
}

impl Lines {
    /// `bins`: strips of some face have several bins.
    pub(crate) fn new(device: &Device, bins: bool) -> Result<Self, GpuError> {
        let kernel =
            Kernel::new(device, "lines", &shaders::LINES_COMP, &[(constant::SCENE_HAS_BINS, u32::from(bins))])?;
        Ok(Self { kernel })
    }

    /// One thread for each of `bins`.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, bins: u32) {
        // not read without bins
        let seen_bins = b.seen_bins.unwrap_or(b.frame);
        let resources = [b.frame, b.strip_heights, b.strip_counts, b.counters, seen_bins].map(Into::into);
        self.kernel.record(cmd, &resources, bins);
    }
}
