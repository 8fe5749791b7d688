//! The CPU twin of each compute pass: the same results in plain Rust, for parity tests and for readers who do not know
//! GLSL.
//!
//! ```text
//!   glsl/tessellation/bound.comp   twin::bound   frame::tessellation::bound   parity::bound
//!   glsl/include/view.glsl         twin::view                                  one name, four places
//! ```
//!
//! A twin repeats the shader's single-precision operations in the shader's order, and the shader marks them `precise`.
//! If division and square root are rounded correctly, as on the CPU and on llvmpipe, the results are the same bit for
//! bit. Vulkan allows a GPU 2.5 units in the last place for a quotient and 3 for a root, so a `ceil` may then be one
//! higher or lower.

pub mod border_cells;
pub mod border_reach;
pub mod bound;
pub mod carry;
pub mod cone;
pub mod coverage;
pub mod cross;
pub mod curve;
pub mod density;
pub mod dispatch_arguments;
pub mod edges;
pub mod emit;
pub mod exact;
pub mod factor;
pub mod gap_decide;
pub mod gate;
pub mod grid;
pub mod in_sight;
pub mod lines;
pub mod mesh_walk;
pub mod occlusion;
pub mod operand_sort;
pub mod parts;
pub mod reset;
pub mod scan;
pub mod segments;
pub mod solid_blocks;
pub mod solid_fold;
pub mod solid_rects;
pub mod solid_tiles;
pub mod sort;
pub mod split;
pub mod squares;
pub mod table;
pub mod u_bins;
pub mod view;

pub use crate::abi::constants::push::MAX_PUSH;
pub use crate::abi::constants::scene::{
    CORNER_LIST, CORNER_VERTICES, FAILED_DRAWS, FAILED_INTERCEPTS, FAILED_ROWS, FAILED_SUB_PATCHES, MAX_FACTOR,
    MAX_SPLIT, PLAIN_LIST, TRIMMED_CORNER_LIST, TRIMMED_LIST,
};
use crate::abi::{Cell, Curve, Face, FaceInstance, Instance, Link, Patch, View};

/// Most segments along one side of a patch.
pub const MOST_SEGMENTS: u32 = MAX_FACTOR * MAX_SPLIT;

/// The scene as passes read it: the arrays of `glsl/include/scene.glsl`, by reference.
#[derive(Clone, Copy, Debug, Default)]
pub struct Scene<'a> {
    /// Part to pixel, for each instance.
    pub views: &'a [View],
    /// Placed parts.
    pub instances: &'a [Instance],
    /// Faces of placed parts.
    pub face_instances: &'a [FaceInstance],
    /// Faces.
    pub faces: &'a [Face],
    /// Patches of all faces.
    pub patches: &'a [Patch],
    /// Homogeneous control points.
    pub points: &'a [[f32; 4]],
    /// The cells of each patch that no part of the face covers, in scenes with occlusion culling.
    pub outside: &'a [[u32; 2]],
    /// The cone of each patch's outward normals ([`cone`]); empty if no part is closed and without trims.
    pub cones: &'a [[f32; 4]],
    /// Sides that faces share, four a patch; empty if there are none.
    pub links: &'a [Link],
    /// Face instance of each patch instance.
    pub patch_instances: &'a [u32],
    /// Parts of patches in v-strips.
    pub cells: &'a [Cell],
    /// Face instance of each cell instance.
    pub cell_instances: &'a [u32],
    /// Trim curves.
    pub curves: &'a [Curve],
    /// Control points of curves, three numbers each.
    pub curve_points: &'a [f32],
    /// Face instance of each curve instance.
    pub curve_instances: &'a [u32],
}

impl Scene<'_> {
    /// The placed face of a patch instance, its face, and its patch.
    fn patch_instance(&self, patch_instance: usize) -> (FaceInstance, Face, Patch) {
        let placed = self.face_instances[self.patch_instances[patch_instance] as usize];
        let face = self.faces[placed.face as usize];
        (placed, face, self.patches[face.first_patch as usize + patch_instance - placed.first_patch_instance as usize])
    }

    /// The placed face of a curve instance, its face, and the curve.
    fn curve(&self, curve_instance: usize) -> (FaceInstance, Face, Curve) {
        let placed = self.face_instances[self.curve_instances[curve_instance] as usize];
        let face = self.faces[placed.face as usize];
        (placed, face, self.curves[face.first_curve as usize + curve_instance - placed.first_curve as usize])
    }
}

/// The first and last strip, of `strip_count`, from `lo` to `hi` in `v`.
fn strips_of(lo: f32, hi: f32, strip_count: u32) -> (u32, u32) {
    let strips = strip_count as f32;
    let strip = |v: f32| (v * strips).floor().clamp(0.0, strips - 1.0) as u32;
    (strip(lo), strip(hi))
}
