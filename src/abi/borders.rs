//! Pixels at borders: twins of `glsl/include/border_pixel.glsl`, `border_around.glsl` and `border_followed.glsl`.

use bytemuck::{Pod, Zeroable};

/// A pixel at a border.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq, Eq)]
pub struct BorderPixel {
    pub pixel: u32,
    pub mean: [u32; 2],
    pub sliver: u32,
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

/// One of them for which the exact surface is followed.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq)]
pub struct FollowedPoint {
    pub point: u32,
    pub sheets: u32,
    pub depth: f32,
}

/// A pixel whose mean waits for them.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq, Eq)]
pub struct FollowedPixel {
    pub place: u32,
    pub first: u32,
    pub bits: u32,
}

/// How many there are, and the grids of passes over them.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq, Eq)]
pub struct FollowedGrids {
    pub points: [u32; 3],
    pub point_count: u32,
    pub pixels: [u32; 3],
    pub pixel_count: u32,
    pub wanted: u32,
}
