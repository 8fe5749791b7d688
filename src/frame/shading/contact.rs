//! The stage of ambient occlusion: its image, and the barriers around its two passes.

use super::ambient::{AMBIENT_FORMAT, Ambient, Bindings};
use crate::frame::Frame;
use crate::frame::common::room::Room;
use crate::gpu::{Access, Commands, Device, GpuError, Image, barrier};
use crate::scene::SceneData;
use ash::vk;
use std::sync::Arc;

/// The passes, and the radius in model units.
pub(crate) struct Passes {
    pass: Ambient,
    radius: f32,
}

impl Passes {
    /// `None` in scenes without ambient occlusion.
    pub(crate) fn new(device: &Device, data: &SceneData) -> Result<Option<Self>, GpuError> {
        data.ambient.map(|radius| Ok(Self { pass: Ambient::new(device)?, radius: radius as f32 })).transpose()
    }
}

/// The stage.
pub(crate) struct Contact {
    passes: Arc<Passes>,
    image: Image,
}

impl Contact {
    pub(crate) fn new(room: &Room<'_>, passes: &Arc<Passes>) -> Result<Self, GpuError> {
        let image = room.image("ambient", AMBIENT_FORMAT, vk::ImageUsageFlags::STORAGE)?;
        Ok(Self { passes: Arc::clone(passes), image })
    }

    /// Darkens the colours of `resolved` after pass `resolve`. The last write is by a compute shader.
    pub(crate) fn record(&self, frame: &Frame<'_>, cmd: &Commands<'_>, resolved: &Image) {
        let Passes { pass, radius } = &*self.passes;
        let (w, r) = (Access::COMPUTE_WRITE, Access::COMPUTE_READ);
        let bindings = Bindings { frame: frame.constants, resolved, ambient: &self.image };
        barrier::images(cmd, &[(resolved, Access::COLOUR_WRITE, r)]);
        barrier::images(cmd, &[(&self.image, r.discarded(), w)]);
        pass.find(cmd, &bindings, *radius);
        barrier::images(cmd, &[(&self.image, w, r), (resolved, r, r | w)]);
        pass.write(cmd, &bindings, *radius);
    }
}
