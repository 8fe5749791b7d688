//! Boolean solids: the leaves that each tile may show, and the point where each pixel's ray enters a solid.
//!
//! ```text
//!   leaves ──solid_rects──▶ rects ──solid_blocks, solid_tiles (each: count, scan, list)──▶ leaves of each tile
//!          ──solid_fold──▶ their Blist ──solid_squares──▶ tiles that are drawn
//!          ──solid_events──▶ visibility of meshes and solids, depth
//!   operands ──operand_mesh, operand_patch (each: count, scan, fill)──▶ fragments of each pixel
//!            ──operand_sort──▶ in order ──▲
//!
//!   if the lists of tiles and pixels are too large, they are made and drawn band by band: bands.rs
//! ```

pub(crate) mod bands;
pub(crate) mod blister;
pub(crate) mod buffers;
mod capacities;
pub(crate) mod lists;
pub(crate) mod operand_mesh;
pub(crate) mod operand_patch;
pub(crate) mod operand_sort;
mod operands;
mod peel;
pub(crate) mod solid_blocks;
pub(crate) mod solid_cst;
pub(crate) mod solid_events;
pub(crate) mod solid_fold;
pub(crate) mod solid_rects;
pub(crate) mod solid_squares;
pub(crate) mod solid_tiles;
mod tiles;

pub(crate) use capacities::Capacities;

use super::common::room::{DRAWN_AND_READ, Room};
use super::shading::resolve;
use super::visibility::patches::{DEPTH_FORMAT, VISIBILITY_FORMAT};
use super::{Frame, WRITE_TO_READ};
use crate::abi::Rect;
use crate::gpu::{Access, Attachment, Buffer, Commands, Device, GpuError, Image, Load, TexelBuffer, barrier};
use crate::scene::{self, SceneData};
use crate::shaders::TrimTest;
use bands::Band;
use blister::Blister;
use buffers::{FragmentBuffers, LayerImages};
use operands::{OperandPasses, Operands};
use std::sync::Arc;
use tiles::{TilePasses, Tiles};

/// The passes.
pub(crate) struct Passes {
    rects: Arc<solid_rects::SolidRects>,
    way: WayPasses,
    operands: Option<Arc<OperandPasses>>,
}

/// The passes of the way that finds the faces, and the passes that list each tile's leaves.
enum WayPasses {
    Events(Arc<solid_events::SolidEvents>, Arc<TilePasses>),
    Cst(Arc<solid_cst::SolidCst>, Arc<TilePasses>),
    /// Way `blister`; without tiles if it peels meshes.
    Blister(Arc<Blister>, Option<Arc<TilePasses>>),
}

/// Whether there are lists of each tile's leaves: not for way `blister` with meshes.
pub(super) fn has_tiles(data: &SceneData) -> bool {
    data.solids.blister.is_none() || data.solids.operand_leaves.is_empty()
}

impl Passes {
    /// `None` in scenes without Boolean solids.
    pub(super) fn new(device: &Device, data: &SceneData, trim: Option<&TrimTest>) -> Result<Option<Self>, GpuError> {
        let Some(surfaces) = data.solids.kinds() else { return Ok(None) };
        let boundary_operands = !data.solids.operand_leaves.is_empty();
        let peels = data.solids.blister.is_some();
        let formats = (VISIBILITY_FORMAT, DEPTH_FORMAT);
        let tiles = || TilePasses::new(device).map(Arc::new);
        let way = || {
            Ok(if peels {
                let pass = Blister::new(device, (surfaces, boundary_operands), formats.0, formats.1)?;
                WayPasses::Blister(Arc::new(pass), has_tiles(data).then(tiles).transpose()?)
            } else if data.solids.order.is_empty() {
                let followed = data.solids.is_followed();
                let kinds = solid_events::Kinds { surfaces, boundary_operands, patches: data.has_operands, followed };
                let pass = solid_events::SolidEvents::new(device, kinds, formats.0, formats.1)?;
                WayPasses::Events(Arc::new(pass), tiles()?)
            } else {
                let pass = solid_cst::SolidCst::new(device, surfaces, formats.0, formats.1)?;
                WayPasses::Cst(Arc::new(pass), tiles()?)
            })
        };
        let lists = || {
            let operands = (boundary_operands && !peels).then(|| OperandPasses::new(device, data, trim)).transpose()?;
            Ok((solid_rects::SolidRects::new(device)?, operands))
        };
        let (way, lists) = rayon::join(way, lists);
        let (rects, operands) = lists?;
        Ok(Some(Self { rects: Arc::new(rects), way: way?, operands: operands.map(Arc::new) }))
    }
}

