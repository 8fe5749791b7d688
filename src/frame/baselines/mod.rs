//! Ways to trim that only benchmarks and tests use: see `src/baselines`.
//!
//! ```text
//!   cells ──density──▶ face speeds ──sizes──(scan)──▶ starts      textures only; the others have no pass
//!   curves ──flip──▶ bits ──fill──▶ texels, places
//! ```
//!
//! Also measures drawing without a trim test: the frame's sub-patches are drawn into images that pass `visibility` then
//! clears.

pub(crate) mod slefe;
pub(crate) mod texture;

use super::common::room::Room;
use super::trim::density;
use super::visibility::patches;
use super::{Frame, WRITE_TO_READ};
use crate::baselines::TrimMethod;
use crate::gpu::{Access, Buffer, Commands, Device, GpuError, Resource, Texel, TexelBuffer, Timestamps, barrier};
use crate::scene::{BaselineScene, Scene, SceneData, TableScene};
use crate::shaders::{TRIM_BISECT, TRIM_TEXTURE, TRIM_UNTRIMMED, TrimTest};
use std::sync::Arc;

/// The passes of a baseline's way to trim.
pub(crate) enum Passes {
    Untrimmed,
    Bisect,
    Texture(Arc<TexturePasses>),
}

/// The passes of trim textures.
pub(crate) struct TexturePasses {
    density: density::Density,
    texture: texture::BaselineTexture,
}

impl Passes {
    pub(super) fn new(device: &Device, method: TrimMethod) -> Result<Self, GpuError> {
        Ok(match method {
            TrimMethod::Untrimmed => Self::Untrimmed,
            TrimMethod::Bisect { .. } => Self::Bisect,
            TrimMethod::Texture { .. } => Self::Texture(Arc::new(TexturePasses {
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

/// A baseline's way to trim, with its buffers.
pub(crate) enum Trim {
    Untrimmed,
    Bisect,
    Texture(Box<Textures>),
}

/// Trim textures, and the buffers from which they are made.
pub(crate) struct Textures {
    passes: Arc<TexturePasses>,
    strip_heights: Buffer,
    face_speeds: Buffer,
    words: Buffer,
    starts: Buffer,
    places: TexelBuffer,
    /// As long as the capacity of intercepts.
    texels: TexelBuffer,
}

impl Trim {
    pub(super) fn new(room: &Room<'_>, passes: &Passes) -> Result<Self, GpuError> {
        Ok(match passes {
            Passes::Untrimmed => Self::Untrimmed,
            Passes::Bisect => Self::Bisect,
            Passes::Texture(passes) => Self::Texture(Box::new(Textures::new(room, passes)?)),
        })
    }

    /// Clears what the passes count.
    pub(super) fn begin(&self, cmd: &Commands<'_>) {
        if let Self::Texture(textures) = self {
            textures.counted().into_iter().for_each(|buffer| cmd.fill(buffer, 0));
        }
    }

    /// Makes the textures, in scenes with trim textures.
    pub(super) fn record(&self, frame: &Frame<'_>, cmd: &Commands<'_>, times: &mut Timestamps) {
        if let (Self::Texture(textures), Some(BaselineScene::Texture(scene, knob))) = (self, frame.scene.baseline()) {
            times.scope(cmd, "trim texture", || textures.record(frame, cmd, (scene, knob)));
        }
    }

    /// The trim test's resources, in its order.
    pub(super) fn test<'a>(&'a self, scene: &'a Scene) -> Vec<Resource<'a>> {
        match (self, scene.baseline()) {
            (Self::Texture(t), _) => vec![Resource::from(&t.places), Resource::from(&t.texels)],
            (Self::Bisect, Some(BaselineScene::Bisect(buffers))) => buffers.iter().map(Resource::from).collect(),
            _ => Vec::new(),
        }
    }
}

/// Pass `visibility` without a trim test; `None` if it is not requested, or if no patch is trimmed.
pub(super) fn untested(
    device: &Device,
    data: &SceneData,
    kinds: patches::Kinds<'_>,
) -> Result<Option<patches::Visibility>, GpuError> {
    let meshes_and_solids = data.has_meshes() || data.solids.kinds().is_some() || kinds.volume.is_some();
    let kinds = patches::Kinds { trimmed: kinds.trimmed.map(|_| &TRIM_UNTRIMMED), ..kinds };
    let made = data.untested && !meshes_and_solids && kinds.trimmed.is_some();
    made.then(|| patches::Visibility::new(device, kinds)).transpose()
}

impl Textures {
    fn new(room: &Room<'_>, passes: &Arc<TexturePasses>) -> Result<Self, GpuError> {
        let counts = room.counts;
        Ok(Self {
            passes: Arc::clone(passes),
            strip_heights: room.words("trim strip heights", counts.bins)?,
            face_speeds: room.words("trim face speeds", 2 * counts.face_instances)?,
            words: room.words("trim texture sizes", counts.face_instances)?,
            starts: room.words("trim texture starts", counts.face_instances + 1)?,
            places: room.texels::<[u32; 4]>("trim texture places", counts.bins, Texel::U32x4)?,
            texels: room.texels::<u32>("trim texels", room.capacities.trim.intercepts, Texel::Words)?,
        })
    }

    /// The buffers that are zero when the frame begins.
    fn counted(&self) -> [&Buffer; 3] {
        [&self.strip_heights, &self.face_speeds, &self.texels]
    }

    /// Records the passes, and the barrier before the trim test.
    fn record(&self, frame: &Frame<'_>, cmd: &Commands<'_>, (scene, knob): (&TableScene, &Buffer)) {
        let (s, b, t, counts) = (frame.scene, &frame.stages.common, self, frame.counts);
        let (w, r) = WRITE_TO_READ;
        let cleared = (Access::TRANSFER_WRITE, Access::COMPUTE_WRITE);
        barrier::buffers(cmd, &t.counted().map(|buffer| (buffer, cleared.0, cleared.1)));
        let density = density::Bindings {
            frame: frame.constants,
            views: frame.views,
            instances: &s.instances,
            face_instances: &s.face_instances,
            faces: &s.faces,
            cells: &scene.cells,
            cell_instances: &scene.cell_instances,
            strip_heights: &t.strip_heights,
            face_speeds: &t.face_speeds,
            seen_bins: None,
        };
        self.passes.density.record(cmd, &density, counts.cells);
        cmd.after(w, r | w);
        let bindings = texture::Bindings {
            knob,
            frame: frame.constants,
            face_instances: &s.face_instances,
            faces: &s.faces,
            curves: &scene.curves,
            curve_points: &scene.curve_points,
            curve_instances: &scene.curve_instances,
            face_speeds: &t.face_speeds,
            words: &t.words,
            starts: &t.starts,
            places: &t.places,
            texels: &t.texels,
            counters: &b.counters,
        };
        let (p, placed) = (&self.passes.texture, counts.face_instances);
        p.sizes(cmd, &bindings, placed);
        cmd.after(w, r | w);
        b.scan(cmd, &t.words, &t.starts, placed);
        cmd.after(w, r);
        p.flip(cmd, &bindings, counts.curves);
        cmd.after(w, w | r);
        p.fill(cmd, &bindings, placed);
        let tested = Access::FRAGMENT_READ | Access::COMPUTE_READ;
        cmd.after(w, tested | w);
    }
}
