//! Twin of `glsl/solids/solid_tiles.comp`: lists the leaves of its block that each tile may show.

use crate::abi::{BLOCK, Frame, LEAF_RUN, Rect, TILE};
use crate::twin::solid_blocks::block_count;
use crate::twin::solid_rects::tile_count;

/// Tiles of the band: across and down.
pub fn band_tiles(frame: &Frame) -> [u32; 2] {
    let rows = frame.band_height.min(frame.size[1] as u32 - frame.band_top);
    [tile_count(frame)[0], rows.div_ceil(TILE)]
}

/// Whether a leaf's rectangle has a tile from `first` to `last`, inclusive.
pub fn meets(rect: &Rect, first: [u32; 2], last: [u32; 2]) -> bool {
    (0..2).all(|k| rect.first[k] <= last[k] && rect.last[k] >= first[k] && rect.first[k] <= rect.last[k])
}

/// `count` lists one after another, and the start of each.
pub(super) fn lists_of(count: u32, list: impl Fn(u32) -> Vec<u32>) -> (Vec<u32>, Vec<u32>) {
    let (mut starts, mut all) = (vec![0], Vec::new());
    for n in 0..count {
        all.extend(list(n));
        starts.push(all.len() as u32);
    }
    (starts, all)
}

/// The start of each tile's list in the band (and the end of the last), and all lists; the blocks' lists are given.
pub fn solid_tiles(frame: &Frame, rects: &[Rect], block_starts: &[u32], block_leaves: &[u32]) -> (Vec<u32>, Vec<u32>) {
    let [across, down] = band_tiles(frame);
    let list = |n: u32| {
        let tile = [n % across, frame.band_top / TILE + n / across];
        let block = (tile[1] / BLOCK * block_count(frame)[0] + tile[0] / BLOCK) as usize;
        let runs = rects.len().div_ceil(LEAF_RUN as usize);
        let [start, end] = [block, block + 1].map(|block| block_starts[block * runs] as usize);
        let here = &block_leaves[start..end];
        here.iter().copied().filter(|leaf| meets(&rects[*leaf as usize], tile, tile)).collect()
    };
    lists_of(across * down, list)
}