/// The stage.
pub(crate) struct Solids {
    rects: Arc<solid_rects::SolidRects>,
    rect_buffer: Buffer,
    /// Rows of tiles in a band.
    band_rows: u32,
    way: Way,
    operands: Option<Operands>,
    /// (u, v) of spline faces of operands.
    operand_uv: Option<Image>,
    /// The point where each ray resumes, one word a pixel of a band; only if rays need several segments.
    resume_points: Option<Buffer>,
}

/// The buffers of the way that finds the faces, and the lists of each tile's leaves.
enum Way {
    Events(Arc<solid_events::SolidEvents>, Box<Tiles>),
    Cst(Arc<solid_cst::SolidCst>, Box<Tiles>),
    Blister(Arc<Blister>, Box<LayerImages>, Option<Box<Tiles>>),
}

impl Solids {
    pub(super) fn new(room: &Room<'_>, passes: &Passes) -> Result<Self, GpuError> {
        let counts = room.counts;
        let tiles = |passes| Tiles::new(room, passes).map(Box::new);
        let uv = || room.image("operand (u, v)", solid_events::OPERAND_UV_FORMAT, DRAWN_AND_READ);
        let operands = |passes: &Arc<OperandPasses>| Operands::new(room, passes);
        Ok(Self {
            rects: Arc::clone(&passes.rects),
            rect_buffer: room.structs::<Rect>("solid rects", counts.leaves)?,
            band_rows: room.band_rows(),
            way: match &passes.way {
                WayPasses::Events(pass, lists) => Way::Events(Arc::clone(pass), tiles(lists)?),
                WayPasses::Cst(pass, lists) => Way::Cst(Arc::clone(pass), tiles(lists)?),
                WayPasses::Blister(pass, lists) => {
                    let layers = Box::new(LayerImages::new(room)?);
                    Way::Blister(Arc::clone(pass), layers, lists.as_ref().map(tiles).transpose()?)
                }
            },
            operands: passes.operands.as_ref().map(operands).transpose()?,
            operand_uv: (counts.operand_patches && counts.has_fragments()).then(uv).transpose()?,
            resume_points: (room.capacities.solids.ray_segments > 1)
                .then(|| room.words("solid resume points", room.band_pixels()))
                .transpose()?,
        })
    }

    /// The lists of leaves for a band's tiles; `None` for way `blister` with meshes.
    pub(super) fn tiles(&self) -> Option<&Tiles> {
        match &self.way {
            Way::Events(_, tiles) | Way::Cst(_, tiles) => Some(tiles),
            Way::Blister(_, _, tiles) => tiles.as_deref(),
        }
    }

    /// The crossings of rays with operands without equations.
    pub(super) fn fragments(&self) -> Option<&FragmentBuffers> {
        self.operands.as_ref().map(|operands| &operands.fragments)
    }

    /// Before each drawing: clears the counters, and discards the images' contents.
    pub(super) fn begin(&self, cmd: &Commands<'_>) {
        if let Some(f) = self.fragments() {
            cmd.fill(&f.counts, 0);
        }
        if let Some(uv) = &self.operand_uv {
            let read = (Access::COMPUTE_READ | Access::FRAGMENT_READ).discarded();
            barrier::images(cmd, &[(uv, read, Access::COLOUR_WRITE)]);
        }
    }
}

