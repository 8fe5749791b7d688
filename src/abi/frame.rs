//! Data that changes in every frame.

pub use crate::abi::constants::scene::ENCODE_SUMMED;
use bytemuck::{Pod, Zeroable};
use std::slice;

/// From part coordinates to homogeneous pixels: rows `X`, `Y`, depth and `W`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq)]
pub struct View {
    pub x: [f32; 4],
    pub y: [f32; 4],
    pub depth: [f32; 4],
    pub w: [f32; 4],
}

/// One frame's view and budgets; see the GLSL for the meaning of each field.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq)]
pub struct Frame {
    pub size: [f32; 2],
    pub focal: f32,
    pub slant: f32,
    pub near: f32,
    pub far: f32,
    pub perspective: u32,
    pub deviation_px: f32,
    pub gap_radius_px: f32,
    pub row_px: f32,
    pub chord_px: f32,
    pub table_density: f32,
    pub fixed_factor: u32,
    pub listed_patch_instances: u32,
    pub run_count: u32,
    pub cell_count: u32,
    pub bin_count: u32,
    pub curve_count: u32,
    pub draw_vertices: u32,
    pub encode_srgb: u32,
    pub sub_patch_capacity: u32,
    pub draw_capacity: u32,
    pub corner_lists: u32,
    pub row_capacity: u32,
    pub intercept_capacity: u32,
    pub gap_candidate_capacity: u32,
    pub leaf_count: u32,
    pub block_leaf_capacity: u32,
    pub tile_leaf_capacity: u32,
    pub fragment_capacity: u32,
    pub followed_leaf: u32,
    pub layer_capacity: u32,
    pub side_count: u32,
    pub band_top: u32,
    pub band_height: u32,
    pub right: [f32; 3],
    pub up: [f32; 3],
    pub forward: [f32; 3],
    pub background: [f32; 4],
    pub offset: [f32; 2],
    pub spread_px: f32,
    pub samples: u32,
    pub style: u32,
    pub curvature: f32,
    pub most_groups: u32,
    pub focal_px: [f32; 2],
    pub principal_px: [f32; 2],
}

#[cfg(any(test, feature = "baselines"))]
impl Frame {
    /// Lists of sub-patches, and of draws: plain, trimmed, and those of patches that are drawn by their corners.
    pub fn patch_lists(&self) -> u32 {
        2 + self.corner_lists
    }
}

impl Counters {
    /// The larger of each count, for two samples of one frame.
    pub fn most(self, other: Self) -> Self {
        let mut all = self;
        let words: &mut [u32] = bytemuck::cast_slice_mut(slice::from_mut(&mut all));
        let others: &[u32] = bytemuck::cast_slice(slice::from_ref(&other));
        words.iter_mut().zip(others).for_each(|(word, other)| *word = (*other).max(*word));
        all.failed = self.failed | other.failed;
        all
    }
}

/// Written by the passes, read back by the host.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq, Eq)]
pub struct Counters {
    pub plain: u32,
    pub trimmed: u32,
    pub corners: u32,
    pub plain_draws: u32,
    pub trimmed_draws: u32,
    pub corner_draws: u32,
    pub trimmed_corner_draws: u32,
    pub rows: u32,
    pub segments: u32,
    pub wanted_rows: u32,
    pub intercepts: u32,
    pub gap_candidates: u32,
    pub band_gap_candidates: u32,
    pub block_leaves: u32,
    pub tile_leaves: u32,
    pub band_tile_leaves: u32,
    pub row_tile_leaves: u32,
    pub fragments: u32,
    pub band_fragments: u32,
    pub row_fragments: u32,
    pub mended: u32,
    pub unpaired: u32,
    pub contacts: u32,
    pub overlaps: u32,
    pub layers: u32,
    pub ray_segments: u32,
    pub hidden: u32,
    pub hidden_parts: u32,
    pub listed_patches: u32,
    pub edge_chords: u32,
    pub line_points: u32,
    pub line_seeds: u32,
    pub fold_starts: u32,
    pub followed_points: u32,
    pub clamps: u32,
    pub failed: u32,
}

/// Tessellation of one patch instance.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq, Eq)]
pub struct Factors {
    pub inner: u32,
    pub edge_u: u32,
    pub edge_v: u32,
    pub splits: u32,
}

/// A pixel for pass `gap_fill`, with the surface visible there.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq, Eq)]
pub struct GapCandidate {
    pub pixel: u32,
    pub word: [u32; 2],
}

/// The list of gap candidates of a band of rows: the grid of passes over it, and its length.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq, Eq)]
pub struct GapBand {
    pub grid: [u32; 3],
    pub count: u32,
}

/// A run of consecutive patch instances in sight: its first one, and the place of that among all in sight.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq, Eq)]
pub struct PatchRun {
    pub place: u32,
    pub patch_instance: u32,
}

/// One entry of the draw list.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq, Eq)]
pub struct SubPatch {
    pub patch_instance: u32,
    pub place: u32,
}
