//! Pass `seen_squares`: the squares of tiles that show a patch or a mesh.
//!
//! Reads: `frame`, the visibility images. Writes: `seen_squares`. Twin: `src/twin/squares.rs`.
//! Parity: exact.

use crate::abi::{BLOCK, TILE};
use crate::frame::common::kernel::Kernel;
use crate::gpu::{Buffer, Commands, Device, GpuError, Image};
use crate::shaders;

/// The pass.
pub(crate) struct SeenSquares {
    kernel: Kernel,
}

/// Its buffers and images, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub visibility: &'a Image,
    /// The image of meshes and solids; the visibility image again if the scene has no trims, or only patches.
    pub meshes_and_solids: &'a Image,
    /// The side, in tiles, of the square that begins at each tile, or 0.
    pub squares: &'a Buffer,
}

impl SeenSquares {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        let kernel = Kernel::new(device, "seen squares", &shaders::SEEN_SQUARES_COMP, &[])?;
        Ok(Self { kernel })
    }

    /// One workgroup for each block of tiles.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>) {
        let (width, height) = b.visibility.size();
        let blocks = |pixels: u32| pixels.div_ceil(TILE * BLOCK);
        self.kernel.record_grid(
            cmd,
            &[b.frame.into(), b.visibility.into(), b.meshes_and_solids.into(), b.squares.into()],
            [blocks(width), blocks(height), 1],
        );
    }
}
