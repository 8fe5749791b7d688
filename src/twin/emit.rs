//! Twin of the pass `emit`: writes the list of sub-patches, and the draws that cover it.
//!
//! ```text
//!   vertices before a patch instance  0 ..... draw_vertices ..... 2 draw_vertices ....
//!   draw that covers it      |   0   |        1         |        2
//! ```
//!
//! Only sums and extrema: the order of the patch instances does not matter.

use super::{
    CORNER_LIST, CORNER_VERTICES, FAILED_DRAWS, FAILED_SUB_PATCHES, PLAIN_LIST, TRIMMED_CORNER_LIST, TRIMMED_LIST,
};
use crate::abi::{Counters, Factors, Frame, SubPatch};
use bytemuck::{Pod, Zeroable};

/// `VkDrawIndirectCommand`; a vertex is a sub-patch, or one of the [`CORNER_VERTICES`] of a patch drawn by its corners.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq, Eq)]
pub struct Draw {
    /// Number of vertices.
    pub vertex_count: u32,
    /// 1.
    pub instance_count: u32,
    /// The first of them.
    pub first_vertex: u32,
    /// 0.
    pub first_instance: u32,
}

/// Writes `sub_patches` and `draws` (list by list, `draw_capacity` each; cleared before), up to their capacities.
/// `counters` receive the total numbers and the failures.
///
/// The starts are the prefix sums of the counts of [`Split`](super::split::Split), followed by the total.
pub fn emit(
    frame: &Frame,
    factors: &[Factors],
    sub_patch_starts: &[u32],
    vertex_starts: &[u32],
    (sub_patches, draws): (&mut [SubPatch], &mut [Draw]),
    counters: &mut Counters,
) {
    let (n, lists) = (frame.listed_patch_instances as usize, frame.patch_lists());
    let starts = |list: u32| sub_patch_starts[list as usize * n];
    let total = |list: u32| if list < lists { starts(list + 1) - starts(list) } else { 0 };
    let corners = [CORNER_LIST, TRIMMED_CORNER_LIST].map(total);
    counters.plain += total(PLAIN_LIST) + corners[0];
    counters.trimmed += total(TRIMMED_LIST) + corners[1];
    counters.corners += corners[0] + corners[1];
    if sub_patch_starts[lists as usize * n] > frame.sub_patch_capacity {
        counters.failed |= FAILED_SUB_PATCHES;
    }
    for (patch_instance, factors) in factors.iter().enumerate().take(n) {
        let slot_in = |list: u32| list as usize * n + patch_instance;
        let count_in = |list: u32| sub_patch_starts[slot_in(list) + 1] - sub_patch_starts[slot_in(list)];
        let Some(list) = (0..lists).find(|list| count_in(*list) > 0) else { continue };
        let (slot, count) = (slot_in(list), count_in(list));
        let first = sub_patch_starts[slot];
        let vertices = (vertex_starts[slot + 1] - vertex_starts[slot]) / count;
        let before = vertex_starts[slot] - vertex_starts[list as usize * n];
        let across = factors.splits & 0xffff;
        for k in 0..count {
            let at = first + k;
            if at >= frame.sub_patch_capacity {
                break;
            }
            sub_patches[at as usize] =
                SubPatch { patch_instance: patch_instance as u32, place: (k % across) | (k / across) << 8 };
            let draw = (before + k * vertices) / frame.draw_vertices;
            let used = match list {
                PLAIN_LIST => &mut counters.plain_draws,
                TRIMMED_LIST => &mut counters.trimmed_draws,
                CORNER_LIST => &mut counters.corner_draws,
                _ => &mut counters.trimmed_corner_draws,
            };
            *used = (*used).max((draw + 1).min(frame.draw_capacity));
            if draw >= frame.draw_capacity {
                counters.failed |= FAILED_DRAWS;
                break;
            }
            let of_one = if list >= CORNER_LIST { CORNER_VERTICES } else { 1 };
            let draw = &mut draws[(draw + list * frame.draw_capacity) as usize];
            draw.vertex_count += of_one;
            draw.first_vertex = draw.first_vertex.min(of_one * at);
        }
    }
}
