//! The frame's part for Boolean solids: what each tile sees, where each pixel's ray enters, light.
//!
//! ```text
//!   leaves ──solid_rects──▶ rects ──solid_blocks, solid_tiles (each: count, scan, list)──▶ leaves of each tile
//!          ──solid_fold──▶ their Blist ──solid_events──▶ visibility, depth ──resolve_solids──▶ the host's targets
//! ```

use super::{Frame, WRITE_TO_READ};
use crate::buffers::SolidBuffers;
use crate::gpu::{Access, Buffer, Commands, Device, GpuError, barrier};
use crate::passes::visibility::{DEPTH_FORMAT, VISIBILITY_FORMAT};
use crate::passes::{resolve, resolve_solids, solid_blocks, solid_events, solid_fold, solid_rects, solid_tiles};
use crate::scene::{SolidData, Solids};

/// The passes of Boolean solids.
pub(super) struct SolidPasses {
    rects: solid_rects::SolidRects,
    blocks: solid_blocks::SolidBlocks,
    tiles: solid_tiles::SolidTiles,
    fold: solid_fold::SolidFold,
    events: solid_events::SolidEvents,
    resolve: resolve_solids::ResolveSolids,
}

impl SolidPasses {
    /// `None` when the scene has no Boolean solid.
    pub(super) fn new(
        device: &Device,
        solids: &SolidData,
        formats: resolve::Formats,
    ) -> Result<Option<Self>, GpuError> {
        if solids.leaves.is_empty() {
            return Ok(None);
        }
        let aovs = resolve::AOV_FORMATS.into_iter().filter(|_| formats.aovs);
        let colour: Vec<_> = std::iter::once(formats.colour).chain(aovs).collect();
        Ok(Some(Self {
            rects: solid_rects::SolidRects::new(device)?,
            blocks: solid_blocks::SolidBlocks::new(device)?,
            tiles: solid_tiles::SolidTiles::new(device)?,
            fold: solid_fold::SolidFold::new(device)?,
            events: solid_events::SolidEvents::new(device, solids.has_tori(), VISIBILITY_FORMAT, DEPTH_FORMAT)?,
            resolve: resolve_solids::ResolveSolids::new(device, &colour, formats.depth)?,
        }))
    }
}

/// Where the parts of Boolean solids are, model axes, seen from this frame's eye.
#[derive(Clone, Copy)]
pub(crate) struct Centres<'a> {
    pub leaves: &'a Buffer,
    pub surfaces: &'a Buffer,
}

/// What the passes of Boolean solids work on.
pub(super) struct SolidParts<'a> {
    passes: &'a SolidPasses,
    scene: &'a Solids,
    buffers: &'a SolidBuffers,
    centres: Centres<'a>,
}

