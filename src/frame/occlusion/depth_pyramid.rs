//! Pass `depth_pyramid`: the farthest visible depth in each square of few pixels, in each tile, and in each block of
//! tiles.
//!
//! Reads: `frame`, the depth image. Writes: `depth_pyramid`. Twin: `src/twin/occlusion.rs`.
//! Parity: exact.

use crate::abi::{BLOCK, TILE};
use crate::frame::common::kernel::Kernel;
use crate::gpu::{Buffer, Commands, Device, GpuError, Image, Resource, Sampler};
use crate::shaders;
use ash::vk;

/// The pass.
pub(crate) struct DepthPyramid {
    kernel: Kernel,
    nearest: Sampler,
}

/// Its buffers and images, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    pub depth: &'a Image,
    /// One float a square, row by row, then one a tile, then one a block.
    pub farthest: &'a Buffer,
}

impl DepthPyramid {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        let kernel = Kernel::new(device, "depth pyramid", &shaders::DEPTH_PYRAMID_COMP, &[])?;
        Ok(Self { kernel, nearest: Sampler::new(device, vk::Filter::NEAREST)? })
    }

    /// One workgroup for each block of tiles.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>) {
        let (width, height) = b.depth.size();
        let blocks = |pixels: u32| pixels.div_ceil(TILE * BLOCK);
        self.kernel.record_grid(
            cmd,
            &[b.frame.into(), Resource::Sampled(b.depth, &self.nearest), b.farthest.into()],
            [blocks(width), blocks(height), 1],
        );
    }
}
