//! Twin of `glsl/solid_blocks.comp`: which leaves each block of tiles may see.

use super::solid_tiles::{lists_of, meets};
use crate::abi::{BLOCK, Frame, Rect};
use crate::twin::solid_rects::tile_count;

/// Blocks across and down the picture.
pub fn block_count(frame: &Frame) -> [u32; 2] {
    tile_count(frame).map(|n| n.div_ceil(BLOCK))
}

/// Where the list of each block begins (and the last one ends), and all lists, leaves in order.
pub fn solid_blocks(frame: &Frame, rects: &[Rect]) -> (Vec<u32>, Vec<u32>) {
    let [across, down] = block_count(frame);
    let sees = |n: u32, leaf: &u32| {
        let first = [n % across, n / across].map(|b| b * BLOCK);
        meets(&rects[*leaf as usize], first, first.map(|t| t + BLOCK - 1))
    };
    lists_of(across * down, |n| (0..rects.len() as u32).filter(|leaf| sees(n, leaf)).collect())
}