/// Places of surfaces and leaves, in model axes relative to this frame's eye.
#[derive(Clone, Copy)]
pub(crate) struct Centres<'a> {
    pub leaves: &'a Buffer,
    pub surfaces: &'a TexelBuffer,
}

/// The plane at which rays start.
#[derive(Clone, Copy)]
pub(crate) struct Near {
    /// Distance along the view axis.
    pub depth: f32,
    /// Whether the plane may be inside the Boolean solids.
    pub may_cut: bool,
}

/// The stage, and a frame's inputs to it.
pub(super) struct SolidParts<'a> {
    pub(super) stage: &'a Solids,
    pub(super) scene: &'a scene::Solids,
    pub(super) centres: Centres<'a>,
}

impl<'a> Frame<'a> {
    /// `None` in scenes without Boolean solids.
    pub(super) fn solids(&self) -> Option<SolidParts<'a>> {
        Some(SolidParts {
            stage: self.stages.solids.as_ref()?,
            scene: self.scene.solids.as_ref()?,
            centres: self.centres?,
        })
    }
}

impl<'a> SolidParts<'a> {
    /// Makes the lists of leaves, then draws the pixels.
    pub(super) fn record(&self, frame: &Frame<'_>, cmd: &Commands<'_>) {
        let (stage, s) = (self.stage, self.scene);
        let (w, r) = WRITE_TO_READ;
        let rects = solid_rects::Bindings {
            frame: frame.constants,
            leaves: &s.leaves,
            centres: self.centres.leaves,
            rects: &stage.rect_buffer,
        };
        stage.rects.record(cmd, &rects, frame.counts.leaves);
        cmd.after(w, r | Access::VERTEX_READ);

        if let Some(tiles) = stage.tiles() {
            tiles.blocks(frame, cmd, self);
        }
        for band in frame.bands() {
            self.lists(frame, cmd, &band);
            self.band(frame, cmd, &band);
        }
        if let Some(uv) = &stage.operand_uv {
            barrier::images(cmd, &[(uv, Access::COLOUR_WRITE, Access::COMPUTE_READ | Access::FRAGMENT_READ)]);
        }
    }

    /// Makes the lists of everything that rays through a band's pixels may meet.
    pub(super) fn lists(&self, frame: &Frame<'_>, cmd: &Commands<'_>, band: &Band) {
        frame.begin_band(cmd, self.stage, band);
        if let Some(tiles) = self.stage.tiles() {
            tiles.record(frame, cmd, self, band);
        }
        if let (Some(operands), Some(boundary_operands)) = (&self.stage.operands, &self.scene.boundary_operands) {
            operands.record(frame, cmd, (self, boundary_operands), band);
        }
    }

