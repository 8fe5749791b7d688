//! The visible surface of each pixel: triangles of meshes, then patches. The stage of Boolean solids draws between the
//! two.

pub(crate) mod mesh;
pub(crate) mod patches;

use super::Frame;
use super::common::room::{DRAWN_AND_READ, Room};
use crate::gpu::{Access, Attachment, Commands, Device, GpuError, Image, Load, Resource, barrier};
use crate::scene::{MeshBuffers, SceneData, SolidData};
use crate::shaders::TrimTest;
use ash::vk;
use patches::{DEPTH_FORMAT, Kinds, VISIBILITY_FORMAT, Visibility as PatchPass};
use std::sync::Arc;

/// The passes.
pub(crate) struct Passes {
    patches: PatchPass,
    mesh: mesh::Mesh,
    /// Draws the patches without a trim test, to measure the test.
    #[cfg(feature = "baselines")]
    untested: Option<PatchPass>,
}

impl Passes {
    /// `test`: the trim test; `None` if no face is trimmed.
    pub(super) fn new(device: &Device, data: &SceneData, test: Option<&TrimTest>) -> Result<Self, GpuError> {
        let volume = data.volume.as_ref().and_then(SolidData::kinds);
        let kinds = Kinds {
            rational: data.has_rational,
            plain: data.has_plain,
            corner_lists: data.corner_lists(),
            linked: !data.links.is_empty(),
            trimmed: test,
            bins: !data.wide_strips.is_empty(),
            operands: data.has_operands,
            volume,
        };
        let outward = data.meshes.draws.len() - data.meshes.outward;
        let meshes = mesh::Kinds { both: data.meshes.outward > 0, outward: outward > 0, volume };
        Ok(Self {
            patches: PatchPass::new(device, kinds)?,
            mesh: mesh::Mesh::new(device, (VISIBILITY_FORMAT, DEPTH_FORMAT), meshes)?,
            #[cfg(feature = "baselines")]
            untested: super::baselines::untested(device, data, kinds)?,
        })
    }
}

/// The stage: its passes and images.
pub(crate) struct Visibility {
    passes: Arc<Passes>,
    /// Patch instance and (u, v); also meshes and solids, if they have no image of their own.
    pub image: Image,
    /// Meshes and solids, if gap filling needs them in an image of their own.
    pub meshes_and_solids: Option<Image>,
    pub depth: Image,
}

impl Visibility {
    pub(super) fn new(room: &Room<'_>, passes: &Arc<Passes>) -> Result<Self, GpuError> {
        let counts = room.counts;
        let sampled = if counts.trim.is_some() || counts.hides {
            vk::ImageUsageFlags::SAMPLED
        } else {
            vk::ImageUsageFlags::empty()
        };
        let apart = counts.trim.is_some() && (counts.mesh_instances > 0 || counts.leaves > 0);
        // pixels are read back
        let usage = DRAWN_AND_READ | vk::ImageUsageFlags::TRANSFER_SRC;
        let meshes_and_solids = || room.image("visibility without patches", VISIBILITY_FORMAT, usage);
        Ok(Self {
            passes: Arc::clone(passes),
            image: room.image("visibility", VISIBILITY_FORMAT, usage)?,
            meshes_and_solids: apart.then(meshes_and_solids).transpose()?,
            depth: room.image(
                "visibility depth",
                DEPTH_FORMAT,
                vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT | sampled,
            )?,
        })
    }

    /// The image that meshes and solids are drawn into.
    pub(super) fn of_meshes_and_solids(&self) -> &Image {
        self.meshes_and_solids.as_ref().unwrap_or(&self.image)
    }

    /// Discards the images' contents, after the previous frame has read them.
    pub(super) fn begin(&self, cmd: &Commands<'_>) {
        let read = (Access::COMPUTE_READ | Access::FRAGMENT_READ).discarded();
        let meshes_and_solids = self.meshes_and_solids.iter().map(|image| (image, read, Access::COLOUR_WRITE));
        let tested = (Access::DEPTH_WRITE | Access::COMPUTE_READ).discarded();
        let fixed = [(&self.image, read, Access::COLOUR_WRITE), (&self.depth, tested, Access::DEPTH_WRITE)];
        barrier::images(cmd, &fixed.into_iter().chain(meshes_and_solids).collect::<Vec<_>>());
    }

