//! The sun: its direction, and the tiles of its picture. Twin of `glsl/include/sun.glsl`.

use bytemuck::{Pod, Zeroable};

/// One frame's sun.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq)]
pub struct Sun {
    pub towards: [f32; 3],
    pub across: u32,
    pub right: [f32; 3],
    pub down: u32,
    pub up: [f32; 3],
    pub eye: [f32; 2],
    pub crack: f32,
}

/// A tile of the sun's picture.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq, Eq)]
pub struct SunTile {
    pub first: u32,
    pub end: u32,
    pub entry: u32,
    pub first_triangle: u32,
    pub end_triangle: u32,
    pub first_facet: u32,
    pub end_facet: u32,
}

/// A triangle of an operand, projected along the sun's rays.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq)]
pub struct SunTriangle {
    pub corners: [[f32; 2]; 3],
    pub heights: [f32; 3],
    pub operand: u32,
    pub surface: u32,
    pub slack: f32,
}

/// A triangle of a placed part, projected likewise.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq)]
pub struct SunFacet {
    pub corners: [[f32; 2]; 3],
    pub plane: [f32; 3],
    pub steep: f32,
    pub slack: f32,
    pub part: u32,
}
