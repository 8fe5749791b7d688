//! Data that stays in GPU memory while a model is loaded.

pub use crate::abi::constants::behind::OUTSIDE_CELLS;
pub use crate::abi::constants::border_cells::BORDER_BANDS;
use crate::abi::constants::depth_pyramid::{SMALL_PICTURE, SMALL_SQUARE, SQUARE};
pub use crate::abi::constants::scene::{
    BORDER_U0, BORDER_U1, BORDER_V0, BORDER_V1, FACE_CLOSED_U, FACE_CLOSED_V, FACE_GOES_ON, FACE_MEETS_U, FACE_MEETS_V,
    FACE_OPERAND, FACE_POINTS, FACE_SAME_SENSE, FACE_SOLID, FACE_TRIMMED, MESH_NORMALS, MESH_SOLID,
};
use bytemuck::{Pod, Zeroable};

/// How a patch lies to its face's trim loops.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Side {
    /// Wholly trimmed away.
    Outside = 0,
    /// No trim curve meets it.
    Inside = 1,
    /// A trim curve may meet it.
    Boundary = 2,
}

/// Pixels along the sides of the smallest squares of farthest depths, in a picture of this size.
pub fn square_side(size: [u32; 2]) -> u32 {
    if u64::from(size[0]) * u64::from(size[1]) <= u64::from(SMALL_PICTURE) { SMALL_SQUARE } else { SQUARE }
}

/// One Bézier patch.
///
/// ```text
///   shape   bits 0-3 degree_u | 4-7 degree_v | 8 rational | 9-10 Side | 11-14 borders | 15 a fine net follows |
///           16-21, 22-27 pieces of its size in the patch before the split, along u and v, less one
/// ```
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq)]
pub struct Patch {
    pub box_min: [f32; 3],
    pub first: u32,
    pub box_max: [f32; 3],
    pub shape: u32,
    pub domain: [f32; 4],
    pub bend: [f32; 3],
    pub face: u32,
}

impl Face {
    /// Packs [`Face::strips`].
    pub fn pack_strips(strips: u32, bins: u32) -> u32 {
        strips | bins << 16
    }

    /// v-strips of the trim table; 0 where there is none.
    pub fn strip_count(&self) -> u32 {
        self.strips & 0xffff
    }

    /// Bins of each strip.
    pub fn bin_count(&self) -> u32 {
        self.strips >> 16
    }
}

impl Patch {
    /// Packs [`Patch::shape`].
    pub fn pack_shape(degrees: (usize, usize), rational: bool, side: Side, borders: u32) -> u32 {
        degrees.0 as u32 | (degrees.1 as u32) << 4 | u32::from(rational) << 8 | (side as u32) << 9 | borders << 11
    }

    /// The same word of a patch whose control points a fine net follows (`src/scene/fine.rs`).
    pub fn with_fine_net(shape: u32) -> u32 {
        shape | 1 << 15
    }

    /// The same word for a patch that covers these shares of a larger one, along u and v.
    pub fn with_shares(shape: u32, shares: [f64; 2]) -> u32 {
        // the number of pieces of this size, less one: six bits each
        let [u, v] = shares.map(|share| ((1.0 / share).ceil() as u32).clamp(1, 64) - 1);
        shape & 0xffff | u << 16 | v << 22
    }

    /// The same word with another side.
    pub fn with_side(shape: u32, side: Side) -> u32 {
        (shape & !(3 << 9)) | (side as u32) << 9
    }

    /// The borders stored in [`Patch::shape`].
    pub fn borders(&self) -> u32 {
        self.shape >> 11 & 15
    }

    /// Its weights may differ.
    #[cfg(any(test, feature = "baselines"))]
    pub fn is_rational(&self) -> bool {
        self.shape >> 8 & 1 != 0
    }

    /// The degrees stored in [`Patch::shape`].
    pub fn degrees(&self) -> (usize, usize) {
        ((self.shape & 15) as usize, (self.shape >> 4 & 15) as usize)
    }

