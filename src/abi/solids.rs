//! Boolean solids: leaves, their surfaces, and the tiles that may show them.

pub use crate::abi::constants::boundary_operands::NO_PLANE;
#[cfg(any(test, feature = "baselines"))]
pub use crate::abi::constants::boundary_operands::{FRAGMENT_LEAVES, FRAGMENT_PATCH, FRAGMENT_SKIRT, FRAGMENT_WITHIN};
pub use crate::abi::constants::solids::{
    EXIT_FALSE, EXIT_TRUE, LEAF_BOUNDARY, LEAF_CAP, LEAF_ELSEWHERE, LEAF_FALLS, LEAF_FLAG_BITS, LEAF_NEGATIVE,
    LEAF_PLANES, LEAF_ROUNDS, LEAF_UNBOUNDED, OWN_PLANE, SIDE_MORE, SIDE_NEGATIVE, SIDE_PLANE, SIDE_SHIFT,
    SURFACE_PLANE, SURFACE_QUADRIC, SURFACE_TORUS,
};
pub use crate::abi::constants::tiles::{BLOCK, LEAF_RUN, TILE};
#[cfg(any(test, feature = "baselines"))]
pub use crate::abi::constants::tiles::{TILE_LEAF_ENTRY, TILE_LEAF_GATE};
use bytemuck::{Pod, Zeroable};

/// The name of scenes with this most general kind of surface.
pub(crate) fn surface_kind(most: u32) -> &'static str {
    match most {
        SURFACE_PLANE => "planes",
        SURFACE_QUADRIC => "quadrics",
        _ => "tori",
    }
}

/// A side of a leaf.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq, Eq)]
pub struct LeafSurface {
    pub surface: u32,
    pub leaf: u32,
}

/// One switch of the Blist.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq)]
pub struct Leaf {
    pub half_size: [f32; 3],
    pub first: u32,
    pub count: u32,
    pub colour: u32,
    pub id: u32,
    pub in_exit: u32,
    pub out_exit: u32,
    pub pre: u32,
    pub end: u32,
    pub flags: u32,
    pub item: u32,
}

impl Leaf {
    /// One word with its first side, or its operand's number, and its flags.
    pub fn own(&self) -> u32 {
        self.first << LEAF_FLAG_BITS | self.flags & ((1 << LEAF_FLAG_BITS) - 1)
    }
}

/// Tiles from first to last.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq, Eq)]
pub struct Rect {
    pub first: [u32; 2],
    pub last: [u32; 2],
}

/// A leaf in a tile.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq, Eq)]
pub struct TileLeaf {
    pub leaf: u32,
    pub in_exit: u32,
    pub out_exit: u32,
    /// [`Leaf::own`].
    pub of: u32,
}

/// A mesh of an operand.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq, Eq)]
pub struct OperandMesh {
    pub operand: u32,
    pub instance: u32,
    pub first_triangle: u32,
    pub first_plane: u32,
    pub mirrored: u32,
    pub leaf: u32,
}

/// A crossing of a ray with an operand.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq)]
pub struct Fragment {
    pub operand: u32,
    pub depth: f32,
    pub what: u32,
    pub uv: u32,
}
