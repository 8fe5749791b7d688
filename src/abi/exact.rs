//! The exact way to trim: twin of `glsl/include/exact.glsl`, which reads these structs as texels.

pub use crate::abi::constants::exact::{ARC_LAST, ARC_UP, CELL_SPLIT};
use bytemuck::{Pod, Zeroable};

/// The place of a face's cells.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq)]
pub struct ExactFace {
    pub first_cell: u32,
    /// Number of the first column; in the upper half, number of the first row. Signed.
    pub first: u32,
    /// Number of columns; in the upper half, number of rows.
    pub counts: u32,
    /// Columns in the domain, as a power of two; in the upper half, rows.
    pub bits: u32,
}

/// A rectangle of the domain.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq)]
pub struct ExactCell {
    /// First arc of its list, or [`CELL_SPLIT`] and its first part.
    pub first: u32,
    /// Winding number of the arcs that are not in the list; or halvings.
    pub winding: i32,
}

/// A monotone piece of a trim curve, in a list.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq)]
pub struct ExactArc {
    pub low: [f32; 2],
    pub high: [f32; 2],
    pub corner: [f32; 2],
    pub fullness: f32,
    /// [`AT_LOW`](crate::trim::AT_LOW), [`AT_HIGH`](crate::trim::AT_HIGH), [`ARC_UP`], [`ARC_LAST`].
    pub shape: u32,
}
