//! The frame's part for ways to trim that only benchmarks and tests use: see `src/baselines`.
//!
//! ```text
//!   cells ──density──▶ face speeds ──sizes──(scan)──▶ starts      textures only; the others have no pass
//!   curves ──flip──▶ bits ──fill──▶ texels, places
//! ```
//!
//! And for what trim tests cost, whatever the way: the frame's sub-patches drawn without one, into images that pass
//! `visibility` then clears.

pub(crate) mod slefe;
pub(crate) mod texture;

use super::antialiasing::samples::Scopes;
use super::{Frame, WRITE_TO_READ, WRITE_TO_WRITE};
use crate::frame::buffers::TextureBuffers;
use crate::frame::trim::density;
use crate::frame::visibility::patches;
use crate::gpu::{Access, Buffer, Commands, Device, GpuError, Resource, barrier};
use crate::picture::Rival;
use crate::scene::{RivalScene, SceneData, TableScene};
use crate::shaders::{TRIM_BISECT, TRIM_TEXTURE, TRIM_UNTRIMMED, TrimTest};

/// The passes of such a way.
pub(super) enum RivalPasses {
    Untrimmed,
    Bisect,
    Texture(Box<TexturePasses>),
}

/// The passes of trim textures.
pub(super) struct TexturePasses {
    density: density::Density,
    texture: texture::BaselineTexture,
}

impl RivalPasses {
    pub(super) fn new(device: &Device, rival: Rival) -> Result<Self, GpuError> {
        Ok(match rival {
            Rival::Untrimmed => Self::Untrimmed,
            Rival::Bisect { .. } => Self::Bisect,
            Rival::Texture { .. } => Self::Texture(Box::new(TexturePasses {
                density: density::Density::new(device, false)?,
                texture: texture::BaselineTexture::new(device)?,
            })),
        })
    }

    pub(super) fn test(&self) -> &'static TrimTest {
        match self {
            Self::Untrimmed => &TRIM_UNTRIMMED,
            Self::Bisect => &TRIM_BISECT,
            Self::Texture(_) => &TRIM_TEXTURE,
        }
    }
}

/// What such a way works on.
#[derive(Clone, Copy)]
pub(super) struct RivalParts<'a> {
    pub passes: &'a RivalPasses,
    pub scene: &'a RivalScene,
    pub buffers: Option<&'a TextureBuffers>,
}

/// What trim textures are made of and with.
pub(super) struct TextureParts<'a> {
    passes: &'a TexturePasses,
    scene: &'a TableScene,
    knob: &'a Buffer,
    buffers: &'a TextureBuffers,
}

impl<'a> RivalParts<'a> {
    /// What the test reads, in its order.
    pub(super) fn test(&self) -> Vec<Resource<'a>> {
        match (self.scene, self.buffers) {
            (RivalScene::Bisect(buffers), _) => buffers.iter().map(Resource::from).collect(),
            (RivalScene::Texture(..), Some(b)) => vec![Resource::from(&b.places), Resource::from(&b.texels)],
            _ => Vec::new(),
        }
    }

    pub(super) fn texture(self) -> Option<TextureParts<'a>> {
        match (self.passes, self.scene, self.buffers) {
            (RivalPasses::Texture(passes), RivalScene::Texture(scene, knob), Some(buffers)) => {
                Some(TextureParts { passes, scene, knob, buffers })
            }
            _ => None,
        }
    }
}

/// Pass `visibility` without a test; `None` where nobody asked for it, or there is none to leave out.
pub(super) fn untested(
    device: &Device,
    data: &SceneData,
    kinds: patches::Kinds<'_>,
) -> Result<Option<patches::Visibility>, GpuError> {
    let others = data.has_meshes() || data.solids.kinds().is_some() || kinds.volume.is_some();
    let kinds = patches::Kinds { trimmed: kinds.trimmed.map(|_| &TRIM_UNTRIMMED), ..kinds };
    let made = data.untested && !others && kinds.trimmed.is_some();
    made.then(|| patches::Visibility::new(device, kinds)).transpose()
}

impl Frame<'_> {
    /// Draws the patches without a test, where that is asked for.
    pub(super) fn untested(&self, cmd: &Commands<'_>, times: &mut Scopes<'_>) {
        let Some(pass) = &self.passes.untested else { return };
        times.scope(cmd, "visibility untested", || self.patches(cmd, pass, &[], false));
        let b = self.buffers;
        let (colour, depth) = (Access::COLOUR_WRITE, Access::DEPTH_WRITE);
        barrier::images(cmd, &[(&b.visibility, colour, colour), (&b.depth, depth, depth)]);
    }
}

impl TextureParts<'_> {
    /// Records the passes; what the trim test reads is then ready for it.
    pub(super) fn record(&self, frame: &Frame<'_>, cmd: &Commands<'_>) {
        let (s, b, t) = (frame.scene, frame.buffers, self.buffers);
        let (w, r) = WRITE_TO_READ;
        let (w1, w2) = WRITE_TO_WRITE;
        let cleared = (Access::TRANSFER_WRITE, Access::COMPUTE_WRITE);
        barrier::buffers(cmd, &t.cleared().map(|buffer| (buffer, cleared.0, cleared.1)));
        let density = density::Bindings {
            frame: frame.constants,
            views: frame.views,
            instances: &s.instances,
            face_instances: &s.face_instances,
            faces: &s.faces,
            cells: &self.scene.cells,
            cell_items: &self.scene.cell_items,
            strip_heights: &t.strip_heights,
            face_speeds: &t.face_speeds,
            seen_bays: None,
        };
        self.passes.density.record(cmd, &density, b.counts.cells);
        barrier::buffers(cmd, &[(&t.face_speeds, w, r), (&b.counters, w1, w2)]);
        let bindings = texture::Bindings {
            knob: self.knob,
            frame: frame.constants,
            face_instances: &s.face_instances,
            faces: &s.faces,
            curves: &self.scene.curves,
            curve_points: &self.scene.curve_points,
            curve_items: &self.scene.curve_items,
            face_speeds: &t.face_speeds,
            words: &t.words,
            starts: &t.starts,
            places: &t.places,
            texels: &t.texels,
            counters: &b.counters,
        };
        let (p, placed) = (&self.passes.texture, b.counts.face_instances);
        p.sizes(cmd, &bindings, placed);
        barrier::buffers(cmd, &[(&t.words, w, r), (&b.counters, w1, w2)]);
        frame.scan(cmd, &t.words, &t.starts, placed);
        barrier::buffers(cmd, &[(&t.starts, w, r)]);
        p.flip(cmd, &bindings, b.counts.curves);
        barrier::buffers(cmd, &[(&t.texels, w1, w2), (&b.counters, w, r)]);
        p.fill(cmd, &bindings, placed);
        let tested = Access::FRAGMENT_READ | Access::COMPUTE_READ;
        barrier::buffers(cmd, &[(&t.texels, w, tested), (&t.places, w, tested), (&b.counters, r, w)]);
    }
}