    /// Draws the faces that a band's pixels show.
    fn band(&self, frame: &Frame<'_>, cmd: &Commands<'_>, band: &Band) {
        let (stage, s) = (self.stage, self.scene);
        let w = WRITE_TO_READ.0;
        let (v, counters) = (&frame.stages.visibility, &frame.stages.common.counters);
        let seen = v.of_meshes_and_solids();
        // meshes are drawn before
        let drawn = frame.scene.meshes.is_some();
        let colour = Attachment { image: seen, load: if drawn { Load::Keep } else { Load::ColourU32([0; 4]) } };
        let depth = Attachment { image: &v.depth, load: if drawn { Load::Keep } else { Load::Depth(0.0) } };
        match &stage.way {
            Way::Blister(pass, images, _) => self.peel(frame, cmd, (pass, images), (colour, depth)),
            Way::Cst(pass, tiles) => {
                let Some((order, drawn)) = &s.order else { return };
                let bindings = solid_cst::Bindings {
                    frame: frame.constants,
                    primitives: s.primitives(self.centres.surfaces),
                    tile_starts: &tiles.tile_starts,
                    tile_leaves: &tiles.tile_leaves,
                    tile_entries: &tiles.tile_entries,
                    rects: &stage.rect_buffer,
                    order,
                    counters,
                };
                cmd.after(w, Access::FRAGMENT_WRITE);
                pass.record(cmd, &bindings, (colour, depth), *drawn);
                cmd.after(Access::FRAGMENT_WRITE, w);
            }
            Way::Events(pass, tiles) => {
                let bindings = solid_events::Bindings {
                    frame: frame.constants,
                    primitives: s.primitives(self.centres.surfaces),
                    tile_starts: &tiles.tile_starts,
                    tile_leaves: &tiles.tile_leaves,
                    tile_entries: &tiles.tile_entries,
                    fragments: stage.fragments().map(|f| solid_events::Fragments {
                        starts: &f.starts,
                        counts: &f.counts,
                        all: &f.all,
                    }),
                    counters,
                    tile_squares: &tiles.tile_squares,
                    resume_points: stage.resume_points.as_ref(),
                };
                cmd.after(w, Access::FRAGMENT_WRITE);
                let uv = stage.operand_uv.as_ref().map(|image| Attachment { image, load: Load::Discard });
                ray_segments(frame, cmd, (pass, &bindings), (colour, uv, depth), band);
                cmd.after(Access::FRAGMENT_WRITE, w);
            }
        }
        v.drawn_again(cmd, seen);
    }

    /// The resources of pass `resolve`.
    pub(super) fn resolve(&self, frame: &Frame<'a>) -> resolve::SolidBindings<'a> {
        let v = &frame.stages.visibility;
        resolve::SolidBindings {
            frame: frame.constants,
            primitives: self.scene.primitives(self.centres.surfaces),
            visibility: &v.image,
            meshes_and_solids: v.of_meshes_and_solids(),
            operand_uv: self.stage.operand_uv.as_ref(),
            boundary_operands: self.scene.boundary_operands.as_ref().map(|m| resolve::OperandBindings {
                instances: &frame.scene.instances,
                meshes: &m.meshes,
                triangles: &m.triangles,
                positions: &m.positions,
                planes: &m.planes,
                views: frame.views,
            }),
            tiles: self.stage.tiles().map(|t| (t.tiles, &t.tile_squares)),
        }
    }
}

/// Follows the rays of a band's pixels from event to event. If a driver ends long loops, it draws several times, and
/// each time the rays resume where they stopped.
fn ray_segments(
    frame: &Frame<'_>,
    cmd: &Commands<'_>,
    (pass, bindings): (&solid_events::SolidEvents, &solid_events::Bindings<'_>),
    (colour, uv, depth): (Attachment<'_>, Option<Attachment<'_>>, Attachment<'_>),
    band: &Band,
) {
    let of = frame.capacities.solids.ray_segments;
    let drawn = [(colour.image, Access::COLOUR_WRITE), (depth.image, Access::DEPTH_WRITE)];
    let drawn = drawn.into_iter().chain(uv.map(|uv| (uv.image, Access::COLOUR_WRITE)));
    let drawn: Vec<_> = drawn.map(|(image, access)| (image, access, access)).collect();
    let kept = (
        Attachment { load: Load::Keep, ..colour },
        uv.map(|uv| Attachment { load: Load::Keep, ..uv }),
        Attachment { load: Load::Keep, ..depth },
    );
    for nth in 0..of {
        if bindings.resume_points.is_some() {
            // writes by the segment before, of this band, another band or another sample
            cmd.after(Access::FRAGMENT_WRITE, Access::FRAGMENT_WRITE);
        }
        if nth > 0 {
            cmd.after(Access::FRAGMENT_WRITE, Access::FRAGMENT_WRITE);
            barrier::images(cmd, &drawn);
        }
        let segment = solid_events::RaySegment { nth, of, is_most: of >= capacities::MOST_RAY_SEGMENTS };
        let targets = if nth == 0 { (colour, uv, depth) } else { kept };
        pass.record(cmd, bindings, targets, (band.rows.clone(), frame.tiles_of(band)), segment);
    }
}
