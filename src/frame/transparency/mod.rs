//! The frame's part for what is seen through, and for lengths within solids.
//!
//! ```text
//!   resolve ──▶ behind ─┐
//!   tiles, fragments ───┴─solid_layers─▶ the host's colour, or the sum of samples
//!                                     ─▶ the images of the first layer, over those of resolve; the host's depth
//!                                     ─▶ thickness
//! ```

pub(crate) mod solid_layers;

use super::solids::bands::Band;
use super::{Frame, WRITE_TO_READ};
use crate::frame::antialiasing::average;
use crate::frame::shading::resolve;
use crate::frame::transparency::solid_layers::{Bindings, For, Kinds, SolidLayers};
use crate::gpu::{Access, Attachment, Commands, Device, GpuError, Load, barrier};
use crate::picture::Samples;
use crate::scene::SceneData;

/// The passes of scenes whose rays are followed through solids.
pub(super) struct LayerPasses {
    /// Into the host's colour, or each of a pixel's samples.
    colour: Option<SolidLayers>,
    first: Option<SolidLayers>,
    thickness: Option<SolidLayers>,
}

/// Which of them one drawing needs.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Drawing {
    /// The only one.
    Whole,
    /// One of a pixel's samples.
    Sample,
    /// What is no colour, beside samples.
    Beside,
}

impl LayerPasses {
    /// `None` when nothing is followed.
    pub(super) fn new(device: &Device, data: &SceneData, formats: resolve::Formats) -> Result<Option<Self>, GpuError> {
        let Some(surfaces) = data.solids.kinds().filter(|_| data.solids.is_followed()) else { return Ok(None) };
        let kinds = Kinds {
            surfaces,
            shells: !data.solids.shell_leaves.is_empty(),
            patches: data.has_operands,
            rational: data.has_rational,
            pieces: data.has_pieces,
            fine: data.has_fine,
            marks: data.highlight.map(|h| [h.contact, h.overlap]),
            sun: data.sun.is_some(),
        };
        let make = |purpose| SolidLayers::new(device, purpose, formats.depth, kinds);
        let colour = match data.samples {
            Samples::One => For::Colour(formats.colour),
            Samples::Four | Samples::Eight => For::Sample(average::SUM_FORMAT),
        };
        let aovs: &[_] = if formats.aovs { &resolve::AOV_FORMATS } else { &[] };
        let first = For::First { colour: formats.colour, aovs };
        let beside = formats.aovs || formats.depth.is_some();
        Ok(Some(Self {
            colour: data.is_layered.then(|| make(colour)).transpose()?,
            first: (data.is_layered && beside).then(|| make(first)).transpose()?,
            thickness: data.thickness.then(|| make(For::Thickness)).transpose()?,
        }))
    }

    /// Something is drawn in layers, so that pass `resolve` draws what lies behind them.
    pub(super) fn is_layered(&self) -> bool {
        self.colour.is_some()
    }
}

impl<'a> Frame<'a> {
    /// Layers over what pass `resolve` drew, and lengths within solids. Where lists are those of one band, they are
    /// made again.
    pub(super) fn layers(&self, cmd: &Commands<'_>, passes: &LayerPasses, drawing: Drawing) {
        let (Some(parts), Some(behind)) = (self.solids(), &self.buffers.behind) else {
            unreachable!("made with the passes")
        };
        barrier::images(cmd, &[(behind, Access::COLOUR_WRITE, Access::FRAGMENT_READ)]);
        let mut counted_again = false;
        for band in self.bands(&parts) {
            if !band.is_whole {
                if !std::mem::replace(&mut counted_again, true) {
                    self.count_bands_again(cmd);
                }
                self.solid_lists(cmd, &parts, &band);
            }
            self.layers_of(cmd, passes, drawing, &band);
        }
    }

    fn layers_of(&self, cmd: &Commands<'_>, passes: &LayerPasses, drawing: Drawing, band: &Band) {
        let (b, s) = (self.buffers, self.scene);
        let (Some(parts), Some(behind)) = (self.solids(), &b.behind) else { unreachable!("made with the passes") };
        let (solid, solids, centres) = parts.followed();
        let Some(tiles) = &solids.tiles else { unreachable!("made with the passes") };
        let bindings = Bindings {
            frame: self.constants,
            primitives: solid.primitives(centres.surfaces),
            leaf_centres: centres.leaves,
            tile_starts: &tiles.tile_starts,
            tile_leaves: &tiles.tile_leaves,
            fragments: solids.fragments.as_ref().map(|f| (&f.starts, &f.counts, &f.all)),
            counters: &b.counters,
            behind,
            views: self.views,
            face_instances: &s.face_instances,
            faces: &s.faces,
            patches: &s.patches,
            items: &s.items,
            points: &s.points,
            instances: &s.instances,
            sun: self.sun_bindings(),
            shells: solid.shells.as_ref().map(|m| [&m.meshes, &m.triangles, &m.positions, &m.planes]),
        };
        let (w, _) = WRITE_TO_READ;
        let rows = || band.rows.clone();
        barrier::buffers(cmd, &[(&b.counters, w | Access::INDIRECT_READ, Access::FRAGMENT_WRITE)]);
        let kept = |a: &Attachment<'a>| Attachment { load: Load::Keep, ..*a };
        let depth = self.depth.as_ref().map(kept);
        if let Some(pass) = passes.colour.as_ref().filter(|_| drawing != Drawing::Beside) {
            self.drawn_again(cmd);
            // colours are laid over what is there
            let load = match self.colour[0].load {
                Load::Discard => Load::ColourF32([0.0; 4]),
                load => load,
            };
            pass.record(cmd, &bindings, &[Attachment { load, ..self.colour[0] }], depth, rows());
        }
        if let Some(pass) = passes.first.as_ref().filter(|_| drawing != Drawing::Sample) {
            self.drawn_again(cmd);
            let all: Vec<_> = self.colour.iter().map(kept).collect();
            pass.record(cmd, &bindings, &all, depth, rows());
        }
        if let (Some(pass), Some(target)) = (&passes.thickness, self.thickness.filter(|_| drawing != Drawing::Sample)) {
            barrier::images(cmd, &[(target.image, Access::COLOUR_WRITE, Access::COLOUR_WRITE)]);
            pass.record(cmd, &bindings, &[target], None, rows());
        }
        barrier::buffers(cmd, &[(&b.counters, Access::FRAGMENT_WRITE, w | Access::INDIRECT_READ)]);
    }

    /// The targets are drawn into once more.
    fn drawn_again(&self, cmd: &Commands<'_>) {
        let colour = self.colour.iter().map(|a| (a.image, Access::COLOUR_WRITE, Access::COLOUR_WRITE));
        let depth = self.depth.iter().map(|a| (a.image, Access::DEPTH_WRITE, Access::DEPTH_WRITE));
        barrier::images(cmd, &colour.chain(depth).collect::<Vec<_>>());
    }

    /// No ray is within a solid where there is none.
    pub(super) fn no_thickness(&self, cmd: &Commands<'_>) {
        if let Some(target) = self.thickness.filter(|_| self.passes.layers.is_none()) {
            cmd.rendering(target.image.size(), &[target], None, || {});
        }
    }
}
