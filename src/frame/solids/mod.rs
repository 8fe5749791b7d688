//! The frame's part for Boolean solids: what each tile sees, where each pixel's ray enters.
//!
//! ```text
//!   leaves ──solid_rects──▶ rects ──solid_blocks, solid_tiles (each: count, scan, list)──▶ leaves of each tile
//!          ──solid_fold──▶ their Blist ──solid_squares──▶ tiles that are drawn
//!          ──solid_events──▶ visibility of what is no patch, depth
//!   operands ──operand_mesh, operand_patch (each: count, scan, fill)──▶ fragments of each pixel
//!            ──operand_sort──▶ in order ──▲
//!
//!   the lists of tiles and pixels, and what is drawn from them, band after band where they are large: bands.rs
//! ```

pub(crate) mod bands;
pub(crate) mod blister;
pub(crate) mod lists;
pub(crate) mod operand_mesh;
pub(crate) mod operand_patch;
pub(crate) mod operand_sort;
mod peel;
pub(crate) mod solid_blocks;
pub(crate) mod solid_cst;
pub(crate) mod solid_events;
pub(crate) mod solid_fold;
pub(crate) mod solid_rects;
pub(crate) mod solid_squares;
pub(crate) mod solid_tiles;

use super::{Frame, WRITE_TO_READ};
use crate::abi::TILE;
use crate::frame::buffers::{FragmentBuffers, SolidBuffers, TileBuffers};
use crate::frame::shading::resolve;
use crate::frame::visibility::patches::{DEPTH_FORMAT, VISIBILITY_FORMAT};
use crate::gpu::{Access, Attachment, Buffer, Commands, Device, GpuError, Load, Texels, barrier};
use bands::Band;

use crate::scene::{SceneData, Shells, Solids};
use crate::shaders::TrimTest;

/// The passes of Boolean solids.
pub(super) struct SolidPasses {
    rects: solid_rects::SolidRects,
    tiles: Option<TilePasses>,
    way: Way,
    shells: Option<ShellPasses>,
}

/// Those that say which leaves each tile sees.
struct TilePasses {
    blocks: solid_blocks::SolidBlocks,
    tiles: solid_tiles::SolidTiles,
    fold: solid_fold::SolidFold,
    squares: solid_squares::SolidSquares,
}

/// Who finds the faces.
enum Way {
    Events(solid_events::SolidEvents),
    Cst(solid_cst::SolidCst),
    Blister(Box<blister::Blister>),
}

/// Those of operands without equations.
struct ShellPasses {
    meshes: Option<operand_mesh::OperandMesh>,
    patches: Option<operand_patch::OperandPatch>,
    sort: operand_sort::OperandSort,
}

/// Which leaves each tile sees is asked: not where layers are peeled of meshes.
pub(super) fn has_tiles(data: &SceneData) -> bool {
    data.solids.blister.is_none() || data.solids.shell_leaves.is_empty()
}

