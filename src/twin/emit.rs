//! Twin of the pass `emit`: writes the list of sub-patches, and the draws that cover it.
//!
//! ```text
//!   vertices before a patch instance  0 ..... draw_vertices ..... 2 draw_vertices ....
//!   draw that covers it      |   0   |        1         |        2
//! ```
//!
//! Only sums and extrema: the order of the patch instances does not matter.

use super::{FAILED_DRAWS, FAILED_SUB_PATCHES};
use crate::abi::{Counters, Factors, Frame, SubPatch};
use bytemuck::{Pod, Zeroable};

/// `VkDrawIndirectCommand`; a vertex is a sub-patch.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable, PartialEq, Eq)]
pub struct Draw {
    /// Sub-patches.
    pub vertex_count: u32,
    /// 1.
    pub instance_count: u32,
    /// The first of them.
    pub first_vertex: u32,
    /// 0.
    pub first_instance: u32,
}

/// Writes `sub_patches` and `draws` (plain, then trimmed: `draw_capacity` each; cleared before), up to their
/// capacities. `counters` receive the total numbers and the failures.
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
    let n = frame.listed_patch_instances as usize;
    counters.plain += sub_patch_starts[n];
    counters.trimmed += sub_patch_starts[2 * n] - sub_patch_starts[n];
    if sub_patch_starts[2 * n] > frame.sub_patch_capacity {
        counters.failed |= FAILED_SUB_PATCHES;
    }
    for patch_instance in 0..n {
        let trimmed = sub_patch_starts[patch_instance + 1] == sub_patch_starts[patch_instance];
        let slot = if trimmed { n + patch_instance } else { patch_instance };
        let first = sub_patch_starts[slot];
        let count = sub_patch_starts[slot + 1] - first;
        if count == 0 {
            continue;
        }
        let vertices = (vertex_starts[slot + 1] - vertex_starts[slot]) / count;
        let before = vertex_starts[slot] - if trimmed { vertex_starts[n] } else { 0 };
        let across = factors[patch_instance].splits & 0xffff;
        for k in 0..count {
            let at = first + k;
            if at >= frame.sub_patch_capacity {
                break;
            }
            sub_patches[at as usize] =
                SubPatch { patch_instance: patch_instance as u32, place: (k % across) | (k / across) << 8 };
            let draw = (before + k * vertices) / frame.draw_vertices;
            let used = if trimmed { &mut counters.trimmed_draws } else { &mut counters.plain_draws };
            *used = (*used).max((draw + 1).min(frame.draw_capacity));
            if draw >= frame.draw_capacity {
                counters.failed |= FAILED_DRAWS;
                break;
            }
            let draw = &mut draws[(draw + if trimmed { frame.draw_capacity } else { 0 }) as usize];
            draw.vertex_count += 1;
            draw.first_vertex = draw.first_vertex.min(at);
        }
    }
}
