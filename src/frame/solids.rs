//! The frame's part for Boolean solids: what each tile sees, where each pixel's ray enters.
//!
//! ```text
//!   leaves ──solid_rects──▶ rects ──solid_blocks, solid_tiles (each: count, scan, list)──▶ leaves of each tile
//!          ──solid_fold──▶ their Blist ──solid_events──▶ visibility of what is no patch, depth
//! ```

use super::{Frame, WRITE_TO_READ};
use crate::buffers::SolidBuffers;
use crate::gpu::{Access, Attachment, Buffer, Commands, Device, GpuError, Load, barrier};
use crate::passes::visibility::{DEPTH_FORMAT, VISIBILITY_FORMAT};
use crate::passes::{resolve, solid_blocks, solid_cst, solid_events, solid_fold, solid_rects, solid_tiles};
use crate::scene::{SolidData, Solids};

/// The passes of Boolean solids.
pub(super) struct SolidPasses {
    rects: solid_rects::SolidRects,
    blocks: solid_blocks::SolidBlocks,
    tiles: solid_tiles::SolidTiles,
    fold: solid_fold::SolidFold,
    way: Way,
}

/// Who finds the faces.
enum Way {
    Events(solid_events::SolidEvents),
    Cst(solid_cst::SolidCst),
}

impl SolidPasses {
    /// `None` when the scene has no Boolean solid.
    pub(super) fn new(device: &Device, solids: &SolidData) -> Result<Option<Self>, GpuError> {
        let Some(tori) = solids.kinds() else { return Ok(None) };
        Ok(Some(Self {
            rects: solid_rects::SolidRects::new(device)?,
            blocks: solid_blocks::SolidBlocks::new(device)?,
            tiles: solid_tiles::SolidTiles::new(device)?,
            fold: solid_fold::SolidFold::new(device)?,
            way: if solids.order.is_empty() {
                Way::Events(solid_events::SolidEvents::new(device, tori, VISIBILITY_FORMAT, DEPTH_FORMAT)?)
            } else {
                Way::Cst(solid_cst::SolidCst::new(device, tori, VISIBILITY_FORMAT, DEPTH_FORMAT)?)
            },
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
    pub(super) fn solid_faces(&self, cmd: &Commands<'_>, parts: &SolidParts<'_>) {
        let (p, s, t) = (parts.passes, parts.scene, parts.buffers);
        let (w, r) = WRITE_TO_READ;
        let rects = solid_rects::Bindings {
            frame: self.constants,
            leaves: &s.leaves,
            centres: parts.centres.leaves,
            rects: &t.rects,
        };
        p.rects.record(cmd, &rects, self.buffers.counts.leaves);
        barrier::buffers(cmd, &[(&t.rects, w, r | Access::VERTEX_READ)]);

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

        let b = self.buffers;
        let seen = b.others.as_ref().unwrap_or(&b.visibility);
        // meshes came before
        let drawn = self.scene.meshes.is_some();
        let colour = Attachment { image: seen, load: if drawn { Load::Keep } else { Load::ColourU32([0; 4]) } };
        let depth = Attachment { image: &b.depth, load: if drawn { Load::Keep } else { Load::Depth(0.0) } };
        match (&p.way, &s.order) {
            (Way::Cst(cst), Some((order, drawn))) => {
                let cst_bindings = solid_cst::Bindings {
                    frame: self.constants,
                    leaves: &s.leaves,
                    leaf_surfaces: &s.leaf_surfaces,
                    surfaces: &s.surfaces,
                    surface_centres: parts.centres.surfaces,
                    tile_starts: &t.tile_starts,
                    tile_leaves: &t.tile_leaves,
                    tile_entries: &t.tile_entries,
                    rects: &t.rects,
                    order,
                };
                cst.record(cmd, &cst_bindings, (colour, depth), *drawn);
            }
            (Way::Events(events), _) => {
                let bindings = solid_events::Bindings {
                    frame: self.constants,
                    leaves: &s.leaves,
                    leaf_surfaces: &s.leaf_surfaces,
                    surfaces: &s.surfaces,
                    surface_centres: parts.centres.surfaces,
                    tile_starts: &t.tile_starts,
                    tile_leaves: &t.tile_leaves,
                    tile_entries: &t.tile_entries,
                };
                events.record(cmd, &bindings, (colour, depth));
            }
            (Way::Cst(_), None) => unreachable!("the pass is made of the order"),
        }
        barrier::images(
            cmd,
            &[(seen, Access::COLOUR_WRITE, Access::COLOUR_WRITE), (&b.depth, Access::DEPTH_WRITE, Access::DEPTH_WRITE)],
        );
    }
}

impl<'a> SolidParts<'a> {
    /// What pass `resolve` needs of them.
    pub(super) fn resolve(&self, frame: &Frame<'a>) -> resolve::SolidBindings<'a> {
        let b = frame.buffers;
        resolve::SolidBindings {
            frame: frame.constants,
            leaves: &self.scene.leaves,
            leaf_surfaces: &self.scene.leaf_surfaces,
            surfaces: &self.scene.surfaces,
            surface_centres: self.centres.surfaces,
            visibility: &b.visibility,
            others: b.others.as_ref().unwrap_or(&b.visibility),
        }
    }
}
