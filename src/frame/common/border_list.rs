//! The lists of pixels at borders, and of their points that follow surfaces, as the passes over them are given them.

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

/// The list of points that follow surfaces, and what belongs to it.
#[derive(Clone, Copy)]
pub(crate) struct FollowedBindings<'a> {
    /// [`FollowedPoint`](abi::FollowedPoint)s.
    pub points: &'a Buffer,
    /// As many as there is room for.
    pub capacity: u32,
    /// [`FollowedPixel`](abi::FollowedPixel)s, as many; in scenes without meshes and Boolean solids.
    pub pixels: Option<&'a Buffer>,
    /// [`FollowedGrids`](abi::FollowedGrids); zero before.
    pub grids: &'a Buffer,
}

impl<'a> FollowedBindings<'a> {
    /// The arguments of a thread a point.
    pub(crate) fn of_points(&self) -> (&'a Buffer, u64) {
        (self.grids, offset_of!(abi::FollowedGrids, points) as u64)
    }

    /// The arguments of a thread a pixel.
    pub(crate) fn of_pixels(&self) -> (&'a Buffer, u64) {
        (self.grids, offset_of!(abi::FollowedGrids, pixels) as u64)
    }
}
