//! The exact way to trim: twin of `glsl/include/exact.glsl`, which reads these structs as texels.

use bytemuck::{Pod, Zeroable};

/// [`ExactArc::shape`]: the loop runs from the lower end to the higher one.
pub const ARC_UP: u32 = 32;

/// Where a face's bands are.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq)]
pub struct ExactFace {
    pub first_band: u32,
    pub band_count: u32,
}

/// Arcs between two scan lines.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq)]
pub struct ExactBand {
    pub top: f32,
    pub end: u32,
}

/// Part of a band.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq)]
pub struct ExactCell {
    pub right: f32,
    pub winding: i32,
    pub first: u32,
    pub count: u32,
}

/// A monotone piece of a trim curve.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq)]
pub struct ExactArc {
    pub low: [f32; 2],
    pub high: [f32; 2],
    pub hull: [f32; 2],
    pub first: u32,
    pub shape: u32,
}
