//! Parity of the passes `solid_blocks` and `solid_tiles`: exact, also with lists that are too short.

use super::Random;
use super::harness::{Gpu, Mismatch, same};
use crate::abi::{Counters, Frame, Rect, TileLeaf};
use crate::frame::solids::solid_blocks;
use crate::frame::solids::solid_tiles;
use crate::twin;

const UNTOUCHED: u32 = 0xabcd_1234;

fn random_rects(random: &mut Random, tiles: [u32; 2], count: u32) -> Vec<Rect> {
    let one = |_| {
        let mut side = |k: usize| {
            let first = random.integer(0, tiles[k] - 1);
            (first, (first + random.integer(0, 4)).min(tiles[k] - 1))
        };
        let (x, y) = (side(0), side(1));
        Rect { first: [x.0, y.0], last: [x.1, y.1] }
    };
    let mut all: Vec<Rect> = (0..count).map(one).collect();
    all.extend([twin::solid_rects::NOWHERE, Rect { first: [0; 2], last: tiles.map(|n| n - 1) }]);
    all
}

/// Whether the GPU's result for `given` is the twin's for `expected`.
fn compare(gpu: &Gpu, frame: &Frame, given: &[Rect], expected: &[Rect]) -> Result<(), Mismatch> {
    let frames = gpu.upload("frame", &[*frame]);
    let rects = gpu.upload("rects", given);
    let (starts, leaves) = twin::solid_blocks::solid_blocks(frame, expected);
    let blocks = starts.len() as u32 - 1;
    let counts = gpu.upload("counts", &vec![UNTOUCHED; blocks as usize]);
    let block_starts = gpu.upload("starts", &starts);
    let block_leaves = gpu.upload("leaves", &vec![UNTOUCHED; leaves.len() + 1]);
    let pass = solid_blocks::SolidBlocks::new(gpu.device()).unwrap();
    let bindings = solid_blocks::Bindings {
        frame: &frames,
        rects: &rects,
        counts: &counts,
        starts: &block_starts,
        leaves: &block_leaves,
    };
    gpu.run(|cmd| pass.count(cmd, &bindings, blocks));
    gpu.run(|cmd| pass.list(cmd, &bindings, blocks));
    let sizes = |starts: &[u32]| starts.windows(2).map(|w| w[1] - w[0]).collect::<Vec<_>>();
    let cut = |all: &[u32], room: u32| {
        let fits = |(i, v): (usize, &u32)| if i < room as usize { *v } else { UNTOUCHED };
        all.iter().chain([&UNTOUCHED]).enumerate().map(fits).collect::<Vec<_>>()
    };
    same("block counts", &gpu.read(&counts, blocks as usize), &sizes(&starts))?;
    same("block leaves", &gpu.read(&block_leaves, leaves.len() + 1), &cut(&leaves, frame.block_leaf_capacity))?;

    let wanted = leaves.len() as u32;
    let (tile_starts, tile_leaves) = twin::solid_tiles::solid_tiles(frame, expected, &starts, &leaves);
    let tiles = tile_starts.len() as u32 - 1;
    let whole = gpu.upload("leaves", &leaves);
    let counts = gpu.upload("counts", &vec![UNTOUCHED; tiles as usize]);
    let gpu_starts = gpu.upload("starts", &tile_starts);
    let empty = TileLeaf { leaf: UNTOUCHED, ..TileLeaf::default() };
    let listed = gpu.upload("leaves", &vec![empty; tile_leaves.len() + 1]);
    let counters = gpu.upload("counters", &[Counters::default()]);
    let pass = solid_tiles::SolidTiles::new(gpu.device()).unwrap();
    // all lists of the blocks fit, so that only the tiles' lists are too short
    let roomy = gpu.upload("frame", &[Frame { block_leaf_capacity: wanted, ..*frame }]);
    let bindings = solid_tiles::Bindings {
        frame: &roomy,
        rects: &rects,
        block_starts: &block_starts,
        block_leaves: &whole,
        counts: &counts,
        starts: &gpu_starts,
        leaves: &listed,
        counters: &counters,
    };
    gpu.run(|cmd| pass.count(cmd, &bindings, tiles));
    gpu.run(|cmd| pass.list(cmd, &bindings, tiles));
    let failed = if tile_leaves.len() as u32 > frame.tile_leaf_capacity { 64 } else { 0 };
    let (all, across) = (tile_leaves.len() as u32, twin::solid_tiles::band_tiles(frame)[0] as usize);
    let rows = tile_starts.iter().step_by(across).zip(tile_starts.iter().skip(across).step_by(across));
    let c = Counters {
        block_leaves: wanted,
        tile_leaves: all,
        band_tile_leaves: all,
        row_tile_leaves: rows.map(|(start, end)| end - start).max().unwrap(),
        failed,
        ..Counters::default()
    };
    same("counters", &gpu.read(&counters, 1), &[c])?;
    same("tile counts", &gpu.read(&counts, tiles as usize), &sizes(&tile_starts))?;
    let found: Vec<u32> = gpu.read::<TileLeaf>(&listed, tile_leaves.len() + 1).iter().map(|t| t.leaf).collect();
    same("tile leaves", &found, &cut(&tile_leaves, frame.tile_leaf_capacity))
}

#[test]
fn parity() {
    for gpu in Gpu::all() {
        let mut random = Random::new(17);
        // the last have more than one run, and more leaves than drivers allow steps in a loop
        for (size, count) in [([333.0, 211.0], 300), ([16.0, 16.0], 3), ([700.0, 40.0], 1200), ([260.0, 40.0], 70_000)]
        {
            let frame = Frame { size, band_height: 4096, ..Frame::default() };
            let rects = random_rects(&mut random, twin::solid_rects::tile_count(&frame), count);
            let frame = Frame { leaf_count: rects.len() as u32, ..frame };
            let room = Frame { block_leaf_capacity: 1 << 20, tile_leaf_capacity: 1 << 20, ..frame };
            compare(&gpu, &room, &rects, &rects).unwrap();
            // a band of one row of tiles, and the remaining rows
            for (band_top, band_height) in [(16, 16), (32, 512)] {
                if (band_top as f32) < size[1] {
                    compare(&gpu, &Frame { band_top, band_height, ..room }, &rects, &rects).unwrap();
                }
            }
            // too little room: the lists contain what fits, and the counters report the rest
            let tight = Frame { block_leaf_capacity: 3, tile_leaf_capacity: 2, ..frame };
            compare(&gpu, &tight, &rects, &rects).unwrap();
            let mut other = rects.clone();
            other[0] = twin::solid_rects::NOWHERE;
            assert_eq!(compare(&gpu, &room, &other, &rects).unwrap_err().buffer, "block counts");
        }
        // so many leaves in one block that a driver may end the loop over them: the lists are complete, or the counters
        // report it
        let frame = Frame { size: [32.0, 16.0], band_height: 4096, leaf_count: 300_000, ..Frame::default() };
        let room = Frame { block_leaf_capacity: 1 << 20, tile_leaf_capacity: 1 << 20, ..frame };
        let rect = |n: u32| {
            let tile = [u32::from(n.is_multiple_of(9)), 0];
            Rect { first: tile, last: tile }
        };
        let rects: Vec<Rect> = (0..frame.leaf_count).map(rect).collect();
        if let Err(mismatch) = compare(&gpu, &room, &rects, &rects) {
            assert_eq!(mismatch.buffer, "counters");
        }
        gpu.finish();
    }
}