impl<'a> Frame<'a> {
    /// `None` when the scene has no Boolean solid.
    pub(super) fn solids(&self) -> Option<SolidParts<'a>> {
        let passes = self.passes.solids.as_ref()?;
        let (scene, buffers) = (self.scene.solids.as_ref()?, self.buffers.solids.as_ref()?);
        Some(SolidParts { passes, scene, buffers, centres: self.centres? })
    }

    /// Which leaves each tile sees, then the pixels.
    pub(super) fn solid_events(&self, cmd: &Commands<'_>, parts: &SolidParts<'_>) {
        let (p, s, t) = (parts.passes, parts.scene, parts.buffers);
        let (w, r) = WRITE_TO_READ;
        let rects = solid_rects::Bindings {
            frame: self.constants,
            leaves: &s.leaves,
            centres: parts.centres.leaves,
            rects: &t.rects,
        };
        p.rects.record(cmd, &rects, self.buffers.counts.leaves);
        barrier::buffers(cmd, &[(&t.rects, w, r)]);

        let blocks = solid_blocks::Bindings {
            frame: self.constants,
            rects: &t.rects,
            counts: &t.block_counts,
            starts: &t.block_starts,
            leaves: &t.block_leaves,
        };
        p.blocks.count(cmd, &blocks, t.blocks);
        barrier::buffers(cmd, &[(&t.block_counts, w, r), (&t.block_starts, r, w)]);
        self.scan(cmd, &t.block_counts, &t.block_starts, t.blocks);
        barrier::buffers(cmd, &[(&t.block_starts, w, r), (&t.block_counts, r, w)]);
        p.blocks.list(cmd, &blocks, t.blocks);
        barrier::buffers(cmd, &[(&t.block_leaves, w, r)]);

        let tiles = solid_tiles::Bindings {
            frame: self.constants,
            rects: &t.rects,
            block_starts: &t.block_starts,
            block_leaves: &t.block_leaves,
            counts: &t.tile_counts,
            starts: &t.tile_starts,
            leaves: &t.tile_leaves,
            counters: &self.buffers.counters,
        };
        barrier::buffers(cmd, &[(&self.buffers.counters, Access::COMPUTE_WRITE | Access::INDIRECT_READ, w)]);
        p.tiles.count(cmd, &tiles, t.tiles);
        barrier::buffers(cmd, &[(&t.tile_counts, w, r), (&t.tile_starts, r, w), (&self.buffers.counters, w, w)]);
        self.scan(cmd, &t.tile_counts, &t.tile_starts, t.tiles);
        barrier::buffers(cmd, &[(&t.tile_starts, w, r), (&t.tile_counts, r, w)]);
        p.tiles.list(cmd, &tiles, t.tiles);
        barrier::buffers(cmd, &[(&t.tile_leaves, w, w), (&self.buffers.counters, w, w)]);

        let fold = solid_fold::Bindings {
            frame: self.constants,
            leaves: &s.leaves,
            tile_starts: &t.tile_starts,
            tile_leaves: &t.tile_leaves,
            tile_entries: &t.tile_entries,
        };
        p.fold.record(cmd, &fold, t.tiles);
        barrier::buffers(
            cmd,
            &[
                (&t.tile_starts, w, Access::FRAGMENT_READ),
                (&t.tile_leaves, w, Access::FRAGMENT_READ),
                (&t.tile_entries, w, Access::FRAGMENT_READ),
            ],
        );

        let images = (&self.buffers.visibility, &self.buffers.depth);
        barrier::images(
            cmd,
            &[
                (images.0, Access::COLOUR_WRITE, Access::COLOUR_WRITE),
                (images.1, Access::DEPTH_WRITE, Access::DEPTH_WRITE),
            ],
        );
        let events = solid_events::Bindings {
            frame: self.constants,
            leaves: &s.leaves,
            leaf_surfaces: &s.leaf_surfaces,
            surfaces: &s.surfaces,
            surface_centres: parts.centres.surfaces,
            tile_starts: &t.tile_starts,
            tile_leaves: &t.tile_leaves,
            tile_entries: &t.tile_entries,
        };
        p.events.record(cmd, &events, images);
    }

    /// The pixels that `resolve` left to the solids.
    pub(super) fn resolve_solids(&self, cmd: &Commands<'_>, parts: &SolidParts<'_>) {
        let colour = self.colour.iter().map(|a| (a.image, Access::COLOUR_WRITE, Access::COLOUR_WRITE));
        let depth = self.depth.iter().map(|a| (a.image, Access::DEPTH_WRITE, Access::DEPTH_WRITE));
        barrier::images(cmd, &colour.chain(depth).collect::<Vec<_>>());
        let bindings = resolve_solids::Bindings {
            frame: self.constants,
            leaves: &parts.scene.leaves,
            leaf_surfaces: &parts.scene.leaf_surfaces,
            surfaces: &parts.scene.surfaces,
            surface_centres: parts.centres.surfaces,
            visibility: &self.buffers.visibility,
        };
        parts.passes.resolve.record(cmd, &bindings, self.colour, self.depth);
    }
}
