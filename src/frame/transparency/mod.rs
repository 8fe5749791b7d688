//! Transparent solids and highlights, and lengths within solids.
//!
//! ```text
//!   resolve ──▶ behind ─┐
//!   tiles, fragments ───┴─solid_layers─▶ the host's colour, or the sum of samples
//!                                     ─▶ the images of the first layer, over those of resolve; the host's depth
//!                                     ─▶ thickness
//! ```

pub(crate) mod solid_layers;

use super::antialiasing::average;
use super::common::layer_faces::Faces;
use super::common::room::{DRAWN_AND_READ, Room};
use super::shading::resolve;
use super::solids::SolidParts;
use super::solids::bands::Band;
use super::{Frame, WRITE_TO_READ};
use crate::gpu::{Access, Attachment, Commands, Device, GpuError, Image, Load, barrier};
use crate::picture::Samples;
use crate::scene::SceneData;
use solid_layers::{Bindings, For, Kinds, SolidLayers};
use std::sync::Arc;

/// The passes of scenes whose rays are followed through solids.
pub(crate) struct Passes {
    /// For the host's colour, or for each of a pixel's samples.
    colour: Option<SolidLayers>,
    first: Option<SolidLayers>,
    thickness: Option<SolidLayers>,
}

/// The images that one drawing needs.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Drawing {
    /// All of them: the only drawing.
    Whole,
    /// The colour of one sample.
    Sample,
    /// All images but the colour, which samples make.
    Beside,
}

/// `surfaces`: the most general kind of the solids' surfaces, `abi::SURFACE_*`.
pub(super) fn kinds(data: &SceneData, surfaces: u32) -> Kinds {
    Kinds {
        surfaces,
        boundary_operands: !data.solids.operand_leaves.is_empty(),
        patches: data.has_operands,
        rational: data.has_rational,
        pieces: data.has_pieces,
        fine: data.has_fine,
        marks: data.highlight.map(|h| [h.contact, h.overlap]),
        sun: data.sun.is_some(),
    }
}

impl Passes {
    /// `None` if no rays are followed.
    pub(super) fn new(device: &Device, data: &SceneData, formats: resolve::Formats) -> Result<Option<Self>, GpuError> {
        let Some(surfaces) = data.solids.kinds().filter(|_| data.solids.is_followed()) else { return Ok(None) };
        let kinds = kinds(data, surfaces);
        let make = |purpose| SolidLayers::new(device, purpose, formats.depth, kinds);
        let colour = match data.samples {
            Samples::One => For::Colour(formats.colour),
            Samples::Four | Samples::Eight => For::Sample(average::SUM_FORMAT),
        };
        let aovs: &[_] = if formats.has_aovs() { &resolve::AOV_FORMATS } else { &[] };
        let first = For::First { colour: formats.colour, aovs };
        let beside = formats.has_aovs() || formats.depth.is_some();
        Ok(Some(Self {
            colour: data.is_layered.then(|| make(colour)).transpose()?,
            first: (data.is_layered && beside).then(|| make(first)).transpose()?,
            thickness: data.thickness.then(|| make(For::Thickness)).transpose()?,
        }))
    }
}

/// The stage.
pub(crate) struct Transparency {
    passes: Arc<Passes>,
    /// The surfaces behind layers: linear colour and depth.
    pub behind: Image,
}

impl Transparency {
    pub(super) fn new(room: &Room<'_>, passes: &Arc<Passes>) -> Result<Self, GpuError> {
        let behind = room.image("behind layers", resolve::BEHIND_FORMAT, DRAWN_AND_READ)?;
        Ok(Self { passes: Arc::clone(passes), behind })
    }

    /// The image that pass `resolve` draws into if layers are drawn over it.
    pub(super) fn behind_layers(&self) -> Option<&Image> {
        self.passes.colour.as_ref().map(|_| &self.behind)
    }

    /// Draws layers over the colours behind them, and lengths within solids. `written`: the last write to those
    /// colours. If the lists are those of one band, they are made again.
    pub(super) fn record(
        &self,
        frame: &Frame<'_>,
        cmd: &Commands<'_>,
        solids: &SolidParts<'_>,
        drawing: Drawing,
        written: Access,
    ) {
        barrier::images(cmd, &[(&self.behind, written, Access::FRAGMENT_READ)]);
        let mut counted_again = false;
        for band in frame.bands() {
            if !band.is_whole {
                if !std::mem::replace(&mut counted_again, true) {
                    frame.count_bands_again(cmd);
                }
                solids.lists(frame, cmd, &band);
            }
            self.band(frame, cmd, (solids, drawing), &band);
        }
    }

