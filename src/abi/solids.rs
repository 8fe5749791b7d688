//! Boolean solids: leaves, their surfaces, and the tiles that see them.

use bytemuck::{Pod, Zeroable};

/// The most general surface of a scene is a plane.
pub const SURFACE_PLANE: u32 = 0;
/// It is another quadric.
pub const SURFACE_QUADRIC: u32 = 1;
/// It is a torus; which, of major radius 1, is marked so.
pub const SURFACE_TORUS: u32 = 2;

/// What to call scenes of this most general kind.
pub(crate) fn surface_kind(most: u32) -> &'static str {
    match most {
        SURFACE_PLANE => "planes",
        SURFACE_QUADRIC => "quadrics",
        _ => "tori",
    }
}

/// Bits below the surface's number in [`LeafSurface::surface`].
pub const SIDE_SHIFT: u32 = 3;
/// [`LeafSurface::surface`]: the leaf is where the surface's function is positive.
pub const SIDE_NEGATIVE: u32 = 1;
/// [`LeafSurface::surface`]: a plane; the last sides of a leaf are.
pub const SIDE_PLANE: u32 = 2;
/// [`LeafSurface::surface`]: the leaf's next side is a plane, too, or none, too.
pub const SIDE_MORE: u32 = 4;

/// The walk ends outside of the solid.
pub const EXIT_FALSE: u32 = 0xffff_fffe;
/// The walk ends inside of the solid.
pub const EXIT_TRUE: u32 = 0xffff_ffff;

/// The leaf has no box: every tile sees it.
pub const LEAF_UNBOUNDED: u32 = 1;
/// Under an odd number of complements.
pub const LEAF_NEGATIVE: u32 = 2;
/// Its chain of out-exits ends at [`EXIT_FALSE`].
pub const LEAF_FALLS: u32 = 4;

/// An operand without equations: [`Leaf::first`] is its number among them.
pub const LEAF_SHELL: u32 = 8;

/// Of an item that rays are followed through, and that is drawn by another pass.
pub const LEAF_ELSEWHERE: u32 = 16;
/// Of its sides the last are planes.
pub const LEAF_PLANES: u32 = 32;
/// The first are none.
pub const LEAF_ROUNDS: u32 = 64;
/// Bits of [`Leaf::flags`].
pub const LEAF_FLAG_BITS: u32 = 7;

/// [`TileLeaf::leaf`]: the walk of an item that rays are followed through begins here.
pub const TILE_LEAF_ENTRY: u32 = 0x8000_0000;
/// [`TileLeaf::leaf`]: every walk of the union that ends inside comes through this leaf.
pub const TILE_LEAF_GATE: u32 = 0x4000_0000;

/// Pixels along a tile's side.
pub const TILE: u32 = 16;
/// Leaves that one thread of pass `solid_blocks` looks at.
pub const LEAF_RUN: u32 = 32_768;
/// Tiles along a block's side.
pub const BLOCK: u32 = 8;

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
    /// Its first side, or its shell's number, and its flags, in one word.
    pub fn own(&self) -> u32 {
        self.first << LEAF_FLAG_BITS | self.flags
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

/// A mesh that bounds an operand.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq, Eq)]
pub struct OperandMesh {
    pub shell: u32,
    pub instance: u32,
    pub first_triangle: u32,
    pub first_plane: u32,
    pub mirrored: u32,
    pub leaf: u32,
}

/// In place of a surface's number: the plane of one triangle alone, and which.
pub const OWN_PLANE: u32 = 0x8000_0000;

/// Of a triangle whose plane is nobody else's; of a mesh none of whose triangles has another one.
pub const NO_PLANE: u32 = u32::MAX;

/// [`Fragment::shell`]: the ray leaves the operand.
pub const FRAGMENT_LEAVES: u32 = 0x8000_0000;
/// [`Fragment::shell`]: of the ring around a trimmed face.
pub const FRAGMENT_RING: u32 = 0x4000_0000;
/// [`Fragment::shell`]: of a spline face, else of a triangle.
pub const FRAGMENT_PATCH: u32 = 0x2000_0000;
/// [`Fragment::shell`]: the near plane is within the operand.
pub const FRAGMENT_WITHIN: u32 = 0x1000_0000;

/// Where a ray crosses an operand.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq)]
pub struct Fragment {
    pub shell: u32,
    pub depth: f32,
    pub what: u32,
    pub uv: u32,
}
