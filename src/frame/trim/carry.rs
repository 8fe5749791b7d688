//! Pass `carry`: the winding number that each row of a strip with several bays begins with: what crosses its scan line in
//! the bays before.
//!
//! ```text
//!   bay               0     1     2     3
//!   crossings add up  +1    0     -1    0      as pass `cross` counted them
//!   begins with        0    1     1     0
//! ```
//!
//! Reads: `frame`, `strips`, `wide_strips`. Writes: `row_windings`. Twin: `src/twin/carry.rs`.

use crate::bindings::with_texels;
use crate::gpu::{Buffer, Commands, ComputeInfo, Device, GpuError, Pipeline, Texels};
use crate::shaders;

/// The pass.
pub(crate) struct Carry {
    pipeline: Pipeline,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub strips: &'a Texels,
    /// Bay items of the strips with several bays.
    pub wide_strips: &'a Buffer,
    pub row_windings: &'a Buffer,
}

impl Carry {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        let pipeline = Pipeline::compute(
            device,
            &ComputeInfo {
                name: "carry",
                spirv: shaders::CARRY_COMP,
                bindings: &with_texels(1..2, 4),
                push_bytes: 0,
                constants: &[],
            },
        )?;
        Ok(Self { pipeline })
    }

    /// One workgroup for each of `wide_strips`.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, wide_strips: u32) {
        let resources = [b.frame.into(), b.strips.into(), b.wide_strips.into(), b.row_windings.into()];
        cmd.bind(&self.pipeline, &resources, &[]);
        cmd.dispatch(wide_strips);
    }
}
