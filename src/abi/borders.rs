//! Pixels at borders: twins of `glsl/include/border_pixel.glsl` and `border_seen.glsl`.

use bytemuck::{Pod, Zeroable};

/// A pixel at a border.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq, Eq)]
pub struct BorderPixel {
    pub pixel: u32,
    pub mean: [u32; 2],
}

/// How many there are, and the grids of passes over them.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq, Eq)]
pub struct BorderGrids {
    pub pixels: [u32; 3],
    pub count: u32,
    pub points: [u32; 3],
}

/// What a point of one of them sees.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq)]
pub struct BorderPoint {
    pub depth: f32,
    pub shown: u32,
}