    /// The side stored in [`Patch::shape`].
    pub fn side(&self) -> Side {
        match self.shape >> 9 & 3 {
            0 => Side::Outside,
            1 => Side::Inside,
            _ => Side::Boundary,
        }
    }
}

/// A side of a patch that other faces share: one of a ring of sides. `place` is 0 if the side is not shared.
/// ```text
///   place   bits 0-12 start | 13-16 halvings | 17 reversed | 18 owner | 19 shared
/// ```
///
/// The ring's sides lie on one curve; this one begins at `start / 2^halvings` and is `1 / 2^halvings` long. The control
/// points of each piece of the curve are those of its *owner*.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq, Eq)]
pub struct Link {
    /// The next side of the ring: four times its patch, plus 0 to 3 for `u = 0`, `v = 0`, `u = 1`, `v = 1`.
    pub next: u32,
    pub place: u32,
}

impl Link {
    /// Most sides of a ring.
    pub const MOST_SIDES: u32 = 32;

    /// A side that is shared.
    pub fn new(next: u32, (start, halvings): (u32, u32), reversed: bool, owner: bool) -> Self {
        let place = start | halvings << 13 | u32::from(reversed) << 17 | u32::from(owner) << 18 | 1 << 19;
        Self { next, place }
    }

    /// Number of halvings of the ring's curve that give this side.
    pub fn halvings(&self) -> u32 {
        self.place >> 13 & 15
    }

    /// The side runs against the curve.
    pub fn is_reversed(&self) -> bool {
        self.place >> 17 & 1 != 0
    }

    /// Other sides lie on the same curve.
    pub fn is_shared(&self) -> bool {
        self.place >> 19 & 1 != 0
    }
}

/// One face.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq)]
pub struct Face {
    pub domain: [f32; 4],
    pub first_patch: u32,
    pub flags: u32,
    pub strips: u32,
    pub first_curve: u32,
    pub id: u32,
    pub colour: u32,
    pub count_u: u32,
    pub count_v: u32,
    pub first_cell: u32,
    /// Padding to whole texels.
    pub unused: [u32; 3],
}

/// One face of one placed part.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq)]
pub struct FaceInstance {
    pub face: u32,
    pub instance: u32,
    pub first_patch_instance: u32,
    pub first_bin: u32,
    pub first_cell: u32,
    pub first_curve: u32,
    /// Padding to whole texels.
    pub unused: [u32; 2],
}

/// One placed part.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq)]
pub struct Instance {
    pub normal: [[f32; 3]; 3],
    pub scale: f32,
    pub colour: u32,
    pub mirrored: u32,
    pub operand: u32,
    /// Padding to whole texels.
    pub unused: [u32; 3],
}

/// One triangle mesh.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq)]
pub struct Mesh {
    pub first_triangle: u32,
    pub first_normal: u32,
    pub flags: u32,
    pub id: u32,
    pub colour: u32,
}

/// One mesh of one placed part.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq)]
pub struct MeshInstance {
    pub mesh: u32,
    pub instance: u32,
}

/// The part of a patch that lies in one v-strip.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq)]
pub struct Cell {
    pub box_min: [f32; 3],
    pub speed_u: f32,
    pub box_max: [f32; 3],
    pub speed_v: f32,
    pub bin: u32,
    pub normal: u32,
    pub low: f32,
    pub high: f32,
}

/// See [`BORDER_BANDS`].
pub const BORDER_COLUMNS: u32 = crate::abi::constants::border_cells::BORDER_COLUMNS as u32;

/// The rows of a v-strip: `glsl/include/u_bins.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq, Eq)]
pub struct StripRows {
    pub first: u32,
    pub lines: u32,
    pub first_bin: u32,
    pub bins: u32,
}

/// One trim curve.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq)]
pub struct Curve {
    pub start: [f32; 2],
    pub end: [f32; 2],
    pub first: u32,
    pub degree: u32,
    pub bend: [f32; 2],
    pub range_v: [f32; 2],
    pub range_u: [f32; 2],
}
