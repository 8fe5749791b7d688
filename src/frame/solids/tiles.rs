//! The leaves that each block of tiles may show, then those of each tile of a band, and their Blist.

use super::bands::Band;
use super::{SolidParts, solid_blocks, solid_fold, solid_squares, solid_tiles};
use crate::abi::{BLOCK, LEAF_RUN, TILE, TileLeaf};
use crate::frame::common::room::Room;
use crate::frame::{Frame, WRITE_TO_READ};
use crate::gpu::{Access, Buffer, Commands, Device, GpuError, Texel, TexelBuffer};
use std::sync::Arc;

/// The passes.
pub(super) struct TilePasses {
    blocks: solid_blocks::SolidBlocks,
    tiles: solid_tiles::SolidTiles,
    fold: solid_fold::SolidFold,
    squares: solid_squares::SolidSquares,
}

impl TilePasses {
    pub(super) fn new(device: &Device) -> Result<Self, GpuError> {
        Ok(Self {
            blocks: solid_blocks::SolidBlocks::new(device)?,
            tiles: solid_tiles::SolidTiles::new(device)?,
            fold: solid_fold::SolidFold::new(device)?,
            squares: solid_squares::SolidSquares::new(device)?,
        })
    }
}

/// The passes, and their lists.
pub(crate) struct Tiles {
    passes: Arc<TilePasses>,
    /// Runs of leaves of all blocks.
    runs: u32,
    /// Tiles in the picture.
    pub tiles: u32,
    pub block_counts: Buffer,
    pub block_starts: Buffer,
    pub block_leaves: Buffer,
    pub tile_counts: Buffer,
    pub tile_starts: TexelBuffer,
    pub tile_leaves: TexelBuffer,
    /// Entry and square of every tile of the picture.
    pub tile_entries: TexelBuffer,
    pub tile_squares: Buffer,
}

/// Number of runs of leaves of all blocks, and of tiles of a band.
pub(super) fn counted(room: &Room<'_>) -> [u32; 2] {
    let runs = room.squares(TILE * BLOCK) * room.counts.leaves.div_ceil(LEAF_RUN);
    [runs, room.squares(TILE).min(room.size.0.div_ceil(TILE) * room.band_rows())]
}

impl Tiles {
    pub(super) fn new(room: &Room<'_>, passes: &Arc<TilePasses>) -> Result<Self, GpuError> {
        let all_tiles = room.squares(TILE);
        let [runs, tiles] = counted(room);
        Ok(Self {
            passes: Arc::clone(passes),
            runs,
            tiles: all_tiles,
            block_counts: room.words("solid block counts", runs)?,
            block_starts: room.words("solid block starts", runs + 1)?,
            block_leaves: room.words("solid block leaves", room.capacities.solids.block_leaves)?,
            tile_counts: room.words("solid tile counts", tiles)?,
            tile_starts: room.texels::<u32>("solid tile starts", tiles + 1, Texel::Words)?,
            tile_leaves: room.texels::<TileLeaf>(
                "solid tile leaves",
                room.capacities.solids.tile_leaves,
                Texel::U32x4,
            )?,
            tile_entries: room.texels::<u32>("solid tile entries", all_tiles, Texel::Words)?,
            tile_squares: room.words("solid tile squares", all_tiles)?,
        })
    }

    /// Lists the leaves of each block of tiles.
    pub(super) fn blocks(&self, frame: &Frame<'_>, cmd: &Commands<'_>, solids: &SolidParts<'_>) {
        let (w, r) = WRITE_TO_READ;
        let blocks = solid_blocks::Bindings {
            frame: frame.constants,
            rects: &solids.stage.rect_buffer,
            counts: &self.block_counts,
            starts: &self.block_starts,
            leaves: &self.block_leaves,
        };
        let pass = &self.passes.blocks;
        pass.count(cmd, &blocks, self.runs);
        cmd.after(w, r | w);
        frame.stages.common.scan(cmd, &self.block_counts, &self.block_starts, self.runs);
        cmd.after(w, r | w);
        pass.list(cmd, &blocks, self.runs);
        cmd.after(w, r);
    }

    /// Lists the leaves of each tile of a band, and makes their Blist.
    pub(super) fn record(&self, frame: &Frame<'_>, cmd: &Commands<'_>, solids: &SolidParts<'_>, band: &Band) {
        let (w, r) = WRITE_TO_READ;
        let count = frame.tiles_of(band).len() as u32;
        let (p, t) = (&self.passes, self);
        let counters = &frame.stages.common.counters;
        let tiles = solid_tiles::Bindings {
            frame: frame.constants,
            rects: &solids.stage.rect_buffer,
            block_starts: &t.block_starts,
            block_leaves: &t.block_leaves,
            counts: &t.tile_counts,
            starts: &t.tile_starts,
            leaves: &t.tile_leaves,
            counters,
        };
        cmd.after(Access::COMPUTE_WRITE | Access::INDIRECT_READ, w);
        p.tiles.count(cmd, &tiles, count);
        cmd.after(w, r | w);
        frame.stages.common.scan(cmd, &t.tile_counts, &t.tile_starts, count);
        cmd.after(w, r | w);
        p.tiles.list(cmd, &tiles, count);
        cmd.after(w, w);

        let fold = solid_fold::Bindings {
            frame: frame.constants,
            leaves: &solids.scene.leaves,
            tile_starts: &t.tile_starts,
            tile_leaves: &t.tile_leaves,
            tile_entries: &t.tile_entries,
            counters,
        };
        p.fold.record(cmd, &fold, count);
        cmd.after(w | Access::VERTEX_READ, w | r);
        let squares = solid_squares::Bindings {
            frame: frame.constants,
            tile_entries: &t.tile_entries,
            tile_squares: &t.tile_squares,
        };
        p.squares.record(cmd, &squares, count);
        cmd.after(w, Access::VERTEX_READ | Access::FRAGMENT_READ);
    }
}
