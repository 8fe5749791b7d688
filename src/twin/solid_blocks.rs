//! Twin of `glsl/solids/solid_blocks.comp`: lists the leaves that each block of tiles may show.

use super::solid_tiles::{lists_of, meets};
use crate::abi::{BLOCK, Frame, LEAF_RUN, Rect};
use crate::twin::solid_rects::tile_count;

/// Blocks across and down the picture.
pub fn block_count(frame: &Frame) -> [u32; 2] {
    tile_count(frame).map(|n| n.div_ceil(BLOCK))
}

/// The start of each block's list (and the end of the last), run after run of [`LEAF_RUN`] leaves; and all lists, with
/// leaves in order.
pub fn solid_blocks(frame: &Frame, rects: &[Rect]) -> (Vec<u32>, Vec<u32>) {
    let [across, down] = block_count(frame);
    let leaves = rects.len() as u32;
    let runs = leaves.div_ceil(LEAF_RUN);
    let sees = |n: u32, leaf: &u32| {
        let block = n / runs;
        let first = [block % across, block / across].map(|b| b * BLOCK);
        meets(&rects[*leaf as usize], first, first.map(|t| t + BLOCK - 1))
    };
    lists_of(across * down * runs, |n| {
        let from = n % runs * LEAF_RUN;
        (from..leaves.min(from + LEAF_RUN)).filter(|leaf| sees(n, leaf)).collect()
    })
}
