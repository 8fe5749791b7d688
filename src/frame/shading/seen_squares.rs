//! Pass `seen_squares`: the squares of tiles in which a patch or a mesh is seen.
//!
//! Reads: `frame`, the visibility images. Writes: `seen_squares`. Twin: `src/twin/squares.rs`.

use crate::abi::{BLOCK, TILE};
use crate::gpu::{Binding, Buffer, Commands, ComputeInfo, Device, GpuError, Image, Pipeline};
use crate::shaders;

/// The pass.
pub(crate) struct SeenSquares {
    pipeline: Pipeline,
}

/// Its buffers and images, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub visibility: &'a Image,
    /// The visibility image again where the scene has no trims, or nothing but patches.
    pub others: &'a Image,
    /// The side of the square that each tile draws, in tiles, or 0.
    pub squares: &'a Buffer,
}

impl SeenSquares {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        let bindings = [Binding::Uniform, Binding::StorageImage, Binding::StorageImage, Binding::Storage];
        let pipeline = Pipeline::compute(
            device,
            &ComputeInfo {
                name: "seen squares",
                spirv: shaders::SEEN_SQUARES_COMP,
                bindings: &bindings,
                push_bytes: 0,
                constants: &[],
            },
        )?;
        Ok(Self { pipeline })
    }

    /// One workgroup for each block of tiles.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>) {
        let (width, height) = b.visibility.size();
        let blocks = |pixels: u32| pixels.div_ceil(TILE * BLOCK);
        cmd.bind(&self.pipeline, &[b.frame.into(), b.visibility.into(), b.others.into(), b.squares.into()], &[]);
        cmd.dispatch_grid([blocks(width), blocks(height), 1]);
    }
}
