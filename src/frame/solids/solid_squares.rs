//! Pass `solid_squares`: which squares of tiles are drawn where Boolean solids may be seen.
//!
//! Reads: `frame`, `tile_entries`. Writes: `tile_squares`. Twin: `src/twin/squares.rs`.

use crate::bindings::with_constants;
use crate::gpu::{Buffer, Commands, ComputeInfo, Device, GpuError, Pipeline};
use crate::shaders;

/// Threads of a workgroup, as in the shader.
const GROUP: u32 = 64;

/// The pass.
pub(crate) struct SolidSquares {
    pipeline: Pipeline,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    /// Where each tile's walk begins.
    pub tile_entries: &'a Buffer,
    /// The side of the square that each tile draws, in tiles, or 0.
    pub tile_squares: &'a Buffer,
}

impl SolidSquares {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        let pipeline = Pipeline::compute(
            device,
            &ComputeInfo {
                name: "solid squares",
                spirv: shaders::SOLID_SQUARES_COMP,
                bindings: &with_constants(3),
                push_bytes: 0,
                constants: &[],
            },
        )?;
        Ok(Self { pipeline })
    }

    /// One thread for each of `tiles`.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, tiles: u32) {
        cmd.bind(&self.pipeline, &[b.frame, b.tile_entries, b.tile_squares].map(Into::into), &[]);
        cmd.dispatch(tiles.div_ceil(GROUP));
    }
}
