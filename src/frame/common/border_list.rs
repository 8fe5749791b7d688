//! The list of pixels at borders, as the passes over it are given it.

use crate::abi;
use crate::gpu::Buffer;
use std::mem::offset_of;

/// A list of pixels, and the grids of passes over it.
#[derive(Clone, Copy)]
pub(crate) struct ListBindings<'a> {
    /// [`BorderPixel`](abi::BorderPixel)s.
    pub pixels: &'a Buffer,
    /// [`BorderGrids`](abi::BorderGrids); zero before.
    pub grids: &'a Buffer,
}

impl<'a> ListBindings<'a> {
    /// The arguments of a thread a pixel.
    pub(crate) fn of_pixels(&self) -> (&'a Buffer, u64) {
        (self.grids, offset_of!(abi::BorderGrids, pixels) as u64)
    }

    /// The arguments of a thread a point.
    pub(crate) fn of_points(&self) -> (&'a Buffer, u64) {
        (self.grids, offset_of!(abi::BorderGrids, points) as u64)
    }
}
