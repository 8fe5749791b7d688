//! Pass `carry`: the winding number at the start of each row of a strip with several bins, from the crossings of its
//! scan line in the bins before.
//!
//! ```text
//!   bin               0     1     2     3
//!   crossings add up  +1    0     -1    0      as pass `cross` counted them
//!   at the start      0    1     1     0
//! ```
//!
//! Reads: `frame`, `strips`, `wide_strips`. Writes: `row_windings`. Twin: `src/twin/carry.rs`.
//! Parity: exact.

use crate::frame::common::kernel::Kernel;
use crate::gpu::{Buffer, Commands, Device, GpuError, TexelBuffer};
use crate::shaders;

/// The pass.
pub(crate) struct Carry {
    kernel: Kernel,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub strips: &'a TexelBuffer,
    /// Bin instances of the strips with several bins.
    pub wide_strips: &'a Buffer,
    pub row_windings: &'a Buffer,
}

impl Carry {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        let kernel = Kernel::new(device, "carry", &shaders::CARRY_COMP, &[])?;
        Ok(Self { kernel })
    }

    /// One workgroup for each of `wide_strips`.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, wide_strips: u32) {
        let resources = [b.frame.into(), b.strips.into(), b.wide_strips.into(), b.row_windings.into()];
        self.kernel.bind(cmd, &resources, bytemuck::bytes_of(&wide_strips));
        cmd.dispatch(wide_strips);
    }
}