    /// Draws the meshes. They come first because patches in front of them may lie in gaps.
    pub(super) fn meshes(&self, frame: &Frame<'_>, cmd: &Commands<'_>, m: &MeshBuffers) {
        let bindings = mesh::Bindings {
            frame: frame.constants,
            views: frame.views,
            mesh_instances: &m.instances,
            triangles: &m.triangles,
            positions: &m.positions,
            volume: frame.volume(),
        };
        let seen = self.of_meshes_and_solids();
        self.passes.mesh.record(cmd, &bindings, (seen, &self.depth), &m.draws, m.outward);
        self.drawn_again(cmd, seen);
    }

    /// A barrier between two drawings into `seen` and the depth.
    pub(super) fn drawn_again(&self, cmd: &Commands<'_>, seen: &Image) {
        let (colour, depth) = (Access::COLOUR_WRITE, Access::DEPTH_WRITE);
        barrier::images(cmd, &[(seen, colour, colour), (&self.depth, depth, depth)]);
    }

    /// Draws the patches, with the trim test of the scene. `again`: over an earlier drawing of this frame.
    pub(super) fn patches(&self, frame: &Frame<'_>, cmd: &Commands<'_>, test: &[Resource<'_>], again: bool) {
        self.patches_by(&self.passes.patches, frame, cmd, (test, again));
    }

    /// Draws the patches without a test, into images that are cleared afterwards, to measure the test.
    #[cfg(feature = "baselines")]
    pub(super) fn untested(&self, frame: &Frame<'_>, cmd: &Commands<'_>, times: &mut super::Scopes<'_>) {
        let Some(pass) = &self.passes.untested else { return };
        times.scope(cmd, "visibility untested", || self.patches_by(pass, frame, cmd, (&[], false)));
        self.drawn_again(cmd, &self.image);
    }

    fn patches_by(
        &self,
        pass: &PatchPass,
        frame: &Frame<'_>,
        cmd: &Commands<'_>,
        (test, again): (&[Resource<'_>], bool),
    ) {
        let (s, stages) = (frame.scene, frame.stages);
        let (c, t) = (&stages.common, &stages.tessellation);
        let border_depths = stages.gaps.as_ref().map(|gaps| &gaps.border_depths);
        cmd.after(Access::COMPUTE_WRITE, Access::INDIRECT_READ);
        if let Some(border_depths) = border_depths {
            barrier::images(cmd, &[(border_depths, Access::FRAGMENT_WRITE, Access::FRAGMENT_WRITE)]);
        }
        let bindings = patches::Bindings {
            frame: frame.constants,
            placed: s.placed(frame.views),
            factors: &t.factors,
            sub_patches: &t.sub_patches,
            instances: &s.instances,
            border_depths,
            trim: test,
            volume: frame.volume(),
            links: s.links.as_ref(),
            draws: &c.draws,
            counters: &c.counters,
        };
        let drawn = again || s.meshes.is_some() || s.solids.is_some();
        let colour =
            if again || drawn && self.meshes_and_solids.is_none() { Load::Keep } else { Load::ColourU32([0; 4]) };
        let visibility = Attachment { image: &self.image, load: colour };
        let depth = Attachment { image: &self.depth, load: if drawn { Load::Keep } else { Load::Depth(0.0) } };
        let between = || {
            self.drawn_again(cmd, &self.image);
            if let Some(border_depths) = border_depths {
                barrier::images(cmd, &[(border_depths, Access::FRAGMENT_WRITE, Access::FRAGMENT_WRITE)]);
            }
        };
        pass.record(cmd, &bindings, (visibility, depth), frame.capacities.tessellation.draws, between);
    }
}
