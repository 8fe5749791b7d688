//! Twin of `glsl/solids/solid_fold.comp`: the Blist of each tile, reduced to the leaves that the tile may show.
//!
//! ```text
//!   exit e ──▶ [absent] ──out──▶ [absent] ──out──▶ [present]     the first of e and its ancestors that is in the
//!                                                                tile's list
//! ```

use crate::abi::{EXIT_FALSE, EXIT_TRUE, LEAF_FALLS, Leaf, TILE_LEAF_ENTRY, TILE_LEAF_GATE, TileLeaf};

/// Sets the exits of `tile_leaves`; tile `n` has `tile_starts[n]` to `tile_starts[n + 1]`. Returns the first leaf of
/// each tile's walk. A leaf is marked as a gate if no exit but `EXIT_FALSE` leads past it. From leaf `followed` on,
/// lists are items of their own; the start of each is marked.
pub fn solid_fold(leaves: &[Leaf], followed: u32, tile_starts: &[u32], tile_leaves: &mut [TileLeaf]) -> Vec<u32> {
    let tile = |ends: &[u32]| {
        let (start, end) = (ends[0], ends[1]);
        let union = fold(leaves, tile_leaves, 0, start, end);
        let (mut item, mut entry) = (None, EXIT_FALSE);
        let passes = |exit: &u32| *exit != EXIT_FALSE;
        let mut reach = Some(union).filter(passes).unwrap_or(0);
        for i in start..end {
            let at = tile_leaves[i as usize].leaf;
            let leaf = leaves[at as usize];
            let in_exit = fold(leaves, tile_leaves, leaf.in_exit, i + 1, end);
            let out_exit = fold(leaves, tile_leaves, leaf.out_exit, i + 1, end);
            if at >= followed && item != Some(leaf.item) {
                item = Some(leaf.item);
                entry = fold(leaves, tile_leaves, leaf.item, i, end);
            }
            let mark = match at < followed {
                true if reach <= i => TILE_LEAF_GATE,
                false if i == entry => TILE_LEAF_ENTRY,
                _ => 0,
            };
            reach = [in_exit, out_exit].into_iter().filter(passes).fold(reach, u32::max);
            tile_leaves[i as usize] = TileLeaf { leaf: at | mark, in_exit, out_exit, of: leaf.own() };
        }
        union
    };
    tile_starts.windows(2).map(tile).collect()
}

fn fold(leaves: &[Leaf], tile_leaves: &[TileLeaf], to: u32, from: u32, end: u32) -> u32 {
    let Some(target) = leaves.get(to as usize) else { return to };
    let holds = |i: &u32| {
        let place = tile_leaves[*i as usize].leaf;
        let leaf = &leaves[place as usize];
        place >= to && leaf.pre <= target.pre && target.pre < leaf.end
    };
    let end_of_chain = if target.flags & LEAF_FALLS != 0 { EXIT_FALSE } else { EXIT_TRUE };
    (from..end).find(holds).unwrap_or(end_of_chain)
}