impl SolidPasses {
    /// `None` when the scene has no Boolean solid.
    pub(super) fn new(device: &Device, data: &SceneData, trim: Option<&TrimTest>) -> Result<Option<Self>, GpuError> {
        let Some(surfaces) = data.solids.kinds() else { return Ok(None) };
        let shells = !data.solids.shell_leaves.is_empty();
        let meshes = !data.solids.operand_draws.is_empty();
        let plain = (data.has_plain, !data.links.is_empty());
        let patches = |()| operand_patch::OperandPatch::new(device, data.has_rational, plain, trim);
        let tiles = |()| {
            Ok(TilePasses {
                blocks: solid_blocks::SolidBlocks::new(device)?,
                tiles: solid_tiles::SolidTiles::new(device)?,
                fold: solid_fold::SolidFold::new(device)?,
                squares: solid_squares::SolidSquares::new(device)?,
            })
        };
        let peels = data.solids.blister.is_some();
        let formats = (VISIBILITY_FORMAT, DEPTH_FORMAT);
        let shell_passes = |()| {
            Ok(ShellPasses {
                meshes: meshes.then(|| operand_mesh::OperandMesh::new(device)).transpose()?,
                patches: data.has_operands.then_some(()).map(patches).transpose()?,
                sort: operand_sort::OperandSort::new(device)?,
            })
        };
        let way = || {
            Ok(if peels {
                Way::Blister(Box::new(blister::Blister::new(device, (surfaces, shells), formats.0, formats.1)?))
            } else if data.solids.order.is_empty() {
                let followed = data.solids.is_followed();
                let kinds = solid_events::Kinds { surfaces, shells, patches: data.has_operands, followed };
                Way::Events(solid_events::SolidEvents::new(device, kinds, formats.0, formats.1)?)
            } else {
                Way::Cst(solid_cst::SolidCst::new(device, surfaces, formats.0, formats.1)?)
            })
        };
        let lists = || {
            let shells = (shells && !peels).then_some(()).map(shell_passes).transpose()?;
            let tiles = has_tiles(data).then_some(()).map(tiles).transpose()?;
            Ok((solid_rects::SolidRects::new(device)?, tiles, shells))
        };
        let (way, lists) = rayon::join(way, lists);
        let (rects, tiles, shells) = lists?;
        Ok(Some(Self { rects, tiles, way: way?, shells }))
    }
}

/// Where the parts of Boolean solids are, model axes, seen from this frame's eye.
#[derive(Clone, Copy)]
pub(crate) struct Centres<'a> {
    pub leaves: &'a Buffer,
    pub surfaces: &'a Texels,
}

/// The plane at which rays begin.
#[derive(Clone, Copy)]
pub(crate) struct Near {
    /// Along the view axis.
    pub depth: f32,
    /// It may be within the Boolean solids.
    pub may_cut: bool,
}

/// What the passes of Boolean solids work on.
pub(super) struct SolidParts<'a> {
    passes: &'a SolidPasses,
    pub(super) scene: &'a Solids,
    pub(super) buffers: &'a SolidBuffers,
    pub(super) centres: Centres<'a>,
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

        if let (Some(passes), Some(tiles)) = (&p.tiles, &t.tiles) {
            self.blocks(cmd, parts, passes, tiles);
        }
        for band in self.bands(parts) {
            self.solid_lists(cmd, parts, &band);
            self.solid_band(cmd, parts, &band);
        }
        if let Some(uv) = &t.operand_uv {
            barrier::images(cmd, &[(uv, Access::COLOUR_WRITE, Access::FRAGMENT_READ)]);
        }
    }

    /// What rays through a band's pixels may meet.
    pub(super) fn solid_lists(&self, cmd: &Commands<'_>, parts: &SolidParts<'_>, band: &Band) {
        let (p, s, t) = (parts.passes, parts.scene, parts.buffers);
        self.begin_band(cmd, parts, band);
        if let (Some(passes), Some(tiles)) = (&p.tiles, &t.tiles) {
            self.tiles(cmd, parts, passes, tiles, band);
        }
        if let (Some(passes), Some(shells), Some(f)) = (&p.shells, &s.shells, &t.fragments) {
            self.operands(cmd, parts, (passes, shells), f, band);
        }
    }

    /// The faces that a band's pixels see.
    fn solid_band(&self, cmd: &Commands<'_>, parts: &SolidParts<'_>, band: &Band) {
        let (p, s, t) = (parts.passes, parts.scene, parts.buffers);
        let w = WRITE_TO_READ.0;
        let b = self.buffers;
        let seen = b.others.as_ref().unwrap_or(&b.visibility);
        // meshes came before
        let drawn = self.scene.meshes.is_some();
        let colour = Attachment { image: seen, load: if drawn { Load::Keep } else { Load::ColourU32([0; 4]) } };
        let depth = Attachment { image: &b.depth, load: if drawn { Load::Keep } else { Load::Depth(0.0) } };
        match (&p.way, &s.order, &t.tiles) {
            (Way::Blister(pass), ..) => self.blister(cmd, parts, pass, (colour, depth)),
            (Way::Cst(cst), Some((order, drawn)), Some(t)) => {
                let cst_bindings = solid_cst::Bindings {
                    frame: self.constants,
                    primitives: s.primitives(parts.centres.surfaces),
                    tile_starts: &t.tile_starts,
                    tile_leaves: &t.tile_leaves,
                    tile_entries: &t.tile_entries,
                    rects: &parts.buffers.rects,
                    order,
                    counters: &b.counters,
                };
                barrier::buffers(cmd, &[(&b.counters, w, Access::FRAGMENT_WRITE)]);
                cst.record(cmd, &cst_bindings, (colour, depth), *drawn);
                barrier::buffers(cmd, &[(&b.counters, Access::FRAGMENT_WRITE, w)]);
            }
            (Way::Events(events), _, Some(tiles)) => {
                let bindings = solid_events::Bindings {
                    frame: self.constants,
                    primitives: s.primitives(parts.centres.surfaces),
                    tile_starts: &tiles.tile_starts,
                    tile_leaves: &tiles.tile_leaves,
                    tile_entries: &tiles.tile_entries,
                    fragments: t.fragments.as_ref().map(|f| solid_events::Fragments {
                        starts: &f.starts,
                        counts: &f.counts,
                        all: &f.all,
                    }),
                    counters: &b.counters,
                    tile_squares: &tiles.tile_squares,
                    halts: t.halts.as_ref(),
                };
                barrier::buffers(cmd, &[(&b.counters, w, Access::FRAGMENT_WRITE)]);
                let uv = t.operand_uv.as_ref().map(|image| Attachment { image, load: Load::Discard });
                self.legs(cmd, events, &bindings, (colour, uv, depth), band);
                barrier::buffers(cmd, &[(&b.counters, Access::FRAGMENT_WRITE, w)]);
            }
            (Way::Cst(_), None, _) | (_, _, None) => {
                unreachable!("these ways have tiles, and the pass is made of the order")
            }
        }
        barrier::images(
            cmd,
            &[(seen, Access::COLOUR_WRITE, Access::COLOUR_WRITE), (&b.depth, Access::DEPTH_WRITE, Access::DEPTH_WRITE)],
        );
    }
}

