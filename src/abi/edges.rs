//! Lines along edges. Twins of `glsl/include/edges.glsl`.

pub use crate::abi::constants::edges::{
    EDGE_BOLD, EDGE_FULL, EDGE_MOST_SEEDS, EDGE_NEAR, EDGE_SEEDS, EDGE_THIN, EDGE_TURNS, EDGE_UNDRAWN, FOLD_NUMBER,
    OWN_TRIANGLE, SEED_END, SOLID_NUMBER,
};
use bytemuck::{Pod, Zeroable};

/// A rational Bézier piece of an edge.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq, Eq)]
pub struct EdgePiece {
    pub first: u32,
    pub degree: u32,
    pub edge: u32,
}

/// The line along one edge.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq)]
pub struct EdgeLine {
    pub number: u32,
    pub style: u32,
    pub first_own: u32,
    pub own_count: u32,
    pub off: f32,
}

/// A placed piece.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq, Eq)]
pub struct PieceInstance {
    pub piece: u32,
    pub placement: u32,
    pub instance: u32,
}

/// How long lists of lines are, and the grids of passes over them.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq, Eq)]
pub struct LineList {
    pub grid: [u32; 3],
    pub count: u32,
    pub found_grid: [u32; 3],
    pub found_count: u32,
}

/// A straight line of a frame.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq)]
pub struct Chord {
    pub a: [f32; 2],
    pub b: [f32; 2],
    pub w: [f32; 2],
    pub t: [f32; 2],
    pub piece_instance: u32,
    pub style: u32,
}
