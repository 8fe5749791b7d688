//! Pass `reset`: empties the draws and clears the counters, before any other pass counts.
//!
//! ```text
//!    draws     [0 vertices, first = none] x 2 capacity
//!    counters  all 0
//! ```
//!
//! A second drawing of patches clears only the draws and their numbers.
//!
//! Reads: `frame`. Writes: `draws`, `counters`.
//! Twin: `src/twin/reset.rs`.
//! Parity: exact.

use crate::frame::common::kernel::Kernel;
use crate::gpu::{Buffer, Commands, Device, GpuError};
use crate::shaders::{self, constant};

/// The pass.
pub(crate) struct Reset {
    kernel: Kernel,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    /// The frame's constants.
    pub frame: &'a Buffer,
    /// Plain, then trimmed draws.
    pub draws: &'a Buffer,
    /// The frame's counters.
    pub counters: &'a Buffer,
}

impl Reset {
    /// `draws_only`: the other counters stay.
    pub(crate) fn new(device: &Device, draws_only: bool) -> Result<Self, GpuError> {
        let kernel = Kernel::new(
            device,
            if draws_only { "reset (draws)" } else { "reset" },
            &shaders::RESET_COMP,
            &[(constant::DRAWS_ONLY, u32::from(draws_only))],
        )?;
        Ok(Self { kernel })
    }

    /// One thread for each of `threads`.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, threads: u32) {
        let resources = [b.frame, b.draws, b.counters].map(Into::into);
        self.kernel.record(cmd, &resources, threads);
    }
}