impl Frame<'_> {
    /// The rays of a band's pixels, from event to event; again and again from where they came to, where a driver ends long
    /// loops.
    fn legs(
        &self,
        cmd: &Commands<'_>,
        pass: &solid_events::SolidEvents,
        bindings: &solid_events::Bindings<'_>,
        (colour, uv, depth): (Attachment<'_>, Option<Attachment<'_>>, Attachment<'_>),
        band: &Band,
    ) {
        let of = self.legs;
        let drawn = [(colour.image, Access::COLOUR_WRITE), (depth.image, Access::DEPTH_WRITE)];
        let drawn = drawn.into_iter().chain(uv.map(|uv| (uv.image, Access::COLOUR_WRITE)));
        let drawn: Vec<_> = drawn.map(|(image, access)| (image, access, access)).collect();
        let kept = (
            Attachment { load: Load::Keep, ..colour },
            uv.map(|uv| Attachment { load: Load::Keep, ..uv }),
            Attachment { load: Load::Keep, ..depth },
        );
        for nth in 0..of {
            if let Some(halts) = bindings.halts {
                // by the leg before, of this band or another, or of another sample
                barrier::buffers(cmd, &[(halts, Access::FRAGMENT_WRITE, Access::FRAGMENT_WRITE)]);
            }
            if nth > 0 {
                barrier::buffers(cmd, &[(bindings.counters, Access::FRAGMENT_WRITE, Access::FRAGMENT_WRITE)]);
                barrier::images(cmd, &drawn);
            }
            let leg = solid_events::Leg { nth, of, is_most: self.legs_are_most };
            let targets = if nth == 0 { (colour, uv, depth) } else { kept };
            pass.record(cmd, bindings, targets, (band.rows.clone(), self.tiles_of(band)), leg);
        }
    }

    /// Which leaves each block of tiles sees.
    fn blocks(&self, cmd: &Commands<'_>, parts: &SolidParts<'_>, p: &TilePasses, t: &TileBuffers) {
        let (w, r) = WRITE_TO_READ;
        let blocks = solid_blocks::Bindings {
            frame: self.constants,
            rects: &parts.buffers.rects,
            counts: &t.block_counts,
            starts: &t.block_starts,
            leaves: &t.block_leaves,
        };
        p.blocks.count(cmd, &blocks, t.runs);
        barrier::buffers(cmd, &[(&t.block_counts, w, r), (&t.block_starts, r, w)]);
        self.scan(cmd, &t.block_counts, &t.block_starts, t.runs);
        barrier::buffers(cmd, &[(&t.block_starts, w, r), (&t.block_counts, r, w)]);
        p.blocks.list(cmd, &blocks, t.runs);
        barrier::buffers(cmd, &[(&t.block_leaves, w, r)]);
    }

    /// Which leaves each tile of a band sees, and their Blist.
    fn tiles(&self, cmd: &Commands<'_>, parts: &SolidParts<'_>, p: &TilePasses, t: &TileBuffers, band: &Band) {
        let (w, r) = WRITE_TO_READ;
        let count = self.tiles_of(band).len() as u32;
        let tiles = solid_tiles::Bindings {
            frame: self.constants,
            rects: &parts.buffers.rects,
            block_starts: &t.block_starts,
            block_leaves: &t.block_leaves,
            counts: &t.tile_counts,
            starts: &t.tile_starts,
            leaves: &t.tile_leaves,
            counters: &self.buffers.counters,
        };
        barrier::buffers(cmd, &[(&self.buffers.counters, Access::COMPUTE_WRITE | Access::INDIRECT_READ, w)]);
        p.tiles.count(cmd, &tiles, count);
        barrier::buffers(cmd, &[(&t.tile_counts, w, r), (&t.tile_starts, r, w), (&self.buffers.counters, w, w)]);
        self.scan(cmd, &t.tile_counts, &t.tile_starts, count);
        barrier::buffers(cmd, &[(&t.tile_starts, w, r), (&t.tile_counts, r, w)]);
        p.tiles.list(cmd, &tiles, count);
        barrier::buffers(cmd, &[(&t.tile_leaves, w, w), (&self.buffers.counters, w, w)]);

        let fold = solid_fold::Bindings {
            frame: self.constants,
            leaves: &parts.scene.leaves,
            tile_starts: &t.tile_starts,
            tile_leaves: &t.tile_leaves,
            tile_entries: &t.tile_entries,
            counters: &self.buffers.counters,
        };
        p.fold.record(cmd, &fold, count);
        barrier::buffers(
            cmd,
            &[(&self.buffers.counters, w, w), (&t.tile_entries, w, r), (&t.tile_squares, Access::VERTEX_READ, w)],
        );
        let squares = solid_squares::Bindings {
            frame: self.constants,
            tile_entries: &t.tile_entries,
            tile_squares: &t.tile_squares,
        };
        p.squares.record(cmd, &squares, count);
        barrier::buffers(
            cmd,
            &[
                (&t.tile_squares, w, Access::VERTEX_READ),
                (&t.tile_starts, w, Access::FRAGMENT_READ),
                (&t.tile_leaves, w, Access::FRAGMENT_READ),
                (&t.tile_entries, w, Access::FRAGMENT_READ),
            ],
        );
    }

    /// The fragments of operands without equations, in a band: counted, stored, put in order.
    fn operands(
        &self,
        cmd: &Commands<'_>,
        parts: &SolidParts<'_>,
        (passes, shells): (&ShellPasses, &Shells),
        f: &FragmentBuffers,
        band: &Band,
    ) {
        let (s, b) = (self.scene, self.buffers);
        let size = b.visibility.size();
        let rows = || band.rows.clone();
        let trim = self.trim().map_or_else(Vec::new, |parts| parts.test());
        let meshes = operand_mesh::Bindings {
            frame: self.constants,
            views: self.views,
            meshes: &shells.meshes,
            triangles: &shells.triangles,
            positions: &shells.positions,
            planes: &shells.planes,
            surfaces: &parts.scene.surfaces,
            surface_places: parts.centres.surfaces,
            counts: &f.counts,
            starts: &f.starts,
            fragments: &f.all,
        };
        let patches = operand_patch::Bindings {
            frame: self.constants,
            placed: s.placed(self.views),
            factors: &b.factors,
            sub_patches: &b.sub_patches,
            instances: &s.instances,
            counts: &f.counts,
            starts: &f.starts,
            fragments: &f.all,
            trim: &trim,
            links: s.links.as_ref(),
            draws: &b.draws,
            counters: &b.counters,
        };
        let rastered = |fills: bool| {
            if let Some(pass) = &passes.meshes {
                pass.record(cmd, &meshes, (size, rows()), &shells.draws, fills);
            }
            if let Some(pass) = &passes.patches {
                pass.record(cmd, &patches, (size, rows()), b.capacities.draws, fills);
            }
        };
        let (w, r) = WRITE_TO_READ;
        let drawn = Access::FRAGMENT_WRITE;
        // by the drawing before, of another band or another sample
        let followed = Access::FRAGMENT_READ | r;
        barrier::buffers(
            cmd,
            &[
                (&f.counts, Access::TRANSFER_WRITE, drawn),
                (&f.all, followed, drawn),
                (&b.counters, w, Access::INDIRECT_READ),
            ],
        );
        rastered(false);
        barrier::buffers(cmd, &[(&f.counts, drawn, r), (&f.starts, followed, w), (&f.all, drawn, drawn)]);
        self.scan(cmd, &f.counts, &f.starts, size.0 * rows().len() as u32);
        barrier::buffers(cmd, &[(&f.counts, r, drawn), (&f.starts, w, Access::FRAGMENT_READ | r)]);
        rastered(true);
        barrier::buffers(cmd, &[(&f.counts, drawn, w), (&f.all, drawn, w), (&b.counters, Access::INDIRECT_READ, w)]);
        let sort = operand_sort::Bindings {
            frame: self.constants,
            leaves: &parts.scene.leaves,
            leaf_centres: parts.centres.leaves,
            shell_leaves: &shells.leaves,
            starts: &f.starts,
            counts: &f.counts,
            fragments: &f.all,
            counters: &b.counters,
        };
        let [columns, seen] = self.shell_pixels.clone();
        let first = (seen.start / TILE * TILE).max(band.rows.start);
        let part = first - band.rows.start..seen.end.min(band.rows.end).max(first) - band.rows.start;
        passes.sort.record(cmd, &sort, columns, part);
        barrier::buffers(
            cmd,
            &[(&f.counts, w, Access::FRAGMENT_READ), (&f.all, w, Access::FRAGMENT_READ), (&b.counters, w, w)],
        );
    }
}

impl<'a> SolidParts<'a> {
    /// What rays are followed through.
    pub(super) fn followed(&self) -> (&'a Solids, &'a SolidBuffers, Centres<'a>) {
        (self.scene, self.buffers, self.centres)
    }

    /// What pass `resolve` needs of them.
    pub(super) fn resolve(&self, frame: &Frame<'a>) -> resolve::SolidBindings<'a> {
        let b = frame.buffers;
        resolve::SolidBindings {
            frame: frame.constants,
            primitives: self.scene.primitives(self.centres.surfaces),
            visibility: &b.visibility,
            others: b.others.as_ref().unwrap_or(&b.visibility),
            operand_uv: self.buffers.operand_uv.as_ref(),
            shells: self.scene.shells.as_ref().map(|m| resolve::ShellBindings {
                instances: &frame.scene.instances,
                meshes: &m.meshes,
                triangles: &m.triangles,
                positions: &m.positions,
                planes: &m.planes,
                views: frame.views,
            }),
            tiles: self.buffers.tiles.as_ref().map(|t| (t.tiles, &t.tile_squares)),
        }
    }
}