    /// What following a ray through solids reads; `None` without the lists of tiles that it needs.
    fn bindings<'b>(&'b self, frame: &'b Frame<'_>, solids: &'b SolidParts<'_>) -> Option<Bindings<'b>> {
        let (c, s) = (&frame.stages.common, frame.scene);
        let tiles = solids.stage.tiles()?;
        Some(Bindings {
            frame: frame.constants,
            primitives: solids.scene.primitives(solids.centres.surfaces),
            leaf_centres: solids.centres.leaves,
            tile_starts: &tiles.tile_starts,
            tile_leaves: &tiles.tile_leaves,
            fragments: solids.stage.fragments().map(|f| (&f.starts, &f.counts, &f.all)),
            counters: &c.counters,
            behind: &self.behind,
            views: frame.views,
            face_instances: &s.face_instances,
            faces: &s.faces,
            patches: &s.patches,
            patch_instances: &s.patch_instances,
            points: &s.points,
            instances: &s.instances,
            sun: frame.sun_bindings(),
            boundary_operands: solids
                .scene
                .boundary_operands
                .as_ref()
                .map(|m| [&m.meshes, &m.triangles, &m.positions, &m.planes]),
        })
    }

    /// Draws faces whose lines are drawn into a band's rows of `target`. The lists are the band's.
    pub(super) fn faces(
        &self,
        frame: &Frame<'_>,
        cmd: &Commands<'_>,
        (pass, faces, solids): (&SolidLayers, Faces, &SolidParts<'_>),
        (target, band): (Attachment<'_>, &Band),
    ) {
        let Some(bindings) = self.bindings(frame, solids) else { return };
        let w = WRITE_TO_READ.0;
        cmd.after(w | Access::INDIRECT_READ, Access::FRAGMENT_WRITE);
        pass.record_faces(cmd, &bindings, (faces, target), band.rows.clone());
        cmd.after(Access::FRAGMENT_WRITE, w | Access::INDIRECT_READ);
    }

    fn band(&self, frame: &Frame<'_>, cmd: &Commands<'_>, (solids, drawing): (&SolidParts<'_>, Drawing), band: &Band) {
        let passes = &self.passes;
        let Some(bindings) = self.bindings(frame, solids) else { return };
        let w = WRITE_TO_READ.0;
        let rows = || band.rows.clone();
        cmd.after(w | Access::INDIRECT_READ, Access::FRAGMENT_WRITE);
        let depth = frame.depth.as_ref().map(Attachment::again);
        if let Some(pass) = passes.colour.as_ref().filter(|_| drawing != Drawing::Beside) {
            drawn_again(frame, cmd);
            // colours are blended over the target
            let load = match frame.colour[0].load {
                Load::Discard => Load::ColourF32([0.0; 4]),
                load => load,
            };
            pass.record(cmd, &bindings, &[Attachment { load, ..frame.colour[0] }], depth, rows());
        }
        if let Some(pass) = passes.first.as_ref().filter(|_| drawing != Drawing::Sample) {
            drawn_again(frame, cmd);
            let all: Vec<_> = frame.colour.iter().map(Attachment::again).collect();
            pass.record(cmd, &bindings, &all, depth, rows());
        }
        if let (Some(pass), Some(target)) = (&passes.thickness, frame.thickness.filter(|_| drawing != Drawing::Sample))
        {
            barrier::images(cmd, &[(target.image, Access::COLOUR_WRITE, Access::COLOUR_WRITE)]);
            pass.record(cmd, &bindings, &[target], None, rows());
        }
        cmd.after(Access::FRAGMENT_WRITE, w | Access::INDIRECT_READ);
    }
}

/// A barrier before the targets are drawn into again.
fn drawn_again(frame: &Frame<'_>, cmd: &Commands<'_>) {
    let colour = frame.colour.iter().map(|a| (a.image, Access::COLOUR_WRITE, Access::COLOUR_WRITE));
    let depth = frame.depth.iter().map(|a| (a.image, Access::DEPTH_WRITE, Access::DEPTH_WRITE));
    barrier::images(cmd, &colour.chain(depth).collect::<Vec<_>>());
}

impl Frame<'_> {
    /// Clears the lengths within solids in a scene without solids.
    pub(super) fn no_thickness(&self, cmd: &Commands<'_>) {
        if let Some(target) = self.thickness.filter(|_| self.stages.transparency.is_none()) {
            cmd.rendering(target.image.size(), &[target], None, || {});
        }
    }
}
